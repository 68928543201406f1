#pragma once

#include <array>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// A mesh as flat arrays, for the loops that visit every face many times. Indices are those of
/// the mesh handles. About 110 bytes a face.
struct MeshArrays {
    std::vector<Vec3> points;                        ///< per vertex
    std::vector<std::array<int, 3>> face_vertices;   ///< in the order of face_vertices()
    std::vector<std::array<int, 3>> face_edges;      ///< edge i joins corners i and i + 1
    std::vector<std::array<int, 3>> face_neighbors;  ///< across edge i; -1 at the boundary
    std::vector<Vec3> normals;                       ///< per face; zero where degenerate
    std::vector<double> areas;                       ///< per face
    std::vector<std::array<int, 2>> edge_vertices;   ///< from, to
    std::vector<std::array<int, 2>> edge_faces;      ///< left and right of from -> to; -1 outside
    std::vector<double> dihedrals;                   ///< per edge, signed as dihedral_angle()
    double mean_edge_length = 0;

    int vertex_count() const { return static_cast<int>(points.size()); }
    int face_count() const { return static_cast<int>(face_vertices.size()); }
    int edge_count() const { return static_cast<int>(edge_vertices.size()); }
    double edge_length(int edge) const;
    Vec3 centroid(int face) const;
    bool is_boundary(int edge) const;
};

/// Linear time; the same values on any number of threads.
MeshArrays mesh_arrays(const Mesh& mesh, int threads = 1);

/// Rows of integers of different lengths, in one array.
struct IndexRows {
    std::vector<int> offsets;
    std::vector<int> values;
    int row_count() const { return static_cast<int>(offsets.size()) - 1; }
    const int* begin(int row) const { return values.data() + offsets[row]; }
    const int* end(int row) const { return values.data() + offsets[row + 1]; }
    int size(int row) const { return offsets[row + 1] - offsets[row]; }
};

/// Faces around each vertex, in ascending order.
IndexRows faces_of_vertices(const MeshArrays& arrays);

/// Marked edges at each vertex, in ascending order.
IndexRows edges_of_vertices(const MeshArrays& arrays, const std::vector<bool>& is_marked_edge);

/// A vertex as a point on one of its faces.
SurfacePoint surface_point_of_vertex(const MeshArrays& arrays, int vertex, int face);

}  // namespace fcn
