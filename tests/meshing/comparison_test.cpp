#include "meshing/comparison.h"

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "meshing/baselines.h"
#include "remesh_checks.h"
#include "sample_meshes.h"
#include "sample_networks.h"

namespace fcn {
namespace {

TEST(Comparison, EveryWayMakesAMesh) {
    const LoadedMesh mesh = test::cylinder(0.5, 64, 16);
    const FeatureCurveNetwork initial = test::crease_network(mesh.mesh, 0.7);
    const double rmin = 0.12;
    const FeatureCurveNetwork adapted = test::cut_evenly(initial, rmin);
    const ComparisonInput input{mesh, initial, adapted, rmin, 1.5, 5, 0.02};
    std::size_t vertices = 0;
    for (const std::string& name : remesher_names()) {
        SCOPED_TRACE(name);
        const ComparisonRow row = run_remesher(name, input, vertices);
        ASSERT_EQ(row.failure, "");
        if (name == "own") vertices = row.quality.vertices;
        EXPECT_EQ(test::euler(row.mesh.mesh), 2);
        EXPECT_EQ(test::boundary_edges(row.mesh.mesh), 0U);
        EXPECT_GT(row.quality.min_angle_degrees, 0);
        EXPECT_LT(row.distance.hausdorff, name == "filtered" ? 0.3 : 0.1);
        if (name == "own" || name == "cgal") {
            EXPECT_EQ(row.broken_segments, 0U);
            EXPECT_LT(row.features.max_node, 1e-9);
            // Chords of a circle: sagitta L^2 / (8 r).
            EXPECT_LT(row.features.max, 1.1 * 0.15 * 0.15 / (8 * 0.5));
        }
        if (name == "quadrics") {
            EXPECT_NEAR(static_cast<double>(row.quality.vertices), static_cast<double>(vertices),
                        2);
        }
    }
    EXPECT_THROW(run_remesher("nobody", input, 10), InputError);
    EXPECT_THROW(run_remesher("curvature-much", input, 10), InputError);
}

TEST(Baselines, CurvatureThresholdKeepsWhatTurnsMore) {
    FeatureCurveNetwork network;
    for (const double dihedral : {0.2, -0.6, 0.9, -1.5}) {
        NetworkArc arc;
        arc.dihedral = dihedral;
        network.arcs.push_back(arc);
    }
    network.arcs[0].pin = Pin::Keep;
    EXPECT_EQ(above_curvature(network, 0).arcs.size(), 4U);
    EXPECT_EQ(above_curvature(network, 0.7).arcs.size(), 3U);
    EXPECT_EQ(above_curvature(network, 2).arcs.size(), 1U);
}

TEST(Baselines, FilterRemovesRipplesAndKeepsPlanesAndBorders) {
    LoadedMesh plane;
    plane.mesh = test::rectangle(1, 1, 30, 30);
    const LoadedMesh same = filter_detail(plane, 0.2);
    for (const VertexHandle v : plane.mesh.vertices()) EXPECT_NEAR(same.mesh.point(v)[2], 0, 1e-12);
    LoadedMesh ripples = plane;
    for (const VertexHandle v : ripples.mesh.vertices()) {
        Vec3 p = ripples.mesh.point(v);
        p[2] = 0.01 * std::sin(40 * p[0]);
        ripples.mesh.set_point(v, p);
    }
    const LoadedMesh filtered = filter_detail(ripples, 0.2);
    double before = 0, after = 0;
    for (const VertexHandle v : plane.mesh.vertices()) {
        if (plane.mesh.is_boundary(v)) {
            EXPECT_LT((filtered.mesh.point(v) - ripples.mesh.point(v)).norm(), 1e-6);
            continue;
        }
        const Vec3& p = plane.mesh.point(v);
        if ((p - Vec3(0.5, 0.5, 0)).cwiseAbs().maxCoeff() > 0.3) continue;
        before = std::max(before, std::abs(ripples.mesh.point(v)[2]));
        after = std::max(after, std::abs(filtered.mesh.point(v)[2]));
    }
    // One implicit step damps a wave of number k by 1 / (1 + t k^2) = 1 / 17, far from borders.
    EXPECT_LT(after, 0.2 * before);
}

}  // namespace
}  // namespace fcn
