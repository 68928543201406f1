// Synthetic families: the optimum that comes with a problem is the one that branch-and-bound proves
// and enumeration finds, equal seeds give equal bytes, and every knob does what its name says.
#include "labeling/generators.h"

#include <gtest/gtest.h>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/problems.h"
#include "labeling/registry.h"

namespace labeling_test {
namespace {

using labeling::GeneratedProblem;
using Options = std::map<std::string, std::string>;

void expect_optimum(const GeneratedProblem& made, std::uint64_t seed) {
    ASSERT_TRUE(made.optimum) << seed;
    const auto check = check_solution(made.problem, *made.optimum);
    EXPECT_TRUE(check.is_feasible && check.value_matches) << seed << ": " << check.message;
    const auto proof = every_solver().find("branch-and-bound")->solve(made.problem);
    ASSERT_EQ(proof.status, labeling::SolveStatus::Optimal) << seed;
    EXPECT_EQ(proof.solution->value, made.optimum->value) << seed;
}

TEST(Generators, ChainsHaveTheEnumeratedOptimum) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        labeling::ChainOptions options;
        options.labels = 1 + static_cast<int>(seed % 12);
        options.reach = 1 + static_cast<int>(seed % 5);
        options.seed = seed;
        const GeneratedProblem made = labeling::chain(options);
        ASSERT_TRUE(made.optimum) << seed;
        ASSERT_EQ(enumerate_optimum(made.problem), made.optimum->value) << seed;
        ASSERT_TRUE(check_solution(made.problem, *made.optimum).value_matches) << seed;
    }
}

TEST(Generators, PlantedProblemsHaveTheEnumeratedOptimum) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        labeling::PlantedOptions options;
        options.cliques = 1 + static_cast<int>(seed % 4);
        options.clique_size = 1 + static_cast<int>(seed % 3);
        options.rules = 0.8;
        options.seed = seed;
        const GeneratedProblem made = labeling::planted(options);
        ASSERT_TRUE(made.optimum) << seed;
        ASSERT_EQ(enumerate_optimum(made.problem), made.optimum->value) << seed;
    }
}

TEST(Generators, LargerOnesHaveTheOptimumOfBranchAndBound) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        labeling::ChainOptions chain;
        chain.labels = 150;
        chain.seed = seed;
        expect_optimum(labeling::chain(chain), seed);
        labeling::PlantedOptions planted;
        planted.cliques = 25;
        planted.seed = seed;
        expect_optimum(labeling::planted(planted), seed);
    }
}

TEST(Generators, SameSeedSameBytesOtherSeedOtherProblem) {
    for (const std::string& family : labeling::problem_families()) {
        const Options one{{"seed", "1"}}, two{{"seed", "2"}};
        const auto text = [&family](const Options& options) {
            return format_problem(labeling::generate_problem(family, options).problem,
                                  labeling::ProblemFormat::Lab);
        };
        EXPECT_EQ(text(one), text(one)) << family;
        EXPECT_NE(text(one), text(two)) << family;
    }
}

TEST(Generators, CurvesAreProvenAndLambdaIsTheShareOfBonuses) {
    for (const char* family : {"curves-plane", "curves-sphere"}) {
        for (const char* seed : {"1", "2", "3"}) {
            Options options{{"bundles", "3"}, {"curves", "3"}, {"extent", "7"}, {"seed", seed}};
            const auto made = labeling::generate_problem(family, options);
            EXPECT_GT(made.problem.bonus_count(), 0u) << family << seed;
            EXPECT_GT(made.problem.rule_count(), 0u) << family << seed;
            const auto proof = every_solver().find("branch-and-bound")->solve(made.problem);
            EXPECT_EQ(proof.status, labeling::SolveStatus::Optimal) << family << seed;
            options["lambda0"] = "0";
            EXPECT_EQ(labeling::generate_problem(family, options).problem.bonus_count(), 0u);
        }
    }
}

TEST(Generators, CloserCurvesConflictMore) {
    for (const char* family : {"curves-plane", "curves-sphere"}) {
        std::size_t before = 0;
        for (const char* spacing : {"3", "0.9", "0.4"}) {
            const auto made =
                labeling::generate_problem(family, {{"bundles", "1"}, {"spacing", spacing}});
            EXPECT_TRUE(made.problem.conflict_count() > before ||
                        (made.problem.conflict_count() == 0 && before == 0))
                << family << " " << spacing;
            before = made.problem.conflict_count();
        }
        EXPECT_GT(before, 0u) << family;
        const auto dense = labeling::generate_problem(family, {{"density", "3"}});
        const auto sparse = labeling::generate_problem(family, {{"density", "0.8"}});
        EXPECT_GT(dense.problem.label_count(), 2 * sparse.problem.label_count()) << family;
    }
}

TEST(Generators, UnitDisksHaveTheDegreeAskedFor) {
    for (double degree : {3.0, 12.0}) {
        labeling::UnitDiskOptions options;
        options.labels = 4000;
        options.degree = degree;
        const auto made = labeling::unit_disks(options);
        const double mean = 2.0 * static_cast<double>(made.problem.conflict_count()) / 4000;
        EXPECT_NEAR(mean, degree, 0.15 * degree);  // the border takes a little
        EXPECT_EQ(made.problem.rule_count() + made.problem.bonus_count(), 0u);
        EXPECT_FALSE(made.optimum);
    }
}

TEST(Generators, RefuseWrongOptions) {
    EXPECT_THROW(labeling::generate_problem("spirals", {}), labeling::InputError);
    EXPECT_THROW(labeling::generate_problem("chain", {{"reach", "11"}}), labeling::InputError);
    EXPECT_THROW(labeling::generate_problem("chain", {{"labels", "4x"}}), labeling::InputError);
    EXPECT_THROW(labeling::generate_problem("chain", {{"length", "4"}}), labeling::InputError);
    EXPECT_THROW(labeling::generate_problem("curves-plane", {{"spacing", "nan"}}),
                 labeling::InputError);
}

}  // namespace
}  // namespace labeling_test
