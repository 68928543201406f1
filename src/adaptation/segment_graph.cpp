#include "adaptation/segment_graph.h"

#include <numeric>

namespace fcn {

namespace {

int find_root(std::vector<int>& parent, int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

}  // namespace

void SegmentGraph::connect() {
    incident.assign(nodes.size(), {});
    for (GraphNode& node : nodes) node.pinned_valence = 0;
    std::vector<int> parent(nodes.size());
    std::iota(parent.begin(), parent.end(), 0);
    std::vector<bool> is_in_cluster(nodes.size(), false);
    for (int s = 0; s < static_cast<int>(segments.size()); ++s) {
        const GraphSegment& segment = segments[s];
        for (int node : segment.nodes) {
            incident[node].push_back(s);
            if (segment.is_pinned) ++nodes[node].pinned_valence;
        }
        if (!segment.is_short) continue;
        is_in_cluster[segment.nodes[0]] = is_in_cluster[segment.nodes[1]] = true;
        const int a = find_root(parent, segment.nodes[0]);
        const int b = find_root(parent, segment.nodes[1]);
        parent[std::max(a, b)] = std::min(a, b);
    }
    for (int v = 0; v < static_cast<int>(nodes.size()); ++v) {
        nodes[v].is_extraordinary = incident[v].size() != 2;
        nodes[v].cluster = is_in_cluster[v] ? find_root(parent, v) : -1;
    }
}

double SegmentGraph::length(int segment) const {
    const auto& ends = segments[segment].nodes;
    return (nodes[ends[0]].position - nodes[ends[1]].position).norm();
}

Vec3 SegmentGraph::direction(int segment, int from_node) const {
    const Vec3 d = nodes[other_node(segment, from_node)].position - nodes[from_node].position;
    const double length = d.norm();
    return length > 0 ? Vec3(d / length) : Vec3(Vec3::Zero());
}

int SegmentGraph::other_node(int segment, int node) const {
    const auto& ends = segments[segment].nodes;
    return ends[0] == node ? ends[1] : ends[0];
}

}  // namespace fcn
