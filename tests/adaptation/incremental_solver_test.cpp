#include "adaptation/incremental_solver.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "labeling/generators.h"

namespace fcn {
namespace {

using labeling::LabelingProblem;

/// Several problems side by side, in the order given.
LabelingProblem side_by_side(const std::vector<LabelingProblem>& problems) {
    labeling::ProblemBuilder builder;
    for (const LabelingProblem& p : problems) {
        const labeling::Label first = builder.label_count();
        for (const auto weight : p.weights()) builder.add_label(weight);
        for (const auto& c : p.conflicts()) builder.add_conflict(first + c.first, first + c.second);
        for (const auto& b : p.bonuses()) {
            builder.add_bonus(first + b.first, first + b.second, b.value);
        }
        for (labeling::Rule rule : p.rules()) {
            for (labeling::Term& term : rule.terms) term.label += first;
            builder.add_rule(std::move(rule));
        }
    }
    return builder.build();
}

std::vector<labeling::GeneratedProblem> some_chains() {
    std::vector<labeling::GeneratedProblem> chains;
    for (const int labels : {60, 90, 40, 120}) {
        labeling::ChainOptions options;
        options.labels = labels;
        options.seed = static_cast<std::uint64_t>(labels);
        chains.push_back(labeling::chain(options));
    }
    return chains;
}

/// A heuristic that never ends before its work does must not leave the later components without
/// any: greedy's labelings would be all that they get.
TEST(IncrementalSolver, ALimitOfWorkIsSharedByAllComponents) {
    const auto chains = some_chains();
    std::vector<LabelingProblem> problems;
    labeling::Value optimum = 0;
    for (const auto& chain : chains) {
        problems.push_back(chain.problem);
        optimum += chain.optimum->value;
    }
    const auto solvers = labeling::builtin_solvers();
    const auto local_search = solvers.find("local-search");
    for (const bool is_reversed : {false, true}) {
        if (is_reversed) std::reverse(problems.begin(), problems.end());
        labeling::SolveOptions options;
        options.work_limit = 8'000'000;
        options.extra["reductions"] = "off";
        IncrementalSolver solver(*local_search, options);
        const auto result = solver.solve(side_by_side(problems), {});
        ASSERT_TRUE(result.solution);
        EXPECT_EQ(result.solution->value, optimum);
        EXPECT_LE(result.work, 9'000'000);
    }
}

TEST(IncrementalSolver, FindsWhatTheWholeProblemIsWorth) {
    const auto chains = some_chains();
    std::vector<LabelingProblem> problems;
    labeling::Value optimum = 0;
    for (const auto& chain : chains) {
        problems.push_back(chain.problem);
        optimum += chain.optimum->value;
    }
    const auto solvers = labeling::builtin_solvers();
    const auto exact = solvers.find("branch-and-bound");
    IncrementalSolver solver(*exact, {});
    const auto result = solver.solve(side_by_side(problems), {});
    ASSERT_TRUE(result.solution);
    EXPECT_EQ(result.solution->value, optimum);
    EXPECT_EQ(result.bound, optimum);
    // The same again costs nothing.
    const int solved = solver.components_solved();
    EXPECT_EQ(solver.solve(side_by_side(problems), {}).solution->value, optimum);
    EXPECT_EQ(solver.components_solved(), solved);
}

}  // namespace
}  // namespace fcn
