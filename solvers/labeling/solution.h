#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "labeling/problem.h"

namespace labeling {

/// One 0/1 value per label, and the objective value its maker claims.
struct Solution {
    std::vector<std::uint8_t> labels;
    Value value = 0;
};

/// What check_solution found; empty lists mean feasible.
struct SolutionCheck {
    bool is_feasible = false;
    Value value = 0;             ///< recomputed, whatever the solution claims
    bool value_matches = false;  ///< claimed == recomputed
    std::vector<Conflict> violated_conflicts;
    std::vector<std::int32_t> violated_rules;
    std::string message;  ///< one line, empty when feasible and matching
};

/// Recomputes value and every violated constraint in integers. Shares no code with any solver.
/// Throws InputError when the number of labels differs or a label is neither 0 nor 1.
SolutionCheck check_solution(const LabelingProblem& problem, const Solution& solution);

}  // namespace labeling
