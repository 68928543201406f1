#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "labeling/cut_lane.h"
#include "labeling/lp_engine.h"
#include "labeling/problem.h"
#include "labeling/run_control.h"
#include "labeling/solution.h"
#include "labeling/techniques.h"
#include "labeling/tree_search.h"

namespace labeling {

struct BranchAndCutOptions {
    LpFactory lp;
    std::uint64_t seed = 1;
    int threads = 1;
    Techniques techniques;
    /// Called with every better value (of the whole problem given) and bound.
    std::function<void(std::optional<Value>, std::optional<Value>)> report;
    /// Solves what is left when fixing by bounds has shrunk or split the problem at the root; gets
    /// the problem and a start that may be absent. Empty: the tree does it all.
    std::function<TreeResult(const LabelingProblem&, const std::optional<Solution>&)> solve_rest;
};

/// LP-based branch and cut for one connected problem. `start`, if given, is feasible. Looks for
/// solutions of value > lower; every bound it prunes with is exact.
TreeResult branch_and_cut(const LabelingProblem& problem, const std::optional<Solution>& start,
                          Value lower, RunControl& control, const BranchAndCutOptions& options,
                          BranchAndCutStatistics* statistics = nullptr);

}  // namespace labeling
