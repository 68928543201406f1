#pragma once

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <utility>

#include "geometry/mesh_io.h"

namespace fcn::testing {

/// Checks from the face list alone, and then OpenMesh's links against it, that the mesh is an
/// oriented 2-manifold: no directed edge twice, the faces at each vertex form one fan, every link
/// leads back.
inline void expect_manifold(const LoadedMesh& loaded) {
    const Mesh& mesh = loaded.mesh;
    ASSERT_GT(mesh.n_faces(), 0U);
    const std::size_t label_count = loaded.face_labels.size();
    ASSERT_TRUE(label_count == 0 || label_count == mesh.n_faces());
    std::map<std::pair<int, int>, int> face_of_edge;
    std::map<int, std::map<int, int>> next_around;  // vertex -> corner after -> corner before
    for (const auto face : mesh.faces()) {
        const auto corners = face_vertices(mesh, face);
        EXPECT_GT(face_area(mesh, face), 0.0);
        for (int i = 0; i < 3; ++i) {
            const int from = corners[i].idx();
            const int to = corners[(i + 1) % 3].idx();
            const int apex = corners[(i + 2) % 3].idx();
            ASSERT_NE(from, to);
            ASSERT_TRUE(face_of_edge.emplace(std::pair(from, to), face.idx()).second)
                << "directed edge " << from << " " << to << " is used twice";
            ASSERT_TRUE(next_around[from].emplace(to, apex).second);
        }
    }
    for (const auto vertex : mesh.vertices()) {
        const auto& around = next_around[vertex.idx()];
        ASSERT_FALSE(around.empty()) << "vertex without face";
        std::set<int> ends;
        for (const auto& [after, before] : around) ends.insert(before);
        int start = around.begin()->first;
        for (const auto& [after, before] : around) {
            if (!ends.contains(after)) start = after;
        }
        std::size_t length = 0;
        for (auto it = around.find(start); it != around.end() && length < around.size();
             it = around.find(it->second)) {
            ++length;
        }
        EXPECT_EQ(length, around.size()) << "vertex " << vertex.idx() << " has several fans";
        EXPECT_EQ(mesh.valence(vertex), ends.contains(start) ? length : length + 1);
        EXPECT_EQ(mesh.is_boundary(vertex), !ends.contains(start));
    }
    for (const auto halfedge : mesh.halfedges()) {
        EXPECT_EQ(mesh.prev_halfedge_handle(mesh.next_halfedge_handle(halfedge)), halfedge);
        EXPECT_EQ(mesh.from_vertex_handle(mesh.next_halfedge_handle(halfedge)),
                  mesh.to_vertex_handle(halfedge));
        const std::pair ends(mesh.from_vertex_handle(halfedge).idx(),
                             mesh.to_vertex_handle(halfedge).idx());
        const auto face = face_of_edge.find(ends);
        EXPECT_EQ(mesh.face_handle(halfedge).idx(), face == face_of_edge.end() ? -1 : face->second);
        EXPECT_EQ(
            mesh.find_halfedge(mesh.from_vertex_handle(halfedge), mesh.to_vertex_handle(halfedge)),
            halfedge);
    }
}

}  // namespace fcn::testing
