#pragma once

#include <cstdint>
#include <vector>

#include "labeling/propagation.h"
#include "labeling/relaxation.h"

namespace labeling {

/// Keeps the column bounds of a relaxation equal to a propagator's decisions: labels as decided,
/// bonuses at 0 once one of their labels is off.
class NodeState {
public:
    NodeState(const LabelingProblem& problem, Propagator& propagator, Relaxation& relaxation);
    /// The same decisions on copies of its propagator and relaxation.
    NodeState(const NodeState& other, Propagator& propagator, Relaxation& relaxation);

    /// Assigns, propagates, passes the consequences on; false on a contradiction (then undo).
    bool assign(Label i, bool value);
    /// Passes on what the propagator has decided since the last call.
    void synchronize();
    std::size_t size() const { return propagator_.trail().size(); }
    void undo(std::size_t size);
    /// The bonus is earned in no solution worth finding: fixed to 0 from now on.
    void forbid_bonus(std::int32_t bonus);

    Propagator& propagator() { return propagator_; }
    Relaxation& relaxation() { return relaxation_; }

private:
    const LabelingProblem& problem_;
    Propagator& propagator_;
    Relaxation& relaxation_;
    std::vector<std::size_t> bonus_begin_;
    std::vector<std::int32_t> bonuses_at_;
    std::vector<std::int32_t> fixed_;        ///< columns, in order
    std::vector<std::size_t> fixed_before_;  ///< per synchronized trail entry
};

}  // namespace labeling
