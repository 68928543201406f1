#pragma once

#include <string>
#include <vector>

#include "geometry/mesh_io.h"
#include "meshing/feature_pieces.h"
#include "meshing/working_mesh.h"

namespace fcn {

/// A mesh with a network in it, ready to be remeshed: stations are fixed vertices (tracked, in
/// their order), pieces are chains of feature edges; boundaries and borders of labels are curves.
struct NetworkInMesh {
    WorkingMesh mesh;
    FeaturePieces pieces;
    std::vector<std::string> warnings;
};

/// Embeds a network cut for edges of length L; without arcs: the mesh as it is. Falls back to the
/// mesh without the network, with a warning.
NetworkInMesh embed_network(const LoadedMesh& input, const FeatureCurveNetwork& network,
                            double edge_length, const ReferenceSurface& reference);

/// The mesh with its borders as curves and their corners fixed.
WorkingMesh working_mesh(const LoadedMesh& input);

/// Pieces whose two stations are not joined by a single feature edge.
std::vector<int> broken_pieces(const WorkingMesh& mesh, const FeaturePieces& pieces);

}  // namespace fcn
