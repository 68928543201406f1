// Another MIP solver, GLPK, gets the same optimum from the files that we write: MPS and LP, the
// paper's rows and the strengthened ones. Skipped where `glpsol` (Debian: glpk-utils) is missing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "labeling/formats.h"
#include "labeling/problems.h"
#include "labeling/registry.h"

namespace labeling_test {
namespace {

namespace fs = std::filesystem;
using labeling::ProblemFormat;
using labeling::RowStyle;

bool has_glpsol() {
    static const bool is_there = std::system("glpsol --version >/dev/null 2>&1") == 0;
    return is_there;
}

class ExportedModels : public testing::Test {
protected:
    void SetUp() override {
        if (!has_glpsol()) GTEST_SKIP() << "glpsol (Debian package glpk-utils) is not installed";
        folder_ = fs::temp_directory_path() /
                  ("labeling_models_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)));
        fs::create_directories(folder_);
    }
    void TearDown() override {
        if (!folder_.empty()) fs::remove_all(folder_);
    }

    /// Optimum by glpsol as our value; nullopt: it found no solution.
    std::optional<Value> glpk_optimum(const LabelingProblem& problem, ProblemFormat format,
                                      RowStyle rows) const {
        const bool is_mps = format == ProblemFormat::Mps;
        const fs::path model = folder_ / (is_mps ? "model.mps" : "model.lp");
        const fs::path answer = folder_ / "answer.txt";
        fs::remove(answer);
        labeling::write_problem(problem, model, rows);
        const std::string command = std::string("glpsol ") + (is_mps ? "--freemps" : "--lp") + " " +
                                    model.string() + " --cuts --write " + answer.string() +
                                    " >/dev/null 2>&1";
        EXPECT_EQ(std::system(command.c_str()), 0) << command;
        std::ifstream in(answer);
        for (std::string line; std::getline(in, line);) {
            std::istringstream words(line);
            std::string kind, type, status;
            double rows_read = 0, columns_read = 0, objective = 0;
            words >> kind;
            if (kind != "s") continue;
            words >> type >> rows_read >> columns_read >> status >> objective;
            if (status != "o") return std::nullopt;
            return std::llround(is_mps ? -objective : objective);
        }
        ADD_FAILURE() << "no answer of: " << command;
        return std::nullopt;
    }

    void expect_optimum(const LabelingProblem& problem, std::optional<Value> optimum,
                        std::uint64_t seed) const {
        for (ProblemFormat format : {ProblemFormat::Mps, ProblemFormat::Lp}) {
            for (RowStyle rows : {RowStyle::Paper, RowStyle::Strengthened}) {
                EXPECT_EQ(glpk_optimum(problem, format, rows), optimum)
                    << "seed " << seed << (format == ProblemFormat::Mps ? " MPS" : " LP")
                    << (rows == RowStyle::Paper ? " paper rows" : " strengthened rows");
            }
        }
    }

private:
    fs::path folder_;
};

TEST_F(ExportedModels, OfSmallProblemsHaveTheEnumeratedOptimum) {
    int infeasible = 0;
    for (std::uint64_t seed = 50000; seed < 50060; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem problem =
            seed % 2 == 0 ? random_problem(engine, 9) : frustrated_problem(engine, 9);
        const auto optimum = enumerate_optimum(problem);
        infeasible += optimum ? 0 : 1;
        expect_optimum(problem, optimum, seed);
        if (HasFailure()) return;
    }
    EXPECT_GT(infeasible, 0);
    EXPECT_LT(infeasible, 30);
}

TEST_F(ExportedModels, OfBundlesHaveTheOptimumOfBranchAndBound) {
    for (std::uint64_t seed = 51000; seed < 51006; ++seed) {
        std::mt19937_64 engine(seed);
        BundleOptions options;
        options.curves = 5;
        options.segments = 10;
        options.crossings = 5;
        const LabelingProblem problem = curve_bundle(engine, options);
        const auto result = every_solver().find("branch-and-bound")->solve(problem);
        ASSERT_EQ(result.status, labeling::SolveStatus::Optimal);
        expect_optimum(problem, result.solution->value, seed);
    }
}

}  // namespace
}  // namespace labeling_test
