#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "labeling/pass_guard.h"
#include "labeling/problem.h"
#include "labeling/run_control.h"
#include "labeling/solution.h"

namespace labeling {

/// Families of reductions, each in a file of its own (reduction_*.cpp). Propagation of rules and of
/// fixed labels is always on.
struct ReductionOptions {
    bool rules = true;        ///< redundant and dominated rules, rules that are conflicts
    bool dual_fixing = true;  ///< labels that nothing wants or nothing opposes
    bool neighbourhoods =
        true;                ///< labels and runs worth more than all that they are in conflict with
    bool domination = true;  ///< labels that a conflict partner can always stand in for
    bool linked_labels = true;  ///< bonuses that come by themselves, labels that are always equal
    bool cliques = true;        ///< labels with a clique for neighbourhood
    bool folding = true;        ///< labels with two conflict partners
};

struct ReductionStatistics {
    std::int64_t labels = 0, conflicts = 0, bonuses = 0, rules = 0;  ///< removed; may be negative
    std::int64_t rule_steps = 0, dual_steps = 0, neighbourhood_steps = 0, domination_steps = 0,
                 link_steps = 0, clique_steps = 0, folding_steps = 0;
};

/// A smaller problem with the same optimum less a constant, and the way back.
class ReducedProblem {
public:
    const LabelingProblem& problem() const { return problem_; }
    /// Proven while reducing; then problem() is empty and means nothing.
    bool is_infeasible() const { return is_infeasible_; }
    /// Optimum of the original = optimum of problem() + offset().
    Value offset() const { return offset_; }
    const ReductionStatistics& statistics() const { return statistics_; }

    /// Feasible for the original; its value is at least that of `reduced` + offset(), and equal to
    /// it when `reduced` is optimal.
    Solution lift(const LabelingProblem& original, const Solution& reduced) const;
    /// What a start of the original (1, 0, -1 per label) says of the labels that are left.
    std::vector<std::int8_t> project(std::span<const std::int8_t> start) const;

private:
    friend class ReductionState;
    /// How the value of a label that is gone, or that may be raised, follows from the others.
    struct Step {
        enum class Kind : std::uint8_t {
            Fixed,   ///< value is `other`
            Equal,   ///< value is that of label `other`
            Spare,   ///< 1 where none of `partners` is 1
            Raised,  ///< 1 where label `other` is 1, as it was otherwise
        };
        Kind kind;
        Label label, other;
        std::size_t partners_begin, partners_end;
    };

    LabelingProblem problem_;
    std::vector<Label> to_original_;
    std::vector<Step> steps_;
    std::vector<Label> partners_;
    Value offset_ = 0;
    bool is_infeasible_ = false;
    ReductionStatistics statistics_;
};

/// Applies every reduction until none is left or `control` stops; what has been done by then
/// counts. Rules stay <= rows of small integers; weights may become negative.
ReducedProblem reduce_problem(const LabelingProblem& problem, RunControl& control,
                              const ReductionOptions& options = {}, PassGuard guard = {});

}  // namespace labeling
