#include "geometry/curvature.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/errors.h"
#include "geometry/models.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

using namespace fcn::testing;

/// Closed forms at a point of one of the models.
struct Truth {
    double kappa_max = 0;
    double kappa_min = 0;
    Vec3 direction_max = Vec3::Zero();  ///< zero where any direction will do
};

Truth on_sphere(const Vec3&) { return {2, 2, Vec3::Zero()}; }

Truth on_cylinder(const Vec3& p) { return {2, 0, Vec3(-p.y(), p.x(), 0).normalized()}; }

Truth on_torus(const Vec3& p) {
    const double radius = std::hypot(p.x(), p.y());
    const Vec3 around(-p.y() / radius, p.x() / radius, 0);
    const Vec3 middle(0.35 * p.x() / radius, 0.35 * p.y() / radius, 0);
    return {1 / 0.15, (radius - 0.35) / 0.15 / radius, around.cross((p - middle).normalized())};
}

struct Deviation {
    double worst_max = 0, worst_min = 0, worst_turn = 0;
    int vertex_count = 0;
};

/// Compares at all vertices at least `margin` from the flat ends of the cylinder.
Deviation deviation(const char* name, Truth (*truth)(const Vec3&), double resolution,
                    double radius) {
    ModelOptions options;
    options.resolution = resolution;
    const LoadedMesh model = make_model(name, options);
    CurvatureOptions curvature_options;
    curvature_options.radius = radius;
    curvature_options.threads = 2;
    const PrincipalCurvatures found = principal_curvatures(model.mesh, curvature_options);
    Deviation result;
    for (const auto vertex : model.mesh.vertices()) {
        const Vec3& p = model.mesh.point(vertex);
        const double margin = 1.5 * radius + 2 * resolution;
        if (truth == on_cylinder && (p.z() < margin || p.z() > 1 - margin)) continue;
        const auto i = static_cast<std::size_t>(vertex.idx());
        const Truth expected = truth(p);
        result.worst_max =
            std::max(result.worst_max, std::abs(found.kappa_max[i] - expected.kappa_max));
        result.worst_min =
            std::max(result.worst_min, std::abs(found.kappa_min[i] - expected.kappa_min));
        EXPECT_GE(std::abs(found.kappa_max[i]), std::abs(found.kappa_min[i]));
        EXPECT_NEAR(found.direction_max[i].norm(), 1, 1e-12);
        EXPECT_NEAR(found.direction_min[i].norm(), 1, 1e-12);
        EXPECT_NEAR(found.direction_max[i].dot(found.direction_min[i]), 0, 1e-12);
        if (expected.direction_max.norm() > 0) {
            result.worst_turn =
                std::max(result.worst_turn,
                         1 - std::abs(expected.direction_max.dot(found.direction_max[i])));
        }
        ++result.vertex_count;
    }
    EXPECT_GT(result.vertex_count, 100);
    return result;
}

TEST(Curvature, OfOneRings) {
    const Deviation cylinder = deviation("cylinder", on_cylinder, 0.02, 0);
    EXPECT_LT(cylinder.worst_max, 0.01);
    EXPECT_LT(cylinder.worst_min, 0.01);
    EXPECT_LT(cylinder.worst_turn, 1e-6);
    const Deviation torus = deviation("torus", on_torus, 0.02, 0);
    EXPECT_LT(torus.worst_max, 0.15 / 0.15);
    EXPECT_LT(torus.worst_min, 0.3);
    EXPECT_LT(torus.worst_turn, 1e-2);
    // Irregular vertices of a triangulated sphere keep an error at every resolution.
    EXPECT_LT(deviation("sphere", on_sphere, 0.02, 0).worst_max, 0.6);
}

TEST(Curvature, OfBalls) {
    const double radius = 0.06;
    const Deviation sphere = deviation("sphere", on_sphere, 0.01, radius);
    EXPECT_LT(sphere.worst_max, 0.15);
    EXPECT_LT(sphere.worst_min, 0.15);
    const Deviation cylinder = deviation("cylinder", on_cylinder, 0.01, radius);
    EXPECT_LT(cylinder.worst_max, 0.05);
    EXPECT_LT(cylinder.worst_min, 0.01);
    EXPECT_LT(cylinder.worst_turn, 1e-6);
    const Deviation torus = deviation("torus", on_torus, 0.01, radius);
    EXPECT_LT(torus.worst_max, 0.5);
    EXPECT_LT(torus.worst_min, 0.6);
    EXPECT_LT(torus.worst_turn, 1e-3);
}

TEST(Curvature, OfBallsWithThousandsOfFaces) {
    // Large enough for the walk over patches; the truth averaged over the ball is within 3%.
    const Deviation sphere = deviation("sphere", on_sphere, 0.01, 0.15);
    EXPECT_LT(sphere.worst_max, 0.06);
    EXPECT_LT(sphere.worst_min, 0.06);
    const Deviation cylinder = deviation("cylinder", on_cylinder, 0.01, 0.15);
    EXPECT_LT(cylinder.worst_max, 0.04);
    EXPECT_LT(cylinder.worst_min, 0.01);
    EXPECT_LT(cylinder.worst_turn, 1e-5);
}

TEST(Curvature, IntegratesToTheTurningOfACrease) {
    // A ball of radius r on a straight crease of angle a: 2 r a / (area of the ball's two half
    // discs), and the direction is across the crease.
    ModelOptions options;
    options.resolution = 0.02;
    const LoadedMesh box = make_model("box", options);
    CurvatureOptions curvature_options;
    curvature_options.radius = 0.1;
    const PrincipalCurvatures found = principal_curvatures(box.mesh, curvature_options);
    int checked = 0;
    for (const auto vertex : box.mesh.vertices()) {
        const Vec3& p = box.mesh.point(vertex);
        if (p.y() != 0 || p.z() != 0 || p.x() < 0.2 || p.x() > 0.8) continue;
        const auto i = static_cast<std::size_t>(vertex.idx());
        const double area = M_PI * 0.1 * 0.1;
        EXPECT_NEAR(found.kappa_max[i], M_PI / 2 * 0.2 / area, 1e-9);
        EXPECT_NEAR(found.kappa_min[i], 0, 1e-9);
        EXPECT_NEAR(found.direction_max[i].x(), 0, 1e-9);
        EXPECT_NEAR(std::abs(found.direction_min[i].x()), 1, 1e-9);
        ++checked;
    }
    EXPECT_GT(checked, 10);
}

TEST(Curvature, IsNegativeInAValley) {
    ModelOptions options;
    const LoadedMesh ribs = make_model("ribs", options);
    const PrincipalCurvatures found = principal_curvatures(ribs.mesh);
    int valley_count = 0;
    for (const auto edge : ribs.mesh.edges()) {
        if (dihedral_angle(ribs.mesh, edge) > -1) continue;
        const HalfedgeHandle halfedge = ribs.mesh.halfedge_handle(edge, 0);
        const VertexHandle vertex = ribs.mesh.to_vertex_handle(halfedge);
        bool is_plain = true;
        for (const auto other : ribs.mesh.ve_range(vertex)) {
            is_plain = is_plain && dihedral_angle(ribs.mesh, other) < 0.1;
        }
        if (!is_plain) continue;
        EXPECT_LT(found.kappa_max[static_cast<std::size_t>(vertex.idx())], -1);
        ++valley_count;
    }
    EXPECT_GT(valley_count, 0);
}

TEST(Curvature, DoesNotJumpToAnUnconnectedSheet) {
    // Two flat squares much closer than the radius: a ball that took both would see no edge, but
    // also a folded sheet beside a flat one must not bend it.
    Soup fold = square_soup(8);
    for (Vec3& p : fold.points) p = Vec3(p.x(), p.y(), 0.02 + std::abs(p.x() - 0.5));
    const LoadedMesh both = joined(square_soup(8), fold).load();
    CurvatureOptions options;
    options.radius = 0.4;
    const PrincipalCurvatures found = principal_curvatures(both.mesh, options);
    for (std::size_t i = 0; i < 81; ++i) EXPECT_NEAR(found.kappa_max[i], 0, 1e-12);
    double largest = 0;
    for (std::size_t i = 81; i < 162; ++i) {
        largest = std::max(largest, std::abs(found.kappa_max[i]));
    }
    EXPECT_GT(largest, 1);
}

TEST(Curvature, IsTheSameOnAnyNumberOfThreads) {
    ModelOptions options;
    options.resolution = 0.02;
    const LoadedMesh model = make_model("octaflower", options);
    for (const double radius : {0.0, 0.05, 0.3, 0.6}) {
        CurvatureOptions one;
        one.radius = radius;
        CurvatureOptions four = one;
        four.threads = 4;
        const PrincipalCurvatures a = principal_curvatures(model.mesh, one);
        const PrincipalCurvatures b = principal_curvatures(model.mesh, four);
        EXPECT_EQ(a.kappa_max, b.kappa_max);
        EXPECT_EQ(a.kappa_min, b.kappa_min);
        EXPECT_EQ(a.direction_max, b.direction_max);
    }
}

TEST(Curvature, RefusesBadRadii) {
    const LoadedMesh cube = cube_soup().load();
    CurvatureOptions options;
    options.radius = -1;
    EXPECT_THROW(principal_curvatures(cube.mesh, options), InputError);
    options.radius = std::nan("");
    EXPECT_THROW(principal_curvatures(cube.mesh, options), InputError);
}

}  // namespace
}  // namespace fcn
