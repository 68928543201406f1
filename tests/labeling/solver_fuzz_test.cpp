// 10^5 small problems, 20,000 for each solver that runs inside this process, and some larger ones,
// with options drawn at random. `labeling_solver_fuzz` runs as many as one likes.
#include "labeling/solver_fuzz.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "labeling/registry.h"

namespace labeling_test {
namespace {

class SolverFuzz : public testing::TestWithParam<std::string> {};

TEST_P(SolverFuzz, KeepsEveryPromise) {
    constexpr std::uint64_t kProblems = 20000;
    for (std::uint64_t seed = 1; seed <= kProblems; ++seed) {
        ASSERT_EQ(fuzz_failure(GetParam(), seed), "");
    }
}

TEST_P(SolverFuzz, KeepsEveryPromiseOnLargerProblems) {
    constexpr std::uint64_t kProblems = 1000;
    for (std::uint64_t seed = 1; seed <= kProblems; ++seed) {
        ASSERT_EQ(fuzz_failure(GetParam(), seed, FuzzSize::Larger), "");
    }
}

std::vector<std::string> names() { return labeling::builtin_solvers().names(); }

std::string test_name(const testing::TestParamInfo<std::string>& param) {
    std::string name = param.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(EverySolver, SolverFuzz, testing::ValuesIn(names()), test_name);

}  // namespace
}  // namespace labeling_test
