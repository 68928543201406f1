#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "labeling/problem.h"
#include "labeling/rows.h"
#include "labeling/run_control.h"
#include "labeling/solution.h"
#include "labeling/solver.h"

namespace labeling {

struct LocalSearchOptions {
    std::uint64_t seed = 1;
    /// Work of the first annealing chain in ticks; 0 = chosen from the size.
    std::int64_t first_chain = 0;
    /// Temperature at which the first chain begins, in medians of (weight + half the bonuses).
    double start_temperature = 3.0;
};

struct LocalSearchStatistics {
    std::int64_t moves = 0, accepted = 0, chains = 0, windows = 0;
    Value crossover_gain = 0;  ///< value won by keeping the good parts of worse chains
};

/// Improves a feasible labeling until `control` stops it. Deterministic per seed and work. Each
/// improvement of the best is passed to `report` (may be empty).
Solution improve_labeling(const LabelingProblem& problem, const RowSystem& rows,
                          RunControl& control, Solution start, const LocalSearchOptions& options,
                          const std::function<void(Value)>& report = {},
                          LocalSearchStatistics* statistics = nullptr);

std::shared_ptr<const Solver> make_local_search_solver();

}  // namespace labeling
