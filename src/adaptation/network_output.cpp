#include "adaptation/network_output.h"

#include <algorithm>
#include <map>

namespace fcn {

namespace {

/// Samples of a working arc without the repeated points that dragging may leave; keeps the chain's.
struct CleanSamples {
    std::vector<int> kept;      ///< working samples
    std::vector<int> position;  ///< of each working sample among the kept; -1 dropped
};

CleanSamples clean_samples(const WorkingArc& arc) {
    CleanSamples result;
    const int count = static_cast<int>(arc.points.size());
    result.position.assign(count, -1);
    std::vector<bool> is_node(count, false);
    for (int sample : arc.chain) is_node[sample] = true;
    for (int k = 0; k < count; ++k) {
        if (!is_node[k] && !result.kept.empty() &&
            arc.points[k] == arc.points[result.kept.back()]) {
            continue;
        }
        while (is_node[k] && !result.kept.empty() && !is_node[result.kept.back()] &&
               arc.points[k] == arc.points[result.kept.back()]) {
            result.position[result.kept.back()] = -1;
            result.kept.pop_back();
        }
        result.position[k] = static_cast<int>(result.kept.size());
        result.kept.push_back(k);
    }
    return result;
}

NetworkArc make_arc(const WorkingArc& working, const CleanSamples& clean,
                    const FeatureCurveNetwork& initial) {
    NetworkArc arc;
    for (std::size_t i = 0; i < clean.kept.size(); ++i) {
        arc.samples.push_back({working.points[clean.kept[i]], {}});
        if (i > 0) arc.origins.push_back(working.origins[clean.kept[i] - 1]);
    }
    const NetworkArc& origin =
        initial.arcs[majority_origin(working, 0, static_cast<int>(working.points.size()) - 1)];
    arc.patches = origin.patches;
    arc.kind = origin.kind;
    arc.pin = working.is_pinned ? Pin::Keep : Pin::None;
    arc.source = origin.source;
    arc.dihedral = origin.dihedral;
    return arc;
}

}  // namespace

int majority_origin(const WorkingArc& arc, int first, int last) {
    std::map<int, double> share;
    for (int k = first; k < last; ++k) {
        share[arc.origins[k]] += (arc.points[k + 1] - arc.points[k]).norm();
    }
    int best = -1;
    double largest = -1;
    for (const auto& [origin, length] : share) {
        if (length > largest) {
            largest = length;
            best = origin;
        }
    }
    return best;
}

FeatureCurveNetwork make_adapted_network(const FeatureCurveNetwork& initial,
                                         const WorkingNetwork& network, const NetworkGraph& graph,
                                         const std::vector<double>& weights,
                                         const SurfaceQueries& queries) {
    FeatureCurveNetwork result;
    result.mesh_name = initial.mesh_name;
    result.mesh_hash = initial.mesh_hash;
    result.units = initial.units;
    result.diagonal = initial.diagonal;
    result.notes = initial.notes;
    std::vector<int> node_index(graph.graph.nodes.size(), -1);
    const auto node_of = [&](int v) {
        if (node_index[v] < 0) {
            node_index[v] = static_cast<int>(result.nodes.size());
            result.nodes.push_back({graph.graph.nodes[v].position, {}});
        }
        return node_index[v];
    };
    std::vector<CleanSamples> clean(network.arcs.size());
    std::vector<int> arc_index(network.arcs.size(), -1);
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        if (!network.arcs[a].is_alive) continue;
        clean[a] = clean_samples(network.arcs[a]);
        arc_index[a] = static_cast<int>(result.arcs.size());
        result.arcs.push_back(make_arc(network.arcs[a], clean[a], initial));
        result.arcs.back().nodes = {node_of(network.arcs[a].nodes[0]),
                                    node_of(network.arcs[a].nodes[1])};
    }
    for (std::size_t s = 0; s < graph.sources.size(); ++s) {
        const SegmentSource& source = graph.sources[s];
        NetworkSegment segment;
        const auto& ends = graph.graph.segments[s].nodes;
        segment.nodes = {node_of(ends[0]), node_of(ends[1])};
        segment.arc = arc_index[source.arc];
        segment.first_sample = clean[source.arc].position[source.first_sample];
        segment.last_sample = clean[source.arc].position[source.last_sample];
        segment.weight = s < weights.size() ? weights[s] : 0.0;
        segment.is_long = graph.graph.segments[s].is_long;
        result.segments.push_back(segment);
    }
    for (NetworkNode& node : result.nodes) node.surface = queries.closest(node.position).surface;
    for (NetworkArc& arc : result.arcs) {
        for (ArcSample& sample : arc.samples) {
            sample.surface = queries.closest(sample.position).surface;
        }
    }
    find_curves(result);
    return result;
}

}  // namespace fcn
