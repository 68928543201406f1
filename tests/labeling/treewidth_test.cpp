// Dynamic programming over elimination orders against enumeration, against optima known by
// construction, and against branch and bound without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "labeling/elimination_order.h"
#include "labeling/generators.h"
#include "labeling/problems.h"
#include "labeling/registry.h"
#include "labeling/treewidth_search.h"

namespace labeling_test {
namespace {

using labeling::EliminationRule;
using labeling::Label;
using labeling::RunControl;
using labeling::SolveOptions;
using labeling::TreeResult;
using labeling::TreewidthOptions;

std::optional<TreeResult> search(const LabelingProblem& problem, const SolveOptions& options = {},
                                 std::int64_t most_ticks = 1'000'000'000) {
    RunControl control(options);
    TreewidthOptions width;
    width.most_ticks = most_ticks;
    return treewidth_search(problem, control, width);
}

/// Empty when the answer is that of enumeration.
std::string failure(const LabelingProblem& problem) {
    const auto result = search(problem);
    if (!result) return "not solved";
    const std::optional<Value> optimum = enumerate_optimum(problem);
    std::ostringstream why;
    if (result->solution) {
        const auto check = check_solution(problem, *result->solution);
        if (!check.message.empty()) why << check.message << "; ";
        if (result->bound != result->solution->value) why << "bound " << result->bound << "; ";
        if (optimum != result->solution->value) why << "value " << result->solution->value << "; ";
    } else if (optimum || result->bound != labeling::kNoValue) {
        why << "called infeasible; ";
    }
    return why.str();
}

void expect_optimum(const LabelingProblem& problem, std::uint64_t seed) {
    const std::string why = failure(problem);
    if (why.empty()) return;
    ADD_FAILURE() << "seed " << seed << ": " << why << "\n"
                  << shrunk(problem, [](const LabelingProblem& p) { return !failure(p).empty(); });
}

TEST(TreewidthSearch, AgreesWithEnumeration) {
    for (std::uint64_t seed = 1; seed <= 6000 && !testing::Test::HasFailure(); ++seed) {
        std::mt19937_64 engine(seed);
        expect_optimum(random_problem(engine, 11), seed);
        expect_optimum(frustrated_problem(engine, static_cast<int>(pick(engine, 4, 8))), seed);
    }
}

TEST(TreewidthSearch, AgreesWithEnumerationOnBundles) {
    for (std::uint64_t seed = 1; seed <= 200 && !testing::Test::HasFailure(); ++seed) {
        std::mt19937_64 engine(seed);
        BundleOptions options;
        options.curves = 2 + static_cast<int>(seed % 2);
        options.segments = 4;
        options.crossings = 1 + static_cast<int>(seed % 3);
        options.short_percent = 60;
        expect_optimum(curve_bundle(engine, options), seed);
    }
}

TEST(TreewidthSearch, FindsTheOptimumOfChains) {
    for (int reach = 1; reach <= 6; ++reach) {
        labeling::ChainOptions options;
        options.labels = 3000;
        options.reach = reach;
        options.seed = static_cast<std::uint64_t>(reach);
        const auto chain = labeling::chain(options);
        const auto result = search(chain.problem);
        ASSERT_TRUE(result && result->solution) << reach;
        EXPECT_EQ(check_solution(chain.problem, *result->solution).message, "") << reach;
        EXPECT_EQ(result->solution->value, chain.optimum->value) << reach;
        EXPECT_EQ(result->bound, chain.optimum->value) << reach;
    }
}

TEST(TreewidthSearch, AgreesWithBranchAndBoundOnNarrowBundles) {
    for (std::uint64_t seed = 1; seed <= 15; ++seed) {
        std::mt19937_64 engine(seed);
        BundleOptions bundle;
        bundle.curves = 4;
        bundle.segments = 12;
        bundle.crossings = 4;
        const LabelingProblem problem = curve_bundle(engine, bundle);
        SolveOptions options;
        options.extra["treewidth"] = "off";
        const auto expected = every_solver().find("branch-and-bound")->solve(problem, options);
        ASSERT_TRUE(expected.solution) << seed;
        const auto result = search(problem);
        ASSERT_TRUE(result && result->solution) << seed;
        EXPECT_EQ(check_solution(problem, *result->solution).message, "") << seed;
        EXPECT_EQ(result->solution->value, expected.solution->value) << seed;
    }
}

TEST(TreewidthSearch, LeavesWideProblemsAlone) {
    labeling::UnitDiskOptions disks;
    disks.labels = 3000;
    disks.degree = 30;
    EXPECT_FALSE(search(labeling::unit_disks(disks).problem));
    labeling::ChainOptions options;
    const LabelingProblem chain = labeling::chain(options).problem;
    EXPECT_TRUE(search(chain));
    EXPECT_FALSE(search(chain, {}, 1));
}

TEST(TreewidthSearch, StopsWithinItsWorkLimit) {
    labeling::ChainOptions chain;
    chain.labels = 2000;
    chain.reach = 8;
    const LabelingProblem problem = labeling::chain(chain).problem;
    for (std::int64_t work : {0, 10, 1000, 10000}) {
        SolveOptions options;
        options.work_limit = work;
        RunControl control(options);
        TreewidthOptions width;
        width.most_ticks = 1'000'000'000;
        EXPECT_FALSE(treewidth_search(problem, control, width)) << work;
        EXPECT_TRUE(control.is_over()) << work;
    }
}

TEST(EliminationOrders, JoinWhatBelongsTogether) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem problem = random_problem(engine, 20);
        const labeling::RowSystem rows(problem);
        for (auto rule : {EliminationRule::Degree, EliminationRule::Fill}) {
            const SolveOptions unlimited;
            RunControl control(unlimited);
            const auto order = elimination_order(problem, rows, control, rule);
            ASSERT_TRUE(order) << seed;
            std::vector<Label> place(problem.label_count(), -1);
            for (std::size_t k = 0; k < order->order.size(); ++k) {
                ASSERT_EQ(place[order->order[k]], -1) << seed;
                place[order->order[k]] = static_cast<Label>(k);
            }
            ASSERT_EQ(order->order.size(), place.size()) << seed;
            const auto expect_joined = [&](Label a, Label b) {
                if (a == b) return;
                if (place[a] > place[b]) std::swap(a, b);
                const auto& later = order->neighbours[a];
                EXPECT_TRUE(std::binary_search(later.begin(), later.end(), b)) << seed;
            };
            for (const auto& c : problem.conflicts()) expect_joined(c.first, c.second);
            for (const auto& b : problem.bonuses()) expect_joined(b.first, b.second);
            for (const auto& r : problem.rules()) {
                for (const auto& s : r.terms) {
                    for (const auto& t : r.terms) expect_joined(s.label, t.label);
                }
            }
            for (Label i = 0; i < problem.label_count(); ++i) {
                for (Label a : order->neighbours[i]) {
                    EXPECT_GT(place[a], place[i]) << seed;
                    for (Label b : order->neighbours[i]) expect_joined(a, b);
                }
            }
        }
    }
}

}  // namespace
}  // namespace labeling_test
