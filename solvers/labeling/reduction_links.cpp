// Labels whose values are linked. A label that can join whenever another is on (all its conflict
// partners are off then, its weight is not negative, no row minds) needs no bonus with it: the
// bonus becomes weight of the other, and the label is raised when the solution is lifted. A label
// that is worth nothing without another one, and that no row needs, is on only with it. Where links
// go both ways, the two labels always have the same value and become one; twins, labels with the
// same conflict partners (Lamm et al. 2019), are an instance.
#include <algorithm>

#include "labeling/reduction_state.h"

namespace labeling {
namespace {

constexpr std::size_t kMostConflicts = 300;

bool can_join(ReductionState& state, Label i, Label when) {
    const auto mine = state.conflicts_of(i);
    const auto its = state.conflicts_of(when);
    if (state.weight(i) < 0 || mine.size() > its.size()) return false;
    state.work += static_cast<std::int64_t>(mine.size() + its.size());
    return std::includes(its.begin(), its.end(), mine.begin(), mine.end()) &&
           state.is_safe({.on = {&i, 1}, .off = {}, .known_on = when, .known_off = its});
}

bool is_worthless_without(const ReductionState& state, Label i, Label other) {
    return state.potential(i) - state.bonus(i, other) <= 0 && state.can_be_dropped(i);
}

/// A label with the same conflict partners and no conflict with i; -1: none.
Label twin_of(ReductionState& state, Label i) {
    const auto conflicts = state.conflicts_of(i);
    if (conflicts.empty()) return -1;
    const Label nearest =
        *std::min_element(conflicts.begin(), conflicts.end(), [&](Label a, Label b) {
            return state.conflicts_of(a).size() < state.conflicts_of(b).size();
        });
    const auto candidates = state.conflicts_of(nearest);
    if (candidates.size() > kMostConflicts) return -1;
    state.work += static_cast<std::int64_t>(candidates.size());
    for (Label k : candidates) {
        if (k == i) continue;
        const auto its = state.conflicts_of(k);
        if (its.size() == conflicts.size() &&
            std::equal(its.begin(), its.end(), conflicts.begin())) {
            return k;
        }
    }
    return -1;
}

}  // namespace

bool reduce_linked(ReductionState& state, Label i) {
    if (state.conflicts_of(i).size() > kMostConflicts) return false;
    for (const auto& b : state.bonuses_of(i)) {
        const Label k = b.label;
        const bool i_joins = can_join(state, i, k), k_joins = can_join(state, k, i);
        if ((i_joins || is_worthless_without(state, k, i)) &&
            (k_joins || is_worthless_without(state, i, k))) {
            state.merge(i, k);
            return true;
        }
        if (!i_joins && !k_joins) continue;
        if (i_joins) {
            state.grant_bonus(i, k);
        } else {
            state.grant_bonus(k, i);
        }
        return true;
    }
    const Label twin = twin_of(state, i);
    if (twin < 0 || !can_join(state, i, twin) || !can_join(state, twin, i)) return false;
    state.merge(i, twin);
    return true;
}

}  // namespace labeling
