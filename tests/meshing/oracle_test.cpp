// CGAL as the oracle: bounded-error Hausdorff distances, and self-intersections.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/models.h"
#include "meshing/measure.h"
#include "meshing/remesh.h"
#include "meshing/self_intersections.h"
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

std::size_t oracle_intersections(const Mesh& mesh) {
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
        ASSERT_EQ(oracle_intersections(mesh.mesh), 0U);
        const FeatureCurveNetwork network =
            test::cut_evenly(test::crease_network(mesh.mesh, 0.7), rmin);
        RemeshOptions options;
        options.edge_length = 1.2 * rmin;
        for (const bool is_protecting : {true, false}) {
            options.is_protecting = is_protecting;
            const RemeshResult result = remesh_triangles(mesh, network, options);
            EXPECT_EQ(oracle_intersections(result.mesh.mesh), 0U) << "rmin " << rmin;
        }
    }
}

TEST(SelfIntersections, AgreeWithCgal) {
    // Spheres whose vertices were shaken until sheets cross, folded and pierced pairs among them.
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 engine(seed);
        std::uniform_real_distribution<double> shake(-0.25, 0.25);
        Mesh mesh = test::sphere(1, 2);
        for (const VertexHandle v : mesh.vertices())
            if (engine() % 4 == 0)
                mesh.set_point(v,
                               mesh.point(v) + Vec3(shake(engine), shake(engine), shake(engine)));
        const auto pairs = self_intersections(mesh);
        EXPECT_EQ(pairs.size(), oracle_intersections(mesh));
        EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
    }
}

/// A tube with walls: `sides` around, inner and outer radius, open rims closed.
LoadedMesh thin_tube(int sides, double inner, double outer, double height, int rows) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    const int ring = 2 * rows;  // outer rows upwards, then inner rows downwards
    for (int k = 0; k < ring; ++k) {
        const bool is_outer = k < rows;
        const int row = is_outer ? k : ring - 1 - k;
        const double radius = is_outer ? outer : inner;
        for (int i = 0; i < sides; ++i) {
            const double angle = 2 * M_PI * i / sides;
            points.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                height * row / (rows - 1));
        }
    }
    for (int k = 0; k < ring; ++k)
        for (int i = 0; i < sides; ++i) {
            const int a = k * sides + i, b = k * sides + (i + 1) % sides;
            const int c = (k + 1) % ring * sides + (i + 1) % sides, d = (k + 1) % ring * sides + i;
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
        }
    return mesh_from_soup(points, triangles);
}

TEST(RemeshOracle, ThinTubeKeepsItsWallsApart) {
    // Edges of 0.5 on a circle of radius 0.5: their sagitta is three times the wall.
    const LoadedMesh tube = thin_tube(96, 0.48, 0.5, 1, 17);
    ASSERT_EQ(oracle_intersections(tube.mesh), 0U);
    const FeatureCurveNetwork creases = test::crease_network(tube.mesh, 0.7);
    for (const double rmin : {0.1, 0.2, 0.4}) {
        RemeshOptions options;
        options.edge_length = 1.2 * rmin;
        const RemeshResult result =
            remesh_triangles(tube, test::cut_evenly(creases, rmin), options);
        EXPECT_EQ(oracle_intersections(result.mesh.mesh), 0U) << "rmin " << rmin;
        EXPECT_EQ(result.new_intersections, 0U);
    }
}

TEST(RemeshOracle, TipsOfThinSpikesStay) {
    // Eight spikes on a sphere, as long as two edges and thinner than one.
    Mesh mesh = test::sphere(1, 4);
    for (const VertexHandle v : mesh.vertices()) {
        const Vec3 p = mesh.point(v);
        const double toward = p.cwiseAbs().sum() / std::sqrt(3.0);
        mesh.set_point(v, p * (1 + std::clamp((toward - 0.985) / 0.015, 0.0, 1.0)));
    }
    LoadedMesh spiked;
    spiked.mesh = mesh;
    RemeshOptions options;
    options.edge_length = 0.5;
    options.is_protecting = false;
    const RemeshResult result = remesh_triangles(spiked, {}, options);
    EXPECT_LT(measure_distance(result.mesh.mesh, mesh, 0.05).backward, 0.3);
    EXPECT_FALSE(result.refined_places.empty());
    for (const RefinedPlace& place : result.refined_places) {
        EXPECT_LT(place.edge_length, options.edge_length);
        EXPECT_GE(place.edge_length, 0.1 * options.edge_length);
    }
    EXPECT_EQ(oracle_intersections(result.mesh.mesh), 0U);
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
    EXPECT_EQ(oracle_intersections(result.mesh.mesh), 0U);
    EXPECT_LT(measure_distance(result.mesh.mesh, plate.mesh, 0.05).hausdorff, 0.051);
}

}  // namespace
}  // namespace fcn
