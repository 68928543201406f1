#pragma once

#include <array>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

struct TriangleEdge {
    int from = -1, to = -1;      ///< vertices, as the left triangle has them
    int left = -1, right = -1;   ///< triangles; right -1: boundary
    bool is_curve = false;       ///< feature or border: stays an edge
    Vec3 middle = Vec3::Zero();  ///< where the edge will be cut
};

/// Triangles that are to become quads, each cut at the middles of its edges.
struct PairableTriangles {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<std::array<int, 3>> triangle_edges;  ///< edge i from corner i to corner i + 1
    std::vector<TriangleEdge> edges;
};

/// The corners, counter-clockwise, of the quad that the triangles beside an edge make, and its
/// edges from each corner to the next.
struct PairedQuad {
    std::array<int, 4> corners, edges;
};
PairedQuad quad_across(const PairableTriangles& mesh, int edge);

/// Pairs triangles across edges to quads of good shape, as many as that allows, so that about four
/// quads meet at each vertex; never across curves. Returns the edges that go.
std::vector<int> pair_triangles(const PairableTriangles& mesh);

}  // namespace fcn
