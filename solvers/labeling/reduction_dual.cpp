// Labels that nothing wants or nothing opposes (dual fixing of integer programming). A label whose
// weight and bonuses together bring nothing is 0 if no row needs it. A label of no negative weight
// without conflicts is 1 if no row can be violated by it; a keep-label of an extraordinary node
// far from all others is the common case.
#include "labeling/reduction_state.h"

namespace labeling {

bool reduce_dual(ReductionState& state, Label i) {
    if (state.potential(i) <= 0 && state.can_be_dropped(i)) {
        state.fix(i, false);
        return true;
    }
    if (state.weight(i) < 0 || !state.conflicts_of(i).empty()) return false;
    if (!state.is_safe({.on = {&i, 1}, .off = {}, .known_off = {}})) return false;
    state.fix(i, true);
    return true;
}

}  // namespace labeling
