#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiment/bootstrap.h"
#include "experiment/campaign_runs.h"
#include "experiment/cross_check.h"
#include "experiment/run_reading.h"

namespace experiment {

/// Gaps to the best known value of the time-to-target tables.
constexpr std::array<double, 3> kTargets{0.01, 0.001, 0};

/// Times within this factor, or both below the floor, are a tie.
constexpr double kTieFactor = 1.1;

/// A solver on a problem: medians over its seeds and renamings, of the runs that were made.
struct Cell {
    Standing standing = Standing::NotRun;
    bool is_planned = false;
    std::size_t made = 0;
    bool is_proven = false;    ///< in more than half of the runs
    bool was_stopped = false;  ///< by a limit of time or work, in any of them
    double seconds = 0;        ///< of all runs, as measured
    double counted = 0;        ///< runs without a proof at the limit
    double par10 = 0;          ///< the same at ten times the limit
    double spread = 1;  ///< slowest over fastest run, floored; NaN of one run or without a proof
    std::optional<std::int64_t> value;         ///< the lower one of two in the middle
    double gap_to_best = 1, gap_to_bound = 1;  ///< NaN when nothing is known to compare with
    double primal_integral = 0;                ///< seconds; NaN when no solution is known
    std::array<double, kTargets.size()> target_seconds{};  ///< infinite: never; NaN as above
    double instructions = 0;                               ///< NaN where they are not counted
};

struct SolverSummary {
    bool is_exact = false;                                                ///< claims bounds
    std::size_t taken = 0, not_applicable = 0, missing = 0, not_run = 0;  ///< problems
    std::size_t runs_planned = 0, runs_made = 0, runs_over_limit = 0;
    std::map<Outcome, std::size_t> outcomes;                           ///< of runs
    std::size_t proven = 0, with_value = 0, at_best = 0, fastest = 0;  ///< problems
    Interval time;   ///< shifted geometric mean, unproven at the limit
    Interval par10;  ///< mean
    Interval gap_to_best, gap_to_bound, primal_integral;  ///< means
    std::array<std::size_t, kTargets.size()> reached{};
    double instructions = 0;  ///< geometric mean; NaN where none were counted
    double spread = 0;        ///< geometric mean; NaN where there is none
    /// Of runs with a proof, seconds; NaN without any.
    double shortest_proof = std::numeric_limits<double>::quiet_NaN();
    double longest_proof = std::numeric_limits<double>::quiet_NaN();
    std::size_t ended_unproven = 0;  ///< runs that ended by themselves with an answer and no proof
};

/// Solver `a` against `b` on the problems that both took.
struct PairComparison {
    std::size_t a = 0, b = 0, common = 0;
    std::size_t both_proven = 0, only_a = 0, only_b = 0;  ///< exact solvers
    std::size_t faster_a = 0, faster_b = 0, ties = 0;     ///< where at least one proves
    Interval time_ratio;  ///< time of b over time of a, floored, where at least one proves
    std::size_t better_a = 0, better_b = 0, equal = 0;  ///< median values
    Interval gap_difference;  ///< gap of b minus gap of a to the best known value
};

struct Comparison {
    CrossCheck check;
    double horizon = 0;                    ///< of the primal integrals, seconds
    bool uses_largest_time = false;        ///< as limit of runs that had none
    std::vector<std::vector<Cell>> cells;  ///< [solver][problem]; studies stay empty
    std::vector<SolverSummary> solvers;
    SolverSummary virtual_best;  ///< of the exact solvers without a start
    bool has_instructions = false;
};

Comparison compare_solvers(const CampaignRuns& campaign);

PairComparison compare_pair(const CampaignRuns& campaign, const Comparison& comparison,
                            std::size_t a, std::size_t b);

/// Median of each measure over readings of the same solver on the same problem.
Cell summarise(const std::vector<RunReading>& readings, double horizon, double floor_seconds);

/// Index of the solver that the others are compared with.
std::size_t baseline_of(const Plan& plan);

/// Values of one measure over the problems that a solver took, where it is known.
std::vector<Grouped> measured(const CampaignRuns& campaign, const std::vector<Cell>& cells,
                              double Cell::*measure);

}  // namespace experiment
