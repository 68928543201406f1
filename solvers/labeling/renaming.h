#pragma once

#include <cstdint>
#include <vector>

#include "labeling/problem.h"
#include "labeling/solution.h"

namespace labeling {

/// The same problem with its labels renamed and its rules in another order, to see how far a
/// solver's time depends on the order in which it is told things.
struct RenamedProblem {
    LabelingProblem problem;
    std::vector<Label> renamed;  ///< per label of the original: its name in `problem`
};

/// `seed` 0 leaves everything as it is. O(size of the problem).
RenamedProblem rename_labels(const LabelingProblem& problem, std::uint64_t seed);

/// A solution of the renamed problem, told in the names of the original.
Solution original_solution(const RenamedProblem& renamed, const Solution& solution);

/// And a solution of the original, in the names of the renamed problem.
Solution renamed_solution(const RenamedProblem& renamed, const Solution& solution);

/// A start (0, 1 or -1 a label) of the original, told in the names of the renamed problem.
std::vector<std::int8_t> renamed_start(const RenamedProblem& renamed,
                                       const std::vector<std::int8_t>& start);

}  // namespace labeling
