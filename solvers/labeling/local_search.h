#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "labeling/problem.h"
#include "labeling/rows.h"
#include "labeling/run_control.h"
#include "labeling/solution.h"
#include "labeling/solver.h"

namespace labeling {

struct LocalSearchOptions {
    std::uint64_t seed = 1;
    /// Change the time a search takes, not its answer (unless time ends it).
    int threads = 1;
    /// Searches that go on side by side from the same best; 1 to 16.
    int lanes = 2;
    /// Work of the first annealing chain in ticks; 0 = chosen from the size.
    std::int64_t first_chain = 0;
    /// Ends when nothing worthwhile was found in so many ticks, nor in a third of all; 0 = never.
    std::int64_t patience = 0;
    /// Temperature at which the first chain begins, in medians of (weight + half the bonuses).
    double start_temperature = 3.0;

    // Techniques; each is an extra option of the same name with '-' for '_', on or off.
    bool regions = true;        ///< lanes anneal regions of their own where that pays
    bool windows = true;        ///< chains over windows of connected labels
    bool adaptive = true;       ///< learn which kind of chain pays; off: any
    bool by_worth = true;       ///< some chains are hotter where labels are worth more
    bool restarts = true;       ///< climb anew when a climb comes to nothing
    bool recombination = true;  ///< of a climb's end with those before
    bool merging = true;        ///< of the ends of the last chains, exactly

    /// Gets a third to a tenth of the work, if given: may improve the labeling; the others are the
    /// ends of earlier climbs. Spends its work on the same control.
    std::function<void(Solution&, std::span<const Solution>)> intensify;
};

struct LocalSearchStatistics {
    std::int64_t moves = 0, accepted = 0, chains = 0, windows = 0, climbs = 0, recombined = 0,
                 merges = 0, merged = 0;
};

/// Improves a feasible labeling until `control` stops it. Deterministic per seed and work, on any
/// number of threads. Each improvement of the best is passed to `report` (may be empty).
Solution improve_labeling(const LabelingProblem& problem, const RowSystem& rows,
                          RunControl& control, Solution start, const LocalSearchOptions& options,
                          const std::function<void(Value)>& report = {},
                          LocalSearchStatistics* statistics = nullptr);

std::shared_ptr<const Solver> make_local_search_solver();

}  // namespace labeling
