// CGAL as the oracle: bounded-error Hausdorff distances, and self-intersections.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include "geometry/models.h"
#include "meshing/measure.h"
#include "meshing/remesh.h"
#include "sample_meshes.h"
#include "sample_networks.h"

namespace fcn {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

SurfaceMesh to_cgal(const Mesh& mesh) {
    SurfaceMesh result;
    for (const VertexHandle v : mesh.vertices()) {
        const Vec3& p = mesh.point(v);
        result.add_vertex({p[0], p[1], p[2]});
    }
    for (const FaceHandle f : mesh.faces()) {
        const auto v = face_vertices(mesh, f);
        result.add_face(SurfaceMesh::Vertex_index(static_cast<unsigned>(v[0].idx())),
                        SurfaceMesh::Vertex_index(static_cast<unsigned>(v[1].idx())),
                        SurfaceMesh::Vertex_index(static_cast<unsigned>(v[2].idx())));
    }
    return result;
}

std::size_t self_intersections(const Mesh& mesh) {
    const SurfaceMesh surface = to_cgal(mesh);
    std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> pairs;
    pmp::self_intersections(surface, std::back_inserter(pairs));
    return pairs.size();
}

TEST(MeasureOracle, HausdorffDistanceAgreesWithBoundedError) {
    const std::vector<std::pair<Mesh, Mesh>> pairs{
        {test::sphere(1, 1), test::sphere(1, 3)},
        {test::sphere(1, 2), test::cube(2).mesh},
        {test::rectangle(1, 1, 3, 5), test::rectangle(2, 1, 4, 2, 0.3)}};
    for (const auto& [one, other] : pairs) {
        constexpr double kSpacing = 0.02, kError = 0.001;
        const MeshDistance measured = measure_distance(one, other, kSpacing);
        const double forward = pmp::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(
            to_cgal(one), to_cgal(other), kError);
        const double backward = pmp::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(
            to_cgal(other), to_cgal(one), kError);
        EXPECT_NEAR(measured.forward, forward, kSpacing + kError);
        EXPECT_NEAR(measured.backward, backward, kSpacing + kError);
        EXPECT_LE(measured.hausdorff, std::max(forward, backward) + kError);
    }
}

TEST(RemeshOracle, NoSelfIntersectionsAreIntroduced) {
    std::vector<std::pair<LoadedMesh, double>> cases{{test::cube(6), 0.1},
                                                     {test::cylinder(0.5, 48, 12), 0.12},
                                                     {test::cylinder(0.05, 24, 8), 0.06}};
    for (const auto& [mesh, rmin] : cases) {
        ASSERT_EQ(self_intersections(mesh.mesh), 0U);
        const FeatureCurveNetwork network =
            test::cut_evenly(test::crease_network(mesh.mesh, 0.7), rmin);
        RemeshOptions options;
        options.edge_length = 1.2 * rmin;
        for (const bool is_protecting : {true, false}) {
            options.is_protecting = is_protecting;
            const RemeshResult result = remesh_triangles(mesh, network, options);
            EXPECT_EQ(self_intersections(result.mesh.mesh), 0U) << "rmin " << rmin;
        }
    }
}

TEST(RemeshOracle, ThinPlateKeepsItsSidesApart) {
    // 2 x 2 x 0.05, meshed with edges of six times the thickness, rims kept.
    LoadedMesh plate = test::cube(8);
    for (const VertexHandle v : plate.mesh.vertices()) {
        const Vec3 p = plate.mesh.point(v);
        plate.mesh.set_point(v, Vec3(2 * p[0], 2 * p[1], 0.05 * p[2]));
    }
    const FeatureCurveNetwork network =
        test::cut_evenly(test::crease_network(plate.mesh, 0.7), 0.25);
    RemeshOptions options;
    options.edge_length = 0.3;
    const RemeshResult result = remesh_triangles(plate, network, options);
    EXPECT_EQ(self_intersections(result.mesh.mesh), 0U);
    EXPECT_LT(measure_distance(result.mesh.mesh, plate.mesh, 0.05).hausdorff, 0.051);
}

}  // namespace
}  // namespace fcn
