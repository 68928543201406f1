#pragma once

#include <string>
#include <vector>

#include "network/network.h"

namespace fcn {

/// What a curve file says: points, and edges that index them, in file order.
struct EdgeSoup {
    struct Edge {
        int from = -1;
        int to = -1;
        int arc = -1;  ///< the file's number of the arc, >= 0; -1 where it has none
    };
    std::vector<Vec3> points;
    std::vector<Edge> edges;
    std::vector<DroppedPiece> dropped;

    /// Adds the edges of a polyline of point indices.
    void add_polyline(const std::vector<int>& indices, int arc);
};

/// Chains edges into arcs. Points with equal coordinates are one; edges without length and
/// repeated ones (same ends, same arc number) are dropped with a note. Nodes are the points
/// with other than two edges, those where the arc number changes, and on a closed chain the first
/// point of its first edge. Arcs are sorted by number, then by first edge, and run as their first
/// edge does, so that what a network was written as chains to the same arcs. O(n log n).
FeatureCurveNetwork chain_edges(const EdgeSoup& soup);

}  // namespace fcn
