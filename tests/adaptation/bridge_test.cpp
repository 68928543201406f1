// The labeling bridge on graphs worked by hand: rules (4) to (9), merged labels, pins, scaling.

#include <gtest/gtest.h>

#include <algorithm>

#include "adaptation/labeling_bridge.h"

namespace fcn::test {
namespace {

using labeling::Relation;
using labeling::Rule;

/// A graph from positions and node pairs; pairs listed in `shorts` are short.
SegmentGraph graph_of(const std::vector<Vec3>& points,
                      const std::vector<std::array<int, 2>>& segments,
                      const std::vector<int>& shorts = {}, const std::vector<int>& pinned = {}) {
    SegmentGraph graph;
    for (const Vec3& p : points) {
        graph.nodes.emplace_back();
        graph.nodes.back().position = p;
    }
    for (const auto& nodes : segments) {
        graph.segments.emplace_back();
        graph.segments.back().nodes = nodes;
    }
    for (int s : shorts) graph.segments[s].is_short = true;
    for (int s : pinned) graph.segments[s].is_pinned = true;
    graph.connect();
    return graph;
}

Conflict conflict_of(int first, int second) {
    Conflict conflict;
    conflict.first = first;
    conflict.second = second;
    return conflict;
}

bool has_rule(const labeling::LabelingProblem& problem, Rule rule) {
    const auto by_label = [](const labeling::Term& a, const labeling::Term& b) {
        return a.label < b.label;
    };
    std::ranges::sort(rule.terms, by_label);
    return std::ranges::any_of(problem.rules(), [&](Rule other) {
        std::ranges::sort(other.terms, by_label);
        return other == rule;
    });
}

/// Two stars of three whose centres 0 and 1 are joined by the short segment 0.
struct ShortBar {
    SegmentGraph graph = graph_of({{0, 0, 0},
                                   {0.5, 0, 0},
                                   {-1, 1, 0},
                                   {-1, -1, 0},
                                   {1.5, 1, 0},
                                   {1.5, -1, 0},
                                   {0.2, 2, 0},
                                   {0.4, 3, 0}},
                                  {{0, 1}, {0, 2}, {0, 3}, {1, 4}, {1, 5}, {6, 7}}, {0});
    ConflictResult conflicts;
    BridgeInput input;
    ShortBar() {
        input.graph = &graph;
        input.conflicts = &conflicts;
        input.weights = {1, 2, 3, 4, 5, 6};
    }
};

TEST(LabelingBridge, WritesValenceSupportAndInheritedRules) {
    ShortBar bar;
    bar.conflicts.vertex_conflicts = {{0, 1, 0.5}};
    bar.conflicts.conflicts = {conflict_of(0, 5), conflict_of(1, 5)};
    const LabelingBridge bridge(bar.input);
    const labeling::LabelingProblem problem = bridge.build();
    const int c0 = bridge.label_of_node(0), c1 = bridge.label_of_node(1);
    ASSERT_GE(c0, 0);
    ASSERT_GE(c1, 0);
    EXPECT_EQ(bridge.label_of_node(2), -1) << "no vertex conflict, no label";
    EXPECT_TRUE(problem.in_conflict(c0, c1)) << "(4)";
    EXPECT_TRUE(has_rule(problem, {Relation::LessEqual, 2, {{1, 0}, {1, 1}, {1, 2}, {-1, c0}}}));
    EXPECT_TRUE(has_rule(problem, {Relation::LessEqual, 2, {{1, 0}, {1, 3}, {1, 4}, {-1, c1}}}));
    EXPECT_TRUE(
        has_rule(problem, {Relation::GreaterEqual, 0, {{-1, 0}, {1, 1}, {1, 2}, {1, 3}, {1, 4}}}))
        << "(8)";
    EXPECT_TRUE(has_rule(problem, {Relation::LessEqual, 2, {{1, 5}, {1, 2}, {1, 3}}})) << "(9)";
    EXPECT_TRUE(has_rule(problem, {Relation::LessEqual, 2, {{1, 5}, {1, 2}, {1, 4}}})) << "(9)";
    // Segment 1 is in conflict with 5 itself: nothing to inherit.
    EXPECT_FALSE(has_rule(problem, {Relation::LessEqual, 2, {{1, 5}, {1, 1}, {1, 3}}}));
    EXPECT_EQ(problem.rule_count(), 5u);
    EXPECT_EQ(problem.weight(c0), 0);
}

TEST(LabelingBridge, ValenceOneNodeNeedsItsLabel) {
    const SegmentGraph graph =
        graph_of({{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, {1, 0.5, 0}}, {{0, 1}, {2, 3}});
    ConflictResult conflicts;
    conflicts.vertex_conflicts = {{0, 2, 0.5}};
    BridgeInput input;
    input.graph = &graph;
    input.conflicts = &conflicts;
    input.weights = {1, 1};
    const LabelingBridge bridge(input);
    const auto problem = bridge.build();
    EXPECT_TRUE(
        has_rule(problem, {Relation::LessEqual, 0, {{1, 0}, {-1, bridge.label_of_node(0)}}}));
    labeling::Solution solution;
    solution.labels = {1, 0, 1, 1};
    bridge.relax_node_labels(solution);
    EXPECT_EQ(solution.labels[bridge.label_of_node(0)], 1);
    EXPECT_EQ(solution.labels[bridge.label_of_node(2)], 0) << "c is 1 only where needed";
}

TEST(LabelingBridge, MergesLabelsBySummingAndFixesInnerConflicts) {
    ShortBar bar;
    bar.input.groups = {0, 1, 2, 1, 2, 3};
    bar.input.bonuses = {{1, 3, 10}, {1, 2, 7}, {3, 4, 5}};
    bar.conflicts.conflicts = {conflict_of(2, 4)};
    const LabelingBridge bridge(bar.input);
    const auto problem = bridge.build();
    const double units = problem.units_per_one();
    EXPECT_EQ(problem.label_count(), 4);
    EXPECT_EQ(problem.weight(1), std::llround((2 + 4 + 10) * units)) << "inner bonus is weight";
    ASSERT_EQ(problem.bonus_count(), 1u);
    EXPECT_EQ(problem.bonuses()[0].value, std::llround(12 * units));
    ASSERT_EQ(bridge.inner_conflicts().size(), 1u);
    EXPECT_EQ(bridge.inner_conflicts()[0].label, 2);
    EXPECT_EQ(bridge.inner_conflicts()[0].first, 2);
    EXPECT_EQ(bridge.inner_conflicts()[0].second, 4);
    EXPECT_TRUE(has_rule(problem, {Relation::Equal, 0, {{1, 2}}}));
    EXPECT_TRUE(has_rule(problem, {Relation::GreaterEqual, 0, {{-1, 0}, {2, 1}, {2, 2}}}))
        << "coefficients add up in (8)";
}

TEST(LabelingBridge, ScalesTheSumOfPositiveTermsIntoItsDecade) {
    for (const double factor : {1e-9, 1.0, 3.7, 1e7}) {
        ShortBar bar;
        for (double& w : bar.input.weights) w *= factor;
        bar.input.bonuses = {{1, 2, 3 * factor}};
        const auto problem = LabelingBridge(bar.input).build();
        labeling::Value sum = 0;
        for (labeling::Value w : problem.weights()) sum += w;
        for (const auto& bonus : problem.bonuses()) sum += bonus.value;
        EXPECT_GE(sum, 999'999'990);
        EXPECT_LT(sum, 10'000'000'010);
        const double power = std::log10(problem.units_per_one());
        EXPECT_NEAR(power, std::round(power), 1e-9);
    }
    ShortBar bar;
    bar.input.weights.assign(6, 0.0);
    const auto problem = LabelingBridge(bar.input).build();
    EXPECT_EQ(problem.units_per_one(), 1);
    EXPECT_EQ(problem.weight(0), 1) << "every segment weighs at least one unit";
}

TEST(LabelingBridge, PinsAndShortSegmentsBetweenThem) {
    // Node 0 and 1 each hold three pinned segments; the short segment 0 between them can go
    // nowhere.
    const SegmentGraph graph =
        graph_of({{0, 0, 0},
                  {0.5, 0, 0},
                  {-1, 1, 0},
                  {-1, -1, 0},
                  {-1, 0, 0},
                  {2, 1, 0},
                  {2, -1, 0},
                  {2, 0, 0}},
                 {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 5}, {1, 6}, {1, 7}}, {0}, {1, 2, 3, 4, 5, 6});
    ConflictResult conflicts;
    BridgeInput input;
    input.graph = &graph;
    input.conflicts = &conflicts;
    input.weights.assign(7, 1.0);
    const auto problem = LabelingBridge(input).build();
    EXPECT_TRUE(has_rule(problem, {Relation::Equal, 0, {{1, 0}}}));
    for (int s = 1; s < 7; ++s) EXPECT_TRUE(has_rule(problem, {Relation::Equal, 1, {{1, s}}}));
}

TEST(LabelingBridge, SplitsCurvesSoThatNoConflictStaysInside) {
    const std::vector<std::vector<int>> order{{0, 1, 2, 3, 4, 5, 6, 7}, {8, 9}};
    const std::vector<Conflict> conflicts{conflict_of(1, 6), conflict_of(2, 5), conflict_of(8, 9),
                                          conflict_of(0, 8)};
    const std::vector<int> groups = split_groups(order, 11, conflicts, false);
    for (const Conflict& c : conflicts) EXPECT_NE(groups[c.first], groups[c.second]);
    EXPECT_EQ(groups[0], groups[1]);
    EXPECT_EQ(std::ranges::max(groups) + 1, 5) << "two halves, two ends, one segment of its own";
    const std::vector<int> dissolved = split_groups(order, 11, conflicts, true);
    EXPECT_EQ(std::ranges::max(dissolved) + 1, 11);
}

}  // namespace
}  // namespace fcn::test
