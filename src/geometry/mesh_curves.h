#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/mesh_io.h"

namespace fcn {

using VertexCurves = std::vector<std::vector<int>>;

/// Chains edges, given by their end vertices, to curves between the vertices with other than two of
/// them; a closed curve repeats its first vertex. Edges given twice count once. Deterministic:
/// curves by their first edge.
VertexCurves chain_vertex_pairs(const std::vector<std::array<int, 2>>& edges);

/// The curves' edges in all.
std::size_t curve_edge_count(const LoadedMesh& mesh);

/// Vertices where other than two curve ends meet.
std::vector<int> curve_corners(const LoadedMesh& mesh);

/// Calls `visit(curve, from, to)` for every edge of every curve, in order.
template <typename Visit>
void for_each_curve_edge(const LoadedMesh& mesh, Visit visit) {
    for (std::size_t curve = 0; curve < mesh.curves.size(); ++curve)
        for (std::size_t k = 1; k < mesh.curves[curve].size(); ++k)
            visit(curve, mesh.curves[curve][k - 1], mesh.curves[curve][k]);
}

// The formats that hold curves alone.

/// "type,face,edge" for each side of each edge, behind their number; 0 concave, 1 convex.
std::string write_sharp_curves(const Mesh& mesh, const VertexCurves& curves);
/// The vertices of each curve behind their number, behind the number of curves.
std::string write_fl_curves(const VertexCurves& curves);

}  // namespace fcn
