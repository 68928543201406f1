#pragma once

#include <functional>
#include <string>
#include <vector>

#include "labeling/problem.h"

namespace labeling_test {

/// A problem that can be changed.
struct ProblemParts {
    std::vector<labeling::Value> weights;
    std::vector<labeling::Conflict> conflicts;
    std::vector<labeling::Bonus> bonuses;
    std::vector<labeling::Rule> rules;

    explicit ProblemParts(const labeling::LabelingProblem& problem);
    labeling::LabelingProblem build() const;
    /// With all that names it; later labels move up.
    void remove_label(labeling::Label label);
};

/// Text (.lab) of a smallest problem of which `fails` is still true: labels, rules, terms,
/// conflicts, bonuses are left out and numbers brought towards 0 as long as it fails.
std::string shrunk(const labeling::LabelingProblem& problem,
                   const std::function<bool(const labeling::LabelingProblem&)>& fails);

}  // namespace labeling_test
