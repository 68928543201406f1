#include <gtest/gtest.h>

#include <algorithm>

#include "network/network.h"
#include "network/sample_networks.h"

namespace fcn {
namespace {

using namespace fcn::testing;

TEST(MergeRegularNodes, StraightChainBecomesOneArc) {
    FeatureCurveNetwork network = NetworkBuilder()
                                      .arc({{2, 0, 0}, {1, 0, 0}})
                                      .arc({{2, 0, 0}, {4, 0, 0}})
                                      .arc({{4, 0, 0}, {5, 0, 0}, {5, 1, 0}})
                                      .build();
    network.arcs[0].dihedral = 1;
    network.arcs[1].dihedral = 0.5;
    network.arcs[2].dihedral = -0.5;
    const FeatureCurveNetwork merged = merge_regular_nodes(network);
    ASSERT_TRUE(validate(merged).empty()) << validate(merged).front();
    ASSERT_EQ(merged.arcs.size(), 1u);
    EXPECT_EQ(merged.nodes.size(), 2u);
    EXPECT_EQ(merged.arcs[0].samples.size(), 5u);
    // In the direction of the arc of lowest index.
    EXPECT_EQ(merged.arcs[0].samples.front().position, Vec3(5, 1, 0));
    EXPECT_NEAR(merged.arcs[0].dihedral, (1 * 1 + 2 * 0.5 - 2 * 0.5) / 5, 1e-15);
    EXPECT_TRUE(merged.arcs[0].origins.empty());
}

TEST(MergeRegularNodes, PatchesAreComparedAlongTheWay) {
    const auto merged_count = [](std::array<int, 2> second) {
        return merge_regular_nodes(NetworkBuilder()
                                       .arc({{0, 0, 0}, {1, 0, 0}}, {3, 4})
                                       .arc({{2, 0, 0}, {1, 0, 0}}, second)
                                       .build())
            .arcs.size();
    };
    EXPECT_EQ(merged_count({4, 3}), 1u);  // the second arc runs against the first
    EXPECT_EQ(merged_count({3, 4}), 2u);
    EXPECT_EQ(merged_count({5, 3}), 2u);
    EXPECT_EQ(merged_count({-1, -1}), 2u);
}

TEST(MergeRegularNodes, DifferencesKeepNodes) {
    const FeatureCurveNetwork chain =
        NetworkBuilder().arc({{0, 0, 0}, {1, 0, 0}}).arc({{1, 0, 0}, {2, 0, 0}}).build();
    ASSERT_EQ(merge_regular_nodes(chain).arcs.size(), 1u);
    FeatureCurveNetwork other = chain;
    other.arcs[1].kind = ArcKind::Boundary;
    EXPECT_EQ(merge_regular_nodes(other).arcs.size(), 2u);
    other = chain;
    other.arcs[1].pin = Pin::Keep;
    EXPECT_EQ(merge_regular_nodes(other).arcs.size(), 2u);
    other = chain;
    other.arcs[1].source = "sharp";
    EXPECT_EQ(merge_regular_nodes(other).arcs.size(), 2u);
    other = chain;
    OrbitMember member;
    member.arc = 1;
    other.orbits.push_back({{member}});
    EXPECT_EQ(merge_regular_nodes(other).arcs.size(), 2u);
}

TEST(MergeRegularNodes, RingBecomesAClosedArc) {
    const FeatureCurveNetwork ring = NetworkBuilder()
                                         .arc({{0, 0, 0}, {1, 0, 0}})
                                         .arc({{1, 1, 0}, {1, 0, 0}})
                                         .arc({{1, 1, 0}, {0, 0, 0}})
                                         .build();
    const FeatureCurveNetwork merged = merge_regular_nodes(ring);
    ASSERT_TRUE(validate(merged).empty()) << validate(merged).front();
    ASSERT_EQ(merged.arcs.size(), 1u);
    EXPECT_TRUE(merged.arcs[0].is_closed());
    EXPECT_EQ(merged.nodes[0].position, Vec3(0, 0, 0));
    EXPECT_EQ(intervals(merged), intervals(ring));
}

TEST(MergeRegularNodes, TwoStraightArcsBetweenTheSameNodesStay) {
    const FeatureCurveNetwork pair =
        NetworkBuilder().arc({{0, 0, 0}, {1, 0, 0}}).arc({{1, 0, 0}, {0, 0, 0}}).build();
    const FeatureCurveNetwork merged = merge_regular_nodes(pair);
    EXPECT_TRUE(validate(merged).empty());
    EXPECT_EQ(merged.arcs.size(), 2u);
}

TEST(MergeRegularNodes, TwoStraightArcsBackToAJunctionStay) {
    const FeatureCurveNetwork network = NetworkBuilder()
                                            .arc({{0, 0, 0}, {1, 0, 0}})
                                            .arc({{1, 0, 0}, {0, 0, 0}})
                                            .arc({{0, 0, 0}, {0, 1, 0}})
                                            .build();
    const FeatureCurveNetwork merged = merge_regular_nodes(network);
    EXPECT_TRUE(validate(merged).empty());
    EXPECT_EQ(merged.arcs.size(), 3u);
}

TEST(MergeRegularNodes, OneLongSegmentAnArc) {
    FeatureCurveNetwork network = NetworkBuilder()
                                      .arc({{0, 0, 0}, {1, 0, 0}})
                                      .arc({{1, 0, 0}, {2, 0, 0}})
                                      .arc({{2, 0, 0}, {3, 0, 0}})
                                      .build();
    for (int a = 0; a < 3; ++a) network.segments.push_back({{a, a + 1}, a, 0, 1, 1.0, a != 1});
    ASSERT_TRUE(validate(network).empty());
    const FeatureCurveNetwork merged = merge_regular_nodes(network);
    EXPECT_TRUE(validate(merged).empty());
    ASSERT_EQ(merged.arcs.size(), 2u);
    EXPECT_EQ(merged.arcs[0].samples.size(), 3u);
}

TEST(MergeRegularNodes, JunctionsAndClosedArcsStay) {
    for (const FeatureCurveNetwork& network :
         {y_junction(), t_junction(), cube(), circle(), figure_eight(), two_loops(), lasso()}) {
        const FeatureCurveNetwork merged = merge_regular_nodes(network);
        EXPECT_TRUE(validate(merged).empty());
        EXPECT_EQ(merged.arcs.size(), network.arcs.size());
        EXPECT_EQ(merged.nodes.size(), network.nodes.size());
    }
}

TEST(MergeRegularNodes, OriginsSegmentsAndCurvesTravel) {
    // Drop one edge of the adapted cube's top: its two corners become regular.
    FeatureCurveNetwork network = adapted_cube();
    network.orbits.clear();
    for (NetworkArc& arc : network.arcs) {
        arc.kind = ArcKind::Feature;
        arc.pin = Pin::None;
        arc.source = "sharp";
        arc.patches = {-1, -1};
    }
    for (NetworkSegment& segment : network.segments) segment.is_long = false;
    const int gone = 11;
    network.nodes.erase(network.nodes.begin() + network.segments[2 * gone].nodes[1]);
    network.segments.erase(network.segments.begin() + 2 * gone, network.segments.end());
    network.arcs.erase(network.arcs.begin() + gone);
    find_curves(network);
    ASSERT_TRUE(validate(network).empty()) << validate(network).front();
    const FeatureCurveNetwork merged = merge_regular_nodes(network);
    ASSERT_TRUE(validate(merged).empty()) << validate(merged).front();
    EXPECT_EQ(merged.arcs.size(), 9u);
    EXPECT_EQ(merged.nodes.size(), network.nodes.size());  // segments still use every node
    EXPECT_EQ(merged.segments.size(), network.segments.size());
    EXPECT_EQ(intervals(merged), intervals(network));
    for (const NetworkArc& arc : merged.arcs) EXPECT_EQ(arc.origins.size() + 1, arc.samples.size());
    double before = 0, after = 0;
    for (const NetworkSegment& segment : network.segments) before += segment.weight;
    for (const NetworkSegment& segment : merged.segments) after += segment.weight;
    EXPECT_NEAR(before, after, 1e-12);
}

TEST(MergeRegularNodes, RandomNetworksKeepTheirGeometry) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const int nodes = 12 + static_cast<int>(seed % 10);
        FeatureCurveNetwork network = random_network(seed, nodes, nodes);
        for (NetworkArc& arc : network.arcs)
            if (seed % 2 == 0) arc.kind = ArcKind::Feature, arc.pin = Pin::None, arc.source = "vsa";
        find_curves(network);
        const FeatureCurveNetwork merged = merge_regular_nodes(network);
        ASSERT_TRUE(validate(merged).empty()) << validate(merged).front();
        EXPECT_EQ(intervals(merged), intervals(network));
        EXPECT_NEAR(merged.total_length(), network.total_length(), 1e-9);
        EXPECT_LE(merged.arcs.size(), network.arcs.size());
        // Nothing is left to merge, and what is merged is the same again.
        const FeatureCurveNetwork again = merge_regular_nodes(merged);
        EXPECT_EQ(again.arcs.size(), merged.arcs.size());
        // Extraordinary nodes are untouched.
        const auto count_extraordinary = [](const FeatureCurveNetwork& n) {
            const std::vector<int> valences = n.valences();
            return std::count_if(valences.begin(), valences.end(), [](int v) { return v != 2; });
        };
        EXPECT_EQ(count_extraordinary(merged), count_extraordinary(network));
    }
}

}  // namespace
}  // namespace fcn
