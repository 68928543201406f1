#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "labeling/problem.h"
#include "labeling/rows.h"
#include "labeling/run_control.h"
#include "labeling/solution.h"
#include "labeling/solver.h"

namespace labeling {

/// What decides which label comes next. A label's gain is its weight, the bonuses to chosen
/// partners and half of those to undecided ones.
enum class GreedyRule {
    Best,     ///< the better result of Gain and Blocked
    Weight,   ///< largest gain
    Blocked,  ///< largest gain per gain of the conflict partners that it blocks
    Gain,     ///< largest gain less a share of the gain that it blocks
    Curve,    ///< as Gain, then at once the run of similar labels along its bonuses
};

struct GreedyOptions {
    /// With a start, Best is Gain: little is left to choose.
    GreedyRule rule = GreedyRule::Best;
    /// One entry per label, 1, 0 or -1 (unknown), or empty: followed as far as it propagates.
    std::span<const std::int8_t> start;
    /// Wrong guesses that may be taken back when the rules make greedy choices run into a dead end.
    std::int64_t max_backtracks = 10000;
};

struct GreedyResult {
    std::optional<Solution> solution;
    bool is_infeasible = false;          ///< proven: no solution exists
    GreedyRule rule = GreedyRule::Best;  ///< the one that made the solution
    std::int64_t insertions = 0;
    std::int64_t backtracks = 0;
};

/// Near-linear construction; see greedy.cpp. Spends its work on `control` and stops with it, but
/// always returns a solution when one was complete by then.
GreedyResult greedy_labeling(const LabelingProblem& problem, const RowSystem& rows,
                             RunControl& control, const GreedyOptions& options = {});

/// Objective value in integers.
Value labeling_value(const LabelingProblem& problem, std::span<const std::uint8_t> labels);

/// Extra option: rule=best|weight|blocked|gain|curve.
std::shared_ptr<const Solver> make_greedy_solver();

}  // namespace labeling
