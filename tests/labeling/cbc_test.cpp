// The CBC adapter when CBC misbehaves, and on a problem that CBC with its own settings dies of.
#include <gtest/gtest.h>
#include <signal.h>

#include "labeling/problems.h"
#include "labeling_mip/cbc_solver.h"
#include "labeling_mip/mip_solvers.h"

namespace labeling_test {
namespace {

using labeling::SolveOptions;
using labeling::SolveResult;
using labeling::SolveStatus;
using labeling::StopReason;

LabelingProblem bundle() {
    std::mt19937_64 engine(81);
    return curve_bundle(engine, {});
}

Value optimum(const LabelingProblem& problem) {
    const SolveResult best = labeling::all_solvers().find("branch-and-bound")->solve(problem);
    EXPECT_EQ(best.status, SolveStatus::Optimal);
    return best.solution->value;
}

TEST(Cbc, IsTriedAgainWhenItDies) {
    const LabelingProblem problem = bundle();
    const auto solver = labeling::make_cbc_solver([](int attempt) {
        if (attempt == 0) ::raise(SIGKILL);
    });
    const SolveResult result = solver->solve(problem);
    EXPECT_EQ(result.status, SolveStatus::Optimal);
    EXPECT_EQ(result.statistics.at("attempts"), 2);
    ASSERT_TRUE(result.solution);
    EXPECT_EQ(result.solution->value, optimum(problem));
}

TEST(Cbc, SaysSoWhenItDiesTwice) {
    const LabelingProblem problem = bundle();
    const auto solver = labeling::make_cbc_solver([](int) { ::raise(SIGSEGV); });
    const SolveResult result = solver->solve(problem);
    EXPECT_EQ(result.status, SolveStatus::Feasible);  // the greedy start
    EXPECT_EQ(result.stop_reason, StopReason::SolverFailed);
    EXPECT_FALSE(result.message.empty());
    EXPECT_EQ(result.statistics.at("attempts"), 2);
    const Value best = optimum(problem);
    ASSERT_TRUE(result.solution && result.bound);
    EXPECT_LE(result.solution->value, best);
    EXPECT_GE(*result.bound, best);
}

TEST(Cbc, OneAttemptIsTheRule) {
    const SolveResult result = labeling::make_cbc_solver()->solve(bundle());
    EXPECT_EQ(result.statistics.at("attempts"), 1);
}

TEST(Cbc, SurvivesDenseBundles) {
    std::mt19937_64 engine(0);
    BundleOptions options;
    options.curves = 60;
    options.segments = 30;
    options.crossings = 60;
    options.short_percent = 60;
    options.reach = 6;
    SolveOptions limits;
    limits.time_limit = std::chrono::duration<double>(3);
    const SolveResult result =
        labeling::make_cbc_solver()->solve(curve_bundle(engine, options), limits);
    EXPECT_NE(result.stop_reason, StopReason::SolverFailed);
    EXPECT_EQ(result.statistics.at("attempts"), 1);
}

}  // namespace
}  // namespace labeling_test
