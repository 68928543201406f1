#pragma once

#include <chrono>
#include <map>
#include <vector>

#include "labeling/problem.h"
#include "labeling/solver.h"

namespace fcn {

/// Solves a labeling problem component by component and remembers what it has solved, so that a
/// problem that changed in one place is solved again only there. Rules on a single label are
/// fixed and substituted first. Answers are the wrapped solver's: deterministic for equal calls in
/// equal order.
class IncrementalSolver {
public:
    IncrementalSolver(const labeling::Solver& solver, labeling::SolveOptions options);

    /// `warm_start` (may be empty): one label value each. Time and work limits are for all calls
    /// together, shared by the components' sizes; without either there is a default of work.
    labeling::SolveResult solve(const labeling::LabelingProblem& problem,
                                const std::vector<std::int8_t>& warm_start);

    int components_solved() const { return components_solved_; }
    int components_reused() const { return components_reused_; }

private:
    struct Component {
        labeling::LabelingProblem problem;
        std::vector<labeling::Label> labels;  ///< of the whole problem, ascending
    };
    struct Memory {
        labeling::LabelingProblem problem;
        labeling::SolveResult result;
    };

    /// `share` of the limits that are left.
    labeling::SolveResult solve_component(const Component& component,
                                          const std::vector<std::int8_t>& warm_start, double share);
    const labeling::SolveResult* recall(const labeling::LabelingProblem& problem) const;

    const labeling::Solver& solver_;
    labeling::SolveOptions options_;
    std::chrono::steady_clock::time_point start_;
    std::int64_t work_used_ = 0;
    std::multimap<std::uint64_t, Memory> memory_;
    int components_solved_ = 0, components_reused_ = 0;
};

}  // namespace fcn
