// Round trips through every format, every error message with its line, atomic writes.
#include "labeling/formats.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "labeling/errors.h"
#include "labeling/problems.h"
#include "labeling/registry.h"
#include "labeling/text_file.h"

namespace labeling_test {
namespace {

using labeling::InputError;
using labeling::ProblemFormat;
using labeling::RowStyle;

std::string parse_error(const std::string& text, ProblemFormat format = ProblemFormat::Lab) {
    try {
        labeling::parse_problem(text, format, "in");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

class Folder {
public:
    Folder()
        : path_(std::filesystem::temp_directory_path() /
                ("labeling_formats_" +
                 std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                 std::to_string(reinterpret_cast<std::uintptr_t>(this)))) {
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    std::filesystem::path operator/(const char* name) const { return path_ / name; }
    std::size_t file_count() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(path_), {}));
    }

private:
    std::filesystem::path path_;
};

TEST(Lab, RoundTripsRandomProblems) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem p = random_problem(engine, 12);
        const std::string text = format_problem(p, ProblemFormat::Lab);
        const LabelingProblem q = labeling::parse_problem(text, ProblemFormat::Lab, "in");
        EXPECT_EQ(q.hash(), p.hash()) << seed;
        EXPECT_EQ(format_problem(q, ProblemFormat::Lab), text) << seed;
    }
}

TEST(MpsAndLp, PaperRowsRoundTripAndStrengthenedRowsKeepTheOptimum) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem p = random_problem(engine, 9);
        for (ProblemFormat format : {ProblemFormat::Mps, ProblemFormat::Lp}) {
            const auto paper =
                labeling::parse_problem(format_problem(p, format, RowStyle::Paper), format, "in");
            EXPECT_EQ(paper.hash(), p.hash()) << seed;
            const auto strong = labeling::parse_problem(
                format_problem(p, format, RowStyle::Strengthened), format, "in");
            EXPECT_EQ(enumerate_optimum(strong), enumerate_optimum(p)) << seed;
        }
    }
}

TEST(Lab, KeepsNamesAndUnits) {
    const auto p = labeling::parse_problem("c hi\np labeling 2 0 0 0\ns 2.5\nl 2 -4\nl 1 3 a b\n",
                                           ProblemFormat::Lab, "in");
    EXPECT_EQ(p.name(0), "a b");
    EXPECT_EQ(p.name(1), "");
    EXPECT_EQ(p.units_per_one(), 2.5);
    EXPECT_EQ(p.weight(1), -4);
}

TEST(Lab, NamesTheLineOfEveryMistake) {
    const std::string two = "p labeling 2 1 0 0\nl 1 1\nl 2 1\n";
    EXPECT_EQ(parse_error(""), "in: no line 'p labeling ...'");
    EXPECT_EQ(parse_error("l 1 1\n"), "in:1: expected 'p labeling ...' before anything else");
    EXPECT_EQ(parse_error("p labeling 2 1\n"),
              "in:1: expected 'p labeling <labels> <conflicts> <bonuses> <rules>'");
    EXPECT_EQ(parse_error("p labeling x 0 0 0\n"), "in:1: number of labels 'x' is not an integer");
    EXPECT_EQ(parse_error("p labeling -1 0 0 0\n"), "in:1: negative size -1");
    EXPECT_EQ(parse_error("p labeling 999999999 0 0 0\n"),
              "in:1: size 999999999 exceeds the file's length");
    EXPECT_EQ(parse_error("p labeling 1 0 0 0\np labeling 1 0 0 0\n"), "in:2: second line 'p'");
    EXPECT_EQ(parse_error("p labeling 1 0 0 0\ns 0\n"),
              "in:2: units per 1.0 must be positive and finite");
    EXPECT_EQ(parse_error("p labeling 1 0 0 0\nl 2 1\n"), "in:2: label 2 is out of range 1..1");
    EXPECT_EQ(parse_error("p labeling 1 0 0 0\nl 1\n"), "in:2: missing weight");
    EXPECT_EQ(parse_error("p labeling 1 0 0 0\nl 1 99999999999999999999\n"),
              "in:2: weight '99999999999999999999' is not an integer of 64 bits");
    EXPECT_EQ(parse_error("p labeling 1 0 0 0\nl 1 9007199254740993\n"),
              "in:2: the weight exceeds 2^53");
    EXPECT_EQ(parse_error("p labeling 1 0 0 0\nl 1 1\nl 1 1\n"), "in:3: label 1 is given twice");
    EXPECT_EQ(parse_error("p labeling 2 0 0 0\nl 1 1\n"), "in: label 2 has no line 'l'");
    EXPECT_EQ(parse_error("p labeling 1 0 0 0\nl 1 1\nz\n"), "in:3: unknown record 'z'");
    EXPECT_EQ(parse_error(two + "x 1\n"), "in:4: expected 'x <i> <j>'");
    EXPECT_EQ(parse_error(two + "x 1 1\n"), "in:4: conflict of label 1 with itself");
    EXPECT_EQ(parse_error(two + "x 1 3\n"), "in:4: label 3 is out of range 1..2");
    EXPECT_EQ(parse_error(two), "in: announces 1 conflicts, holds 0");
    EXPECT_EQ(parse_error(two + "x 1 2\nb 1 2 -1\n"), "in:5: bonus (1, 2): negative value -1");
    EXPECT_EQ(parse_error(two + "x 1 2\nr lt 1 1 1 1\n"),
              "in:5: relation 'lt' is not le, ge or eq");
    EXPECT_EQ(parse_error(two + "x 1 2\nr le 1 2 1 1\n"),
              "in:5: the rule announces 2 terms, the line holds 2 words after that");
    EXPECT_EQ(parse_error(two + "x 1 2\nr le 1 1 3000000000 1\n"),
              "in:5: coefficient 3000000000 exceeds 2^31 - 1");
}

TEST(MpsAndLp, NameTheLineOfMistakes) {
    EXPECT_EQ(parse_error("ROWS\n", ProblemFormat::Mps), "in: no ENDATA: the file is cut short");
    EXPECT_EQ(parse_error("RANGES\n", ProblemFormat::Mps), "in:1: unknown section 'RANGES'");
    EXPECT_EQ(parse_error("ROWS\n Q a\n", ProblemFormat::Mps),
              "in:2: row type 'Q' is not N, L, G or E");
    EXPECT_EQ(parse_error("COLUMNS\n b1 nowhere 1\n", ProblemFormat::Mps),
              "in:2: unknown row 'nowhere'");
    EXPECT_EQ(parse_error("ROWS\n N v\n L a\nRHS\n R a 1\n R a 2\n", ProblemFormat::Mps),
              "in:6: row 'a' has two right-hand sides");
    EXPECT_EQ(parse_error("ROWS\n N v\nCOLUMNS\n b1 v 1\n b1 v 2\n", ProblemFormat::Mps),
              "in:5: column 'b1' is twice in the objective");
    EXPECT_EQ(parse_error("", ProblemFormat::Lp), "in: no End: the file is cut short");
    EXPECT_EQ(parse_error("Minimize\n", ProblemFormat::Lp), "in:1: expected 'Maximize'");
    EXPECT_EQ(
        parse_error("Maximize\n value: + 1 b1\nSubject To\n x1: + 1 b2 <= 1\n", ProblemFormat::Lp),
        "in:4: column 'b2' is not in the objective");
    EXPECT_EQ(parse_error("Maximize\n value: + 1 b1 + 2 y1_2\nSubject To\nBinary\n b1\nEnd\n",
                          ProblemFormat::Lp),
              "in: continuous column y1_2 has 0 rows y - b <= 0, a bonus has 2");
}

TEST(Files, AreChosenByNameCompressedAndWrittenAtomically) {
    std::mt19937_64 engine(3);
    const LabelingProblem p = curve_bundle(engine, {});
    Folder folder;
    const char* names[] = {"p.lab", "p.lab.gz", "p.mps", "p.mps.gz",
                           "p.lp",  "p.lp.gz",  "p.cfn", "p.cfn.gz"};
    for (const char* name : names) {
        write_problem(p, folder / name, RowStyle::Paper);
        EXPECT_EQ(labeling::read_problem(folder / name).hash(), p.hash()) << name;
    }
    for (const char* name : {"p.opb", "p.opb.gz"}) {
        write_problem(p, folder / name, RowStyle::Paper);
        EXPECT_EQ(labeling::read_problem(folder / name).rule_count(), p.rule_count()) << name;
    }
    const LabelingProblem graph = labeling::parse_problem(
        "p labeling 2 1 0 0\nl 1 4\nl 2 5\nx 1 2\n", ProblemFormat::Lab, "in");
    for (const char* name : {"p.graph", "p.graph.gz"}) {
        write_problem(graph, folder / name);
        EXPECT_EQ(labeling::read_problem(folder / name).hash(), graph.hash()) << name;
    }
    EXPECT_EQ(folder.file_count(), std::size(names) + 4) << "a temporary file was left behind";
    EXPECT_LT(std::filesystem::file_size(folder / "p.lab.gz"),
              std::filesystem::file_size(folder / "p.lab"));
    EXPECT_THROW(write_problem(p, folder / "p.txt"), InputError);
    EXPECT_THROW(labeling::read_problem(folder / "missing.lab"), InputError);
    EXPECT_THROW(write_problem(p, folder / "none/p.lab"), InputError);
}

TEST(Files, LinksAndDevicesStayWhatTheyAre) {
    std::mt19937_64 engine(3);
    const LabelingProblem p = curve_bundle(engine, {});
    Folder folder;
    write_problem(p, folder / "target.lab");
    std::filesystem::resize_file(folder / "target.lab", 0);
    std::filesystem::create_symlink("target.lab", folder / "link.lab");
    write_problem(p, folder / "link.lab");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.lab"));
    EXPECT_EQ(labeling::read_problem(folder / "target.lab").hash(), p.hash());
    std::filesystem::create_symlink("/dev/null", folder / "null.lab");
    write_problem(p, folder / "null.lab");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    EXPECT_EQ(folder.file_count(), 3u);
}

TEST(Files, TruncatedGzipIsAnError) {
    std::mt19937_64 engine(4);
    Folder folder;
    const auto file = folder / "p.lab.gz";
    write_problem(curve_bundle(engine, {}), file);
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    EXPECT_THROW(labeling::read_problem(file), InputError);
}

TEST(Solutions, RoundTripAndErrors) {
    std::mt19937_64 engine(5);
    const LabelingProblem p = curve_bundle(engine, {});
    const auto result = every_solver().find("greedy")->solve(p);
    ASSERT_TRUE(result.solution);
    const auto back = labeling::parse_solution(format_solution(*result.solution), "in", p);
    EXPECT_EQ(back.labels, result.solution->labels);
    EXPECT_EQ(back.value, result.solution->value);
    auto error = [&p](const char* text) -> std::string {
        try {
            labeling::parse_solution(text, "in", p);
        } catch (const InputError& e) {
            return e.what();
        }
        return "no error";
    };
    EXPECT_EQ(error(""), "in: no line 'v <value>'");
    EXPECT_EQ(error("1\n"), "in:1: expected 'v <value>' before the labels");
    EXPECT_EQ(error("v 1\nv 2\n"), "in:2: second line 'v'");
    EXPECT_EQ(error("v 1\n1\n1\n"), "in:3: label 1 is listed twice");
    EXPECT_EQ(error("v 1\n0\n").substr(0, 29), "in:2: label 0 is out of range");
}

}  // namespace
}  // namespace labeling_test
