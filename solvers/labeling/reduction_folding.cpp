// Labels with two conflict partners a and b that are in no conflict (vertex folding, Lamm et al.
// 2019; the V-shapes of Gellner et al. 2021). Without rules and bonuses such a label is 1 where
// neither partner is: (1 - a)(1 - b) = 1 - a - b + ab. So it always goes: both partners lose its
// weight and earn it back together, as a bonus. Folding proper is what follows: where neither
// partner is worth anything without the other, they are merged.
#include "labeling/reduction_state.h"

namespace labeling {

bool reduce_two_conflicts(ReductionState& state, Label i) {
    const auto conflicts = state.conflicts_of(i);
    if (conflicts.size() != 2 || !state.uses(i).empty() || !state.bonuses_of(i).empty())
        return false;
    const Value weight = state.weight(i);
    const Label a = conflicts[0], b = conflicts[1];
    if (weight < 0 || state.in_conflict(a, b) || !state.may_grow(3 * weight)) return false;
    state.add_offset(weight);
    state.spare(i);
    state.add_weight(a, -weight);
    state.add_weight(b, -weight);
    state.add_bonus(a, b, weight);
    return true;
}

}  // namespace labeling
