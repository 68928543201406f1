// A stop may come at any moment. The injected clock asks for it at its Nth reading, for many N over
// the whole run, so that the moments lie in every phase of every solver, and the same ones each
// time. Whatever the moment: nothing is thrown, the answer is valid, the end comes soon.
#include <gtest/gtest.h>

#include <algorithm>

#include "labeling/exact_search.h"
#include "labeling/generators.h"
#include "labeling/problems.h"
#include "labeling/registry.h"

namespace labeling_test {
namespace {

using labeling::SolveOptions;
using labeling::SolveResult;
using labeling::SolveStatus;
using labeling::StopReason;

struct Case {
    const char* name;
    LabelingProblem problem;
    Value optimum = 0;
    int moments = 25;  ///< at which it is stopped
};

Case generated(const char* family, std::map<std::string, std::string> options) {
    labeling::GeneratedProblem made = labeling::generate_problem(family, options);
    return {family, std::move(made.problem), made.optimum->value, 25};
}

/// Problems that take the solvers through presolve, many parts, cuts and a tree.
const std::vector<Case>& cases() {
    static const std::vector<Case> all = [] {
        std::vector<Case> made;
        made.push_back(generated("chain", {{"labels", "600"}, {"reach", "6"}}));
        made.push_back(generated("planted", {{"cliques", "60"}, {"bonuses", "4"}}));
        made.push_back(generated("chain", {{"labels", "25000"}, {"reach", "6"}}));
        made.back().moments = 8;
        std::mt19937_64 engine(17);
        BundleOptions bundle;
        bundle.curves = 12;
        bundle.segments = 14;
        bundle.crossings = 16;
        bundle.reach = 2;
        bundle.bonus = 60;
        Case last{"bundle", curve_bundle(engine, bundle), 0, 25};
        const SolveResult best = every_solver().find("branch-and-bound")->solve(last.problem);
        EXPECT_EQ(best.status, SolveStatus::Optimal);
        last.optimum = best.solution->value;
        made.push_back(std::move(last));
        return made;
    }();
    return all;
}

struct Interrupted {
    SolveResult result;
    std::int64_t readings = 0;
};

/// Never: -1.
Interrupted solve(const labeling::Solver& solver, const Case& c, std::int64_t stop_at) {
    Interrupted run;
    std::stop_source source;
    SolveOptions options;
    options.stop = source.get_token();
    options.time_limit = std::chrono::duration<double>(1e12);  // or the clock would not be read
    options.work_limit = 1'000'000;
    options.extra = solver.is_exact() ? std::map<std::string, std::string>{{"tree-size", "0"}}
                                      : std::map<std::string, std::string>{};
    options.clock = [&] {
        if (run.readings == stop_at) source.request_stop();
        return static_cast<double>(run.readings++);
    };
    run.result = solver.solve(c.problem, options);
    return run;
}

class Interrupt : public testing::TestWithParam<std::string> {};

TEST(Limits, TheDefaultWorkYieldsToATimeLimit) {
    labeling::ExactSearchOptions limited;
    limited.name = "limited";
    limited.default_work_limit = 1;
    const auto solver = labeling::make_exact_solver(limited);
    const Case& c = cases().front();
    SolveOptions options;
    EXPECT_EQ(solver->solve(c.problem, options).stop_reason, StopReason::WorkLimit);
    options.time_limit = std::chrono::hours(1);
    const SolveResult all = solver->solve(c.problem, options);
    ASSERT_EQ(all.status, SolveStatus::Optimal);
    EXPECT_EQ(all.solution->value, c.optimum);
}

TEST_P(Interrupt, AtAnyMomentLeavesAValidAnswer) {
    const auto solver = every_solver().find(GetParam());
    constexpr std::int64_t kMostReadingsAfter = 30;
    for (const Case& c : cases()) {
        const std::int64_t whole = solve(*solver, c, -1).readings;
        std::mt19937_64 engine(2026);
        int interrupted = 0;
        for (int k = 0; k < c.moments; ++k) {
            // Half of the moments are early, where presolve and heuristics are.
            const std::int64_t at = pick(engine, 0, k % 2 == 0 ? whole - 1 : (whole - 1) / 8);
            const Interrupted run = solve(*solver, c, at);
            const SolveResult& result = run.result;
            SCOPED_TRACE(std::string(c.name) + ", stop at reading " + std::to_string(at) + " of " +
                         std::to_string(whole));
            if (result.solution) {
                const auto check = check_solution(c.problem, *result.solution);
                EXPECT_TRUE(check.is_feasible && check.value_matches) << check.message;
                EXPECT_LE(result.solution->value, c.optimum);
            }
            EXPECT_GE(result.bound.value_or(c.optimum), c.optimum);
            for (const auto& point : result.trace) {
                EXPECT_GE(point.bound.value_or(c.optimum), c.optimum);
                EXPECT_LE(point.value.value_or(c.optimum), c.optimum);
            }
            EXPECT_NE(result.status, SolveStatus::Infeasible);
            EXPECT_LE(run.readings, at + kMostReadingsAfter);
            interrupted += result.stop_reason == StopReason::Interrupted ? 1 : 0;
            if (HasFailure()) return;
        }
        if (GetParam() != "greedy") {
            EXPECT_GT(interrupted, c.moments / 2) << c.name;
        }
    }
}

std::string test_name(const testing::TestParamInfo<std::string>& param) {
    std::string name = param.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(EverySolver, Interrupt,
                         testing::ValuesIn(labeling::builtin_solvers().names()), test_name);

}  // namespace
}  // namespace labeling_test
