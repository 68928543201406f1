#pragma once

#include <vector>

#include "network/network.h"
#include "network/network_io.h"

namespace fcn {

/// A network as the exchange formats see it: points, and one polyline of point indices an arc.
struct WrittenNetwork {
    struct Arc {
        std::vector<int> points;      ///< point indices; a closed arc repeats its first
        std::vector<double> weights;  ///< per edge, w(e) of its segment; 0 without segments
        std::vector<int> segments;    ///< per edge its segment in the network; -1 without
        bool is_pinned = false;
        ArcKind kind = ArcKind::Feature;
    };
    std::vector<Vec3> points;            ///< nodes first, so arcs that meet share a point
    std::vector<SurfacePoint> surfaces;  ///< per point
    std::vector<int> valences;           ///< per point, arc ends; 0 inside an arc
    std::vector<Arc> arcs;
    std::vector<DroppedPiece> dropped;
    bool has_segments = false;  ///< each edge is one segment

    std::size_t edge_count() const;
};

/// The polylines of `detail`: through the ends of the segments (dense where the network has none),
/// or through all samples.
WrittenNetwork polylines_to_write(const FeatureCurveNetwork& network, NetworkDetail detail);

}  // namespace fcn
