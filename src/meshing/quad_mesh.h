#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// An edge of a quad mesh that lies on the network.
struct QuadFeatureEdge {
    int from = -1, to = -1;  ///< vertices
    int arc = -1;            ///< of the network; -1: unknown
    int segment = -1;        ///< of the network; -1: none, or unknown
};

/// A mesh of quads, possibly open, of several components.
struct QuadMesh {
    std::vector<Vec3> points;
    std::vector<std::array<int, 4>> faces;       ///< counter-clockwise seen from outside
    std::vector<int> face_labels;                ///< per face; empty: none
    std::vector<QuadFeatureEdge> feature_edges;  ///< each edge once at most
};

/// What an independent look at a quad mesh's connectivity finds.
struct QuadTopology {
    /// The first fault, empty: none. Indices in range, four different corners, at most two faces an
    /// edge, which run through it in opposite directions; one fan of faces at each vertex; no
    /// vertex without a face; features are edges.
    std::string fault;
    int components = 0;
    int boundary_loops = 0;
    int euler_characteristic = 0;  ///< vertices - edges + faces
};
QuadTopology check_topology(const QuadMesh& mesh);

/// The same counts of a triangle mesh, to compare with.
QuadTopology topology_of(const Mesh& mesh);

/// Halfedge 4 f + i of face f runs from its corner i to corner i + 1. Returns per halfedge the one
/// on the other side, -1 at a boundary; for meshes without a fault.
std::vector<int> opposite_halfedges(const QuadMesh& mesh);
inline int next_in_quad(int h) { return h % 4 == 3 ? h - 3 : h + 1; }
inline int previous_in_quad(int h) { return h % 4 == 0 ? h + 3 : h - 1; }

/// Triangles of the quads, each cut along the diagonal that leaves the better smallest angle;
/// triangles 2 f and 2 f + 1 are those of face f.
std::vector<std::array<int, 3>> cut_into_triangles(const QuadMesh& mesh);
/// The mesh of these triangles, for distances and pictures. Vertices keep their numbers in meshes
/// without a fault.
Mesh triangle_mesh(const QuadMesh& mesh);

}  // namespace fcn
