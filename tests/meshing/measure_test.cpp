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

}  // namespace
}  // namespace fcn
