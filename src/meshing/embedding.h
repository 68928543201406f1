#pragma once

#include <array>
#include <string>
#include <vector>

#include "meshing/feature_pieces.h"

namespace fcn {

/// A mesh refined so that feature pieces are chains of its edges. The input's vertices keep their
/// indices; some move by at most the snapping tolerance onto a station.
struct EmbeddedMesh {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> source_face;          ///< per face: the input face it is part of
    std::vector<int> station_vertex;       ///< per station; -1: not used by any piece
    std::vector<std::vector<int>> chains;  ///< per piece: vertices from end to end; empty: no path
    std::size_t lost_pieces = 0;           ///< ends not connected over the surface
};

struct EmbeddingOptions {
    double snap = 0;      ///< largest distance to snap to a vertex or an edge, mesh units
    double flatness = 0;  ///< curves are followed up to this deviation inside faces, mesh units
    double detour = 0;    ///< what a curve's path may be longer than four times its points' way
};

/// Pieces whose chains meet away from their ends, each with every piece it meets; ascending.
std::vector<int> entangled_pieces(const EmbeddedMesh& embedded, const FeaturePieces& pieces);

/// Every station becomes a vertex exactly at its position; every piece a simple chain of edges.
/// Throws LogicError if a face cannot be subdivided.
EmbeddedMesh embed_pieces(const Mesh& mesh, const FeaturePieces& pieces,
                          const EmbeddingOptions& options);

}  // namespace fcn
