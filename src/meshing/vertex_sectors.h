#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// The faces around each vertex in groups that marked edges and the boundary separate.
struct VertexSectors {
    /// Per face and corner, as face_vertices(): the sector. They ascend with their vertices and,
    /// around one, counter-clockwise.
    std::vector<std::array<int, 3>> of_corner;
    std::vector<int> vertex;  ///< per sector
    int count() const { return static_cast<int>(vertex.size()); }
};

/// `is_separating`: per edge. A vertex with one such edge has one sector.
VertexSectors vertex_sectors(const Mesh& mesh, const std::vector<bool>& is_separating);

}  // namespace fcn
