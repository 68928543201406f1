// Every rule of greedy construction against plain enumeration, and the heap behind it against a
// sorted list.
#include "labeling/greedy.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "labeling/errors.h"
#include "labeling/generators.h"
#include "labeling/label_heap.h"
#include "labeling/problems.h"

namespace labeling_test {
namespace {

using labeling::Label;
using labeling::SolveOptions;
using labeling::SolveResult;
using labeling::SolveStatus;

SolveResult solve(const LabelingProblem& problem, const std::string& rule) {
    SolveOptions options;
    options.extra["rule"] = rule;
    return labeling::make_greedy_solver()->solve(problem, options);
}

class Greedy : public testing::TestWithParam<const char*> {};

TEST_P(Greedy, FindsALabelingWhereverThereIsOne) {
    for (int k = 0; k < 3000; ++k) {
        const std::uint64_t seed = 40000 + static_cast<std::uint64_t>(k);
        std::mt19937_64 engine(seed);
        const LabelingProblem problem = random_problem(engine, 4 + k % 8);
        const SolveResult result = solve(problem, GetParam());
        const auto optimum = enumerate_optimum(problem);
        // So small, the search behind the construction always comes to its end.
        EXPECT_EQ(result.status, optimum ? SolveStatus::Feasible : SolveStatus::Infeasible) << seed;
        if (result.solution && optimum) {
            EXPECT_LE(result.solution->value, *optimum) << seed;
        }
        if (HasFailure()) return;
    }
}

TEST_P(Greedy, LeavesNoLabelOutThatWouldGainAndIsFree) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem bundle = curve_bundle(engine, {});
        const SolveResult result = solve(bundle, GetParam());
        ASSERT_TRUE(result.solution) << seed;
        for (Label i = 0; i < bundle.label_count(); ++i) {
            // Without rules nothing but a conflict keeps a label of positive weight out.
            if (result.solution->labels[i] != 0 || bundle.weight(i) <= 0) continue;
            const auto enemies = bundle.conflicts_of(i);
            const bool is_blocked =
                !bundle.rules_of(i).empty() ||
                std::any_of(enemies.begin(), enemies.end(), [&](Label j) {
                    return result.solution->labels[j] != 0 || !bundle.rules_of(j).empty();
                });
            EXPECT_TRUE(is_blocked) << "label " << i + 1 << ", seed " << seed;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(EveryRule, Greedy,
                         testing::Values("best", "weight", "blocked", "gain", "curve"));

TEST(GreedyRules, BestIsTheBetterOfGainAndBlocked) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        std::mt19937_64 engine(seed);
        BundleOptions options;
        options.curves = 9;
        options.crossings = 12;
        const LabelingProblem problem = curve_bundle(engine, options);
        const Value gain = solve(problem, "gain").solution->value;
        const Value blocked = solve(problem, "blocked").solution->value;
        EXPECT_EQ(solve(problem, "best").solution->value, std::max(gain, blocked)) << seed;
    }
}

TEST(GreedyRules, GiveLargeProblemsALabelingBeforeAnythingElse) {
    labeling::UnitDiskOptions disks;
    disks.labels = 25000;
    const LabelingProblem problem = labeling::unit_disks(disks).problem;
    const SolveResult greedy = solve(problem, "gain");
    SolveOptions options;
    options.work_limit = greedy.work + 1;
    const SolveResult exact = labeling::builtin_solvers().find("auto")->solve(problem, options);
    ASSERT_TRUE(exact.solution);
    EXPECT_GE(exact.solution->value, greedy.solution->value);
    for (auto label : greedy.solution->labels) {
        options.warm_start.push_back(static_cast<std::int8_t>(label));
    }
    options.work_limit = 0;
    const SolveResult warm = labeling::builtin_solvers().find("auto")->solve(problem, options);
    ASSERT_TRUE(warm.solution);
    EXPECT_GE(warm.solution->value, greedy.solution->value);
}

TEST(GreedyRules, UnknownNamesAreRefused) {
    std::mt19937_64 engine(1);
    EXPECT_THROW(solve(random_problem(engine, 5), "luck"), labeling::InputError);
}

TEST(LabelHeap, GivesTheBestLabelAfterAnyChanges) {
    constexpr Label kLabels = 60;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        std::mt19937_64 engine(seed);
        labeling::LabelHeap heap(kLabels);
        std::vector<std::pair<double, Label>> present;  // negated score: the best sorts first
        for (int step = 0; step < 400; ++step) {
            const auto i = static_cast<Label>(pick(engine, 0, kLabels - 1));
            std::erase_if(present, [i](const auto& entry) { return entry.second == i; });
            if (pick(engine, 0, 3) == 0) {
                heap.remove(i);
            } else {
                const auto score = static_cast<double>(pick(engine, -20, 20));
                heap.set(i, score);
                present.emplace_back(-score, i);
            }
            ASSERT_EQ(heap.is_empty(), present.empty()) << seed;
            if (present.empty()) continue;
            ASSERT_EQ(heap.top(), std::min_element(present.begin(), present.end())->second) << seed;
        }
    }
}

}  // namespace
}  // namespace labeling_test
