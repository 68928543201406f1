// What every solver promises, checked against plain enumeration on random small problems with rules
// of every kind, and against each other on bundles of curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <sstream>
#include <thread>

#include "labeling/errors.h"
#include "labeling/problems.h"
#include "labeling/registry.h"

namespace labeling_test {
namespace {

using labeling::Label;
using labeling::SolveOptions;
using labeling::Solver;
using labeling::SolveResult;
using labeling::SolveStatus;

SolveOptions limited(const Solver& solver) {
    SolveOptions options;
    if (!solver.is_exact()) options.work_limit = 3000;
    return options;
}

/// Empty when the result keeps every promise.
std::string broken_promise(const Solver& solver, const LabelingProblem& problem,
                           const SolveResult& result, std::optional<Value> optimum) {
    std::ostringstream why;
    if (result.solution) {
        const auto check = check_solution(problem, *result.solution);
        if (!check.is_feasible || !check.value_matches) why << "wrong solution; ";
        if (!optimum) {
            why << "a solution of an infeasible problem; ";
        } else if (result.solution->value > *optimum) {
            why << "a value above the optimum; ";
        }
        if (result.bound && *result.bound < result.solution->value) why << "bound < value; ";
    }
    if (result.bound && optimum && *result.bound < *optimum) why << "the bound cuts the optimum; ";
    if (result.status == SolveStatus::Infeasible && optimum) why << "called infeasible; ";
    if (result.status == SolveStatus::Optimal) {
        if (!result.solution || !optimum || result.solution->value != *optimum) {
            why << "called optimal but is not; ";
        }
    }
    if (solver.is_exact()) {
        const auto expected = optimum ? SolveStatus::Optimal : SolveStatus::Infeasible;
        if (result.status != expected) why << "not solved; ";
    } else if (result.bound) {
        why << "a heuristic claims a bound; ";
    }
    if (result.solver != solver.name()) why << "wrong name; ";
    return why.str();
}

class Contract : public testing::TestWithParam<std::string> {
protected:
    std::shared_ptr<const Solver> solver = every_solver().find(GetParam());

    std::string failure(const LabelingProblem& problem) const {
        try {
            return broken_promise(*solver, problem, solver->solve(problem, limited(*solver)),
                                  enumerate_optimum(problem));
        } catch (const std::exception& error) {
            return std::string("exception: ") + error.what();
        }
    }

    void expect_kept(const LabelingProblem& problem, std::uint64_t seed) const {
        const std::string why = failure(problem);
        if (why.empty()) return;
        ADD_FAILURE() << GetParam() << ", seed " << seed << ": " << why << "\n"
                      << shrunk(problem, [&](const LabelingProblem& p) {
                             return p.label_count() > 0 && !failure(p).empty();
                         });
    }
};

class ExactContract : public Contract {};

TEST_P(Contract, AgreesWithEnumerationOnRandomProblems) {
    const int count = GetParam() == "cbc" ? 150 : 4000;
    for (int k = 0; k < count; ++k) {
        const std::uint64_t seed = 1000 + static_cast<std::uint64_t>(k);
        std::mt19937_64 engine(seed);
        expect_kept(random_problem(engine, 4 + k % 9), seed);
        if (HasFailure()) return;
    }
}

TEST_P(Contract, AgreesWithEnumerationOnSmallBundles) {
    const int count = GetParam() == "cbc" ? 20 : 300;
    for (int k = 0; k < count; ++k) {
        const std::uint64_t seed = 5000 + static_cast<std::uint64_t>(k);
        std::mt19937_64 engine(seed);
        BundleOptions options;
        options.curves = 2 + k % 3;
        options.segments = 3;
        options.crossings = 1 + k % 3;
        options.short_percent = 60;
        expect_kept(curve_bundle(engine, options), seed);
        if (HasFailure()) return;
    }
}

TEST_P(Contract, SolvesTheEmptyAndTheTrivialProblem) {
    expect_kept(labeling::ProblemBuilder().build(), 0);
    for (Value weight : {-3, 0, 3}) {
        labeling::ProblemBuilder builder;
        builder.add_label(weight);
        expect_kept(builder.build(), 0);
    }
    labeling::ProblemBuilder impossible;
    impossible.add_rule({labeling::Relation::GreaterEqual, 1, {}});
    EXPECT_EQ(solver->solve(impossible.build()).status, SolveStatus::Infeasible);
}

TEST_P(Contract, SameOptionsGiveTheSameResult) {
    std::mt19937_64 engine(77);
    const LabelingProblem problem = curve_bundle(engine, {});
    SolveOptions options;
    options.work_limit = 200000;
    const SolveResult a = solver->solve(problem, options);
    const SolveResult b = solver->solve(problem, options);
    ASSERT_TRUE(a.solution && b.solution);
    EXPECT_EQ(a.solution->labels, b.solution->labels);
    EXPECT_EQ(a.bound, b.bound);
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.stop_reason, b.stop_reason);
    if (GetParam() != "cbc") {
        EXPECT_EQ(a.work, b.work);
    }
}

TEST_P(Contract, CallsAtTheSameTimeGiveTheSameResult) {
    std::mt19937_64 engine(83);
    const LabelingProblem problem = curve_bundle(engine, {});
    SolveOptions options;
    options.work_limit = 100000;
    const SolveResult alone = solver->solve(problem, options);
    std::vector<SolveResult> together(3);
    std::vector<std::thread> threads;
    for (SolveResult& result : together) {
        threads.emplace_back([&] { result = solver->solve(problem, options); });
    }
    for (std::thread& thread : threads) thread.join();
    ASSERT_TRUE(alone.solution);
    for (const SolveResult& result : together) {
        ASSERT_TRUE(result.solution);
        EXPECT_EQ(result.solution->labels, alone.solution->labels);
        EXPECT_EQ(result.bound, alone.bound);
    }
}

TEST_P(Contract, StopsAtTheWorkLimitWithValidBounds) {
    std::mt19937_64 engine(78);
    BundleOptions bundle;
    bundle.curves = 10;
    bundle.segments = 12;
    bundle.crossings = 12;
    const LabelingProblem problem = curve_bundle(engine, bundle);
    const SolveResult full = every_solver().find("branch-and-bound")->solve(problem);
    ASSERT_EQ(full.status, SolveStatus::Optimal);
    for (std::int64_t work : {0, 1, 100, 1000, 10000, 100000}) {
        SolveOptions options;
        options.work_limit = work;
        const SolveResult result = solver->solve(problem, options);
        const Value optimum = full.solution->value;
        EXPECT_LE(result.solution ? result.solution->value : optimum, optimum) << work;
        EXPECT_GE(result.bound.value_or(optimum), optimum) << work;
        for (const auto& point : result.trace) {
            EXPECT_GE(point.bound.value_or(optimum), optimum) << work;
            EXPECT_LE(point.value.value_or(optimum), optimum) << work;
        }
        if (result.status != SolveStatus::Optimal && solver->is_exact()) {
            EXPECT_EQ(result.stop_reason, labeling::StopReason::WorkLimit) << work;
        }
    }
}

TEST_P(Contract, StopsWhenTheInjectedClockRunsOut) {
    std::mt19937_64 engine(79);
    BundleOptions bundle;
    bundle.curves = 14;
    bundle.segments = 16;
    bundle.crossings = 20;
    bundle.reach = 3;
    const LabelingProblem problem = curve_bundle(engine, bundle);
    SolveOptions options;
    options.time_limit = std::chrono::duration<double>(10);
    int readings = 0;
    // Every look at the clock costs a second: the limit is over after ten of them.
    options.clock = [&readings] { return static_cast<double>(readings++); };
    const SolveResult result = solver->solve(problem, options);
    EXPECT_LT(readings, 40);
    if (result.status != SolveStatus::Optimal && GetParam() != "greedy") {
        EXPECT_EQ(result.stop_reason, labeling::StopReason::TimeLimit);
    }
}

TEST_P(Contract, AnswersAStopRequest) {
    std::mt19937_64 engine(80);
    const LabelingProblem problem = curve_bundle(engine, {});
    std::stop_source source;
    source.request_stop();
    SolveOptions options;
    options.stop = source.get_token();
    const SolveResult result = solver->solve(problem, options);
    if (result.status != SolveStatus::Optimal) {
        EXPECT_EQ(result.stop_reason, labeling::StopReason::Interrupted);
    }
}

TEST_P(Contract, IsNoWorseThanItsWarmStart) {
    for (std::uint64_t seed = 300; seed < 320; ++seed) {
        std::mt19937_64 engine(seed);
        BundleOptions bundle;
        bundle.curves = 5;
        bundle.segments = 7;
        const LabelingProblem problem = curve_bundle(engine, bundle);
        const SolveResult best = every_solver().find("branch-and-bound")->solve(problem);
        ASSERT_EQ(best.status, SolveStatus::Optimal) << seed;
        SolveOptions options = limited(*solver);
        for (auto label : best.solution->labels) {
            options.warm_start.push_back(static_cast<std::int8_t>(label));
        }
        const SolveResult result = solver->solve(problem, options);
        ASSERT_TRUE(result.solution) << seed;
        EXPECT_EQ(result.solution->value, best.solution->value) << seed;
    }
}

TEST_P(Contract, AcceptsPartialAndContradictingWarmStarts) {
    for (std::uint64_t seed = 400; seed < 500; ++seed) {
        if (GetParam() == "cbc" && seed >= 410) break;
        std::mt19937_64 engine(seed);
        const LabelingProblem problem = random_problem(engine, 9);
        SolveOptions options = limited(*solver);
        for (Label i = 0; i < problem.label_count(); ++i) {
            options.warm_start.push_back(static_cast<std::int8_t>(pick(engine, -1, 1)));
        }
        const SolveResult result = solver->solve(problem, options);
        EXPECT_EQ(broken_promise(*solver, problem, result, enumerate_optimum(problem)), "") << seed;
    }
}

TEST_P(Contract, RefusesWrongOptions) {
    labeling::ProblemBuilder builder;
    builder.add_label(1);
    const LabelingProblem problem = builder.build();
    SolveOptions wrong_length;
    wrong_length.warm_start = {1, 0};
    EXPECT_THROW(solver->solve(problem, wrong_length), labeling::InputError);
    SolveOptions wrong_entry;
    wrong_entry.warm_start = {2};
    EXPECT_THROW(solver->solve(problem, wrong_entry), labeling::InputError);
    SolveOptions wrong_extra;
    wrong_extra.extra["no-such-option"] = "1";
    EXPECT_THROW(solver->solve(problem, wrong_extra), labeling::InputError);
    SolveOptions wrong_limit;
    wrong_limit.work_limit = -1;
    EXPECT_THROW(solver->solve(problem, wrong_limit), labeling::InputError);
    SolveOptions wrong_gap;
    wrong_gap.relative_gap = -0.1;
    EXPECT_THROW(solver->solve(problem, wrong_gap), labeling::InputError);
}

TEST_P(ExactContract, OptimumSurvivesRenaming) {
    for (std::uint64_t seed = 600; seed < 610; ++seed) {
        std::mt19937_64 engine(seed);
        BundleOptions bundle;
        bundle.crossings = 6;
        bundle.reach = 2;
        const LabelingProblem problem = curve_bundle(engine, bundle);
        std::vector<Label> order(problem.label_count());
        std::iota(order.begin(), order.end(), 0);
        for (std::size_t k = order.size(); k > 1; --k) {
            std::swap(order[k - 1], order[engine() % k]);
        }
        const SolveResult a = solver->solve(problem);
        const SolveResult b = solver->solve(permuted(problem, order));
        ASSERT_EQ(a.status, SolveStatus::Optimal) << seed;
        ASSERT_EQ(b.status, SolveStatus::Optimal) << seed;
        EXPECT_EQ(a.solution->value, b.solution->value) << seed;
    }
}

std::vector<std::string> exact_names() {
    std::vector<std::string> names = every_solver().names();
    std::erase_if(names, [](const auto& name) { return !every_solver().find(name)->is_exact(); });
    return names;
}

std::string test_name(const testing::TestParamInfo<std::string>& param) {
    std::string name = param.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(EverySolver, Contract, testing::ValuesIn(every_solver().names()),
                         test_name);
INSTANTIATE_TEST_SUITE_P(EveryExactSolver, ExactContract, testing::ValuesIn(exact_names()),
                         test_name);

TEST(ExactSolvers, AgreeOnBundlesOfCurves) {
    const auto registry = every_solver();
    for (int k = 0; k < 12; ++k) {
        const std::uint64_t seed = 9000 + static_cast<std::uint64_t>(k);
        std::mt19937_64 engine(seed);
        BundleOptions options;
        options.curves = 5 + k % 4;
        options.segments = 9;
        options.crossings = 4 + k;
        options.reach = 1 + k % 2;
        const LabelingProblem problem = curve_bundle(engine, options);
        std::optional<Value> value;
        for (const std::string& name : registry.names()) {
            const auto solver = registry.find(name);
            if (!solver->is_exact()) continue;
            const SolveResult result = solver->solve(problem);
            ASSERT_EQ(result.status, SolveStatus::Optimal) << name << " seed " << seed;
            if (!value) value = result.solution->value;
            EXPECT_EQ(result.solution->value, *value) << name << " seed " << seed;
        }
    }
}

}  // namespace
}  // namespace labeling_test
