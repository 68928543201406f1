#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "labeling/problem.h"
#include "labeling/run_control.h"
#include "labeling/solution.h"

namespace labeling {

/// Stands for "no solution" where a bound or a lower limit is expected.
inline constexpr Value kNoValue = -(Value{1} << 60);

/// Outcome of an exact search for solutions above a lower limit.
struct TreeResult {
    std::optional<Solution> solution;  ///< best found, value > the lower limit
    /// No solution above the lower limit has a larger value. kNoValue: there is none at all.
    Value bound = kNoValue;
    std::int64_t nodes = 0;

    bool is_closed(Value lower) const { return bound <= (solution ? solution->value : lower); }
};

/// Depth-first branch and bound: propagation, clique cover bound, splitting into independent parts
/// at every node. Looks for solutions of value > lower (kNoValue: any). Stops with `control`; then
/// `bound` is the largest bound of what is left. Memory is that of one path.
TreeResult tree_search(const LabelingProblem& problem, Value lower, RunControl& control);

}  // namespace labeling
