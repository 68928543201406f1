// Proofs of optimality: what the proving search writes is accepted by the checker and says what
// enumeration says; changed proofs are rejected or still say the truth; VeriPB agrees where it is
// installed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "labeling/formats.h"
#include "labeling/proof_checker.h"
#include "labeling/proving_search.h"
#include "labeling_mip/mip_solvers.h"
#include "problems.h"

namespace labeling_test {
namespace {

using labeling::check_proof;
using labeling::ProofCheck;
using labeling::ProofResult;

std::string opb_of(const LabelingProblem& problem) {
    return format_problem(problem, labeling::ProblemFormat::Opb);
}

ProofResult prove(const LabelingProblem& problem) {
    return prove_optimality(problem, std::nullopt, labeling::clp_factory());
}

/// Whether a valid proof's conclusion is true.
::testing::AssertionResult is_true(const ProofCheck& check, const std::optional<Value>& optimum) {
    if (!optimum) {
        if (!check.lower && !check.upper) return ::testing::AssertionSuccess();
        return ::testing::AssertionFailure() << "bounds for an infeasible problem";
    }
    if (!check.lower || !check.upper)
        return ::testing::AssertionFailure() << "infeasible, but it is not";
    if (*check.lower <= -*optimum && -*optimum <= *check.upper)
        return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "the optimum " << *optimum << " is outside the bounds";
}

TEST(Proof, OfSmallProblemsAgreesWithEnumeration) {
    for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            seed % 2 == 0 ? random_problem(engine, 10) : frustrated_problem(engine, 12);
        if (problem.label_count() == 0) continue;
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto optimum = enumerate_optimum(problem);
        const ProofResult result = prove(problem);
        ASSERT_TRUE(result.is_complete);
        ASSERT_EQ(result.solution.has_value(), optimum.has_value());
        if (optimum) {
            ASSERT_EQ(result.solution->value, *optimum);
        }
        const ProofCheck check = check_proof(opb_of(problem), result.proof);
        ASSERT_TRUE(check.is_valid) << check.message << "\n" << opb_of(problem) << result.proof;
        ASSERT_EQ(check.lower, optimum ? std::optional(-*optimum) : std::nullopt);
        ASSERT_EQ(check.upper, check.lower);
    }
}

TEST(Proof, OfCurveBundles) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        std::mt19937_64 engine(seed);
        BundleOptions options;
        options.curves = 5;
        options.segments = 10;
        const LabelingProblem problem = curve_bundle(engine, options);
        const auto best = labeling::all_solvers().find("branch-and-bound")->solve(problem);
        ASSERT_EQ(best.status, labeling::SolveStatus::Optimal);
        const ProofResult result =
            prove_optimality(problem, best.solution, labeling::clp_factory());
        ASSERT_TRUE(result.is_complete);
        EXPECT_EQ(result.solution->value, best.solution->value) << "seed " << seed;
        const ProofCheck check = check_proof(opb_of(problem), result.proof);
        EXPECT_TRUE(check.is_valid) << check.message;
        EXPECT_EQ(check.lower, -best.solution->value);
    }
}

TEST(Proof, ConclusionsThatSayMoreAreRejected) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem problem = frustrated_problem(engine, 12);
        const ProofResult result = prove(problem);
        const std::string value = std::to_string(-result.solution->value);
        const std::string conclusion = "conclusion BOUNDS " + value + " " + value;
        const std::size_t at = result.proof.find(conclusion);
        ASSERT_NE(at, std::string::npos);
        const std::string higher = std::to_string(-result.solution->value + 1);
        const std::string lower = std::to_string(-result.solution->value - 1);
        for (const std::string& claim : {"conclusion BOUNDS " + higher + " " + higher,
                                         "conclusion BOUNDS " + lower + " " + lower,
                                         std::string("conclusion BOUNDS INF INF")}) {
            std::string changed = result.proof;
            changed.replace(at, conclusion.size(), claim);
            EXPECT_FALSE(check_proof(opb_of(problem), changed).is_valid) << claim;
        }
        EXPECT_FALSE(check_proof(opb_of(problem), result.proof.substr(0, at)).is_valid);
    }
}

TEST(Proof, ALineLessOrAProofOfAnotherProblemDoesNotHelp) {
    int rejected = 0;
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem problem = frustrated_problem(engine, 11);
        const auto optimum = enumerate_optimum(problem);
        const LabelingProblem other = frustrated_problem(engine, 11);
        const auto other_optimum = enumerate_optimum(other);
        const ProofResult result = prove(problem);
        const ProofCheck swapped = check_proof(opb_of(other), result.proof);
        if (swapped.is_valid) {
            EXPECT_TRUE(is_true(swapped, other_optimum)) << "seed " << seed;
        }
        std::vector<std::string> lines;
        std::istringstream stream(result.proof);
        for (std::string line; std::getline(stream, line);) lines.push_back(line);
        const auto gone =
            static_cast<std::size_t>(pick(engine, 0, static_cast<std::int64_t>(lines.size()) - 1));
        std::string shorter;
        for (std::size_t k = 0; k < lines.size(); ++k) {
            if (k != gone) shorter += lines[k] + "\n";
        }
        const ProofCheck check = check_proof(opb_of(problem), shorter);
        rejected += !check.is_valid;
        if (check.is_valid) {
            EXPECT_TRUE(is_true(check, optimum)) << "seed " << seed;
        }
    }
    EXPECT_GT(rejected, 50);
}

/// Random changes of numbers, signs and words: a proof that still passes must still be true.
TEST(Proof, MutationsNeverProveAFalsehood) {
    int rejected = 0, runs = 0;
    for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            seed % 4 == 0 ? random_problem(engine, 8) : frustrated_problem(engine, 9);
        if (problem.label_count() == 0) continue;
        const auto optimum = enumerate_optimum(problem);
        std::string proof = prove(problem).proof;
        const int changes = static_cast<int>(pick(engine, 1, 3));
        for (int k = 0; k < changes; ++k) {
            const auto at = static_cast<std::size_t>(
                pick(engine, 0, static_cast<std::int64_t>(proof.size()) - 1));
            const char letters[] = "0123456789~-+*x ds\n";
            switch (pick(engine, 0, 2)) {
                case 0:
                    proof[at] = letters[pick(engine, 0, sizeof letters - 2)];
                    break;
                case 1:
                    proof.erase(at, 1);
                    break;
                default:
                    proof.insert(at, 1, letters[pick(engine, 0, sizeof letters - 2)]);
            }
        }
        const ProofCheck check = check_proof(opb_of(problem), proof);
        ++runs;
        rejected += !check.is_valid;
        if (check.is_valid) {
            ASSERT_TRUE(is_true(check, optimum)) << "seed " << seed << "\n" << proof;
        }
    }
    EXPECT_GT(rejected, runs / 2);
}

TEST(Proof, TheCheckerRejectsWhatItDoesNotKnow) {
    const std::string opb =
        "* #variable= 2 #constraint= 1\nmin: -3 x1 -2 x2 ;\n-1 x1 -1 x2 >= -1 ;\n";
    const std::string head = "pseudo-Boolean proof version 2.0\nf 1\n";
    const std::string tail = "output NONE\nconclusion BOUNDS -3 -3\nend pseudo-Boolean proof\n";
    // -(f) >= 4 is 3 x1 + 2 x2 >= 4; twice the row takes it to x1 >= 2.
    EXPECT_TRUE(check_proof(opb, head + "soli x1 ~x2\npol 2 1 2 * +\n" + tail).is_valid);
    EXPECT_TRUE(check_proof(opb, head + "soli x1 ~x2\nrup >= 1 ;\n" + tail).is_valid);
    const std::vector<std::string> bad = {
        "",                                     // no solution
        "soli x1 x2\nrup >= 1 ;\n",             // infeasible
        "soli x1\nrup >= 1 ;\n",                // incomplete
        "soli ~x1 x2\nrup >= 1 ;\n",            // x1 is better
        "soli x1 ~x2\n",                        // no contradiction
        "soli x1 ~x2\npol 2 1 -2 * +\n",        // negative factor
        "soli x1 ~x2\npol 2 1 2 *\n",           // two on the stack
        "soli x1 ~x2\npol 7\n",                 // no such constraint
        "soli x1 ~x2\npol 2 0 d\n",             // division by zero
        "soli x1 ~x2\npol +\n",                 // empty stack
        "soli x1 ~x2\nred 1 x1 >= 1 ; x1 1\n",  // unknown step
        "soli x1 ~x2\nrup 1 x3 >= 1 ;\n",       // unknown variable
        "soli x1 ~x2\nrup 1 x2 >= 1\n",         // no semicolon
        "soli x1 ~x2\nrup 1 x2 >= 1 ;\ndel id 9\nrup >= 1 ;\n",
        "soli x1 ~x2\npol 1 9223372036854775807 * 9223372036854775807 * 2 +\n",
    };
    for (const std::string& body : bad) {
        const ProofCheck check = check_proof(opb, head + body + tail);
        EXPECT_FALSE(check.is_valid) << body;
        EXPECT_NE(check.message.find("proof line "), std::string::npos) << check.message;
    }
    EXPECT_FALSE(check_proof("min: 3 x1 ;\nrubbish\n", head + tail).is_valid);
    EXPECT_FALSE(
        check_proof(opb, "pseudo-Boolean proof version 2.0\nf 2\nsoli x1 ~x2\n" + tail).is_valid);
}

TEST(Proof, StopsAtItsLimit) {
    std::mt19937_64 engine(3);
    const LabelingProblem problem = frustrated_problem(engine, 40);
    labeling::ProofOptions options;
    options.node_limit = 0;
    const ProofResult result =
        prove_optimality(problem, std::nullopt, labeling::clp_factory(), options);
    EXPECT_FALSE(result.is_complete);
    EXPECT_TRUE(result.proof.empty());
}

TEST(Proof, VeriPbAgrees) {
    const std::string built = SCALEFCN_SOURCE_DIR "/build/veripb/bin/veripb";
    const std::string program = std::filesystem::exists(built) ? built : "veripb";
    if (std::system((program + " --help > /dev/null 2>&1").c_str()) != 0) {
        GTEST_SKIP() << "needs veripb: scripts/setup_veripb.sh builds it";
    }
    const std::filesystem::path folder =
        std::filesystem::path(::testing::TempDir()) / "scalefcn_veripb";
    std::filesystem::create_directories(folder);
    const auto write = [](const std::filesystem::path& file, const std::string& text) {
        std::ofstream(file, std::ios::binary) << text;
    };
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            seed % 2 == 0 ? random_problem(engine, 10) : frustrated_problem(engine, 14);
        if (problem.label_count() == 0) continue;
        write(folder / "problem.opb", opb_of(problem));
        write(folder / "proof.pbp", prove(problem).proof);
        const std::string command = program + " " + (folder / "problem.opb").string() + " " +
                                    (folder / "proof.pbp").string() + " > " +
                                    (folder / "log").string() + " 2>&1";
        const int code = std::system(command.c_str());
        std::stringstream log;
        log << std::ifstream(folder / "log").rdbuf();
        EXPECT_EQ(code, 0) << "seed " << seed << ": " << log.str();
        EXPECT_NE(log.str().find("s VERIFIED"), std::string::npos) << log.str();
    }
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace labeling_test
