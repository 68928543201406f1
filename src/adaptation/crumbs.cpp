#include "adaptation/crumbs.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

namespace fcn {

namespace {

constexpr double kCreaseAngle = 20 * std::numbers::pi / 180;
/// A piece is whole when it lacks less than this share of the length.
constexpr double kWhole = 0.999;

struct Piece {
    std::vector<int> segments;
    double length = 0;         ///< along the arcs
    double chord_length = 0;   ///< of the segments
    double crease_length = 0;  ///< along creases
    bool is_pinned = false;
    bool may_grow = false;
    std::map<int, double> length_of_curve;
};

void add_segment(Piece& piece, int s, const WorkingNetwork& network, const NetworkGraph& graph,
                 const CrumbOptions& options) {
    const SegmentSource& source = graph.sources[s];
    const WorkingArc& arc = network.arcs[source.arc];
    piece.segments.push_back(s);
    piece.is_pinned |= arc.is_pinned;
    piece.chord_length += graph.graph.length(s);
    for (int k = source.first_sample; k < source.last_sample; ++k) {
        const double length = (arc.points[k + 1] - arc.points[k]).norm();
        piece.length += length;
        if ((arc.crease[k] + arc.crease[k + 1]) / 2 >= kCreaseAngle) piece.crease_length += length;
        piece.length_of_curve[options.curve_of_origin[arc.origins[k]]] += length;
    }
    for (int node : graph.graph.segments[s].nodes) {
        piece.may_grow |= graph.graph.nodes[node].cluster >= 0;
    }
}

bool is_crumb(const Piece& piece, const CrumbOptions& options) {
    if (piece.chord_length >= options.min_length || piece.is_pinned || piece.may_grow) return false;
    const bool is_crease = piece.crease_length >= piece.length / 2;
    bool has_whole_curves = true;
    for (const auto& [curve, length] : piece.length_of_curve) {
        has_whole_curves &= length >= kWhole * options.length_of_curve[curve];
    }
    const int component = options.component_of_curve[piece.length_of_curve.begin()->first];
    if (piece.length >= kWhole * options.length_of_component[component]) return false;
    return !(is_crease && has_whole_curves);
}

}  // namespace

std::vector<Crumb> find_crumbs(const WorkingNetwork& network, const NetworkGraph& graph,
                               const std::vector<bool>& kept, const CrumbOptions& options) {
    const SegmentGraph& g = graph.graph;
    const int count = static_cast<int>(g.segments.size());
    std::vector<int> parent(g.nodes.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (int s = 0; s < count; ++s) {
        if (!kept[s]) continue;
        const int u = root(g.segments[s].nodes[0]), v = root(g.segments[s].nodes[1]);
        parent[std::max(u, v)] = std::min(u, v);
    }
    std::map<int, Piece> pieces;
    for (int s = 0; s < count; ++s) {
        if (kept[s]) add_segment(pieces[root(g.segments[s].nodes[0])], s, network, graph, options);
    }
    std::vector<Crumb> result;
    for (auto& [node, piece] : pieces) {
        if (!is_crumb(piece, options)) continue;
        std::set<int> neighbours;
        for (int s : piece.segments) {
            for (int v : g.segments[s].nodes) {
                for (int other : g.incident[v]) {
                    if (!kept[other]) neighbours.insert(other);
                }
            }
        }
        result.push_back({std::move(piece.segments), {neighbours.begin(), neighbours.end()}});
    }
    return result;
}

}  // namespace fcn
