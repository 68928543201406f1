// Conflict detection (paper sections 4.2 and 5.2.2). Candidate pairs come from a uniform grid, so
// the work is linear for bounded density. Paper mode: adjacent segments (also through one short
// segment) need a feasible angle; others closer than rmin need configuration (c) or (d), and never
// cross closer than h. Best mode asks for what strict conformity asks, pair by pair: distance h
// between segments, rmin between nodes, angles between adjacent ones, where the segments at one
// cluster of short segments count as adjacent because the cluster is about to collapse; two
// extraordinary nodes are left to vertex conflicts, since one of them may become regular instead.
// Best mode takes no angles at short segments: one that stays is fused and resampled first.

#include "adaptation/conflicts.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "adaptation/box_grid.h"

namespace fcn {

namespace {

/// Half the checker's tolerance: what passes here passes there whatever the rounding.
constexpr double kSlack = 1 - kScaleTolerance / 2;

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The pair's nodes at which it counts as adjacent; near_first == near_second if shared.
struct Adjacency {
    int near_first = -1;
    int near_second = -1;
};

class PairTest {
public:
    PairTest(const SegmentGraph& graph, const ScaleInterval& scale, const ConflictOptions& options)
        : graph_(graph), scale_(scale), options_(options) {}

    struct Finding {
        std::optional<Conflict> conflict;
        bool is_exempt = false;
        double distance = 0;
    };

    Finding test(int e, int f) const {
        return options_.mode == AdaptationMode::Paper ? test_paper(e, f) : test_best(e, f);
    }

private:
    const Vec3& at(int node) const { return graph_.nodes[node].position; }

    std::optional<Adjacency> adjacency(int e, int f) const {
        for (int u : graph_.segments[e].nodes) {
            for (int v : graph_.segments[f].nodes) {
                if (u == v) return Adjacency{u, u};
            }
        }
        std::optional<Adjacency> best;
        double nearest = scale_.rmin;
        for (int u : graph_.segments[e].nodes) {
            for (int v : graph_.segments[f].nodes) {
                const double distance = (at(u) - at(v)).norm();
                if (distance < nearest && is_joined(u, v)) {
                    nearest = distance;
                    best = Adjacency{u, v};
                }
            }
        }
        return best;
    }

    /// Through one short segment (paper) or one cluster of them (best mode).
    bool is_joined(int u, int v) const {
        if (graph_.nodes[u].cluster < 0 || graph_.nodes[u].cluster != graph_.nodes[v].cluster) {
            return false;
        }
        if (options_.mode == AdaptationMode::Best) return true;
        for (int s : graph_.incident[u]) {
            if (graph_.segments[s].is_short && graph_.other_node(s, u) == v) return true;
        }
        return false;
    }

    std::optional<Conflict> test_angle(int e, int f, const Adjacency& adjacent) const {
        const double angle = angle_between(graph_.direction(e, adjacent.near_first),
                                           graph_.direction(f, adjacent.near_second));
        if (scale_.is_feasible_angle(angle)) return std::nullopt;
        Conflict conflict;
        conflict.kind = ConflictKind::Angle;
        conflict.first = e;
        conflict.second = f;
        conflict.witness_first = at(adjacent.near_first);
        conflict.witness_second = at(adjacent.near_second);
        conflict.distance = (conflict.witness_first - conflict.witness_second).norm();
        conflict.angle = angle;
        return conflict;
    }

    SegmentDistance distance_of(int e, int f) const {
        const auto& a = graph_.segments[e].nodes;
        const auto& b = graph_.segments[f].nodes;
        return segment_distance(at(a[0]), at(a[1]), at(b[0]), at(b[1]));
    }

    Conflict make_distance_conflict(int e, int f, const SegmentDistance& d,
                                    ConflictKind kind) const {
        const auto& a = graph_.segments[e].nodes;
        const auto& b = graph_.segments[f].nodes;
        Conflict conflict;
        conflict.kind = kind;
        conflict.first = e;
        conflict.second = f;
        conflict.witness_first = (1 - d.s) * at(a[0]) + d.s * at(a[1]);
        conflict.witness_second = (1 - d.t) * at(b[0]) + d.t * at(b[1]);
        conflict.distance = d.distance;
        return conflict;
    }

    Finding judge(Conflict conflict) const {
        Finding finding;
        finding.distance = conflict.distance;
        finding.is_exempt = options_.is_thin_wall &&
                            options_.is_thin_wall(conflict.witness_first, conflict.witness_second);
        if (!finding.is_exempt) finding.conflict = conflict;
        return finding;
    }

    Finding test_paper(int e, int f) const {
        if (const auto adjacent = adjacency(e, f)) return {test_angle(e, f, *adjacent)};
        const SegmentDistance d = distance_of(e, f);
        if (d.distance >= scale_.rmin * kSlack) return {};
        constexpr double kInside = 1e-9;
        const bool is_interior =
            d.s > kInside && d.s < 1 - kInside && d.t > kInside && d.t < 1 - kInside;
        if (is_interior && d.distance < scale_.height) {
            return judge(make_distance_conflict(e, f, d, ConflictKind::Crossing));
        }
        if (has_configuration_c(e, f) || has_configuration_d(e, f)) return {};
        return judge(make_distance_conflict(e, f, d, ConflictKind::Distance));
    }

    bool is_apart(int u, int v) const { return (at(u) - at(v)).norm() >= scale_.rmin * kSlack; }

    /// Two triangles between the segments: both sides and one diagonal are long enough.
    bool has_configuration_c(int e, int f) const {
        const auto& a = graph_.segments[e].nodes;
        auto b = graph_.segments[f].nodes;
        const double straight = (at(a[0]) - at(b[0])).norm() + (at(a[1]) - at(b[1])).norm();
        const double crossed = (at(a[0]) - at(b[1])).norm() + (at(a[1]) - at(b[0])).norm();
        if (crossed < straight) std::swap(b[0], b[1]);
        return is_apart(a[0], b[0]) && is_apart(a[1], b[1]) &&
               (is_apart(a[0], b[1]) || is_apart(a[1], b[0]));
    }

    /// A connector of two end points that leaves room for two triangles at either segment.
    bool has_configuration_d(int e, int f) const {
        const double needed = 2 * scale_.triangle_alpha_min * (1 - kScaleTolerance);
        for (int u : graph_.segments[e].nodes) {
            for (int v : graph_.segments[f].nodes) {
                if (!is_apart(u, v)) continue;
                const Vec3 connector = at(v) - at(u);
                if (angle_between(graph_.direction(e, u), connector) >= needed &&
                    angle_between(graph_.direction(f, v), -connector) >= needed) {
                    return true;
                }
            }
        }
        return false;
    }

    Finding test_best(int e, int f) const {
        const bool has_short = graph_.segments[e].is_short || graph_.segments[f].is_short;
        if (const auto adjacent = adjacency(e, f)) {
            if (has_short) return {};
            if (auto conflict = test_angle(e, f, *adjacent)) return {conflict};
            return test_nodes(e, f, &*adjacent);
        }
        const SegmentDistance d = distance_of(e, f);
        if (d.distance < scale_.height * kSlack) {
            const Finding finding = judge(make_distance_conflict(e, f, d, ConflictKind::Distance));
            if (finding.conflict || has_short) return finding;
            const Finding nodes = test_nodes(e, f, nullptr);
            return nodes.conflict ? nodes : finding;
        }
        if (has_short) return {};
        return test_nodes(e, f, nullptr);
    }

    /// Distinct nodes of the two segments closer than rmin. Of an adjacent pair only the far ends
    /// count (and, at a shared node, each far end against the shared one is a length, not a pair).
    Finding test_nodes(int e, int f, const Adjacency* adjacent) const {
        Finding result;
        for (int u : graph_.segments[e].nodes) {
            if (adjacent && u == adjacent->near_first) continue;
            for (int v : graph_.segments[f].nodes) {
                if (adjacent && v == adjacent->near_second) continue;
                if (u == v) continue;
                if (graph_.nodes[u].is_extraordinary && graph_.nodes[v].is_extraordinary) continue;
                const double distance = (at(u) - at(v)).norm();
                if (distance >= scale_.rmin * kSlack) continue;
                Conflict conflict;
                conflict.kind = ConflictKind::Nodes;
                conflict.first = e;
                conflict.second = f;
                conflict.witness_first = at(u);
                conflict.witness_second = at(v);
                conflict.distance = distance;
                const Finding finding = judge(conflict);
                if (finding.conflict) return finding;
                result = finding;
            }
        }
        return result;
    }

    const SegmentGraph& graph_;
    const ScaleInterval& scale_;
    const ConflictOptions& options_;
};

struct SegmentFindings {
    std::vector<Conflict> conflicts, input_forced;
    std::vector<ExemptPair> exempt;
};

void find_edge_conflicts(const SegmentGraph& graph, const ScaleInterval& scale,
                         const ConflictOptions& options, ConflictResult& result) {
    const int count = static_cast<int>(graph.segments.size());
    std::vector<BoxGrid::Box> boxes(count);
    for (int s = 0; s < count; ++s) {
        const auto& ends = graph.segments[s].nodes;
        boxes[s] = BoxGrid::around(graph.nodes[ends[0]].position, graph.nodes[ends[1]].position, 0);
    }
    const BoxGrid grid(boxes, scale.rmax);
    const PairTest pair_test(graph, scale, options);
    std::vector<SegmentFindings> findings(count);
    tbb::parallel_for(tbb::blocked_range<int>(0, count, 64), [&](const auto& range) {
        std::vector<int> near;
        for (int e = range.begin(); e != range.end(); ++e) {
            BoxGrid::Box query = boxes[e];
            query.min.array() -= scale.rmin;
            query.max.array() += scale.rmin;
            grid.find(query, near);
            for (int f : near) {
                if (f <= e) continue;
                const auto finding = pair_test.test(e, f);
                if (finding.conflict) {
                    const bool is_forced =
                        graph.segments[e].is_pinned && graph.segments[f].is_pinned;
                    auto& list = is_forced ? findings[e].input_forced : findings[e].conflicts;
                    list.push_back(*finding.conflict);
                } else if (finding.is_exempt) {
                    findings[e].exempt.push_back({e, f, finding.distance});
                }
            }
        }
    });
    for (const SegmentFindings& found : findings) {
        result.conflicts.insert(result.conflicts.end(), found.conflicts.begin(),
                                found.conflicts.end());
        result.input_forced.insert(result.input_forced.end(), found.input_forced.begin(),
                                   found.input_forced.end());
        result.exempt.insert(result.exempt.end(), found.exempt.begin(), found.exempt.end());
    }
}

/// Pins can force two of their own nodes closer than rmin. A feature that ends at such a node would
/// take part in the violation, so it yields: in conflict with a pinned segment at the other node.
void find_conflicts_at_forced_nodes(const SegmentGraph& graph, const ScaleInterval& scale,
                                    const ConflictOptions& options, ConflictResult& result) {
    std::vector<int> pinned_segment(graph.nodes.size(), -1);
    for (int s = static_cast<int>(graph.segments.size()) - 1; s >= 0; --s) {
        if (!graph.segments[s].is_pinned) continue;
        for (int v : graph.segments[s].nodes) pinned_segment[v] = s;
    }
    std::vector<int> pinned;
    std::vector<BoxGrid::Box> boxes;
    for (int v = 0; v < static_cast<int>(graph.nodes.size()); ++v) {
        if (pinned_segment[v] < 0) continue;
        pinned.push_back(v);
        boxes.push_back({graph.nodes[v].position, graph.nodes[v].position});
    }
    const BoxGrid grid(boxes, scale.rmin);
    std::vector<int> near;
    for (int u : pinned) {
        const Vec3& position = graph.nodes[u].position;
        const bool has_feature = std::ranges::any_of(
            graph.incident[u], [&](int s) { return !graph.segments[s].is_pinned; });
        if (!has_feature) continue;
        grid.find(BoxGrid::around(position, position, scale.rmin), near);
        for (int k : near) {
            const int v = pinned[k];
            const double distance = (graph.nodes[v].position - position).norm();
            if (v == u || distance >= scale.rmin * kSlack) continue;
            if (options.is_thin_wall && options.is_thin_wall(position, graph.nodes[v].position)) {
                continue;
            }
            for (int s : graph.incident[u]) {
                if (graph.segments[s].is_pinned) continue;
                const auto [first, second] = std::minmax(s, pinned_segment[v]);
                result.conflicts.push_back({ConflictKind::Nodes, first, second, position,
                                            graph.nodes[v].position, distance, 0});
            }
            break;
        }
    }
    const auto order = [](const Conflict& c) { return std::pair(c.first, c.second); };
    std::ranges::stable_sort(result.conflicts, {}, order);
    const auto repeated = std::ranges::unique(result.conflicts, {}, order);
    result.conflicts.erase(repeated.begin(), repeated.end());
}

bool must_stay_extraordinary(const GraphNode& node) {
    return node.pinned_valence == 1 || node.pinned_valence >= 3;
}

void find_vertex_conflicts(const SegmentGraph& graph, const ScaleInterval& scale,
                           const ConflictOptions& options, ConflictResult& result) {
    std::vector<int> extraordinary;
    std::vector<BoxGrid::Box> boxes;
    for (int v = 0; v < static_cast<int>(graph.nodes.size()); ++v) {
        if (!graph.nodes[v].is_extraordinary || graph.incident[v].empty()) continue;
        extraordinary.push_back(v);
        boxes.push_back({graph.nodes[v].position, graph.nodes[v].position});
    }
    const BoxGrid grid(boxes, scale.rmin);
    std::vector<int> near;
    for (int i = 0; i < static_cast<int>(extraordinary.size()); ++i) {
        const int u = extraordinary[i];
        const Vec3& position = graph.nodes[u].position;
        grid.find(BoxGrid::around(position, position, scale.rmin), near);
        for (int k : near) {
            const int v = extraordinary[k];
            if (v <= u) continue;
            const double distance = (graph.nodes[v].position - position).norm();
            if (distance >= scale.rmin * kSlack) continue;
            if (must_stay_extraordinary(graph.nodes[u]) &&
                must_stay_extraordinary(graph.nodes[v])) {
                continue;
            }
            if (options.is_thin_wall && options.is_thin_wall(position, graph.nodes[v].position)) {
                continue;
            }
            result.vertex_conflicts.push_back({u, v, distance});
        }
    }
}

}  // namespace

SegmentDistance segment_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
    const Vec3 u = a1 - a0, v = b1 - b0, w = a0 - b0;
    const double a = u.squaredNorm(), b = u.dot(v), c = v.squaredNorm();
    const double d = u.dot(w), e = v.dot(w);
    const double determinant = a * c - b * b;
    SegmentDistance best;
    best.distance = std::numeric_limits<double>::infinity();
    const auto consider = [&](double s, double t) {
        const double distance = (w + s * u - t * v).norm();
        if (distance < best.distance) best = {distance, s, t};
    };
    // The minimum is interior to both, or at an end of one against the closest point of the other.
    if (determinant > 1e-14 * a * c) {
        const double s = (b * e - c * d) / determinant;
        const double t = (a * e - b * d) / determinant;
        if (s >= 0 && s <= 1 && t >= 0 && t <= 1) consider(s, t);
    }
    const auto on_b = [&](double s) { return c > 0 ? std::clamp((e + s * b) / c, 0.0, 1.0) : 0.0; };
    const auto on_a = [&](double t) { return a > 0 ? std::clamp((t * b - d) / a, 0.0, 1.0) : 0.0; };
    consider(0, on_b(0));
    consider(1, on_b(1));
    consider(on_a(0), 0);
    consider(on_a(1), 1);
    return best;
}

const char* to_string(ConflictKind kind) {
    switch (kind) {
        case ConflictKind::Angle:
            return "angle";
        case ConflictKind::Distance:
            return "distance";
        case ConflictKind::Crossing:
            return "crossing";
        case ConflictKind::Nodes:
            return "nodes";
    }
    return "";
}

ConflictResult detect_conflicts(const SegmentGraph& graph, const ScaleInterval& scale,
                                const ConflictOptions& options) {
    ConflictResult result;
    tbb::task_arena arena(std::max(1, options.threads));
    arena.execute([&] { find_edge_conflicts(graph, scale, options, result); });
    if (options.mode == AdaptationMode::Best) {
        find_conflicts_at_forced_nodes(graph, scale, options, result);
    }
    find_vertex_conflicts(graph, scale, options, result);
    return result;
}

}  // namespace fcn
