#pragma once

#include "meshing/quad_mesh.h"
#include "meshing/triangle_pairing.h"

namespace fcn {

/// The quads of a mesh whose faces were all cut from their centre to the middles of their edges.
struct MidpointSplit {
    QuadMesh mesh;                 ///< the triangles' vertices first, in their order
    std::vector<int> edge_vertex;  ///< per edge its middle; -1: the edge is gone
};

/// Cuts the quads that are left when the edges `gone` have vanished into four, and the other
/// triangles into three. `labels` per triangle, or empty.
MidpointSplit split_at_middles(const PairableTriangles& mesh, const std::vector<int>& gone,
                               const std::vector<int>& labels);

}  // namespace fcn
