#pragma once

#include <functional>
#include <optional>

#include "labeling/problem.h"
#include "labeling/rows.h"
#include "labeling/run_control.h"
#include "labeling/solution.h"
#include "labeling/solver.h"

namespace labeling {

struct ReducedSearchResult {
    std::optional<Solution> solution;
    bool is_infeasible = false;  ///< proven
};

/// Improves a feasible labeling of the problem given; reports better values of it.
using Improve = std::function<Solution(const LabelingProblem& problem, const RowSystem& rows,
                                       Solution start, const std::function<void(Value)>& report)>;

/// So long that a labeling is wanted before.
bool takes_long_to_reduce(const LabelingProblem& problem);

/// Whether heuristics are better off with reductions first, unless told. Folded labels take several
/// of the problem's at once, so moves see less: with rules, searches got stuck up to 5% lower.
/// Rules aside, and where labels are many, what reductions remove is worth more.
bool should_reduce_first(const LabelingProblem& problem);

/// The frame of the heuristics: reductions (if so told), greedy, `improve` on what is left,
/// lifting. Never worse than a feasible warm start.
ReducedSearchResult search_reduced(const LabelingProblem& problem, const SolveOptions& options,
                                   RunControl& control, bool is_reducing, const Improve& improve);

}  // namespace labeling
