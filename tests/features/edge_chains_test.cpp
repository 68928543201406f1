#include "features/edge_chains.h"

#include <gtest/gtest.h>

#include "features/feature_meshes.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

using testing::problems_of;

std::vector<bool> all_edges(const Mesh& mesh) { return std::vector<bool>(mesh.n_edges(), true); }

/// Edges of a grid whose both ends satisfy a predicate on the position.
template <typename Predicate>
std::vector<bool> edges_where(const Mesh& mesh, Predicate predicate) {
    std::vector<bool> is_marked(mesh.n_edges(), false);
    for (const auto e : mesh.edges()) {
        const auto h = mesh.halfedge_handle(e, 0);
        is_marked[e.idx()] =
            predicate(mesh.point(mesh.from_vertex_handle(h)), mesh.point(mesh.to_vertex_handle(h)));
    }
    return is_marked;
}

TEST(EdgeChains, NothingMarkedGivesAnEmptyNetwork) {
    const LoadedMesh mesh = testing::square_soup(4).load();
    const auto network =
        network_from_edges(mesh.mesh, std::vector<bool>(mesh.mesh.n_edges(), false), {}, "test");
    EXPECT_TRUE(network.nodes.empty());
    EXPECT_TRUE(network.arcs.empty());
}

TEST(EdgeChains, EveryMarkedEdgeIsCoveredOnce) {
    const LoadedMesh mesh = testing::cube_soup().load();
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    const EdgeNetwork traced = trace_edges(arrays, all_edges(mesh.mesh), {}, "test");
    std::vector<int> uses(arrays.edge_count(), 0);
    for (const auto& edges : traced.arc_edges) {
        for (int e : edges) ++uses[e];
    }
    for (int count : uses) EXPECT_EQ(count, 1);
    EXPECT_EQ(problems_of(traced.network, mesh.mesh), "");
}

TEST(EdgeChains, ClosedChainStartsAtItsSharpestCorner) {
    const LoadedMesh mesh = testing::height_field(20, 20, [](double, double) { return 0.0; });
    std::vector<bool> is_marked = edges_where(mesh.mesh, [](const Vec3& p, const Vec3& q) {
        const auto on = [](const Vec3& v) {
            return std::max(std::abs(v.x() - 10), std::abs(v.y() - 10)) == 4;
        };
        return on(p) && on(q) && std::abs((p - q).x() * (p - q).y()) == 0;
    });
    const auto network = network_from_edges(mesh.mesh, is_marked, {}, "test");
    ASSERT_EQ(network.arcs.size(), 1u);
    ASSERT_EQ(network.nodes.size(), 1u);
    EXPECT_TRUE(network.arcs[0].is_closed());
    EXPECT_DOUBLE_EQ(network.arcs[0].length(), 32);
    const Vec3& start = network.nodes[0].position;
    EXPECT_EQ(std::abs(start.x() - 10), 4);  // one of the four corners
    EXPECT_EQ(std::abs(start.y() - 10), 4);
    EXPECT_EQ(start.y(), 6);  // of equals the smallest vertex
    EXPECT_EQ(start.x(), 6);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
}

TEST(EdgeChains, SplitsWhereThePatchPairChanges) {
    const LoadedMesh mesh = testing::height_field(10, 6, [](double, double) { return 0.0; });
    std::vector<int> patch(mesh.mesh.n_faces());
    for (const auto f : mesh.mesh.faces()) {
        const Vec3 c = (mesh.mesh.point(face_vertices(mesh.mesh, f)[0]) +
                        mesh.mesh.point(face_vertices(mesh.mesh, f)[1]) +
                        mesh.mesh.point(face_vertices(mesh.mesh, f)[2])) /
                       3;
        patch[f.idx()] = c.y() < 3 ? 7 : c.x() < 4 ? 8 : 9;
    }
    // Only the line y = 3 is marked: it is the border of 7 with 8, then with 9.
    const auto is_marked = edges_where(
        mesh.mesh, [](const Vec3& p, const Vec3& q) { return p.y() == 3 && q.y() == 3; });
    const auto network = network_from_edges(mesh.mesh, is_marked, patch, "test");
    ASSERT_EQ(network.arcs.size(), 2u);
    EXPECT_EQ(network.nodes.size(), 3u);
    for (const NetworkArc& arc : network.arcs) {
        const bool goes_right = arc.samples.back().position.x() > arc.samples[0].position.x();
        const bool is_west =
            std::min(arc.samples[0].position.x(), arc.samples.back().position.x()) < 3.5;
        EXPECT_EQ(arc.patches[goes_right ? 0 : 1], is_west ? 8 : 9);  // north, left when eastward
        EXPECT_EQ(arc.patches[goes_right ? 1 : 0], 7);
        EXPECT_DOUBLE_EQ(arc.length(), is_west ? 4 : 6);
    }
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
}

TEST(EdgeChains, DihedralIsLengthWeightedAndSigned) {
    for (const double angle : {0.5, -0.5}) {
        const LoadedMesh mesh = testing::folded_strip(6, 5, 3, [&](double) { return angle; });
        const auto is_marked = edges_where(
            mesh.mesh, [](const Vec3& p, const Vec3& q) { return p.x() == 3 && q.x() == 3; });
        const auto network = network_from_edges(mesh.mesh, is_marked, {}, "test");
        ASSERT_EQ(network.arcs.size(), 1u);
        EXPECT_NEAR(network.arcs[0].dihedral, angle, 1e-12);
    }
}

TEST(EdgeChains, WrongSizesAreOurFault) {
    const LoadedMesh mesh = testing::cube_soup().load();
    EXPECT_THROW(network_from_edges(mesh.mesh, {}, {}, "test"), std::logic_error);
    EXPECT_THROW(network_from_edges(mesh.mesh, all_edges(mesh.mesh), {1, 2}, "test"),
                 std::logic_error);
}

}  // namespace
}  // namespace fcn
