#pragma once

#include <functional>
#include <optional>
#include <span>

#include "labeling/branch_and_cut.h"
#include "labeling/lp_engine.h"
#include "labeling/problem.h"
#include "labeling/run_control.h"
#include "labeling/tree_search.h"

namespace labeling {

struct PartSearchOptions {
    LpFactory lp;  ///< empty: clique bounds alone
    std::uint64_t seed = 1;
    /// One entry per label, 1, 0 or -1, or empty.
    std::span<const std::int8_t> start;
    /// Better values and bounds of the part as they are found; may be empty.
    std::function<void(std::optional<Value>, std::optional<Value>)> report;
};

/// Solves one connected problem as far as `control` allows: greedy, local search as long as the
/// size justifies, then the depth-first tree for few labels and branch-and-cut for more. The
/// solution is the best found; bound == kNoValue proves that there is none.
TreeResult search_part(const LabelingProblem& problem, RunControl& control,
                       const PartSearchOptions& options, BranchAndCutStatistics* statistics);

}  // namespace labeling
