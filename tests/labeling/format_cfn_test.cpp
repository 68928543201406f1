// CFN there and back, networks as toulbar2 writes them, and every mistake with its line.
#include <gtest/gtest.h>

#include <regex>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/problems.h"

namespace labeling_test {
namespace {

using labeling::InputError;
using labeling::ProblemFormat;

LabelingProblem parsed(const std::string& text) {
    return labeling::parse_problem(text, ProblemFormat::Cfn, "in");
}

std::string parse_error(const std::string& text) {
    try {
        parsed(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

/// Three variables a, b, c of two values and the given functions, each on a line of its own.
std::string network(const std::string& functions, const std::string& bound = "<1000") {
    return R"({"problem": {"name": "n", "mustbe": ")" + bound +
           "\"},\n\"variables\": {\"a\": 2, \"b\": 2, \"c\": 2},\n\"functions\": {\n" + functions +
           "}}\n";
}

TEST(Cfn, ComesBackAsItWas) {
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
        std::mt19937_64 engine(seed);
        LabelingProblem p = random_problem(engine, 12);
        if (seed % 5 == 0) {
            BundleOptions bundle;
            bundle.crossings = 8;
            p = curve_bundle(engine, bundle);
        }
        const std::string text = format_problem(p, ProblemFormat::Cfn);
        const LabelingProblem q = parsed(text);
        ASSERT_EQ(q.hash(), p.hash()) << seed << "\n" << text;
        EXPECT_EQ(format_problem(q, ProblemFormat::Cfn), text) << seed;
    }
}

TEST(Cfn, KeepsLongRulesOfEveryRelation) {
    using labeling::Relation;
    for (Relation relation : {Relation::LessEqual, Relation::GreaterEqual, Relation::Equal}) {
        labeling::ProblemBuilder builder;
        labeling::Rule rule{relation, 2, {}};
        for (labeling::Label i = 0; i < 9; ++i) {
            builder.add_label(i);
            rule.terms.push_back({i % 3 - 1, i});
        }
        builder.add_rule(rule);
        rule.relation = Relation::Equal;
        builder.add_rule(rule);
        const LabelingProblem p = builder.build();
        EXPECT_EQ(parsed(format_problem(p, ProblemFormat::Cfn)).hash(), p.hash());
    }
}

TEST(Cfn, WithoutOurNamesKeepsEveryLabelingAndItsValue) {
    const std::regex name("\"[lxqr][0-9]+[^\"]*\": \\{");
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        std::mt19937_64 engine(seed);
        const LabelingProblem p = random_problem(engine, 9);
        const std::string text =
            std::regex_replace(format_problem(p, ProblemFormat::Cfn), name, "f: {");
        ASSERT_EQ(all_values(parsed(text)), all_values(p)) << seed << "\n" << text;
    }
}

TEST(Cfn, ANameThatLiesCountsForNothing) {
    const auto p =
        parsed(network(R"("r1_le_1_1_1": {"scope": ["a", "b"], "costs": [0, 1000, 0, 0]})"));
    EXPECT_EQ(p.rule_count(), 1u);
    const auto values = all_values(p);
    for (std::size_t set = 0; set < values.size(); ++set) {
        EXPECT_EQ(values[set].has_value(), (set & 3U) != 2U) << set;  // a is bit 0, b is bit 1
    }
}

TEST(Cfn, ReadsWhatToulbar2Writes) {
    const auto p = parsed(
        "{\"problem\":{\"name\":\"a.cfn\",\"mustbe\":\"<15\"},\n\"variables\":{\n"
        "\"b1\":[\"0\",\"1\"],\n\"b2\":[\"off\",\"on\"],\n\"b3\":[\"0\",\"1\"]\n},\n"
        "\"functions\": {\n\"F_0_1\":{\"scope\":[b1,b2],\"defaultcost\":0,\n\"costs\":[\n0,off,4,\n"
        "0,on,4,\n1,off,4\n]},\n\"F_0_1_2\":{\"scope\":[b1,b2,b3],\"defaultcost\":0,\n"
        "\"costs\":[\n1,0,0,15,\n1,0,1,15,\n]}\n\"F_0\":{\"scope\":[b1],\"defaultcost\":8,\n"
        "\"costs\":[0,3,1,0]},\n\"F\":{\"scope\":[],\"costs\":[-7]}\n}\n}\n");
    EXPECT_EQ(p.label_count(), 3);
    EXPECT_EQ(p.weight(0), 3);
    EXPECT_EQ(p.bonus_count(), 1u);
    EXPECT_EQ(p.rule_count(), 1u);  // b1 only with b2, whatever b3 is
    EXPECT_EQ(enumerate_optimum(p), 7);
}

TEST(Cfn, HoldsConstantsCliquesAndForbiddenValues) {
    const auto p = parsed(network(
        R"("f": {"scope": ["a"], "costs": [7.00, 2]}, g: {"scope": [b], "costs": [1000, 5]}
           h: {scope: [a, c], costs: [1000, 3, 4, 1]},
           k: {scope: [a, b, c], type: clique, params: {rhs: 1, values: [[1], [1], [1]]}})"));
    ASSERT_EQ(p.label_count(), 4);  // the last one carries the constant
    const auto values = all_values(p);
    // b must be 1 and excludes a and c by the clique; a = c = 0 is forbidden.
    for (const auto& value : values) EXPECT_FALSE(value.has_value());
    const auto costs = parsed(network("f: {scope: [a], costs: [7, 2]}"));
    EXPECT_EQ(enumerate_optimum(costs), -2);
}

TEST(Cfn, CliquesMayCountValueZero) {
    const auto p = parsed(network(
        "k: {scope: [a, b, c], type: clique, params: {rhs: 1, values: [[0], [1], [0, 1]]}}"));
    const auto values = all_values(p);
    for (std::size_t set = 0; set < values.size(); ++set) {
        const bool a = (set & 1U) != 0, b = (set & 2U) != 0;
        EXPECT_EQ(values[set].has_value(), a && !b) << set;
    }
}

TEST(Cfn, NamesTheLineOfMistakes) {
    EXPECT_EQ(parse_error(""), "in:1: expected '{'");
    EXPECT_EQ(parse_error("{}"), "in:1: expected 'problem'");
    EXPECT_EQ(parse_error("{variables: {}}"), "in:1: expected 'problem'");
    EXPECT_EQ(parse_error("{problem: {name: x}\nvariables: {} functions: {}}"),
              "in:2: no upper bound 'mustbe' above 0");
    EXPECT_EQ(parse_error("{problem: {mustbe: \">5\"}"),
              "in:1: 'mustbe' is no upper bound '<number'");
    EXPECT_EQ(parse_error("{problem: {name: [1, {2}]"), "in:1: expected a property of the problem");
    EXPECT_EQ(parse_error("{problem: {name: [1, {2}"), "in:1: the file is cut short");
    EXPECT_EQ(parse_error("{problem: {mustbe: <9}\nvariables: {a: 3}"),
              "in:2: variable 'a' does not have two values");
    EXPECT_EQ(parse_error("{problem: {mustbe: <9}\nvariables: {a: 2\na: 2}"),
              "in:3: second variable 'a'");
    EXPECT_EQ(parse_error("{problem: {mustbe: <9}\nvariables: {\"a: 2}"),
              "in:2: a quotation has no end");
    EXPECT_EQ(parse_error(network("f: {scope: [d], costs: [1, 2]}")), "in:4: unknown variable 'd'");
    EXPECT_EQ(parse_error(network("f: {scope: [a, a], costs: []}")),
              "in:4: a variable is in the scope twice");
    EXPECT_EQ(parse_error(network("f: {scope: [a], costs: [1]}")),
              "in:4: expected 2 costs, found 1");
    EXPECT_EQ(parse_error(network("f: {scope: [a], costs: [1, 2.5]}")),
              "in:4: cost '2.5' is not an integer");
    EXPECT_EQ(parse_error(network("f: {scope: [a], costs: [1, 99999999999999999]}")),
              "in:4: the cost exceeds 2^55");
    EXPECT_EQ(parse_error(network("f: {scope: [a], defaultcost: 0, costs: [1]}")),
              "in:4: the costs are no tuples of values with a cost each");
    EXPECT_EQ(parse_error(network("f: {scope: [a], defaultcost: 0, costs: [2, 0]}")),
              "in:4: '2' is no value of its variable");
    EXPECT_EQ(parse_error(network("f: {scope: [a], type: salldiff, params: {}}")),
              "in:4: functions of type 'salldiff' are not supported");
    EXPECT_EQ(parse_error(network("f: {scope: [a], type: knapsack, params: {capacity: 1}}")),
              "in:4: the parameters do not fit the scope");
    EXPECT_EQ(parse_error(network("f: {scope: [a, b], costs: [0, 0, 0, 5]}")),
              "in:4: two values 1 cost more together than apart; a bonus cannot be negative");
    EXPECT_EQ(parse_error(network("f: {scope: [a, b, c], costs: [0, 0, 0, 5, 0, 0, 0, 0]}")),
              "in:4: costs that depend on more than two variables");
    EXPECT_EQ(parse_error(
                  network("f: {scope: [a], costs: [0, 5]}\ng: {scope: [b], costs: [5, 0]}", "<10")),
              "in:6: allowed costs add up to 10, but 'mustbe' is 10: a bound on the objective is "
              "not supported");
    EXPECT_EQ(parse_error(network("") + "more"), "in:5: expected the end of the file");
    EXPECT_EQ(parse_error(network("f: {scope: [a, b, c, x")), "in:4: unknown variable 'x'");
}

TEST(Cfn, SurvivesRandomChanges) {
    int accepted = 0;
    for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
        std::mt19937_64 engine(seed);
        std::string text = format_problem(random_problem(engine, 6), ProblemFormat::Cfn);
        for (std::int64_t k = pick(engine, 1, 3); k > 0; --k) {
            constexpr std::string_view kLetters = "0123456789-{}[]\",: <abr";
            const auto at = static_cast<std::size_t>(pick(engine, 0, std::ssize(text) - 1));
            text[at] =
                kLetters[static_cast<std::size_t>(pick(engine, 0, std::ssize(kLetters) - 1))];
        }
        try {
            const auto p = parsed(text);
            ++accepted;
            if (p.label_count() == 0 || p.label_count() > 8) continue;
            const auto q = parsed(format_problem(p, ProblemFormat::Cfn));
            ASSERT_EQ(q.hash(), p.hash()) << seed << "\n" << text;
        } catch (const InputError& error) {
            ASSERT_EQ(std::string(error.what()).substr(0, 3), "in:") << seed;
        }
    }
    EXPECT_GT(accepted, 100);
    EXPECT_LT(accepted, 2700);
}

}  // namespace
}  // namespace labeling_test
