// Threads change the time a solve takes and nothing else: labels, bound, work, trace and statistics
// are the same on one, two and three, wherever a work limit ends the run. A stop at any moment
// leaves a valid answer. Run under the thread sanitizer, this covers the lanes of the tree and of
// the local search.
#include <gtest/gtest.h>

#include <sstream>

#include "labeling/problems.h"
#include "labeling/registry.h"

namespace labeling_test {
namespace {

using labeling::SolveOptions;
using labeling::SolveResult;
using labeling::SolveStatus;

using Extras = std::map<std::string, std::string>;

/// Either kind keeps the solvers busy up to the work limits below; the first one in a tree.
LabelingProblem hard_problem(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    if (seed % 2 == 1) return frustrated_problem(engine, 40);
    BundleOptions bundle;
    bundle.curves = 14;
    bundle.segments = 14;
    bundle.crossings = 18;
    bundle.reach = 2;
    bundle.bonus = 60;
    return curve_bundle(engine, bundle);
}

/// Everything but the clock.
std::string text_of(const SolveResult& result) {
    std::ostringstream out;
    out << to_string(result.status) << ' ' << to_string(result.stop_reason) << " work "
        << result.work << " bound " << result.bound.value_or(-1) << '\n';
    if (result.solution) {
        out << result.solution->value << ' ';
        for (const auto label : result.solution->labels) out << static_cast<int>(label);
    }
    for (const auto& point : result.trace) {
        out << '\n'
            << point.work << ' ' << point.value.value_or(-1) << ' ' << point.bound.value_or(-1);
    }
    for (const auto& [key, value] : result.statistics) out << '\n' << key << ' ' << value;
    return out.str();
}

struct Case {
    std::string name, solver;
    Extras extras;
    std::vector<std::int64_t> work_limits;
};

const Extras kNoCuts{{"heuristics", "off"},    {"clique-cuts", "off"}, {"triple-cuts", "off"},
                     {"rank-two-cuts", "off"}, {"gomory-cuts", "off"}, {"tree-size", "0"},
                     {"treewidth", "off"}};

Extras with(Extras extras, const std::string& key, const std::string& value) {
    extras[key] = value;
    return extras;
}

const Case kCases[] = {
    {"auto", "auto", {}, {100'000, 1'000'000, 5'000'000}},
    {"tree", "branch-and-bound", kNoCuts, {300'000, 2'000'000, 10'000'000}},
    {"tree_on_three_lanes",
     "branch-and-bound",
     with(kNoCuts, "tree-lanes", "3"),
     {300'000, 2'000'000, 10'000'000}},
    {"tree_with_heuristics",
     "branch-and-bound",
     with(kNoCuts, "heuristics", "on"),
     {2'000'000, 10'000'000}},
    {"local_search", "local-search", {}, {10'000, 500'000}},
    {"local_search_on_three_lanes", "local-search", {{"lanes", "3"}}, {500'000}},
    {"lns", "lns", {}, {10'000, 1'000'000}},
};

class Threads : public testing::TestWithParam<Case> {};

TEST_P(Threads, ChangeNoByteOfTheAnswer) {
    const Case& c = GetParam();
    const auto solver = every_solver().find(c.solver);
    for (const std::uint64_t seed : {51, 52, 53}) {
        const LabelingProblem problem = hard_problem(seed);
        for (const std::int64_t work : c.work_limits) {
            SolveOptions options;
            options.extra = c.extras;
            options.work_limit = work;
            options.seed = seed;
            const std::string expected = text_of(solver->solve(problem, options));
            for (const int threads : {2, 3}) {
                options.threads = threads;
                EXPECT_EQ(text_of(solver->solve(problem, options)), expected)
                    << "seed " << seed << ", work " << work << ", threads " << threads;
            }
        }
    }
}

TEST_P(Threads, AStopLeavesAValidAnswer) {
    const Case& c = GetParam();
    const auto solver = every_solver().find(c.solver);
    const LabelingProblem problem = hard_problem(solver->is_exact() ? 51 : 52);
    const SolveResult best = every_solver().find("branch-and-bound")->solve(problem);
    ASSERT_EQ(best.status, SolveStatus::Optimal);
    const Value optimum = best.solution->value;
    int interrupted = 0;
    for (const int threads : {2, 3}) {
        for (int stop_at = 0; stop_at < 12; ++stop_at) {
            std::stop_source source;
            int points = 0;
            SolveOptions options;
            options.extra = c.extras;
            options.work_limit = c.work_limits.back();
            options.threads = threads;
            options.stop = source.get_token();
            options.on_improvement = [&](const labeling::TracePoint&) {
                if (points++ == stop_at) source.request_stop();
            };
            const SolveResult result = solver->solve(problem, options);
            SCOPED_TRACE("threads " + std::to_string(threads) + ", stop at point " +
                         std::to_string(stop_at));
            interrupted += result.stop_reason == labeling::StopReason::Interrupted ? 1 : 0;
            EXPECT_GE(result.bound.value_or(optimum), optimum);
            if (!result.solution) continue;
            const auto check = check_solution(problem, *result.solution);
            EXPECT_TRUE(check.is_feasible && check.value_matches) << check.message;
            EXPECT_LE(result.solution->value, optimum);
        }
    }
    EXPECT_GT(interrupted, 2);
}

INSTANTIATE_TEST_SUITE_P(EverySolver, Threads, testing::ValuesIn(kCases),
                         [](const auto& param) { return param.param.name; });

/// The tests above would mean little if one lane did all of the tree.
TEST(TreeLanes, ShareTheWork) {
    const LabelingProblem problem = hard_problem(51);
    SolveOptions options;
    options.extra = kNoCuts;
    options.work_limit = 10'000'000;
    const auto statistics = [&](const std::string& lanes) {
        options.extra["tree-lanes"] = lanes;
        return every_solver().find("branch-and-bound")->solve(problem, options).statistics;
    };
    const auto one = statistics("1"), two = statistics("2"), three = statistics("3");
    EXPECT_EQ(one.at("tree-path"), one.at("tree-work"));
    EXPECT_LT(two.at("tree-path"), 0.8 * two.at("tree-work"));
    EXPECT_LT(three.at("tree-path"), 0.7 * three.at("tree-work"));
}

}  // namespace
}  // namespace labeling_test
