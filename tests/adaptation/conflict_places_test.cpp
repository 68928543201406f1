#include "adaptation/conflict_places.h"

#include <gtest/gtest.h>

#include <set>

namespace fcn {
namespace {

/// `count` parallel segments, a unit long, segment s at height s.
SegmentGraph ladder(int count) {
    SegmentGraph graph;
    for (int s = 0; s < count; ++s) {
        for (const double x : {0.0, 1.0}) {
            GraphNode node;
            node.position = Vec3(x, s, 0);
            graph.nodes.push_back(node);
        }
        GraphSegment segment;
        segment.nodes = {2 * s, 2 * s + 1};
        graph.segments.push_back(segment);
    }
    return graph;
}

std::vector<Conflict> neighbours_in_conflict(int count) {
    std::vector<Conflict> conflicts;
    for (int s = 0; s + 1 < count; ++s) {
        Conflict conflict;
        conflict.kind = s % 2 == 0 ? ConflictKind::Distance : ConflictKind::Angle;
        conflict.first = s;
        conflict.second = s + 1;
        conflict.distance = 1;
        conflict.angle = 0.25;
        conflicts.push_back(conflict);
    }
    return conflicts;
}

TEST(ConflictPlaces, SayWhereWhatAndWhichSideWasKept) {
    const auto conflicts = neighbours_in_conflict(3);
    const auto places = conflict_places(
        conflicts, ladder(3), {5, 7, 9}, {false, true, false},
        [](int segment) { return 10 * segment; }, 100);
    ASSERT_EQ(places.size(), 2U);
    EXPECT_EQ(places[0].kind, "distance");
    EXPECT_EQ(places[0].measured, 1);
    EXPECT_EQ(places[0].first, Vec3(0.5, 0, 0));
    EXPECT_EQ(places[0].second, Vec3(0.5, 1, 0));
    EXPECT_EQ(places[1].kind, "angle");
    EXPECT_EQ(places[1].measured, 0.25);
    EXPECT_EQ(places[1].origin_arcs, (std::array<int, 2>{10, 20}));
    EXPECT_EQ(places[1].weights, (std::array<double, 2>{7, 9}));
    EXPECT_EQ(places[1].is_kept, (std::array<bool, 2>{true, false}));
}

TEST(ConflictPlaces, AreAnEvenSelectionWhereThereAreTooMany) {
    const int count = 1001;
    const auto conflicts = neighbours_in_conflict(count);
    const SegmentGraph graph = ladder(count);
    for (const std::size_t most : {1U, 7U, 100U, 999U, 1000U, 5000U}) {
        const auto places = conflict_places(
            conflicts, graph, std::vector<double>(count, 1), std::vector<bool>(count, true),
            [](int segment) { return segment; }, most);
        EXPECT_LE(places.size(), most);
        EXPECT_GE(2 * places.size(), std::min(most, conflicts.size()));
        std::set<int> gaps;
        for (std::size_t i = 1; i < places.size(); ++i)
            gaps.insert(places[i].origin_arcs[0] - places[i - 1].origin_arcs[0]);
        EXPECT_LE(gaps.size(), 1U);
    }
}

}  // namespace
}  // namespace fcn
