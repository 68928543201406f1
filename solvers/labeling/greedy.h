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

struct GreedyOptions {
    /// One entry per label, 1, 0 or -1 (unknown), or empty: followed as far as it propagates.
    std::span<const std::int8_t> start;
    /// Wrong guesses that may be taken back when the rules make greedy choices run into a dead end.
    std::int64_t max_backtracks = 10000;
};

struct GreedyResult {
    std::optional<Solution> solution;
    bool is_infeasible = false;  ///< proven: no solution exists
    std::int64_t insertions = 0;
    std::int64_t backtracks = 0;
};

/// Near-linear construction; see greedy.cpp. Spends its work on `control` and stops with it, but
/// always returns a solution when one was complete by then.
GreedyResult greedy_labeling(const LabelingProblem& problem, const RowSystem& rows,
                             RunControl& control, const GreedyOptions& options = {});

/// Objective value in integers.
Value labeling_value(const LabelingProblem& problem, std::span<const std::uint8_t> labels);

std::shared_ptr<const Solver> make_greedy_solver();

}  // namespace labeling
