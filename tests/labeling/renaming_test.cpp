#include "labeling/renaming.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "labeling/generators.h"
#include "labeling/solver.h"

namespace labeling {
namespace {

LabelingProblem with_rules(std::uint64_t seed) {
    PlantedOptions options;
    options.cliques = 12;
    options.seed = seed;
    return planted(options).problem;
}

TEST(Renaming, KeepsValueAndFeasibilityOfEverySolution) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE(seed);
        const LabelingProblem problem = with_rules(seed);
        const RenamedProblem renamed = rename_labels(problem, seed);
        const SolveResult result = builtin_solvers().find("greedy")->solve(renamed.problem);
        ASSERT_TRUE(result.solution);
        const Solution original = original_solution(renamed, *result.solution);
        const SolutionCheck check = check_solution(problem, original);
        EXPECT_TRUE(check.is_feasible);
        EXPECT_TRUE(check.value_matches);
    }
}

TEST(Renaming, IsAPermutationAndChangesTheOrder) {
    const LabelingProblem problem = with_rules(7);
    const RenamedProblem renamed = rename_labels(problem, 5);
    std::vector<Label> sorted = renamed.renamed;
    std::sort(sorted.begin(), sorted.end());
    for (Label i = 0; i < problem.label_count(); ++i) EXPECT_EQ(sorted[i], i);
    EXPECT_NE(renamed.problem.hash(), problem.hash());
    EXPECT_EQ(renamed.problem.hash(), rename_labels(problem, 5).problem.hash());
}

TEST(Renaming, SeedZeroChangesNothing) {
    const LabelingProblem problem = with_rules(7);
    EXPECT_EQ(rename_labels(problem, 0).problem.hash(), problem.hash());
}

TEST(Renaming, AStartIsTheSameStart) {
    const LabelingProblem problem = with_rules(3);
    const RenamedProblem renamed = rename_labels(problem, 9);
    std::vector<std::int8_t> start(static_cast<std::size_t>(problem.label_count()), -1);
    for (std::size_t i = 0; i < start.size(); ++i) {
        start[i] = static_cast<std::int8_t>(static_cast<int>(i % 3) - 1);
    }
    const std::vector<std::int8_t> told = renamed_start(renamed, start);
    for (std::size_t i = 0; i < start.size(); ++i) {
        EXPECT_EQ(told[static_cast<std::size_t>(renamed.renamed[i])], start[i]);
    }
}

}  // namespace
}  // namespace labeling
