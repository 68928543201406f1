#pragma once

#include <vector>

#include "meshing/reference_surface.h"
#include "network/network.h"

namespace fcn {

/// A point that must become a vertex of the remeshed surface, exactly there.
struct FeatureStation {
    Vec3 position = Vec3::Zero();
    SurfacePoint surface;
    bool is_used = false;  ///< an end of some piece; others are not embedded
};

/// What should become one edge: from station to station along a dense polyline.
struct FeaturePiece {
    int from = -1, to = -1;            ///< stations
    std::vector<SurfacePoint> points;  ///< strictly between the stations
    int segment = -1;                  ///< of an adapted network; -1 for a piece of an initial arc
    int arc = -1;
    bool is_rigid = false;  ///< follows the mesh's boundary or a border of labels
};

struct FeaturePieces {
    std::vector<FeatureStation> stations;  ///< the network's nodes first, in their order
    std::vector<FeaturePiece> pieces;
};

/// Cuts a network into pieces for edges of length L: every segment of an adapted network is one
/// piece, or several equal ones where it is longer than 4/3 L; every arc of an initial network is
/// cut into round(length / L) pieces, closed ones into three at least. `reference` is the mesh's.
/// Throws InputError on indices out of range.
FeaturePieces cut_into_pieces(const FeatureCurveNetwork& network, double edge_length,
                              const Mesh& mesh, const ReferenceSurface& reference);

}  // namespace fcn
