// Resampling chooses the nodes of an arc before it knows the conflicts, so a segment may be lost
// that another choice of nodes had saved, and a lost segment takes up to rmax with it. Refilling
// looks at the initial arcs again with the kept network held fixed: a best path over (coarsened)
// samples whose edges have lengths in S and are tested, each, against strict conformity with the
// network and with the edge before. What is found enters the next labeling as further segments,
// where the new arcs compete among each other; nothing that was kept is lost.

#include "adaptation/refill.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "adaptation/box_grid.h"
#include "adaptation/conflicts.h"
#include "adaptation/resampling.h"

namespace fcn {

namespace {

/// Spacing of candidate nodes, in rmin.
constexpr double kCandidateSpacing = 0.1;
/// A chord that strays from its arc by this much (mean, in rmin) is worth nothing.
constexpr double kWorthlessDeviation = 0.5;
constexpr double kSlack = 1 - kScaleTolerance / 2;

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

std::array<double, 3> key_of(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// The kept network as obstacles.
class Obstacles {
public:
    explicit Obstacles(const RefillInput& input)
        : graph_(input.graph->graph), scale_(input.scale), grid_(boxes(graph_), scale_.rmax) {
        for (std::size_t v = 0; v < input.network->nodes.size(); ++v) {
            if (input.network->nodes[v].is_alive && !graph_.incident[v].empty()) {
                node_at_[key_of(graph_.nodes[v].position)] = static_cast<int>(v);
            }
        }
    }

    /// The working node at exactly this position; -1 none.
    int node_at(const Vec3& p) const {
        const auto found = node_at_.find(key_of(p));
        return found == node_at_.end() ? -1 : found->second;
    }

    bool is_clear(const Vec3& p, std::vector<int>& near) const {
        grid_.find(BoxGrid::around(p, p, scale_.rmin), near);
        return std::ranges::all_of(near, [&](int s) { return allows(s, p, p, -1, -1); });
    }

    /// Whether a segment from a to b, attached at nodes (or -1), conforms with the network.
    bool is_clear(const Vec3& a, const Vec3& b, int node_a, int node_b,
                  std::vector<int>& near) const {
        grid_.find(BoxGrid::around(a, b, scale_.rmin), near);
        return std::ranges::all_of(near, [&](int s) { return allows(s, a, b, node_a, node_b); });
    }

private:
    static std::vector<BoxGrid::Box> boxes(const SegmentGraph& graph) {
        std::vector<BoxGrid::Box> result;
        for (const GraphSegment& s : graph.segments) {
            result.push_back(BoxGrid::around(graph.nodes[s.nodes[0]].position,
                                             graph.nodes[s.nodes[1]].position, 0));
        }
        return result;
    }

    bool allows(int s, const Vec3& a, const Vec3& b, int node_a, int node_b) const {
        const auto& ends = graph_.segments[s].nodes;
        bool is_adjacent = false;
        for (const auto& [shared, from, to] :
             {std::tuple(node_a, a, b), std::tuple(node_b, b, a)}) {
            if (shared < 0 || (ends[0] != shared && ends[1] != shared)) continue;
            if (is_adjacent) return false;  // both ends shared: a second segment beside s
            is_adjacent = true;
            if (!scale_.is_feasible_angle(angle_between(graph_.direction(s, shared), to - from))) {
                return false;
            }
        }
        for (int node : ends) {
            const Vec3& p = graph_.nodes[node].position;
            if (node != node_a && (p - a).norm() < scale_.rmin * kSlack) return false;
            if (node != node_b && (p - b).norm() < scale_.rmin * kSlack) return false;
        }
        if (is_adjacent) return true;
        return segment_distance(graph_.nodes[ends[0]].position, graph_.nodes[ends[1]].position, a,
                                b)
                   .distance >= scale_.height * kSlack;
    }

    const SegmentGraph& graph_;
    const ScaleInterval& scale_;
    BoxGrid grid_;
    std::map<std::array<double, 3>, int> node_at_;
};

struct Candidate {
    int sample = 0;
    int node = -1;  ///< existing node there
};

/// Best path through candidates; an edge joins candidates whose chord lies in S and is clear.
class PathSearch {
public:
    PathSearch(const RefillInput& input, const Obstacles& obstacles, const WorkingArc& arc)
        : input_(input), obstacles_(obstacles), arc_(arc) {
        prefix_.push_back(0);
        for (std::size_t k = 1; k < arc.points.size(); ++k) {
            prefix_.push_back(prefix_.back() + (arc.points[k] - arc.points[k - 1]).norm());
        }
        collect_candidates();
        collect_edges();
    }

    /// Samples of the best path; empty when there is none. `spans` asks for a path from the first
    /// to the last sample with three segments at least (a closed arc).
    std::vector<int> best(bool spans) const {
        std::vector<double> value(edges_.size(), -1);
        std::vector<int> previous(edges_.size(), -1), count(edges_.size(), 1);
        int best_edge = -1;
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const Edge& edge = edges_[e];
            const bool may_start = !spans || candidates_[edge.from].sample == 0;
            if (may_start) value[e] = edge.worth;
            for (int f : edges_into_[edge.from]) {
                if (value[f] < 0 || !continues(edges_[f], edge)) continue;
                if (value[f] + edge.worth > value[e]) {
                    value[e] = value[f] + edge.worth;
                    previous[e] = f;
                    count[e] = count[f] + 1;
                }
            }
            if (value[e] < 0) continue;
            const bool may_end =
                !spans || (candidates_[edge.to].sample == last_sample() && count[e] >= 3);
            if (may_end && (best_edge < 0 || value[e] > value[best_edge])) {
                best_edge = static_cast<int>(e);
            }
        }
        std::vector<int> samples;
        for (int e = best_edge; e >= 0; e = previous[e]) {
            if (samples.empty()) samples.push_back(candidates_[edges_[e].to].sample);
            samples.push_back(candidates_[edges_[e].from].sample);
        }
        std::ranges::reverse(samples);
        return samples;
    }

    /// Takes out every candidate within rmin of the path's stretch of the arc.
    void block(int first_sample, int last_sample) {
        const double from = prefix_[first_sample] - input_.scale.rmin;
        const double to = prefix_[last_sample] + input_.scale.rmin;
        std::erase_if(candidates_, [&](const Candidate& c) {
            return prefix_[c.sample] > from && prefix_[c.sample] < to;
        });
        collect_edges();
    }

private:
    struct Edge {
        int from = 0, to = 0;  ///< candidates
        double worth = 0;
    };

    int last_sample() const { return static_cast<int>(arc_.points.size()) - 1; }

    void collect_candidates() {
        std::vector<int> near;
        double due = 0;
        for (int k = 0; k <= last_sample(); ++k) {
            const int node = obstacles_.node_at(arc_.points[k]);
            if (node < 0 && prefix_[k] < due && k != last_sample()) continue;
            due = prefix_[k] + kCandidateSpacing * input_.scale.rmin;
            if (node >= 0 || obstacles_.is_clear(arc_.points[k], near)) {
                candidates_.push_back({k, node});
            }
        }
    }

    void collect_edges() {
        edges_.clear();
        edges_into_.assign(candidates_.size(), {});
        std::vector<int> near;
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            for (std::size_t j = i + 1; j < candidates_.size(); ++j) {
                const int a = candidates_[i].sample, b = candidates_[j].sample;
                const double along = prefix_[b] - prefix_[a];
                if (along > 2 * input_.scale.rmax) break;
                if (along < input_.scale.rmin) continue;
                const double chord = (arc_.points[b] - arc_.points[a]).norm();
                if (!input_.scale.contains(chord)) continue;
                const double stray = chord_deviation(arc_.points, a, b) /
                                     (along * kWorthlessDeviation * input_.scale.rmin);
                const double worth = input_.worth(arc_, a, b) * (1 - stray);
                if (worth <= 0 ||
                    !obstacles_.is_clear(arc_.points[a], arc_.points[b], candidates_[i].node,
                                         candidates_[j].node, near)) {
                    continue;
                }
                edges_into_[j].push_back(static_cast<int>(edges_.size()));
                edges_.push_back({static_cast<int>(i), static_cast<int>(j), worth});
            }
        }
    }

    bool continues(const Edge& first, const Edge& second) const {
        if (candidates_[first.to].node >= 0) return false;  // existing nodes only at the ends
        const Vec3& a = arc_.points[candidates_[first.from].sample];
        const Vec3& m = arc_.points[candidates_[first.to].sample];
        const Vec3& b = arc_.points[candidates_[second.to].sample];
        if (a == b) return false;
        return (a - b).norm() >= input_.scale.rmin * kSlack &&
               input_.scale.is_feasible_angle(angle_between(a - m, b - m));
    }

    const RefillInput& input_;
    const Obstacles& obstacles_;
    const WorkingArc& arc_;
    std::vector<double> prefix_;
    std::vector<Candidate> candidates_;
    std::vector<Edge> edges_;
    std::vector<std::vector<int>> edges_into_;
};

WorkingArc make_run(const WorkingArc& arc, const std::vector<int>& path,
                    const Obstacles& obstacles) {
    const int from = path.front(), to = path.back();
    WorkingArc run;
    run.points.assign(arc.points.begin() + from, arc.points.begin() + to + 1);
    run.sharpness.assign(arc.sharpness.begin() + from, arc.sharpness.begin() + to + 1);
    run.crease.assign(arc.crease.begin() + from, arc.crease.begin() + to + 1);
    run.origins.assign(arc.origins.begin() + from, arc.origins.begin() + to);
    for (int sample : path) run.chain.push_back(sample - from);
    run.nodes = {obstacles.node_at(run.points.front()), obstacles.node_at(run.points.back())};
    return run;
}

WorkingArc rotated(const WorkingArc& arc, int start) {
    WorkingNetwork holder;
    holder.nodes.resize(1);
    holder.arcs.push_back(arc);
    holder.arcs[0].nodes = {0, 0};
    holder.rotate_closed(0, start);
    return holder.arcs[0];
}

/// A closed arc of which nothing was kept: the whole loop from one of several starts.
std::optional<WorkingArc> refill_loop(const RefillInput& input, const Obstacles& obstacles,
                                      const WorkingArc& arc) {
    constexpr int kStarts = 8;
    const int distinct = static_cast<int>(arc.points.size()) - 1;
    double along = 0;
    double due = 0;
    for (int k = 0; k < distinct && along < input.scale.rmax; ++k) {
        if (along >= due) {
            due += input.scale.rmax / kStarts;
            const WorkingArc turned = rotated(arc, k);
            if (obstacles.node_at(turned.points.front()) >= 0) return std::nullopt;
            const std::vector<int> path = PathSearch(input, obstacles, turned).best(true);
            if (!path.empty()) {
                WorkingArc loop = make_run(turned, path, obstacles);
                loop.nodes = {-1, -1};
                return loop;
            }
        }
        along += (arc.points[k + 1] - arc.points[k]).norm();
    }
    return std::nullopt;
}

std::vector<WorkingArc> refill_arc(const RefillInput& input, const Obstacles& obstacles,
                                   const WorkingArc& arc) {
    std::vector<WorkingArc> result;
    const bool is_closed = arc.points.front() == arc.points.back();
    if (is_closed) {
        if (auto loop = refill_loop(input, obstacles, arc)) return {*loop};
    }
    PathSearch search(input, obstacles, arc);
    for (;;) {
        const std::vector<int> path = search.best(false);
        if (path.empty()) return result;
        WorkingArc run = make_run(arc, path, obstacles);
        const bool is_attached = run.nodes[0] >= 0 || run.nodes[1] >= 0;
        if (is_attached || run.length() >= input.min_length) result.push_back(std::move(run));
        search.block(path.front(), path.back());
    }
}

}  // namespace

std::vector<WorkingArc> find_refills(const RefillInput& input) {
    const Obstacles obstacles(input);
    const int count = static_cast<int>(input.initial->size());
    std::vector<std::vector<WorkingArc>> found(count);
    tbb::task_arena arena(std::max(1, input.threads));
    arena.execute([&] {
        tbb::parallel_for(0, count, [&](int a) {
            const WorkingArc& arc = (*input.initial)[a];
            if (arc.is_alive && arc.points.size() > 1) found[a] = refill_arc(input, obstacles, arc);
        });
    });
    std::vector<WorkingArc> result;
    for (auto& arcs : found) std::ranges::move(arcs, std::back_inserter(result));
    return result;
}

}  // namespace fcn
