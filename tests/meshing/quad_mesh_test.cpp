#include "meshing/quad_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "sample_meshes.h"
#include "sample_quads.h"

namespace fcn {
namespace {

using test::quad_cube;
using test::quad_grid;
using test::quad_torus;

TEST(QuadTopology, OfKnownShapes) {
    const QuadTopology grid = check_topology(quad_grid(5, 3));
    EXPECT_EQ(grid.fault, "");
    EXPECT_EQ(grid.euler_characteristic, 1);
    EXPECT_EQ(grid.boundary_loops, 1);
    const QuadTopology cube = check_topology(quad_cube());
    EXPECT_EQ(cube.fault, "");
    EXPECT_EQ(cube.euler_characteristic, 2);
    EXPECT_EQ(cube.boundary_loops, 0);
    QuadMesh two = quad_torus(3, 1, 12, 8);
    EXPECT_EQ(check_topology(two).euler_characteristic, 0);
    const int shift = static_cast<int>(two.points.size());
    const QuadMesh other = quad_grid(2, 2);
    two.points.insert(two.points.end(), other.points.begin(), other.points.end());
    for (auto face : other.faces) {
        for (int& v : face) v += shift;
        two.faces.push_back(face);
    }
    const QuadTopology both = check_topology(two);
    EXPECT_EQ(both.fault, "");
    EXPECT_EQ(both.components, 2);
    EXPECT_EQ(both.boundary_loops, 1);
    EXPECT_EQ(both.euler_characteristic, 1);
}

TEST(QuadTopology, OfTrianglesAgreesWithTheCutQuads) {
    for (const QuadMesh& quads : {quad_grid(5, 3), quad_cube(), quad_torus(3, 1, 12, 8)}) {
        const QuadTopology expected = check_topology(quads);
        const QuadTopology cut = topology_of(triangle_mesh(quads));
        EXPECT_EQ(cut.fault, "");
        EXPECT_EQ(cut.euler_characteristic, expected.euler_characteristic);
        EXPECT_EQ(cut.boundary_loops, expected.boundary_loops);
        EXPECT_EQ(cut.components, expected.components);
    }
}

TEST(QuadTopology, NamesEachFault) {
    const auto fault = [](const auto& change) {
        QuadMesh mesh = quad_grid(2, 2);
        change(mesh);
        return check_topology(mesh).fault;
    };
    EXPECT_EQ(fault([](QuadMesh& m) { m.faces.clear(); }), "there are no faces");
    EXPECT_EQ(fault([](QuadMesh& m) { m.faces[1][2] = 9; }),
              "face 1 has a corner that is no vertex");
    EXPECT_EQ(fault([](QuadMesh& m) { m.faces[1][2] = m.faces[1][0]; }),
              "face 1 has a corner twice");
    EXPECT_EQ(fault([](QuadMesh& m) { m.points.emplace_back(0, 0, 1); }), "vertex 9 has no face");
    EXPECT_EQ(fault([](QuadMesh& m) { std::reverse(m.faces[0].begin(), m.faces[0].end()); }),
              "edge 1 4 has faces that disagree");
    EXPECT_EQ(fault([](QuadMesh& m) {
                  m.points.emplace_back(0, 0, 1);
                  m.points.emplace_back(1, 0, 1);
                  m.faces.push_back({4, 1, 9, 10});
              }),
              "edge 1 4 has more than two faces");
    EXPECT_EQ(fault([](QuadMesh& m) {
                  m.faces.erase(m.faces.begin() + 1);
                  m.faces.erase(m.faces.begin() + 1);
                  m.points.erase(m.points.begin() + 2);
                  m.points.erase(m.points.begin() + 5);
                  m.faces = {{0, 1, 3, 2}, {3, 4, 6, 5}};
              }),
              "vertex 3 has more than one fan of faces");
    EXPECT_EQ(fault([](QuadMesh& m) { m.points[4][1] = std::nan(""); }), "vertex 4 is not finite");
    EXPECT_EQ(fault([](QuadMesh& m) { m.face_labels = {1}; }),
              "there are not as many labels as faces");
    EXPECT_EQ(fault([](QuadMesh& m) {
                  m.feature_edges = {{0, 4, -1, -1}};
              }),
              "feature 0 4 is no edge");
    EXPECT_EQ(fault([](QuadMesh& m) {
                  m.feature_edges = {{0, 1, -1, -1}, {1, 0, -1, -1}};
              }),
              "feature 0 1 is there twice");
}

TEST(QuadMesh, OppositeHalfedgesRunBackwards) {
    for (const QuadMesh& mesh : {quad_grid(4, 3), quad_cube()}) {
        const std::vector<int> opposite = opposite_halfedges(mesh);
        const auto from = [&](int h) {
            return mesh.faces[static_cast<std::size_t>(h / 4)][static_cast<std::size_t>(h % 4)];
        };
        int open = 0;
        for (int h = 0; h < static_cast<int>(opposite.size()); ++h) {
            const int other = opposite[static_cast<std::size_t>(h)];
            open += other < 0;
            if (other < 0) continue;
            EXPECT_EQ(opposite[static_cast<std::size_t>(other)], h);
            EXPECT_EQ(from(other), from(next_in_quad(h)));
            EXPECT_EQ(from(next_in_quad(other)), from(h));
        }
        EXPECT_EQ(open, mesh.points.size() == 8 ? 0 : 14);
    }
}

}  // namespace
}  // namespace fcn
