#pragma once

#include <array>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// The resampled network as straight segments between nodes: what conflict detection sees.
struct GraphNode {
    Vec3 position = Vec3::Zero();
    bool is_extraordinary = false;  ///< valence != 2 in the network of segments
    /// Connected component of short segments that holds this node; -1 = none.
    int cluster = -1;
    /// Arc ends at this node that pins keep; with 1 or >= 3 the node cannot become regular.
    int pinned_valence = 0;
};

struct GraphSegment {
    std::array<int, 2> nodes{-1, -1};
    bool is_short = false;
    bool is_long = false;
    bool is_pinned = false;
    int arc = -1;      ///< arc of the working network; -1 in hand-made graphs
    int position = 0;  ///< within the arc's chain
};

struct SegmentGraph {
    std::vector<GraphNode> nodes;
    std::vector<GraphSegment> segments;
    /// Per node, incident segments ascending; filled by connect().
    std::vector<std::vector<int>> incident;

    /// Fills `incident`, is_extraordinary (valence != 2), clusters and pinned valences.
    void connect();
    double length(int segment) const;
    /// Unit vector of a segment away from one of its nodes.
    Vec3 direction(int segment, int from_node) const;
    int other_node(int segment, int node) const;
};

}  // namespace fcn
