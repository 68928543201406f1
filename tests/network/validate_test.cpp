#include <gtest/gtest.h>

#include <limits>

#include "network/network.h"
#include "network/sample_networks.h"

namespace fcn {
namespace {

using namespace fcn::testing;

std::string joined(const std::vector<std::string>& lines) {
    std::string all;
    for (const std::string& line : lines) all += line + "\n";
    return all;
}

void expect_problem(const FeatureCurveNetwork& network, const std::string& words) {
    const std::string problems = joined(validate(network));
    EXPECT_NE(problems.find(words), std::string::npos) << "problems:\n" << problems;
}

TEST(Validate, SamplesAreValid) {
    for (const FeatureCurveNetwork& network :
         {y_junction(), t_junction(), cube(), circle(), figure_eight(), two_loops(), lasso(),
          adapted_cube(), FeatureCurveNetwork{}})
        EXPECT_EQ(joined(validate(network)), "");
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        FeatureCurveNetwork network = random_network(seed, 8, 25);
        EXPECT_EQ(joined(validate(network)), "");
        find_curves(network);
        EXPECT_EQ(joined(validate(network)), "");
    }
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Breaker = void (*)(FeatureCurveNetwork&);
struct BrokenInvariant {
    const char* name;
    const char* words;
    Breaker break_it;
};

class BrokenInvariants : public ::testing::TestWithParam<BrokenInvariant> {};

TEST_P(BrokenInvariants, AreDetected) {
    FeatureCurveNetwork network = adapted_cube();
    ASSERT_EQ(joined(validate(network)), "");
    GetParam().break_it(network);
    expect_problem(network, GetParam().words);
}

using N = FeatureCurveNetwork&;
INSTANTIATE_TEST_SUITE_P(
    Network, BrokenInvariants,
    ::testing::Values(
        BrokenInvariant{"Diagonal", "/diagonal", [](N n) { n.diagonal = kNan; }},
        BrokenInvariant{"Scale", "/scale", [](N n) { n.scale = -1; }},
        BrokenInvariant{"Ratio", "/ratio", [](N n) { n.ratio = kNan; }},
        BrokenInvariant{"NodePosition", "/nodes/3: position",
                        [](N n) { n.nodes[3].position[1] = kNan; }},
        BrokenInvariant{"NodeFace", "/nodes/3: face", [](N n) { n.nodes[3].surface.face = -2; }},
        BrokenInvariant{"NodeBarycentric", "/nodes/9: barycentric",
                        [](N n) { n.nodes[9].surface.barycentric = {1, 0.5, -0.5}; }},
        BrokenInvariant{"UnusedNode", "/nodes/20: no arc or segment",
                        [](N n) { n.nodes.push_back({}); }},
        BrokenInvariant{"ArcNode", "/arcs/2/nodes/1: node 99",
                        [](N n) { n.arcs[2].nodes[1] = 99; }},
        BrokenInvariant{"ArcEndElsewhere", "/arcs/2/nodes/1: arc ends",
                        [](N n) { n.arcs[2].samples.back().position[0] += 1e-6; }},
        BrokenInvariant{"TooFewSamples", "/arcs/2/samples: 1",
                        [](N n) { n.arcs[2].samples.resize(1); }},
        BrokenInvariant{"SampleNotFinite", "/arcs/2/samples/2: position",
                        [](N n) {
                            n.arcs[2].samples[2].position[2] =
                                std::numeric_limits<double>::infinity();
                        }},
        BrokenInvariant{"SampleBarycentric", "/arcs/2/samples/1: barycentric",
                        [](N n) { n.arcs[2].samples[1].surface.barycentric[0] = kNan; }},
        BrokenInvariant{"SamplesEqual", "/arcs/2/samples/3: equals",
                        [](N n) { n.arcs[2].samples[3].position = n.arcs[2].samples[2].position; }},
        BrokenInvariant{"OriginCount", "/arcs/2/origins: 3",
                        [](N n) { n.arcs[2].origins.pop_back(); }},
        BrokenInvariant{"OriginNegative", "/arcs/2/origins/1",
                        [](N n) { n.arcs[2].origins[1] = -1; }},
        BrokenInvariant{"Patch", "/arcs/2/patches/0", [](N n) { n.arcs[2].patches[0] = -5; }},
        BrokenInvariant{"Dihedral", "/arcs/2/dihedral", [](N n) { n.arcs[2].dihedral = kNan; }},
        BrokenInvariant{"SegmentNode", "/segments/4/nodes/0: node -1",
                        [](N n) { n.segments[4].nodes[0] = -1; }},
        BrokenInvariant{"SegmentArc", "/segments/4/arc: arc 12",
                        [](N n) { n.segments[4].arc = 12; }},
        BrokenInvariant{"SegmentRange", "/segments/4: samples 2 to 2",
                        [](N n) { n.segments[4].first_sample = 2; }},
        BrokenInvariant{"SegmentRangeEnd", "/segments/5: samples 2 to 5",
                        [](N n) { n.segments[5].last_sample = 5; }},
        BrokenInvariant{"SegmentWeight", "/segments/4/weight",
                        [](N n) { n.segments[4].weight = kNan; }},
        BrokenInvariant{"SegmentGap", "/segments/5/first_sample: 3",
                        [](N n) { n.segments[5].first_sample = 3; }},
        BrokenInvariant{"SegmentOrder", "/segments/4/first_sample: 2",
                        [](N n) { std::swap(n.segments[4], n.segments[5]); }},
        BrokenInvariant{"SegmentMeeting", "/segments/5/nodes/0",
                        [](N n) { n.segments[5].nodes[0] = n.segments[4].nodes[0]; }},
        BrokenInvariant{"SegmentNodeElsewhere", "is not at sample 2",
                        [](N n) { n.nodes[n.segments[4].nodes[1]].position[0] += 0.01; }},
        BrokenInvariant{"SegmentsEndEarly", "/arcs/2: its segments end at sample 2",
                        [](N n) { n.segments.erase(n.segments.begin() + 5); }},
        BrokenInvariant{"NoSegments", "/arcs/2: has no segments",
                        [](N n) {
                            n.segments.erase(n.segments.begin() + 4, n.segments.begin() + 6);
                        }},
        BrokenInvariant{"TwoLong", "/arcs/2: has 2 long",
                        [](N n) { n.segments[4].is_long = n.segments[5].is_long = true; }},
        BrokenInvariant{"CurveEmpty", "/arcs: empty", [](N n) { n.curves.push_back({}); }},
        BrokenInvariant{"CurveFlags", "/curves/0/is_reversed",
                        [](N n) { n.curves[0].is_reversed.push_back(true); }},
        BrokenInvariant{"CurveArc", "/curves/0/arcs/0: arc 77",
                        [](N n) { n.curves[0].arcs[0] = 77; }},
        BrokenInvariant{"CurveTwice", "is already in curve 0",
                        [](N n) { n.curves.push_back(n.curves[0]); }},
        BrokenInvariant{"CurveChain", "does not start where",
                        [](N n) { n.curves[0].is_reversed[0] = !n.curves[0].is_reversed[0]; }},
        BrokenInvariant{"CurveOpen", "/curves/0/is_closed",
                        [](N n) {
                            ASSERT_TRUE(n.curves[0].is_closed);
                            n.arcs[n.curves[0].arcs.back()].curve = -1;
                            n.curves[0].arcs.pop_back();
                            n.curves[0].is_reversed.pop_back();
                        }},
        BrokenInvariant{"CurveLength", "/curves/0/length",
                        [](N n) { n.curves[0].length = kNan; }},
        BrokenInvariant{"ArcCurve", "/arcs/2/curve: 55", [](N n) { n.arcs[2].curve = 55; }},
        BrokenInvariant{"OrbitEmpty", "/orbits/1/members: empty",
                        [](N n) { n.orbits.push_back({}); }},
        BrokenInvariant{"OrbitArc", "/orbits/0/members/1/arc: arc 50",
                        [](N n) { n.orbits[0].members[1].arc = 50; }},
        BrokenInvariant{"OrbitTwice", "/orbits/0/members/1/arc: arc 0 is already",
                        [](N n) { n.orbits[0].members[1].arc = 0; }},
        BrokenInvariant{"OrbitTransform", "/orbits/0/members/1: transform",
                        [](N n) { n.orbits[0].members[1].translation[0] = kNan; }},
        BrokenInvariant{"OrbitRepresentative", "/orbits/0/members/0: the representative",
                        [](N n) { n.orbits[0].members[0].is_reversed = true; }},
        BrokenInvariant{"DroppedShort", "/dropped/1/polyline: 1",
                        [](N n) { n.dropped[1].polyline.pop_back(); }},
        BrokenInvariant{"DroppedFinite", "/dropped/0/polyline/2",
                        [](N n) { n.dropped[0].polyline[2][0] = kNan; }},
        BrokenInvariant{"DroppedWeight", "/dropped/0/weight",
                        [](N n) { n.dropped[0].weight = kNan; }},
        BrokenInvariant{"DroppedMargin", "/dropped/0/margin",
                        [](N n) { n.dropped[0].margin = kNan; }},
        BrokenInvariant{"BlockerWeight", "/dropped/0/blockers/0",
                        [](N n) { n.dropped[0].blockers[0].weight = kNan; }},
        BrokenInvariant{"DroppedOrigin", "/dropped/0/origin_arc",
                        [](N n) { n.dropped[0].origin_arc = -2; }},
        BrokenInvariant{"DroppedIteration", "/dropped/0/iteration",
                        [](N n) { n.dropped[0].iteration = -1; }},
        BrokenInvariant{"DroppedLabel", "/dropped/0/label",
                        [](N n) { n.dropped[0].label = -2; }}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(Validate, ClosedArcs) {
    FeatureCurveNetwork network = circle(3);
    EXPECT_EQ(joined(validate(network)), "");
    network.arcs[0].samples.erase(network.arcs[0].samples.begin() + 1);
    expect_problem(network, "/arcs/0/samples: 3 samples, a closed arc needs 4");
    network = circle(12);
    network.arcs[0].samples.back().position[0] += 0.25;
    expect_problem(network, "/arcs/0/samples: closed arc whose last");
}

TEST(Validate, SurfacePointsOnTheMesh) {
    Mesh mesh;
    const VertexHandle first = mesh.add_vertex(Vec3(0, 0, 0));
    const VertexHandle second = mesh.add_vertex(Vec3(4, 0, 0));
    const VertexHandle third = mesh.add_vertex(Vec3(0, 4, 0));
    mesh.add_face(first, second, third);
    // The point x = y = t of the triangle, whichever corner the face starts with.
    const auto at = [&](double t) {
        const auto corners = face_vertices(mesh, FaceHandle(0));
        SurfacePoint point{0, Vec3::Zero()};
        for (int k = 0; k < 3; ++k) point.barycentric[k] = corners[k] == first ? 1 - t / 2 : t / 4;
        return point;
    };
    FeatureCurveNetwork network = NetworkBuilder().arc({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}).build();
    EXPECT_EQ(joined(validate(network, mesh)), "");  // places on the surface unknown
    network.arcs[0].samples[1].surface = at(1);
    network.nodes[1].surface = at(2);
    EXPECT_EQ(joined(validate(network, mesh)), "");
    network.nodes[1].surface = at(1.75);
    EXPECT_NE(joined(validate(network, mesh)).find("/nodes/1: position lies"), std::string::npos);
    EXPECT_EQ(joined(validate(network)), "");
    network.nodes[1].surface.face = 1;
    EXPECT_NE(joined(validate(network, mesh)).find("/nodes/1: face 1 does not exist"),
              std::string::npos);
}

}  // namespace
}  // namespace fcn
