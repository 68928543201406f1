// Builder, adjacency, hash, and the exact checker.
#include "labeling/problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "labeling/errors.h"
#include "labeling/problems.h"
#include "labeling/solution.h"

namespace labeling_test {
namespace {

using labeling::InputError;
using labeling::Label;
using labeling::ProblemBuilder;
using labeling::Relation;
using labeling::Solution;

template <typename Action>
std::string message_of(Action action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Builder, RefusesBadInputAndNamesIt) {
    ProblemBuilder b;
    b.add_label(1);
    b.add_label(2);
    EXPECT_EQ(message_of([&] { b.add_conflict(0, 2); }), "conflict: label 3 is out of range 1..2");
    EXPECT_EQ(message_of([&] { b.add_conflict(-1, 0); }), "conflict: label 0 is out of range 1..2");
    EXPECT_EQ(message_of([&] { b.add_conflict(1, 1); }), "conflict of label 2 with itself");
    EXPECT_EQ(message_of([&] { b.add_bonus(1, 1, 3); }), "bonus of label 2 with itself");
    EXPECT_EQ(message_of([&] { b.add_bonus(0, 1, -3); }), "bonus (1, 2): negative value -3");
    EXPECT_EQ(message_of([&] {
                  b.add_rule({Relation::Equal, 0, {{1, 7}}});
              }),
              "rule: label 8 is out of range 1..2");
    EXPECT_EQ(message_of([&] { b.add_label(labeling::kMaxTotal + 1); }),
              "label 3: weight 9007199254740993 exceeds 2^53");
    EXPECT_EQ(message_of([&] { b.add_label(std::numeric_limits<Value>::min()); }),
              "label 3: weight -9223372036854775808 exceeds 2^53");
    EXPECT_EQ(message_of([&] { b.set_units_per_one(0); }),
              "units per 1.0 must be positive and finite");
}

TEST(Builder, RefusesTotalsAboveTheExactRange) {
    ProblemBuilder fits;
    fits.add_label(labeling::kMaxTotal - 5);
    fits.add_label(-5);
    EXPECT_EQ(fits.build().label_count(), 2);
    ProblemBuilder exceeds;
    exceeds.add_label(labeling::kMaxTotal - 5);
    exceeds.add_label(-6);
    EXPECT_EQ(message_of([&] { exceeds.build(); }),
              "the absolute weights and bonuses sum to more than 2^53");
}

TEST(Builder, NormalisesPairsAndRules) {
    ProblemBuilder b;
    for (int k = 0; k < 4; ++k) b.add_label(1);
    b.add_conflict(2, 0);
    b.add_conflict(0, 2);
    b.add_bonus(1, 0, 4);
    b.add_bonus(0, 1, 5);
    b.add_bonus(0, 2, 7);
    b.add_bonus(1, 3, 0);
    b.add_rule({Relation::LessEqual, 1, {{2, 3}, {1, 1}, {-2, 3}, {4, 1}}});
    const LabelingProblem p = b.build();
    ASSERT_EQ(p.conflict_count(), 1U);
    EXPECT_EQ(p.conflicts()[0], (labeling::Conflict{0, 2}));
    ASSERT_EQ(p.bonus_count(), 1U);
    EXPECT_EQ(p.bonuses()[0], (labeling::Bonus{0, 1, 9}));
    EXPECT_EQ(p.dropped_bonus_count(), 1U);
    ASSERT_EQ(p.rules()[0].terms.size(), 1U);
    EXPECT_EQ(p.rules()[0].terms[0], (labeling::Term{5, 1}));
    EXPECT_EQ(b.label_count(), 0);
}

TEST(Problem, AdjacencyAgreesWithTheListsOnRandomProblems) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem p = random_problem(engine, 12);
        std::size_t conflicts = 0, bonuses = 0, terms = 0;
        for (Label i = 0; i < p.label_count(); ++i) {
            conflicts += p.conflicts_of(i).size();
            bonuses += p.bonuses_of(i).size();
            for (Label j : p.conflicts_of(i)) EXPECT_TRUE(p.in_conflict(j, i)) << seed;
            for (const auto& use : p.rules_of(i)) {
                const auto& rule = p.rules()[use.rule].terms;
                EXPECT_EQ(
                    std::count(rule.begin(), rule.end(), (labeling::Term{use.coefficient, i})), 1)
                    << seed;
                ++terms;
            }
        }
        std::size_t expected_terms = 0;
        for (const auto& rule : p.rules()) expected_terms += rule.terms.size();
        EXPECT_EQ(conflicts, 2 * p.conflict_count()) << seed;
        EXPECT_EQ(bonuses, 2 * p.bonus_count()) << seed;
        EXPECT_EQ(terms, expected_terms) << seed;
    }
}

TEST(Problem, HashIgnoresNamesAndOrderButNothingElse) {
    auto make = [](Value weight, bool is_swapped, const char* name) {
        ProblemBuilder b;
        b.add_label(weight, name);
        b.add_label(2);
        b.add_label(3);
        b.add_conflict(is_swapped ? 1 : 0, is_swapped ? 0 : 1);
        b.add_bonus(1, 2, 4);
        return b.build();
    };
    EXPECT_EQ(make(1, false, "").hash(), make(1, true, "first").hash());
    EXPECT_NE(make(1, false, "").hash(), make(5, false, "").hash());
}

TEST(Checker, ListsEveryViolationAndTheTrueValue) {
    ProblemBuilder b;
    for (Value w : {10, 20, 30}) b.add_label(w);
    b.add_conflict(0, 1);
    b.add_bonus(1, 2, 5);
    b.add_rule({Relation::LessEqual, 1, {{1, 1}, {1, 2}}});
    b.add_rule({Relation::GreaterEqual, 1, {{1, 0}}});
    b.add_rule({Relation::Equal, 2, {{1, 0}, {1, 1}}});
    const LabelingProblem p = b.build();
    const auto all = check_solution(p, {{1, 1, 1}, 65});
    EXPECT_FALSE(all.is_feasible);
    EXPECT_TRUE(all.value_matches);
    EXPECT_EQ(all.violated_conflicts.size(), 1U);
    EXPECT_EQ(all.violated_rules, std::vector<std::int32_t>{0});
    const auto none = check_solution(p, {{0, 0, 0}, 3});
    EXPECT_EQ(none.violated_rules, (std::vector<std::int32_t>{1, 2}));
    EXPECT_FALSE(none.value_matches);
    EXPECT_EQ(none.message, "2 violated rule(s), first rule 2; claimed value 3, recomputed 0");
    EXPECT_THROW(check_solution(p, {{1, 1}, 0}), InputError);
    EXPECT_THROW(check_solution(p, {{1, 2, 0}, 0}), InputError);
}

}  // namespace
}  // namespace labeling_test
