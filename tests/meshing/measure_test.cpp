#include "meshing/measure.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <limits>

#include "geometry/errors.h"
#include "sample_meshes.h"

namespace fcn {
namespace {

TEST(MeasureTriangles, EquilateralGridHasSixtyDegreesEverywhere) {
    const TriangleQuality quality = measure_triangles(test::equilateral_grid(0.5, 6, 4));
    EXPECT_EQ(quality.faces, 48U);
    EXPECT_EQ(quality.vertices, 35U);
    EXPECT_NEAR(quality.min_angle_degrees, 60, 1e-9);
    EXPECT_NEAR(quality.mean_min_angle_degrees, 60, 1e-9);
    EXPECT_EQ(quality.share_under_30, 0);
    EXPECT_NEAR(quality.min_edge, 0.5, 1e-12);
    EXPECT_NEAR(quality.mean_edge, 0.5, 1e-12);
    EXPECT_NEAR(quality.max_edge, 0.5, 1e-12);
}

TEST(MeasureTriangles, RightTrianglesOfKnownAngles) {
    for (const double degrees : {5.0, 14.9, 15.1, 29.9, 30.1, 45.0}) {
        const double ratio = std::tan(degrees / 57.29577951308232);
        const TriangleQuality quality = measure_triangles(test::rectangle(1, ratio, 1, 1));
        EXPECT_NEAR(quality.min_angle_degrees, degrees, 1e-9);
        EXPECT_EQ(quality.share_under_15, degrees < 15 ? 1 : 0);
        EXPECT_EQ(quality.share_under_30, degrees < 30 ? 1 : 0);
        EXPECT_NEAR(quality.min_edge, ratio, 1e-12);
        EXPECT_NEAR(quality.max_edge, std::hypot(1, ratio), 1e-12);
    }
}

TEST(MeasureTriangles, DegenerateFaceHasAngleZeroNotNan) {
    Mesh mesh;
    const auto a = mesh.add_vertex({0, 0, 0}), b = mesh.add_vertex({1, 0, 0});
    mesh.add_face(a, b, mesh.add_vertex({1, 0, 0}));
    EXPECT_EQ(measure_triangles(mesh).min_angle_degrees, 0);
    EXPECT_EQ(measure_triangles(mesh).min_edge, 0);
}

TEST(MeasureTriangles, EmptyMeshGivesZeros) {
    const TriangleQuality quality = measure_triangles(Mesh());
    EXPECT_EQ(quality.faces, 0U);
    EXPECT_EQ(quality.min_angle_degrees, 0);
    EXPECT_EQ(quality.mean_edge, 0);
}

TEST(MeasureDistance, OffsetPlanesAreTheirOffsetApart) {
    for (const double offset : {0.0, 0.25, 3.0}) {
        const Mesh plane = test::rectangle(1, 1, 3, 5),
                   lifted = test::rectangle(1, 1, 4, 2, offset);
        const MeshDistance distance = measure_distance(plane, lifted, 0.05);
        EXPECT_NEAR(distance.hausdorff, offset, 1e-12);
        EXPECT_NEAR(distance.forward, offset, 1e-12);
        EXPECT_NEAR(distance.backward, offset, 1e-12);
        EXPECT_NEAR(distance.mean_forward, offset, 1e-12);
        EXPECT_NEAR(distance.mean_backward, offset, 1e-12);
        EXPECT_NEAR(distance.diagonal, std::sqrt(2.0), 1e-12);
    }
}

TEST(MeasureDistance, SidesDifferWhereOneSurfaceIsPartOfTheOther) {
    // [0, 1]^2 inside [0, 3]^2: the far corner is 2 sqrt 2 away.
    const Mesh part = test::rectangle(1, 1, 2, 2), whole = test::rectangle(3, 3, 3, 3);
    const MeshDistance distance = measure_distance(part, whole, 0.02);
    EXPECT_NEAR(distance.forward, 0, 1e-12);
    EXPECT_NEAR(distance.backward, 2 * std::sqrt(2.0), 1e-12);
    EXPECT_EQ(distance.hausdorff, distance.backward);
}

TEST(MeasureDistance, MeanIsWeightedByArea) {
    // Distance to [0, 1] x [0, 1] over [0, 3] x [0, 1] is max(0, x - 1): mean 2/3. The strip's
    // faces are of very different sizes.
    Mesh strip = test::rectangle(3, 1, 30, 1);
    for (const VertexHandle vertex : strip.vertices()) {
        Vec3 p = strip.point(vertex);
        p[0] = 3 * std::pow(p[0] / 3, 3);
        strip.set_point(vertex, p);
    }
    const MeshDistance distance = measure_distance(strip, test::rectangle(1, 1, 1, 1), 0.02);
    EXPECT_NEAR(distance.mean_forward, 2.0 / 3, 1e-3);
    EXPECT_NEAR(distance.forward, 2, 1e-12);
}

TEST(MeasureDistance, ConcentricSpheres) {
    const double inner = 1, outer = 1.5;
    const Mesh small = test::sphere(inner, 5), large = test::sphere(outer, 5);
    const MeshDistance distance = measure_distance(small, large, 0.05);
    // A facet of a sphere lies below it by its sagitta, s^2 / 2R for circumradius s.
    const double sagitta = 0.002;
    EXPECT_NEAR(distance.forward, outer - inner, sagitta);
    EXPECT_NEAR(distance.backward, outer - inner, sagitta);
    EXPECT_NEAR(distance.mean_forward, outer - inner, sagitta);
}

TEST(MeasureDistance, FinerSpacingChangesTheResultByLessThanTheSpacing) {
    const Mesh rough = test::sphere(1, 1), fine = test::sphere(1, 4);
    const double exact = measure_distance(rough, fine, 0.01).hausdorff;
    for (const double spacing : {0.3, 0.1, 0.05})
        EXPECT_LT(std::abs(measure_distance(rough, fine, spacing).hausdorff - exact), spacing);
}

TEST(MeasureDistance, SameBitsOnAnyNumberOfThreads) {
    const Mesh rough = test::sphere(1, 3), fine = test::sphere(1.01, 4);
    const auto with = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return measure_distance(rough, fine, 0.02);
    };
    const MeshDistance one = with(1), many = with(4);
    EXPECT_EQ(one.hausdorff, many.hausdorff);
    EXPECT_EQ(one.mean_forward, many.mean_forward);
    EXPECT_EQ(one.mean_backward, many.mean_backward);
    EXPECT_EQ(one.samples, many.samples);
}

TEST(MeasureDistance, ImpossibleInputIsRefused) {
    const Mesh plane = test::rectangle(1, 1, 1, 1);
    EXPECT_THROW(measure_distance(plane, plane, 0), InputError);
    EXPECT_THROW(measure_distance(plane, plane, -1), InputError);
    EXPECT_THROW(measure_distance(plane, plane, std::numeric_limits<double>::quiet_NaN()),
                 InputError);
    EXPECT_THROW(measure_distance(plane, plane, 1e-9), InputError);
    EXPECT_THROW(measure_distance(Mesh(), plane, 0.1), InputError);
}

TEST(MeasureTriangles, RadiusRatiosAndValencesOfKnownMeshes) {
    const TriangleQuality grid = measure_triangles(test::equilateral_grid(0.5, 6, 4));
    EXPECT_NEAR(grid.min_radius_ratio, 1, 1e-12);
    EXPECT_NEAR(grid.mean_radius_ratio, 1, 1e-12);
    EXPECT_EQ(grid.share_regular, 1);
    EXPECT_EQ(grid.max_valence, 6);
    EXPECT_EQ(grid.min_valence, 2);
    // Right triangles with equal legs 1: r = 1 - 1 / sqrt 2, R = 1 / sqrt 2.
    EXPECT_NEAR(measure_triangles(test::rectangle(1, 1, 2, 2)).mean_radius_ratio,
                2 * (std::sqrt(2.0) - 1), 1e-12);
    // The octahedron's corners keep valence 4, all others get 6.
    const TriangleQuality sphere = measure_triangles(test::sphere(1, 2));
    EXPECT_NEAR(sphere.share_regular, 60.0 / 66, 1e-12);
    EXPECT_EQ(sphere.min_valence, 4);
}

TEST(MeasureEdges, SharesOfARightTriangleGrid) {
    // Legs 1/4 and 1/2, diagonals sqrt(5)/4 = 0.559.
    const EdgeShares shares = measure_edges(test::rectangle(1, 1, 4, 2), 0.3, 0.55);
    const double edges = 4 * 3 + 5 * 2 + 8;
    EXPECT_NEAR(shares.below, 12 / edges, 1e-12);
    EXPECT_NEAR(shares.inside, 10 / edges, 1e-12);
    EXPECT_NEAR(shares.above, 8 / edges, 1e-12);
    EXPECT_EQ(measure_edges(Mesh(), 1, 2).inside, 0);
}

TEST(MeasureNormals, TiltedPlaneDeviatesByItsAngle) {
    for (const double degrees : {0.0, 3.0, 20.0}) {
        Mesh tilted = test::rectangle(1, 1, 3, 3);
        const double slope = std::tan(degrees / 57.29577951308232);
        for (const VertexHandle v : tilted.vertices()) {
            Vec3 p = tilted.point(v);
            p[2] = slope * p[0];
            tilted.set_point(v, p);
        }
        const NormalDeviation deviation = measure_normals(tilted, test::rectangle(3, 3, 2, 2), 0.1);
        EXPECT_NEAR(deviation.mean_degrees, degrees, 1e-6);
        EXPECT_NEAR(deviation.rms_degrees, degrees, 1e-6);
    }
}

TEST(MeasureFeatures, LineBesideTheEdgesIsItsDistanceAway) {
    FeatureCurveNetwork network;
    NetworkArc arc;
    arc.nodes = {0, 1};
    arc.samples = {{Vec3(0.1, 0.55, 0), {}}, {Vec3(0.9, 0.55, 0), {}}};
    network.nodes = {{Vec3(0.1, 0.5, 0), {}}, {Vec3(0.9, 0.5, 0.25), {}}};
    network.segments.push_back({{0, 1}, 0, 0, 1, 1, false});
    network.arcs.push_back(arc);
    // Strips only: rows at 0 and 1/2 and 1, no edges across but at the ends and the diagonals.
    const Mesh mesh = test::rectangle(10, 1, 1, 2);
    const FeatureDeviation deviation = measure_features(mesh, network, 0.01);
    EXPECT_GT(deviation.samples, 70U);
    EXPECT_LE(deviation.max, 0.05 + 1e-12);
    const FeatureDeviation on_edge = [&] {
        FeatureCurveNetwork moved = network;
        for (ArcSample& sample : moved.arcs[0].samples) sample.position[1] = 0.5;
        return measure_features(mesh, moved, 0.01);
    }();
    EXPECT_NEAR(on_edge.max, 0, 1e-12);
    // Nearest vertices of the nodes: (0, 1/2) twice.
    EXPECT_NEAR(deviation.max_node, std::hypot(0.9, 0.25), 1e-12);
    EXPECT_NEAR(deviation.mean_node, (0.1 + std::hypot(0.9, 0.25)) / 2, 1e-12);
    EXPECT_THROW(measure_features(mesh, network, 0), InputError);
    EXPECT_THROW(measure_features(Mesh(), network, 0.1), InputError);
}

}  // namespace
}  // namespace fcn
