#pragma once

#include <string>
#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

/// Edge length of a mesh on a network of scale rmin, in rmin: a remesher that aims at it need not
/// split or collapse a segment.
inline constexpr double kEdgeLengthFactor = 1.2;

struct RemeshOptions {
    double edge_length = 0;  ///< target L, mesh units, > 0
    int iterations = 10;
    /// Protect the network's segments (or dense arcs if it has none); false: plain remeshing.
    bool is_protecting = true;
};

struct RemeshResult {
    LoadedMesh mesh;  ///< labels travel from the input
    /// Pairs of vertex indices of `mesh` that lie on the protected network.
    std::vector<std::array<int, 2>> feature_edges;
    std::vector<std::string> warnings;
    double seconds = 0;
};

/// Isotropic remeshing through CGAL's Polygon_mesh_processing with the network embedded in the
/// mesh and protected.
RemeshResult remesh_with_cgal(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                              const RemeshOptions& options);

}  // namespace fcn
