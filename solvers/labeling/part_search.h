#pragma once

#include <functional>
#include <optional>
#include <span>

#include "labeling/branch_and_cut.h"
#include "labeling/lp_engine.h"
#include "labeling/problem.h"
#include "labeling/run_control.h"
#include "labeling/techniques.h"
#include "labeling/tree_search.h"
#include "labeling/treewidth_search.h"

namespace labeling {

struct PartSearchOptions {
    LpFactory lp;  ///< empty: clique bounds alone
    std::uint64_t seed = 1;
    int threads = 1;  ///< of the local search
    Techniques techniques;
    bool has_labeling = false;  ///< once the run is over, a large problem needs no other
    bool is_wide = false;       ///< known from start_part: dynamic programming takes too long
    TreewidthStatistics* treewidth = nullptr;  ///< counts on; may be null
    /// Better values and bounds of the part as they are found; may be empty.
    std::function<void(std::optional<Value>, std::optional<Value>)> report;
};

struct PartStart {
    std::optional<Solution> solution;
    bool is_infeasible = false;  ///< proven
    bool is_optimal = false;     ///< proven: nothing is left to do
};

/// The optimum, if dynamic programming takes no longer than a proof by branch-and-cut usually
/// would. Else greedy, then local search as long as the size justifies; nothing without heuristics.
/// `labels`: one entry per label, 1, 0 or -1 (unknown), or empty.
PartStart start_part(const LabelingProblem& problem, std::span<const std::int8_t> labels,
                     RunControl& control, const PartSearchOptions& options);

/// Solves one connected problem as far as `control` allows: as start_part if narrow, the
/// depth-first tree for few labels, branch-and-cut for more. The solution is the best found,
/// `start` included; bound == kNoValue proves that there is none.
TreeResult prove_part(const LabelingProblem& problem, const std::optional<Solution>& start,
                      RunControl& control, const PartSearchOptions& options,
                      BranchAndCutStatistics* statistics);

}  // namespace labeling
