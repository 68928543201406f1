// The external programs that are really installed find the enumerated optimum, with the paper's
// rows and the strengthened ones, cold and from a start. Skipped, with a word, where one is
// missing.
#include <gtest/gtest.h>

#include <algorithm>

#include "labeling/problems.h"
#include "labeling_mip/mip_solvers.h"

namespace labeling_test {
namespace {

using labeling::SolveOptions;
using labeling::SolveResult;
using labeling::SolveStatus;

/// More than 32 bits, which clasp does not read.
bool has_long_numbers(const LabelingProblem& problem) {
    constexpr Value kMost = 2'000'000'000;
    return std::any_of(problem.weights().begin(), problem.weights().end(),
                       [](Value w) { return std::abs(w) > kMost; }) ||
           std::any_of(problem.bonuses().begin(), problem.bonuses().end(),
                       [](const auto& b) { return b.value > kMost; });
}

class Peers : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        labeling::ProblemBuilder builder;
        builder.add_label(1);
        const SolveResult probe = solver->solve(builder.build());
        if (probe.message.find("not installed") != std::string::npos ||
            probe.message.find("icense") != std::string::npos) {
            GTEST_SKIP() << probe.message;
        }
    }

    /// Empty when the answer is right.
    std::string failure(const LabelingProblem& problem, const char* rows, bool is_warm) const {
        SolveOptions options;
        options.extra["rows"] = rows;
        if (is_warm) options.warm_start.assign(problem.label_count(), -1);
        const auto optimum = enumerate_optimum(problem);
        const SolveResult result = solver->solve(problem, options);
        if (result.status == SolveStatus::Infeasible) return optimum ? "called infeasible" : "";
        if (!optimum) return "no solution exists, but: " + result.message;
        if (!result.solution) return "no solution: " + result.message;
        if (result.statistics.contains("false_claims")) return "accused: " + result.message;
        if (result.solution->value != *optimum) {
            return std::to_string(result.solution->value) + " is not the optimum " +
                   std::to_string(*optimum);
        }
        if (!result.bound) return "no bound: " + result.message;
        if (*result.bound < *optimum) return "the bound cuts the optimum off";
        // Off by a tolerance of the program at most.
        const auto most = static_cast<Value>(1e-6 * static_cast<double>(std::abs(*optimum))) + 1;
        return *result.bound > *optimum + most ? "the bound is not tight" : "";
    }

    std::shared_ptr<const labeling::Solver> solver = labeling::all_solvers().find(GetParam());
};

TEST_P(Peers, AgreeWithEnumeration) {
    for (std::uint64_t seed = 70000; seed < 70016; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            seed % 2 == 0 ? random_problem(engine, 9) : frustrated_problem(engine, 9);
        if (GetParam() == "clasp" && has_long_numbers(problem)) continue;
        const bool is_warm = seed % 3 == 0;
        for (const char* rows : {"paper", "strengthened"}) {
            const std::string why = failure(problem, rows, is_warm);
            if (why.empty()) continue;
            FAIL() << GetParam() << ", seed " << seed << ", " << rows << " rows: " << why << "\n"
                   << shrunk(problem, [&](const LabelingProblem& p) {
                          return p.label_count() > 0 && !failure(p, rows, is_warm).empty();
                      });
        }
    }
}

TEST_P(Peers, AgreeWithBranchAndBoundOnABundle) {
    std::mt19937_64 engine(71000);
    BundleOptions bundle;
    bundle.curves = 4;
    bundle.segments = 6;
    const LabelingProblem problem = curve_bundle(engine, bundle);
    const SolveResult best = labeling::all_solvers().find("branch-and-bound")->solve(problem);
    ASSERT_EQ(best.status, SolveStatus::Optimal);
    SolveOptions warm;
    for (auto label : best.solution->labels) {
        warm.warm_start.push_back(static_cast<std::int8_t>(label));
    }
    for (const SolveOptions& options : {SolveOptions{}, warm}) {
        const SolveResult result = solver->solve(problem, options);
        ASSERT_TRUE(result.solution) << result.message;
        EXPECT_EQ(result.solution->value, best.solution->value) << result.message;
        EXPECT_EQ(result.status, SolveStatus::Optimal) << result.message;
        EXPECT_EQ(result.statistics.count("false_claims"), 0u) << result.message;
    }
}

std::string test_name(const testing::TestParamInfo<std::string>& param) {
    std::string name = param.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Installed, Peers,
                         testing::Values("glpk", "clasp", "toulbar2", "highs", "scip", "cp-sat",
                                         "gurobi"),
                         test_name);

}  // namespace
}  // namespace labeling_test
