// OPB there and back, foreign OPB, and every mistake with its line.
#include <gtest/gtest.h>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/problems.h"

namespace labeling_test {
namespace {

using labeling::InputError;
using labeling::ProblemFormat;
using labeling::RowStyle;

std::string parse_error(const std::string& text) {
    try {
        labeling::parse_problem(text, ProblemFormat::Opb, "in");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Opb, KeepsEveryLabelingAndItsValue) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem p = random_problem(engine, 9);
        for (RowStyle rows : {RowStyle::Paper, RowStyle::Strengthened}) {
            const std::string text = format_problem(p, ProblemFormat::Opb, rows);
            const auto q = labeling::parse_problem(text, ProblemFormat::Opb, "in");
            ASSERT_EQ(all_values(q), all_values(p)) << seed << "\n" << text;
            EXPECT_EQ(q.bonus_count(), p.bonus_count()) << seed;
            if (rows == RowStyle::Paper) {
                EXPECT_EQ(q.conflict_count(), p.conflict_count()) << seed;
                EXPECT_EQ(q.rule_count(), p.rule_count()) << seed;
            }
        }
    }
}

TEST(Opb, ReadsWhatOthersWrite) {
    const auto p = labeling::parse_problem(
        "* #variable= 3 #constraint= 2\n* a comment\nmin: -5 x1 -6 x2\n -7 x3;\n"
        "-1 x1 -1 x2 >= -1;\n+2 x1 +1 x3 = 1 ;\n",
        ProblemFormat::Opb, "in");
    EXPECT_EQ(p.label_count(), 3);
    EXPECT_EQ(p.conflict_count(), 1u);
    EXPECT_EQ(p.rule_count(), 1u);
    EXPECT_EQ(enumerate_optimum(p), 13);
}

TEST(Opb, NamesTheLineOfMistakes) {
    EXPECT_EQ(parse_error("min: 1 x1"), "in: no ';': the file is cut short");
    EXPECT_EQ(parse_error("* labels 99\nmin: 1 x1 ;\n"), "in: 99 labels exceed the file's length");
    EXPECT_EQ(parse_error("* labels 1\n* labels 1\n"), "in:2: second comment 'labels'");
    EXPECT_EQ(parse_error("min: 1 x1 ;\nmin: 1 x1 ;\n"), "in:2: 'min:' must come first and once");
    EXPECT_EQ(parse_error("min: 1 x1 2 x1 ;\n"), "in:1: variable 'x1' is given twice");
    EXPECT_EQ(parse_error("min: 1 ;\n"), "in:1: coefficient without a variable");
    EXPECT_EQ(parse_error("1 x1 <= 2 ;\n"), "in:1: relation '<=' is not >= or =");
    EXPECT_EQ(parse_error("1 ~x1 >= 2 ;\n"), "in:1: negated variables are not supported");
    EXPECT_EQ(parse_error("1.5 x1 >= 2 ;\n"), "in:1: coefficient '1.5' is not an integer");
    EXPECT_EQ(parse_error("1 x0 >= 2 ;\n"), "in:1: variable 'x0' is out of range");
    EXPECT_EQ(parse_error("1 x999999999 >= 2 ;\n"), "in:1: variable 'x999999999' is out of range");
    EXPECT_EQ(parse_error("* conflicts\n1 x1 1 x2 >= 1 ;\n"),
              "in:2: a row under 'conflicts' is not of the form -1 x -1 x >= -1");
    EXPECT_EQ(parse_error("* labels 2\nmin: -1 x1 -1 x2 -3 x3 ;\n* links\n-1 x3 +1 x1 >= 0 ;\n"),
              "in: continuous column x3 has 1 rows y - b <= 0, a bonus has 2");
    EXPECT_EQ(parse_error(";\n"), "in:1: empty statement");
}

TEST(Opb, SurvivesRandomText) {
    const char* words[] = {"min:",      "x1",  "-1",        "+2",         ">=",     "=",
                           ";",         "\n",  "x3",        "*",          "labels", "2",
                           "x2",        "1;",  "* links\n", "0",          "~x1",    "x",
                           "conflicts", "9e9", "* rules\n", "min: 1 x1 ;"};
    int accepted = 0;
    for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
        std::mt19937_64 engine(seed);
        std::string text;
        for (std::int64_t k = pick(engine, 0, 20); k > 0; --k) {
            text += words[pick(engine, 0, std::ssize(words) - 1)];
            text += ' ';
        }
        try {
            const auto p = labeling::parse_problem(text, ProblemFormat::Opb, "in");
            ++accepted;
            if (p.label_count() == 0 || p.label_count() > 6) continue;
            const auto q = labeling::parse_problem(format_problem(p, ProblemFormat::Opb),
                                                   ProblemFormat::Opb, "in");
            ASSERT_EQ(all_values(q), all_values(p)) << seed << "\n" << text;
        } catch (const InputError& error) {
            ASSERT_EQ(std::string(error.what()).substr(0, 3), "in:") << seed;
        }
    }
    EXPECT_GT(accepted, 0);
}

}  // namespace
}  // namespace labeling_test
