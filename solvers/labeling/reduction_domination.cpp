// Labels that a conflict partner can always stand in for (domination, Lamm et al. 2019): where i is
// on, k could be on instead, since all that k is in conflict with is off then. i goes if k is worth
// as much, i's bonuses included as far as k does not earn the same with the same partner, and if no
// row can be violated by the exchange.
#include "labeling/reduction_state.h"

namespace labeling {
namespace {

constexpr std::size_t kMostConflicts = 300;

bool is_worth_more(const ReductionState& state, Label keep, Label drop) {
    Value lead = state.weight(keep) - state.weight(drop);
    if (lead < 0) return false;
    for (const auto& b : state.bonuses_of(drop)) {
        const Value same = state.bonus(keep, b.label);
        if (same < b.value) lead -= b.value - same;
        if (lead < 0) return false;
    }
    return true;
}

bool can_stand_in(ReductionState& state, Label keep, Label drop) {
    const auto mine = state.conflicts_of(keep);
    const auto its = state.conflicts_of(drop);
    if (mine.size() > its.size() || !is_worth_more(state, keep, drop)) return false;
    state.work += static_cast<std::int64_t>(mine.size() + its.size());
    std::size_t at = 0;
    for (Label j : mine) {
        if (j == drop) continue;
        while (at < its.size() && its[at] < j) ++at;
        if (at == its.size() || its[at] != j) return false;
    }
    return state.is_safe(
        {.on = {&keep, 1}, .off = {&drop, 1}, .known_off = its, .is_certain = true});
}

}  // namespace

bool reduce_dominated(ReductionState& state, Label i) {
    const auto conflicts = state.conflicts_of(i);
    if (conflicts.size() > kMostConflicts) return false;
    for (Label j : conflicts) {
        for (const auto& [keep, drop] : {std::pair(i, j), std::pair(j, i)}) {
            if (!can_stand_in(state, keep, drop)) continue;
            state.fix(drop, false);
            return true;
        }
    }
    return false;
}

}  // namespace labeling
