// METIS graphs: the optimum survives, a problem without bonuses comes back as it was, rules and
// negative weights are refused, every mistake has its line.
#include <gtest/gtest.h>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/generators.h"
#include "labeling/problems.h"

namespace labeling_test {
namespace {

using labeling::InputError;
using labeling::ProblemFormat;

std::string parse_error(const std::string& text) {
    try {
        labeling::parse_problem(text, ProblemFormat::Metis, "in");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

LabelingProblem random_graph(std::mt19937_64& engine, bool has_bonuses) {
    labeling::ProblemBuilder builder;
    const auto n = static_cast<labeling::Label>(pick(engine, 1, 7));
    for (labeling::Label i = 0; i < n; ++i) builder.add_label(pick(engine, 0, 20));
    for (labeling::Label i = 0; i < n; ++i) {
        for (labeling::Label j = i + 1; j < n; ++j) {
            if (pick(engine, 0, 99) < 40) builder.add_conflict(i, j);
            if (has_bonuses && pick(engine, 0, 99) < 40) {
                builder.add_bonus(i, j, pick(engine, 0, 20));
            }
        }
    }
    return builder.build();
}

TEST(Metis, KeepsTheOptimum) {
    int with_bonuses = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem p = random_graph(engine, seed % 2 == 0);
        const std::string text = format_problem(p, ProblemFormat::Metis);
        const auto q = labeling::parse_problem(text, ProblemFormat::Metis, "in");
        if (p.bonus_count() == 0) {
            ASSERT_EQ(q.hash(), p.hash()) << seed << "\n" << text;
        } else if (q.label_count() <= 16) {
            ++with_bonuses;
            ASSERT_EQ(enumerate_optimum(q), enumerate_optimum(p)) << seed << "\n" << text;
        }
    }
    EXPECT_GT(with_bonuses, 50);
}

TEST(Metis, ReadsCommentsAndGraphsWithoutWeights) {
    const auto p =
        labeling::parse_problem("% hello\n3 2\n2 3\n1\n% there\n1\n", ProblemFormat::Metis, "in");
    EXPECT_EQ(p.label_count(), 3);
    EXPECT_EQ(p.conflict_count(), 2u);
    EXPECT_EQ(enumerate_optimum(p), 2);
    const auto lonely = labeling::parse_problem("2 0 10\n5\n6\n", ProblemFormat::Metis, "in");
    EXPECT_EQ(enumerate_optimum(lonely), 11);
}

TEST(Metis, RefusesWhatAGraphCannotHold) {
    labeling::ProblemBuilder rules;
    rules.add_label(1);
    rules.add_rule({labeling::Relation::LessEqual, 1, {{1, 0}}});
    EXPECT_THROW(format_problem(rules.build(), ProblemFormat::Metis), InputError);
    labeling::ProblemBuilder negative;
    negative.add_label(-1);
    EXPECT_THROW(format_problem(negative.build(), ProblemFormat::Metis), InputError);
}

TEST(Metis, NamesTheLineOfMistakes) {
    EXPECT_EQ(parse_error(""), "in: empty file");
    EXPECT_EQ(parse_error("3\n"), "in:1: expected '<vertices> <edges> 10'");
    EXPECT_EQ(parse_error("999 0 10\n"), "in:1: number of vertices 999 exceeds the file's length");
    EXPECT_EQ(parse_error("2 1 11\n"), "in:1: kind '11' is not 0 or 10 (vertex weights alone)");
    EXPECT_EQ(parse_error("2 1 10\n5 2\n"), "in: vertex 2 has no line: the file is cut short");
    EXPECT_EQ(parse_error("2 1 10\n5 3\n5 1\n"), "in:2: vertex 1 cannot have the neighbour 3");
    EXPECT_EQ(parse_error("2 1 10\n5 1\n5\n"), "in:2: vertex 1 cannot have the neighbour 1");
    EXPECT_EQ(parse_error("2 1 10\n5 2\n5\n"),
              "in: vertex 1 names the neighbour 2, which does not name it");
    EXPECT_EQ(parse_error("2 2 10\n5 2\n5 1\n"), "in: announces 2 edges, holds 1");
    EXPECT_EQ(parse_error("1 0 10\n-5\n"), "in:2: the weight is not in 0 .. 2^53");
}

}  // namespace
}  // namespace labeling_test
