#pragma once

#include <optional>
#include <vector>

#include "labeling/problem.h"
#include "labeling/solution.h"

namespace fcn {

/// What keeps a label out: kept labels in conflict with it, and the kept labels of the rules that
/// putting it in would break. Putting it in and taking these out is infeasible or does not raise
/// the objective of an optimal solution.
std::vector<int> find_blockers(const labeling::LabelingProblem& problem,
                               const labeling::Solution& solution, int label);

/// By how much the objective falls with `label` in and `blockers` out, in the problem's units;
/// nothing where the labels then break a conflict or a rule.
std::optional<labeling::Value> swap_margin(const labeling::LabelingProblem& problem,
                                           const labeling::Solution& solution, int label,
                                           const std::vector<int>& blockers);

}  // namespace fcn
