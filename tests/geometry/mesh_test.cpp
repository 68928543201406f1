#include "geometry/mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/small_meshes.h"

namespace fcn {
namespace {

using namespace fcn::testing;

TEST(Mesh, DihedralAngleIsTheTurningAndItsSign) {
    // A sheet folded along the y axis by every angle, once up and once down.
    for (int degrees = -175; degrees <= 175; degrees += 5) {
        const double angle = degrees * M_PI / 180;
        Soup soup;
        soup.points = {
            {0, 0, 0}, {0, 1, 0}, {-1, 0.3, 0}, {std::cos(angle), 0.6, -std::sin(angle)}};
        soup.triangles = {{0, 1, 2}, {1, 0, 3}};
        const Mesh mesh = soup.load().mesh;
        for (const auto edge : mesh.edges()) {
            const double expected = mesh.is_boundary(edge) ? 0.0 : angle;
            EXPECT_NEAR(dihedral_angle(mesh, edge), expected, 1e-12);
        }
    }
}

TEST(Mesh, NormalsAreasAndBoxOfACube) {
    const Vec3 origin(1, -2, 3);
    const Mesh mesh = cube_soup(origin).load().mesh;
    Vec3 sum = Vec3::Zero();
    for (const auto face : mesh.faces()) {
        EXPECT_NEAR(face_area(mesh, face), 0.5, 1e-15);
        const Vec3 normal = face_normal(mesh, face);
        EXPECT_NEAR(normal.norm(), 1, 1e-15);
        const SurfacePoint middle{face.idx(), Vec3::Constant(1.0 / 3)};
        EXPECT_GT(normal.dot(position(mesh, middle) - origin - Vec3::Constant(0.5)), 0.49);
        sum += face_area(mesh, face) * normal;
    }
    EXPECT_LT(sum.norm(), 1e-14);
    const BoundingBox box = bounding_box(mesh);
    EXPECT_EQ(box.min, origin);
    EXPECT_EQ(box.max, origin + Vec3::Ones());
    EXPECT_NEAR(box.diagonal(), std::sqrt(3.0), 1e-15);
    EXPECT_EQ(bounding_box(Mesh()).diagonal(), 0);
}

TEST(Mesh, BarycentricCornersAreTheFacesVertices) {
    const Mesh mesh = tetrahedron_soup().load().mesh;
    for (const auto face : mesh.faces()) {
        const auto corners = face_vertices(mesh, face);
        EXPECT_EQ(corners[0], mesh.from_vertex_handle(mesh.halfedge_handle(face)));
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(position(mesh, {face.idx(), Vec3::Unit(i)}), mesh.point(corners[i]));
        }
    }
}

}  // namespace
}  // namespace fcn
