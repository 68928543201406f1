#pragma once

#include <array>
#include <vector>

#include "adaptation/resampling.h"
#include "adaptation/scale.h"
#include "adaptation/segment_graph.h"
#include "network/network.h"

namespace fcn {

struct WorkingNode {
    Vec3 position = Vec3::Zero();
    bool is_alive = true;
};

/// A dense polyline between two nodes, and the chain of samples that stands for it.
struct WorkingArc {
    std::array<int, 2> nodes{-1, -1};  ///< equal for a closed arc
    std::vector<Vec3> points;
    std::vector<int> origins;       ///< per interval: arc of the initial network
    std::vector<double> sharpness;  ///< per point: |kappa_max| (paper) or turning, radians (best)
    std::vector<double> crease;     ///< per point: |dihedral angle| of the edge there, radians
    std::vector<int> chain;         ///< samples that are nodes, 0 .. points - 1; empty = resample
    std::vector<int>
        orbit_classes;  ///< per segment of the chain: shared class, or -1; may be empty
    int long_segment = -1;
    bool is_short = false;
    bool is_pinned = false;
    bool is_alive = true;
    bool is_closed() const { return nodes[0] == nodes[1]; }
    bool needs_resampling() const { return is_alive && chain.empty(); }
    double length() const;
    int segment_count() const { return chain.empty() ? 0 : static_cast<int>(chain.size()) - 1; }
};

/// The network while it is being adapted. Arcs and nodes are never erased, only marked dead, so
/// that indices stay valid.
struct WorkingNetwork {
    std::vector<WorkingNode> nodes;
    std::vector<WorkingArc> arcs;

    /// Arc ends (arc, 0 or 1) per node, ascending.
    std::vector<std::vector<std::pair<int, int>>> stars() const;
    /// Joins arcs through every node of two arc ends when both are pinned or both are not. A joined
    /// arc keeps its chain unless `must_resample(node)` or a part is short, unsampled, or both have
    /// a long segment. Returns the number of joins.
    template <class Predicate>
    int merge_regular_nodes(Predicate must_resample);

    int add_node(const Vec3& position);
    void remove_arc(int arc);
    int join(int node, int first_arc, int first_end, int second_arc, int second_end,
             bool must_resample);
    void reverse(int arc);
    /// Splits intervals longer than `spacing` (dragging stretches them); pieces inherit the origin.
    void refine(int arc, double spacing);
    /// Moves the closed arc's first sample (and its node) to `start`.
    void rotate_closed(int arc, int start);
};

/// Where a segment of the graph came from.
struct SegmentSource {
    int arc = -1;
    int position = 0;  ///< segment index in the chain
    int first_sample = 0, last_sample = 0;
};

/// The working network's chains as a graph of straight segments; graph nodes 0 .. nodes - 1 are the
/// working nodes (dead ones isolated), chain-interior nodes follow.
struct NetworkGraph {
    SegmentGraph graph;
    std::vector<SegmentSource> sources;
};
NetworkGraph make_graph(const WorkingNetwork& network);

/// Spacing of dense samples: rmin / 50, finer where S is so narrow that chords would miss it.
double sample_spacing(const ScaleInterval& scale);

/// Dense samples at most `spacing` apart: the original corners (thinned where they are denser than
/// a quarter of it and nearly straight) and points between them.
std::vector<Vec3> densify(const std::vector<ArcSample>& samples, double spacing);

/// Resamples every arc that needs it, in parallel; closed arcs are rotated to their best start.
/// Closed arcs that cannot carry three segments are returned: the caller drops or pins them.
std::vector<int> resample_arcs(WorkingNetwork& network, const ScaleInterval& scale, int threads);

template <class Predicate>
int WorkingNetwork::merge_regular_nodes(Predicate must_resample) {
    int joins = 0;
    auto ends = stars();
    for (int v = 0; v < static_cast<int>(nodes.size()); ++v) {
        if (!nodes[v].is_alive || ends[v].size() != 2) continue;
        const auto [a, a_end] = ends[v][0];
        const auto [b, b_end] = ends[v][1];
        if (a == b || arcs[a].is_pinned != arcs[b].is_pinned) continue;
        const int joined = join(v, a, a_end, b, b_end, must_resample(v));
        ++joins;
        for (int end = 0; end < 2; ++end) {
            auto& star = ends[arcs[joined].nodes[end]];
            // The joined arc took b's place; a star that named a or b now names it.
            for (auto& entry : star) {
                if (entry.first == a || entry.first == b) entry = {joined, end};
            }
            if (arcs[joined].is_closed() && star.size() == 2) star = {{joined, 0}, {joined, 1}};
        }
    }
    return joins;
}

}  // namespace fcn
