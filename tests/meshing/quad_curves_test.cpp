#include "meshing/quad_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshing/quad_faults.h"
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

/// A flat grid of 8 x 8 unit quads whose inner vertices are pushed along x, 0.9 in the middle.
QuadMesh pushed_grid() {
    QuadMesh quads = test::quad_grid(8, 8);
    for (Vec3& p : quads.points)
        p[0] += 0.9 * std::sin(std::numbers::pi * p[0] / 8) * std::sin(std::numbers::pi * p[1] / 8);
    return quads;
}

TEST(QuadFitting, KeepsVerticesOnTheirLeashes) {
    const Mesh surface = test::rectangle(8, 8, 16, 16);
    const ReferenceSurface reference(surface);
    QuadMesh fitted = pushed_grid();
    QuadConstraints constraints;
    constraints.curve.assign(fitted.points.size(), QuadConstraints::kFree);
    for (std::size_t v = 0; v < fitted.points.size(); ++v)
        for (const int axis : {0, 1})
            if (std::min(fitted.points[v][axis], 8 - fitted.points[v][axis]) < 0.5)
                constraints.curve[v] = QuadConstraints::kFixed;
    QuadMesh smoothed = fitted;
    QuadFitOptions options;
    options.smoothing.edge_length = 1;
    options.smoothing.rounds = 30;
    EXPECT_EQ(fit_quads(fitted, constraints, sample_points(surface, 0.5), reference, options), 0);
    smooth_quads(smoothed, constraints, reference, options.smoothing);
    const std::vector<Vec3> homes = pushed_grid().points;
    const auto farthest = [&](const QuadMesh& mesh) {
        double distance = 0;
        for (std::size_t v = 0; v < homes.size(); ++v)
            distance = std::max(distance, (mesh.points[v] - homes[v]).norm());
        return distance;
    };
    EXPECT_GT(farthest(smoothed), 0.6);
    EXPECT_LE(farthest(fitted), 0.5 + 1e-9);
    EXPECT_GT(farthest(fitted), 0.3);
}

TEST(QuadFitting, FarPointsAreSeenFromBothSides) {
    // A bump of the surface that the flat quads miss, and a quad over a place without surface.
    Mesh surface = test::rectangle(8, 8, 16, 16);
    for (const VertexHandle v : surface.vertices())
        if ((surface.point(v) - Vec3(4, 4, 0)).norm() < 0.1) surface.set_point(v, {4, 4, 1.5});
    QuadMesh quads = test::quad_grid(8, 8);
    const ReferenceSurface reference(surface);
    auto far = far_points(quads, sample_points(surface, 0.5), reference, 0.4);
    ASSERT_FALSE(far.empty());
    EXPECT_NEAR(far.front().distance, 1.5, 1e-12);
    EXPECT_EQ(far.front().position, Vec3(4, 4, 1.5));
    for (Vec3& p : quads.points)
        if (p == Vec3(8, 8, 0)) p = {10, 10, 0};
    far = far_points(quads, sample_points(test::rectangle(8, 8, 4, 4), 0.5), reference, 0.4);
    ASSERT_FALSE(far.empty());
    for (const FarPoint& point : far) {
        const auto& face = quads.faces[static_cast<std::size_t>(point.quad)];
        EXPECT_TRUE(point.position.head<2>().minCoeff() > 6.9 ||
                    (point.position - Vec3(4, 4, 0)).norm() < 1.5)
            << point.position.transpose();
        EXPECT_EQ(face.size(), 4u);
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
    QuadFitOptions options;
    options.smoothing.edge_length = 1;
    const std::vector<Vec3> samples = sample_points(surface, 0.5);
    EXPECT_GE(reach_tips(quads, constraints, samples, reference, options), 1);
    EXPECT_EQ(std::count(quads.points.begin(), quads.points.end(), tip), 1);
    EXPECT_EQ(count_inverted_corners(quads), 0);
}

}  // namespace
}  // namespace fcn
