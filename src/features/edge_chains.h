#pragma once

#include <string>
#include <vector>

#include "features/features.h"
#include "features/mesh_arrays.h"

namespace fcn {

/// A network whose arcs run along mesh edges, and the edges themselves.
struct EdgeNetwork {
    FeatureCurveNetwork network;
    std::vector<int> node_vertices;              ///< mesh vertex of each node
    std::vector<std::vector<int>> arc_vertices;  ///< mesh vertex of each sample of each arc
    std::vector<std::vector<int>> arc_edges;     ///< mesh edge of each interval of each arc
};

/// network_from_edges() on flat arrays; `is_corner_vertex` (may be empty) forces nodes at marked
/// vertices. Linear time, deterministic.
EdgeNetwork trace_edges(const MeshArrays& arrays, const std::vector<bool>& is_marked_edge,
                        const std::vector<int>& patch_of_face, const std::string& source,
                        const std::vector<bool>& is_corner_vertex = {});

/// Copies name, hash, units and diagonal of the mesh into the network.
void set_provenance(FeatureCurveNetwork& network, const LoadedMesh& mesh);

}  // namespace fcn
