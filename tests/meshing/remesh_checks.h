#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "meshing/measure.h"
#include "meshing/remesh.h"

namespace fcn::test {

inline double nearest_vertex(const Mesh& mesh, const Vec3& point) {
    double best = std::numeric_limits<double>::infinity();
    for (const VertexHandle vertex : mesh.vertices())
        best = std::min(best, (mesh.point(vertex) - point).norm());
    return best;
}

inline int vertex_at(const Mesh& mesh, const Vec3& point) {
    for (const VertexHandle vertex : mesh.vertices())
        if ((mesh.point(vertex) - point).norm() <= 1e-9) return vertex.idx();
    return -1;
}

inline std::size_t boundary_edges(const Mesh& mesh) {
    std::size_t count = 0;
    for (const EdgeHandle edge : mesh.edges()) count += mesh.is_boundary(edge);
    return count;
}

inline int euler(const Mesh& mesh) {
    return static_cast<int>(mesh.n_vertices()) - static_cast<int>(mesh.n_edges()) +
           static_cast<int>(mesh.n_faces());
}

inline double area_of(const Mesh& mesh) {
    double area = 0;
    for (const FaceHandle face : mesh.faces()) area += face_area(mesh, face);
    return area;
}

/// Nodes at the end of some segment, or of some arc of an initial network.
inline std::set<std::size_t> used_nodes(const FeatureCurveNetwork& network) {
    std::set<std::size_t> used;
    const auto add = [&](const std::array<int, 2>& nodes) {
        for (const int node : nodes) used.insert(static_cast<std::size_t>(node));
    };
    for (const NetworkSegment& segment : network.segments) add(segment.nodes);
    if (network.segments.empty())
        for (const NetworkArc& arc : network.arcs) add(arc.nodes);
    return used;
}

/// What holds for every result: one manifold piece of surface of the same topology, nodes and
/// feature edges in it, no degenerate face.
inline void expect_sound(const LoadedMesh& input, const FeatureCurveNetwork& network,
                         const RemeshResult& result) {
    const Mesh& mesh = result.mesh.mesh;
    ASSERT_GT(mesh.n_faces(), 0U);
    EXPECT_EQ(euler(mesh), euler(input.mesh));
    EXPECT_EQ(boundary_edges(mesh) == 0, boundary_edges(input.mesh) == 0);
    for (const VertexHandle vertex : mesh.vertices()) {
        EXPECT_TRUE(mesh.is_manifold(vertex));
        EXPECT_FALSE(mesh.is_isolated(vertex));
        EXPECT_TRUE(mesh.point(vertex).allFinite());
    }
    EXPECT_GT(measure_triangles(mesh).min_angle_degrees, 0);
    for (const std::size_t node : used_nodes(network))
        EXPECT_LE(nearest_vertex(mesh, network.nodes[node].position), 1e-9);
    for (const auto& [a, b] : result.feature_edges)
        EXPECT_TRUE(mesh.find_halfedge(VertexHandle(a), VertexHandle(b)).is_valid());
}

/// Every segment of [0.8, 4/3] L is one edge and listed as a feature.
inline void expect_segments_are_edges(const FeatureCurveNetwork& network,
                                      const RemeshResult& result, double edge_length) {
    const std::set<std::array<int, 2>> features(result.feature_edges.begin(),
                                                result.feature_edges.end());
    const Mesh& mesh = result.mesh.mesh;
    for (const NetworkSegment& segment : network.segments) {
        const Vec3 from = network.nodes[static_cast<std::size_t>(segment.nodes[0])].position;
        const Vec3 to = network.nodes[static_cast<std::size_t>(segment.nodes[1])].position;
        if ((to - from).norm() > 4.0 / 3 * edge_length) continue;
        const int a = vertex_at(mesh, from), b = vertex_at(mesh, to);
        ASSERT_TRUE(a >= 0 && b >= 0);
        EXPECT_TRUE(mesh.find_halfedge(VertexHandle(a), VertexHandle(b)).is_valid());
        EXPECT_TRUE(features.count({a, b}) || features.count({b, a}));
    }
}

}  // namespace fcn::test
