#pragma once

#include <functional>
#include <memory>

#include "labeling/lp_engine.h"
#include "labeling/problem.h"
#include "labeling/rows.h"
#include "labeling/run_control.h"
#include "labeling/solution.h"
#include "labeling/solver.h"

namespace labeling {

struct NeighbourhoodSearchOptions {
    LpFactory lp;  ///< empty: windows are solved by the tree alone
    std::uint64_t seed = 1;
    int threads = 1;                    ///< of the local search
    bool differences = true;            ///< half of the windows where good labelings differ
    std::function<void(Value)> report;  ///< every better value; may be empty
};

struct NeighbourhoodSearchStatistics {
    std::int64_t windows = 0, differences = 0, solved = 0, improved = 0;
};

/// Improves a feasible labeling until `control` stops it, by local search that solves windows
/// exactly in between. Deterministic per seed and work, on any number of threads.
Solution search_neighbourhoods(const LabelingProblem& problem, const RowSystem& rows,
                               RunControl& control, Solution start,
                               const NeighbourhoodSearchOptions& options,
                               NeighbourhoodSearchStatistics* statistics = nullptr);

/// `lns`: greedy, then the above; about 20 s of work unless limited otherwise.
std::shared_ptr<const Solver> make_lns_solver(LpFactory lp = {});

}  // namespace labeling
