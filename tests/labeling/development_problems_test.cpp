// The development problems: values that HiGHS, SCIP or CP-SAT have proven, and best known ones
// where nobody has. A labeling above them would be an error of the checker, a bound below one of
// ours.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "labeling/formats.h"
#include "labeling/solver.h"
#ifdef LABELING_WITH_MIP
#include "labeling_mip/mip_solvers.h"
#endif

namespace labeling {
namespace {

namespace fs = std::filesystem;

constexpr double kRounding = 1e-4;
const fs::path kFolder = SCALEFCN_SOURCE_DIR "/experiments/problems/development";

/// In real units, to four decimals.
std::map<std::string, double> best_known() {
    std::ifstream file(SCALEFCN_SOURCE_DIR "/experiments/benchmarks/labeling_best_known.txt");
    std::map<std::string, double> result;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string name;
        double value = 0;
        if (words >> name >> value) result[name] = value;
    }
    return result;
}

SolverRegistry solvers() {
#ifdef LABELING_WITH_MIP
    return linked_solvers();
#else
    return builtin_solvers();
#endif
}

TEST(DevelopmentProblems, AutoNeitherExceedsNorExcludesTheBestKnownValue) {
    const auto best = best_known();
    int proven = 0, count = 0;
    for (const auto& entry : fs::directory_iterator(kFolder)) {
        const std::string file = entry.path().filename().string();
        const std::string name = file.substr(0, file.find(".lab"));
        SCOPED_TRACE(name);
        ASSERT_TRUE(best.contains(name));
        const LabelingProblem problem = read_problem(entry.path());
        SolveOptions options;
        options.work_limit = 8'000'000;
        const SolveResult result = solvers().find("auto")->solve(problem, options);
        ASSERT_TRUE(result.solution);
        const auto real = [&](Value value) {
            return static_cast<double>(value) / problem.units_per_one();
        };
        EXPECT_LE(real(result.solution->value), best.at(name) + kRounding);
        EXPECT_GE(real(result.solution->value), 0.98 * best.at(name));
        ASSERT_TRUE(result.bound);
        for (const TracePoint& point : result.trace) {
            const Value bound = point.bound.value_or(*result.bound);
            EXPECT_GE(real(bound), best.at(name) - kRounding);
        }
        proven += result.status == SolveStatus::Optimal;
        ++count;
    }
    EXPECT_EQ(count, 17);
#ifdef LABELING_WITH_MIP
    EXPECT_GE(proven, 8);
#endif
}

}  // namespace
}  // namespace labeling
