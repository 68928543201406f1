#include "meshing/remesh_quads.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "geometry/errors.h"
#include "meshing/measure.h"
#include "meshing/quad_quality.h"
#include "meshing/quad_smoothing.h"
#include "sample_meshes.h"
#include "sample_networks.h"
#include "sample_quads.h"

namespace fcn {
namespace {

constexpr double kCrease = 0.6;

LoadedMesh loaded(const Mesh& mesh) {
    LoadedMesh result;
    result.mesh = mesh;
    return result;
}

LoadedMesh torus(double radius, double tube, int m, int n) {
    return loaded(triangle_mesh(test::quad_torus(radius, tube, m, n)));
}

QuadResult by_pairing(const LoadedMesh& mesh, const FeatureCurveNetwork& network, double h) {
    QuadOptions options;
    options.edge_length = h;
    options.best_tier = QuadTier::Pairing;
    return remesh_quads(mesh, network, options);
}

/// From node to node along feature edges of this segment alone.
bool is_chain(const QuadMesh& mesh, const FeatureCurveNetwork& network, int segment) {
    const auto& nodes = network.segments[static_cast<std::size_t>(segment)].nodes;
    const auto vertex_at = [&](int node) {
        const Vec3& p = network.nodes[static_cast<std::size_t>(node)].position;
        for (std::size_t v = 0; v < mesh.points.size(); ++v)
            if ((mesh.points[v] - p).norm() < 1e-9) return static_cast<int>(v);
        return -1;
    };
    std::set<int> reached{vertex_at(nodes[0])};
    for (std::size_t round = 0; round < mesh.feature_edges.size(); ++round)
        for (const QuadFeatureEdge& edge : mesh.feature_edges) {
            if (edge.segment != segment) continue;
            if (reached.contains(edge.from)) reached.insert(edge.to);
            if (reached.contains(edge.to)) reached.insert(edge.from);
            if (reached.contains(vertex_at(nodes[1]))) return true;
        }
    return false;
}

/// What holds for every mesh of quads.
void expect_sound(const LoadedMesh& input, const FeatureCurveNetwork& network,
                  const QuadResult& result, double h, double tolerance) {
    const QuadTopology topology = check_topology(result.mesh), expected = topology_of(input.mesh);
    EXPECT_EQ(topology.fault, "");
    EXPECT_EQ(topology.euler_characteristic, expected.euler_characteristic);
    EXPECT_EQ(topology.boundary_loops, expected.boundary_loops);
    EXPECT_EQ(topology.components, expected.components);
    const QuadQuality quality = measure_quads(result.mesh, h);
    EXPECT_EQ(quality.inverted_corners, 0u);
    EXPECT_GT(quality.min_scaled_jacobian, 0);
    EXPECT_GT(quality.mean_edge, 0.6 * h);
    EXPECT_LT(quality.mean_edge, 1.3 * h);
    const MeshDistance distance =
        measure_distance(triangle_mesh(result.mesh), input.mesh, 0.25 * h);
    EXPECT_LE(distance.hausdorff, tolerance * h);
    EXPECT_EQ(result.broken_segments, std::vector<int>{});
    for (int s = 0; s < static_cast<int>(network.segments.size()); ++s)
        EXPECT_TRUE(is_chain(result.mesh, network, s)) << "segment " << s;
}

TEST(QuadsByPairing, Plane) {
    const LoadedMesh mesh = loaded(test::rectangle(1, 0.7, 10, 7));
    const QuadResult result = by_pairing(mesh, {}, 0.1);
    expect_sound(mesh, {}, result, 0.1, 1e-6);
    EXPECT_EQ(result.tier, QuadTier::Pairing);
    EXPECT_GT(measure_quads(result.mesh).mean_scaled_jacobian, 0.9);
}

TEST(QuadsByPairing, ClosedAndOpenShapes) {
    const LoadedMesh sphere = loaded(test::sphere(1, 4));
    expect_sound(sphere, {}, by_pairing(sphere, {}, 0.25), 0.25, 0.2);
    const LoadedMesh ring = torus(2, 0.7, 48, 24);
    expect_sound(ring, {}, by_pairing(ring, {}, 0.3), 0.3, 0.3);
    const LoadedMesh tube = test::cylinder(1, 36, 12);
    // Nothing holds the creases.
    expect_sound(tube, {}, by_pairing(tube, {}, 0.3), 0.3, 0.5);
}

TEST(QuadsByPairing, SegmentsOfABoxAreEdges) {
    const LoadedMesh box = test::cube(8);
    const FeatureCurveNetwork network =
        test::cut_evenly(test::crease_network(box.mesh, kCrease), 0.16);
    ASSERT_GT(network.segments.size(), 12u);
    const QuadResult result = by_pairing(box, network, 1.2 * 0.16);
    expect_sound(box, network, result, 1.2 * 0.16, 1e-6);
    EXPECT_LT(measure_alignment(result.mesh, network, 0.05).max_degrees, 1e-6);
}

TEST(QuadsByPairing, LabelsStayApart) {
    const LoadedMesh box = test::cube(6, true);
    const QuadResult result = by_pairing(box, {}, 0.2);
    expect_sound(box, {}, result, 0.2, 1e-6);
    ASSERT_EQ(result.mesh.face_labels.size(), result.mesh.faces.size());
    // Each side of the box keeps its area, so no quad reaches over an edge.
    std::vector<double> area(6, 0);
    for (std::size_t f = 0; f < result.mesh.faces.size(); ++f) {
        const auto& [a, b, c, d] = result.mesh.faces[f];
        const auto& p = result.mesh.points;
        const auto at = [&](int v) { return p[static_cast<std::size_t>(v)]; };
        area.at(static_cast<std::size_t>(result.mesh.face_labels[f])) +=
            0.5 * (at(c) - at(a)).cross(at(d) - at(b)).norm();
    }
    for (const double side : area) EXPECT_NEAR(side, 1, 1e-9);
}

TEST(QuadsByPairing, SeveralComponents) {
    LoadedMesh both = torus(2, 0.7, 48, 24);
    const Mesh plane = test::rectangle(2, 2, 8, 8, 3);
    std::vector<VertexHandle> copies;
    for (const VertexHandle v : plane.vertices())
        copies.push_back(both.mesh.add_vertex(plane.point(v)));
    for (const FaceHandle f : plane.faces()) {
        const auto v = face_vertices(plane, f);
        both.mesh.add_face(copies[static_cast<std::size_t>(v[0].idx())],
                           copies[static_cast<std::size_t>(v[1].idx())],
                           copies[static_cast<std::size_t>(v[2].idx())]);
    }
    expect_sound(both, {}, by_pairing(both, {}, 0.3), 0.3, 0.3);
}

TEST(QuadsByPairing, ThinTubesGetShorterEdges) {
    // Edges of h = 0.5 are as long as the tube is wide: six of them would go around.
    const LoadedMesh ring = torus(2, 0.25, 96, 16);
    const QuadResult result = by_pairing(ring, {}, 0.5);
    EXPECT_EQ(check_topology(result.mesh).fault, "");
    EXPECT_EQ(check_topology(result.mesh).euler_characteristic, 0);
    EXPECT_EQ(measure_quads(result.mesh).inverted_corners, 0u);
    EXPECT_LE(measure_distance(triangle_mesh(result.mesh), ring.mesh, 0.05).hausdorff, 0.25);
}

TEST(QuadsByPairing, IsDeterministicOnAnyNumberOfThreads) {
    const LoadedMesh box = test::cube(8);
    const FeatureCurveNetwork network =
        test::cut_evenly(test::crease_network(box.mesh, kCrease), 0.16);
    const auto make = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return by_pairing(box, network, 0.19).mesh;
    };
    const QuadMesh one = make(1), two = make(2);
    EXPECT_EQ(one.points, two.points);
    EXPECT_EQ(one.faces, two.faces);
}

TEST(QuadsByPairing, RefusesBadInput) {
    const LoadedMesh plane = loaded(test::rectangle(1, 1, 4, 4));
    for (const double h : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        EXPECT_THROW(by_pairing(plane, {}, h), InputError);
    EXPECT_THROW(by_pairing(LoadedMesh{}, {}, 0.1), InputError);
    EXPECT_THROW(by_pairing(plane, {}, 1e-9), InputError);
    FeatureCurveNetwork broken;
    broken.segments.push_back({{0, 1}, 0, 0, 1, 0, false});
    EXPECT_THROW(by_pairing(plane, broken, 0.1), InputError);
}

/// All vertices but those of the boundary, by up to `share` of an edge in any direction.
void shake(QuadMesh& mesh, int m, int n, double share) {
    for (int j = 1; j < n; ++j)
        for (int i = 1; i < m; ++i) {
            Vec3& p = mesh.points[static_cast<std::size_t>(j * (m + 1) + i)];
            p += share * Vec3(std::sin(12.9 * i + 78.2 * j), std::sin(39.3 * i + 11.1 * j),
                              0.2 * std::sin(7.7 * i + 3.1 * j));
        }
}

QuadConstraints fixed_boundary(const QuadMesh& mesh) {
    QuadConstraints constraints;
    constraints.curve.assign(mesh.points.size(), QuadConstraints::kFree);
    const std::vector<int> opposite = opposite_halfedges(mesh);
    for (std::size_t h = 0; h < opposite.size(); ++h)
        if (opposite[h] < 0)
            for (const std::size_t i : {h % 4, (h + 1) % 4})
                constraints.curve[static_cast<std::size_t>(mesh.faces[h / 4][i])] =
                    QuadConstraints::kFixed;
    return constraints;
}

TEST(SmoothQuads, UntanglesAShakenGridBackToTheSurface) {
    QuadMesh mesh = test::quad_grid(10, 8);
    shake(mesh, 10, 8, 0.7);
    ASSERT_GT(count_inverted_corners(mesh), 20);
    const Mesh plane = test::rectangle(10, 8, 10, 8);
    const QuadSmoothingResult result =
        smooth_quads(mesh, fixed_boundary(mesh), ReferenceSurface(plane), {1.0, 60, 0.3});
    EXPECT_EQ(result.inverted_after, 0);
    const QuadQuality quality = measure_quads(mesh);
    EXPECT_EQ(quality.inverted_corners, 0u);
    EXPECT_GT(quality.mean_scaled_jacobian, 0.98);
    for (const Vec3& p : mesh.points) EXPECT_NEAR(p[2], 0, 1e-9);
}

TEST(SmoothQuads, KeepsCurvesAndDrawsTowardsThem) {
    QuadMesh mesh = test::quad_grid(6, 6);
    QuadConstraints constraints = fixed_boundary(mesh);
    // The middle row belongs on a wave; one of its vertices on a point.
    constraints.curves = {{}, {{3.2, 3.2, 0}}};
    for (int i = 0; i <= 60; ++i)
        constraints.curves[0].emplace_back(0.1 * i, 3 + 0.2 * std::sin(0.1 * i), 0);
    for (int i = 1; i < 6; ++i) constraints.curve[static_cast<std::size_t>(3 * 7 + i)] = 0;
    constraints.curve[3 * 7 + 3] = 1;
    const Mesh plane = test::rectangle(6, 6, 6, 6);
    const QuadSmoothingResult result =
        smooth_quads(mesh, constraints, ReferenceSurface(plane), {1.0, 60, 0.3});
    EXPECT_EQ(result.off_curve, 0);
    for (int i = 1; i < 6; ++i) {
        const std::size_t v = static_cast<std::size_t>(3 * 7 + i);
        const Vec3 there = closest_on_polyline(constraints.curves[i == 3 ? 1 : 0], mesh.points[v]);
        EXPECT_NEAR((mesh.points[v] - there).norm(), 0, 1e-9) << "vertex " << i;
    }
    for (int i = 0; i <= 6; ++i) EXPECT_EQ(mesh.points[static_cast<std::size_t>(i)], Vec3(i, 0, 0));
}

}  // namespace
}  // namespace fcn
