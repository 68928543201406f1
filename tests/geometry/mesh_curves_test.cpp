#include "geometry/mesh_curves.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>

#include "geometry/errors.h"
#include "geometry/models.h"

namespace fcn {
namespace {

using Edges = std::vector<std::array<int, 2>>;

std::multiset<std::array<int, 2>> edges_of(const VertexCurves& curves) {
    std::multiset<std::array<int, 2>> edges;
    for (const std::vector<int>& curve : curves)
        for (std::size_t k = 1; k < curve.size(); ++k)
            edges.insert({std::min(curve[k - 1], curve[k]), std::max(curve[k - 1], curve[k])});
    return edges;
}

TEST(MeshCurves, ChainsHoldEveryEdgeOnceAndEndAtJunctions) {
    const unsigned seed = 5;
    std::mt19937 random(seed);
    for (int round = 0; round < 300; ++round) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
        const int vertex_count = 2 + static_cast<int>(random() % 12);
        Edges edges(random() % 20);
        std::set<std::array<int, 2>> known;
        std::map<int, int> valence;
        for (auto& [a, b] : edges) {
            a = static_cast<int>(random() % static_cast<unsigned>(vertex_count));
            b = static_cast<int>(random() % static_cast<unsigned>(vertex_count));
            if (a == b || !known.insert({std::min(a, b), std::max(a, b)}).second) continue;
            ++valence[a];
            ++valence[b];
        }
        const VertexCurves curves = chain_vertex_pairs(edges);
        const auto chained = edges_of(curves);
        EXPECT_EQ(std::set(chained.begin(), chained.end()), known);
        EXPECT_EQ(chained.size(), known.size());
        for (const std::vector<int>& curve : curves) {
            ASSERT_GE(curve.size(), 2U);
            for (std::size_t k = 1; k + 1 < curve.size(); ++k) EXPECT_EQ(valence[curve[k]], 2);
            const bool is_loop = curve.front() == curve.back();
            for (const int end : {curve.front(), curve.back()})
                EXPECT_TRUE(is_loop || valence[end] != 2);
        }
        EXPECT_EQ(chain_vertex_pairs(edges), curves);
    }
}

TEST(MeshCurves, CornersAreWhereCurvesEnd) {
    LoadedMesh mesh;
    mesh.curves = {{0, 1, 2}, {2, 3}, {2, 4}, {5, 6, 7, 5}};
    EXPECT_EQ(curve_corners(mesh), (std::vector<int>{0, 2, 3, 4}));
    EXPECT_EQ(curve_edge_count(mesh), 7U);
}

/// A box with its twelve creases as curves.
LoadedMesh box_with_curves() {
    ModelOptions options;
    options.resolution = 0.25;
    LoadedMesh box = make_model("box", options);
    Edges creases;
    for (const EdgeHandle edge : box.mesh.edges())
        if (std::abs(dihedral_angle(box.mesh, edge)) > 1) {
            const HalfedgeHandle side = box.mesh.halfedge_handle(edge, 0);
            creases.push_back(
                {box.mesh.from_vertex_handle(side).idx(), box.mesh.to_vertex_handle(side).idx()});
        }
    box.curves = chain_vertex_pairs(creases);
    return box;
}

class MeshCurveFiles : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("scalefcn_curves_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path folder_;
};

TEST_F(MeshCurveFiles, CurvesDoNotChangeTheMeshThatIsRead) {
    const LoadedMesh box = box_with_curves();
    ASSERT_EQ(box.curves.size(), 12U);
    LoadedMesh bare = box;
    bare.curves.clear();
    for (const char* name : {"a.off", "a.obj", "a.ply", "a.mesh", "a.msh", "a.obj.gz"}) {
        write_mesh(folder_ / name, box);
        const LoadedMesh with = read_mesh(folder_ / name);
        write_mesh(folder_ / name, bare);
        EXPECT_EQ(read_mesh(folder_ / name).hash, with.hash) << name;
        EXPECT_EQ(with.hash, box.hash) << name;
    }
}

TEST_F(MeshCurveFiles, SharpNamesEachSideOfEachEdge) {
    const LoadedMesh box = box_with_curves();
    write_mesh(folder_ / "a.sharp", box);
    std::ifstream in(folder_ / "a.sharp");
    std::size_t count = 0;
    in >> count;
    EXPECT_EQ(count, 2 * curve_edge_count(box));
    std::multiset<std::array<int, 2>> named;
    for (std::size_t k = 0; k < count; ++k) {
        int type = 0, face = 0, edge = 0;
        char comma = 0;
        in >> type >> comma >> face >> comma >> edge;
        EXPECT_EQ(type, 1);  // a box is convex
        const auto corners = face_vertices(box.mesh, FaceHandle(face));
        const int a = corners[static_cast<std::size_t>(edge)].idx();
        const int b = corners[static_cast<std::size_t>(edge + 1) % 3].idx();
        named.insert({std::min(a, b), std::max(a, b)});
    }
    const auto expected = edges_of(box.curves);
    for (const auto& edge : expected) EXPECT_EQ(named.count(edge), 2U);
}

TEST_F(MeshCurveFiles, FormatsThatAreOnlyWrittenAreNotReadAsMeshes) {
    for (const char* name : {"a.vtp", "a.sharp", "a.fl"}) {
        write_mesh(folder_ / name, box_with_curves());
        EXPECT_THROW(read_mesh(folder_ / name), InputError) << name;
    }
}

}  // namespace
}  // namespace fcn
