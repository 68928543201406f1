#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/pass_guard.h"
#include "labeling/problem.h"
#include "labeling/propagation.h"
#include "labeling/rows.h"

namespace labeling {

/// What is left of a problem on some of its undecided labels, and the way back.
struct Subproblem {
    LabelingProblem problem;
    std::vector<Label> to_parent;  ///< per label of `problem`
};

/// Splits what a propagated partial assignment leaves open into independent parts: labels of
/// different parts share no conflict, no bonus and no rule that could still be violated.
/// A part's weights include the bonuses to labels that are on; its rules are the open rows with
/// what is decided moved to the right-hand side. One object can split many times; each split costs
/// the adjacency of the undecided labels.
class Decomposer {
public:
    Decomposer(const LabelingProblem& problem, const RowSystem& rows);
    /// Of the passes from now on.
    void set_guard(PassGuard guard) { guard_ = guard; }

    /// Undecided labels grouped by part, each ascending, parts ordered by first label.
    std::vector<std::vector<Label>> parts(const Propagator& propagator);
    /// Undecided labels are `members`; they must be a union of parts.
    Subproblem extract(const Propagator& propagator, std::span<const Label> members);

    /// Adjacency entries touched so far.
    std::int64_t work() const { return work_; }

private:
    /// A row matters while some completion could violate it.
    bool is_open(const Propagator& propagator, std::int32_t row) const;
    Label find(Label i);
    void join(Label i, Label j);

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    std::vector<Label> parent_, local_;
    std::vector<std::int32_t> part_of_;
    std::int64_t work_ = 0;
    PassGuard guard_;
};

/// Value of what is decided: weights of labels that are on and bonuses between them.
Value decided_value(const LabelingProblem& problem, std::span<const std::int8_t> values);

/// Sum of the positive weights and all bonuses: no labeling is worth more.
Value sum_of_gains(const LabelingProblem& problem);

}  // namespace labeling
