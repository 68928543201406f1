#include "meshing/quad_curves.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "meshing/quad_tips.h"
#include "sample_meshes.h"
#include "sample_quads.h"

namespace fcn {
namespace {

FeatureCurveNetwork network_of(const std::vector<Vec3>& polyline) {
    FeatureCurveNetwork network;
    network.nodes = {{polyline.front(), {}}, {polyline.back(), {}}};
    NetworkArc arc;
    arc.nodes = {0, 1};
    for (const Vec3& p : polyline) arc.samples.push_back({p, {}});
    network.arcs.push_back(arc);
    return network;
}

TEST(QuadCurves, MoveTheLineBesideACurveOntoIt) {
    QuadMesh quads = test::quad_grid(10, 6);
    const Mesh surface = test::rectangle(10, 6, 10, 6);
    QuadCurveOptions options;
    options.edge_length = 1;
    const QuadConstraints constraints =
        move_to_curves(quads, surface, network_of({{2, 2.6, 0}, {8, 3.4, 0}}), options);
    EXPECT_EQ(quads.feature_edges.size(), 6u);
    for (const QuadFeatureEdge& edge : quads.feature_edges) {
        EXPECT_EQ(edge.arc, 0);
        for (const int v : {edge.from, edge.to}) {
            const Vec3& p = quads.points[static_cast<std::size_t>(v)];
            EXPECT_NEAR(p[1], 2.6 + 0.8 * (p[0] - 2) / 6, 1e-9);
            EXPECT_GE(constraints.curve[static_cast<std::size_t>(v)], 0);
        }
    }
    EXPECT_EQ(count_inverted_corners(quads), 0);
    EXPECT_EQ(check_topology(quads).fault, "");
}

TEST(QuadCurves, LeaveQuadsAloneUnderACurveAcrossThem) {
    QuadMesh quads = test::quad_grid(10, 10);
    const Mesh surface = test::rectangle(10, 10, 10, 10);
    QuadCurveOptions options;
    options.edge_length = 1;
    const FeatureCurveNetwork diagonal = network_of({{2, 2, 0}, {8, 8, 0}});
    move_to_curves(quads, surface, diagonal, options);
    EXPECT_TRUE(quads.feature_edges.empty());
    EXPECT_EQ(quads.points, test::quad_grid(10, 10).points);
    // An arc that is left out moves nothing either.
    options.is_left_out = {true};
    move_to_curves(quads, surface, network_of({{2, 3.3, 0}, {8, 3.3, 0}}), options);
    EXPECT_TRUE(quads.feature_edges.empty());
}

TEST(QuadCurves, CornersOfBoundariesGetAVertex) {
    QuadMesh quads = test::quad_grid(6, 4);
    for (Vec3& p : quads.points) p = {0.2 + p[0] * 0.95, 0.1 + p[1] * 0.9, 0};
    const Mesh surface = test::rectangle(6, 4, 6, 4);
    QuadCurveOptions options;
    options.edge_length = 1;
    const QuadConstraints constraints = move_to_curves(quads, surface, {}, options);
    const ReferenceSurface reference(surface);
    QuadSmoothingOptions smoothing;
    smoothing.edge_length = 1;
    smooth_quads(quads, constraints, reference, smoothing);
    EXPECT_EQ(count_inverted_corners(quads), 0);
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(6, 0, 0), Vec3(6, 4, 0), Vec3(0, 4, 0)}) {
        EXPECT_EQ(std::count(quads.points.begin(), quads.points.end(), corner), 1);
    }
}

TEST(QuadTips, ReachWhatIsFarFromTheQuads) {
    // A plane with one high vertex; the quads are flat.
    Mesh surface = test::rectangle(8, 8, 16, 16);
    const Vec3 tip(4, 4, 1.5);
    for (const VertexHandle v : surface.vertices())
        if ((surface.point(v) - Vec3(4, 4, 0)).norm() < 0.1) surface.set_point(v, tip);
    QuadMesh quads = test::quad_grid(8, 8);
    QuadConstraints constraints;
    constraints.curve.assign(quads.points.size(), QuadConstraints::kFree);
    const ReferenceSurface reference(surface);
    QuadTipOptions options;
    options.smoothing.edge_length = 1;
    options.smoothing.leash = 0.5;
    EXPECT_GE(reach_tips(quads, constraints, surface, reference, options), 1);
    EXPECT_EQ(std::count(quads.points.begin(), quads.points.end(), tip), 1);
    EXPECT_EQ(count_inverted_corners(quads), 0);
}

}  // namespace
}  // namespace fcn
