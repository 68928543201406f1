// Short arcs that the labeling gives up are collapsed, which joins the curves at their ends in one
// node (paper Figure 6a). Best mode does so before the labeling where nothing can go wrong: the
// problem becomes much easier and more of the network survives.

#include "adaptation/collapse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace fcn {

namespace {

/// How far along an arc a moved end is felt, in rmin.
constexpr double kDragReach = 2.0;

double end_sharpness(const WorkingArc& arc, int end) {
    const std::size_t k = end == 0 ? 0 : arc.points.size() - 1;
    // A crease outranks every smooth turning, which is at most pi.
    return arc.sharpness[k] + 100 * arc.crease[k];
}

class Collapser {
public:
    Collapser(WorkingNetwork& network, const ScaleInterval& scale, const SurfaceQueries& queries)
        : network_(network),
          rmin_(scale.rmin),
          spacing_(sample_spacing(scale)),
          queries_(queries),
          stars_(network.stars()) {}

    bool collapse(int index) {
        WorkingArc& arc = network_.arcs[index];
        const int u = arc.nodes[0], v = arc.nodes[1];
        remove(index);
        if (u == v || (is_pinned(u) && is_pinned(v))) return false;
        const double distance = (network_.nodes[u].position - network_.nodes[v].position).norm();
        if (distance >= rmin_ || stars_[u].empty() || stars_[v].empty()) return false;
        const bool keeps_u = is_pinned(u) != is_pinned(v)   ? is_pinned(u)
                             : sharpness(u) != sharpness(v) ? sharpness(u) > sharpness(v)
                                                            : u < v;
        move(keeps_u ? v : u, keeps_u ? u : v);
        return true;
    }

private:
    bool is_pinned(int node) const {
        return std::ranges::any_of(stars_[node],
                                   [&](const auto& e) { return network_.arcs[e.first].is_pinned; });
    }

    double sharpness(int node) const {
        double result = 0;
        for (const auto& [arc, end] : stars_[node]) {
            result = std::max(result, end_sharpness(network_.arcs[arc], end));
        }
        return result;
    }

    void remove(int index) {
        WorkingArc& arc = network_.arcs[index];
        for (int node : arc.nodes) {
            std::erase_if(stars_[node], [&](const auto& entry) { return entry.first == index; });
        }
        arc = WorkingArc{};
        arc.is_alive = false;
    }

    void move(int from, int to) {
        for (const auto& [arc, end] : stars_[from]) {
            const std::vector<Vec3> before = network_.arcs[arc].points;
            drag(network_.arcs[arc], end, network_.nodes[to].position);
            network_.refine(arc, spacing_);
            project(network_.arcs[arc], before);
            network_.arcs[arc].nodes[end] = to;
            stars_[to].emplace_back(arc, end);
        }
        stars_[from].clear();
        network_.nodes[from].is_alive = false;
    }

    void drag(WorkingArc& arc, int end, const Vec3& target) {
        const int count = static_cast<int>(arc.points.size());
        const auto at = [&](int k) { return end == 0 ? k : count - 1 - k; };
        const Vec3 displacement = target - arc.points[at(0)];
        const double whole = arc.length();
        const double reach = std::min(kDragReach * rmin_, arc.is_closed() ? whole / 2 : whole);
        double along = 0;
        Vec3 previous = arc.points[at(0)];
        for (int k = 1; k < count - 1; ++k) {
            const Vec3 original = arc.points[at(k)];
            along += (original - previous).norm();
            previous = original;
            if (along >= reach) break;
            const double x = along / reach;
            const double falloff = (1 - x) * (1 - x) * (1 + 2 * x);
            arc.points[at(k)] = original + falloff * displacement;
        }
        arc.points[at(0)] = target;
        arc.chain.clear();
        arc.orbit_classes.clear();
        arc.long_segment = -1;
        arc.is_short = false;
    }

    /// Brings every point that dragging moved or made back to the surface.
    void project(WorkingArc& arc, const std::vector<Vec3>& before) {
        std::set<std::array<double, 3>> untouched;
        for (const Vec3& p : before) untouched.insert({p.x(), p.y(), p.z()});
        for (std::size_t k = 1; k + 1 < arc.points.size(); ++k) {
            Vec3& p = arc.points[k];
            if (!untouched.contains({p.x(), p.y(), p.z()})) p = queries_.closest(p).position;
        }
    }

    WorkingNetwork& network_;
    double rmin_;
    double spacing_;
    const SurfaceQueries& queries_;
    std::vector<std::vector<std::pair<int, int>>> stars_;
};

bool has_feasible_star(const SegmentGraph& graph, const std::vector<int>& nodes, const Vec3& center,
                       const ScaleInterval& scale) {
    std::vector<Vec3> arms;
    for (int v : nodes) {
        for (int s : graph.incident[v]) {
            if (graph.segments[s].is_short) continue;
            const Vec3 arm = graph.nodes[graph.other_node(s, v)].position - center;
            const double length = arm.norm();
            if (length == 0) return false;
            arms.push_back(arm / length);
        }
    }
    for (std::size_t i = 0; i < arms.size(); ++i) {
        for (std::size_t j = i + 1; j < arms.size(); ++j) {
            const double angle = std::atan2(arms[i].cross(arms[j]).norm(), arms[i].dot(arms[j]));
            if (!scale.is_feasible_angle(angle)) return false;
        }
    }
    return true;
}

}  // namespace

int collapse_short_arcs(WorkingNetwork& network, std::vector<int> arcs, const ScaleInterval& scale,
                        const SurfaceQueries& queries) {
    std::map<int, double> length;
    for (int a : arcs) length[a] = network.arcs[a].length();
    std::ranges::sort(
        arcs, [&](int a, int b) { return std::pair(length[a], a) < std::pair(length[b], b); });
    Collapser collapser(network, scale, queries);
    int collapses = 0;
    for (int a : arcs) collapses += collapser.collapse(a);
    return collapses;
}

std::vector<int> find_collapsible_clusters(const WorkingNetwork& network, const NetworkGraph& graph,
                                           const std::vector<Conflict>& conflicts,
                                           const ScaleInterval& scale) {
    const SegmentGraph& g = graph.graph;
    std::map<int, std::vector<int>> nodes_of, shorts_of;
    for (int v = 0; v < static_cast<int>(g.nodes.size()); ++v) {
        if (g.nodes[v].cluster >= 0) nodes_of[g.nodes[v].cluster].push_back(v);
    }
    std::set<int> is_excluded;
    for (int s = 0; s < static_cast<int>(g.segments.size()); ++s) {
        if (!g.segments[s].is_short) continue;
        const int cluster = g.nodes[g.segments[s].nodes[0]].cluster;
        shorts_of[cluster].push_back(s);
        if (g.segments[s].is_pinned) is_excluded.insert(cluster);
    }
    for (const Conflict& conflict : conflicts) {
        for (int s : {conflict.first, conflict.second}) {
            if (g.segments[s].is_short) is_excluded.insert(g.nodes[g.segments[s].nodes[0]].cluster);
        }
    }
    const auto stars = network.stars();
    const auto sharpness = [&](int node) {
        double result = 0;
        for (const auto& [arc, end] : stars[node]) {
            result = std::max(result, end_sharpness(network.arcs[arc], end));
        }
        return result;
    };
    std::vector<int> result;
    for (const auto& [cluster, nodes] : nodes_of) {
        if (is_excluded.contains(cluster)) continue;
        double diameter = 0;
        int pinned = 0;
        int sharpest = nodes.front();
        for (int u : nodes) {
            pinned += g.nodes[u].pinned_valence > 0;
            const bool is_sharper =
                g.nodes[u].pinned_valence != g.nodes[sharpest].pinned_valence
                    ? g.nodes[u].pinned_valence > g.nodes[sharpest].pinned_valence
                    : sharpness(u) > sharpness(sharpest);
            if (is_sharper) sharpest = u;
            for (int v : nodes) {
                diameter = std::max(diameter, (g.nodes[u].position - g.nodes[v].position).norm());
            }
        }
        if (diameter >= scale.rmin || pinned > 1) continue;
        if (!has_feasible_star(g, nodes, g.nodes[sharpest].position, scale)) continue;
        for (int s : shorts_of[cluster]) result.push_back(g.segments[s].arc);
    }
    return result;
}

}  // namespace fcn
