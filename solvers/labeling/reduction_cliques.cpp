// Labels whose conflict partners are a clique (isolated vertex removal with weight transfer, Lamm
// et al. 2019). Without rules and with a weight that is not negative such a label is 1 where none
// of its partners is, which is 1 - (sum of the partners) since they exclude each other. Put into
// the objective, that takes the label out whatever the partners carry: their weights fall by its
// weight. A bonus with k becomes weight of k less the same bonus of k with every partner that k is
// not in conflict with, so those bonuses must be at least as large.
#include <algorithm>
#include <vector>

#include "labeling/reduction_state.h"

namespace labeling {
namespace {

constexpr std::size_t kLargestClique = 60;

bool is_clique(ReductionState& state, std::span<const Label> labels) {
    for (std::size_t k = 1; k < labels.size(); ++k) {
        for (std::size_t l = 0; l < k; ++l) {
            ++state.work;
            if (!state.in_conflict(labels[l], labels[k])) return false;
        }
    }
    return true;
}

bool can_move_bonuses(const ReductionState& state, Label i) {
    for (const auto& b : state.bonuses_of(i)) {
        for (Label j : state.conflicts_of(i)) {
            if (!state.in_conflict(j, b.label) && state.bonus(j, b.label) < b.value) return false;
        }
    }
    return true;
}

}  // namespace

bool reduce_clique(ReductionState& state, Label i) {
    const auto conflicts = state.conflicts_of(i);
    const Value weight = state.weight(i);
    if (weight < 0 || conflicts.empty() || conflicts.size() > kLargestClique) return false;
    if (!state.uses(i).empty() || !is_clique(state, conflicts)) return false;
    if (!can_move_bonuses(state, i)) return false;
    const auto count = static_cast<Value>(conflicts.size());
    if (!state.may_grow(count * weight)) return false;
    const std::vector<Label> clique(conflicts.begin(), conflicts.end());
    const auto bonus_span = state.bonuses_of(i);
    const std::vector<ReductionState::Partner> bonuses(bonus_span.begin(), bonus_span.end());
    state.add_offset(weight);
    state.spare(i);
    for (Label j : clique) state.add_weight(j, -weight);
    for (const auto& b : bonuses) {
        state.add_weight(b.label, b.value);
        for (Label j : clique) state.add_bonus(j, b.label, -b.value);
    }
    return true;
}

}  // namespace labeling
