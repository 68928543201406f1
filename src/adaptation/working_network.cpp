#include "adaptation/working_network.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fcn {

double WorkingArc::length() const {
    double total = 0;
    for (std::size_t k = 1; k < points.size(); ++k) total += (points[k] - points[k - 1]).norm();
    return total;
}

std::vector<std::vector<std::pair<int, int>>> WorkingNetwork::stars() const {
    std::vector<std::vector<std::pair<int, int>>> result(nodes.size());
    for (int a = 0; a < static_cast<int>(arcs.size()); ++a) {
        if (!arcs[a].is_alive) continue;
        for (int end = 0; end < 2; ++end) result[arcs[a].nodes[end]].emplace_back(a, end);
    }
    return result;
}

void WorkingNetwork::reverse(int index) {
    WorkingArc& arc = arcs[index];
    const int last = static_cast<int>(arc.points.size()) - 1;
    std::reverse(arc.points.begin(), arc.points.end());
    std::reverse(arc.origins.begin(), arc.origins.end());
    std::reverse(arc.sharpness.begin(), arc.sharpness.end());
    std::reverse(arc.crease.begin(), arc.crease.end());
    std::reverse(arc.orbit_classes.begin(), arc.orbit_classes.end());
    std::reverse(arc.chain.begin(), arc.chain.end());
    for (int& sample : arc.chain) sample = last - sample;
    if (arc.long_segment >= 0) arc.long_segment = arc.segment_count() - 1 - arc.long_segment;
    std::swap(arc.nodes[0], arc.nodes[1]);
}

int WorkingNetwork::join(int node, int first_arc, int first_end, int second_arc, int second_end,
                         bool must_resample) {
    if (first_end == 0) reverse(first_arc);
    if (second_end == 1) reverse(second_arc);
    WorkingArc& a = arcs[first_arc];
    WorkingArc& b = arcs[second_arc];
    const int offset = static_cast<int>(a.points.size()) - 1;
    const bool keeps_chain = !must_resample && !a.is_short && !b.is_short && !a.chain.empty() &&
                             !b.chain.empty() && (a.long_segment < 0 || b.long_segment < 0);
    if (keeps_chain) {
        if (b.long_segment >= 0) a.long_segment = a.segment_count() + b.long_segment;
        if (!a.orbit_classes.empty() || !b.orbit_classes.empty()) {
            a.orbit_classes.resize(a.segment_count(), -1);
            b.orbit_classes.resize(b.segment_count(), -1);
            a.orbit_classes.insert(a.orbit_classes.end(), b.orbit_classes.begin(),
                                   b.orbit_classes.end());
        }
        for (std::size_t k = 1; k < b.chain.size(); ++k) a.chain.push_back(b.chain[k] + offset);
    } else {
        a.chain.clear();
        a.orbit_classes.clear();
        a.long_segment = -1;
        a.is_short = false;
    }
    a.points.insert(a.points.end(), b.points.begin() + 1, b.points.end());
    a.origins.insert(a.origins.end(), b.origins.begin(), b.origins.end());
    a.sharpness.insert(a.sharpness.end(), b.sharpness.begin() + 1, b.sharpness.end());
    a.crease.insert(a.crease.end(), b.crease.begin() + 1, b.crease.end());
    a.nodes[1] = b.nodes[1];
    b = WorkingArc{};
    b.is_alive = false;
    nodes[node].is_alive = false;
    return first_arc;
}

void WorkingNetwork::refine(int index, double spacing) {
    WorkingArc& arc = arcs[index];
    WorkingArc fine;
    for (std::size_t k = 0; k < arc.points.size(); ++k) {
        const int pieces =
            k == 0 ? 1
                   : std::max(1, static_cast<int>(std::ceil(
                                     (arc.points[k] - arc.points[k - 1]).norm() / spacing - 1e-9)));
        for (int i = 1; i <= pieces; ++i) {
            const double t = static_cast<double>(i) / pieces;
            const std::size_t before = k == 0 ? 0 : k - 1;
            const bool is_given = i == pieces;
            fine.points.push_back(
                is_given ? arc.points[k] : Vec3((1 - t) * arc.points[before] + t * arc.points[k]));
            fine.sharpness.push_back((1 - t) * arc.sharpness[before] + t * arc.sharpness[k]);
            fine.crease.push_back((1 - t) * arc.crease[before] + t * arc.crease[k]);
            if (k > 0) fine.origins.push_back(arc.origins[before]);
        }
    }
    arc.points = std::move(fine.points);
    arc.sharpness = std::move(fine.sharpness);
    arc.crease = std::move(fine.crease);
    arc.origins = std::move(fine.origins);
}

int WorkingNetwork::add_node(const Vec3& position) {
    nodes.push_back({position});
    return static_cast<int>(nodes.size()) - 1;
}

void WorkingNetwork::remove_arc(int index) {
    arcs[index] = WorkingArc{};
    arcs[index].is_alive = false;
}

void WorkingNetwork::rotate_closed(int index, int start) {
    if (start == 0) return;
    WorkingArc& arc = arcs[index];
    const auto rotate_repeating = [start](auto& values) {
        values.pop_back();
        std::rotate(values.begin(), values.begin() + start, values.end());
        values.push_back(values.front());
    };
    rotate_repeating(arc.points);
    rotate_repeating(arc.sharpness);
    rotate_repeating(arc.crease);
    std::rotate(arc.origins.begin(), arc.origins.begin() + start, arc.origins.end());
    nodes[arc.nodes[0]].position = arc.points.front();
}

NetworkGraph make_graph(const WorkingNetwork& network) {
    NetworkGraph result;
    SegmentGraph& graph = result.graph;
    graph.nodes.resize(network.nodes.size());
    for (std::size_t v = 0; v < network.nodes.size(); ++v) {
        graph.nodes[v].position = network.nodes[v].position;
    }
    for (int a = 0; a < static_cast<int>(network.arcs.size()); ++a) {
        const WorkingArc& arc = network.arcs[a];
        if (!arc.is_alive) continue;
        int previous = arc.nodes[0];
        for (int k = 0; k < arc.segment_count(); ++k) {
            int next = arc.nodes[1];
            if (k + 1 < arc.segment_count()) {
                next = static_cast<int>(graph.nodes.size());
                graph.nodes.push_back({});
                graph.nodes.back().position = arc.points[arc.chain[k + 1]];
            }
            GraphSegment segment;
            segment.nodes = {previous, next};
            segment.is_short = arc.is_short;
            segment.is_long = k == arc.long_segment;
            segment.is_pinned = arc.is_pinned;
            segment.arc = a;
            segment.position = k;
            graph.segments.push_back(segment);
            result.sources.push_back({a, k, arc.chain[k], arc.chain[k + 1]});
            previous = next;
        }
    }
    graph.connect();
    return result;
}

double sample_spacing(const ScaleInterval& scale) {
    return std::min(scale.rmin / 50, (scale.rmax - scale.rmin) / 4);
}

namespace {

/// Drops corners that a quarter of the spacing makes redundant: close to the last kept one and
/// within a twentieth of the spacing of a straight line to the next. Of a tiny arc all stay: alone
/// or with another it may be a loop, which with fewer than three corners would be none.
std::vector<int> corners_to_keep(const std::vector<ArcSample>& samples, double spacing) {
    std::vector<int> kept{0};
    const int last = static_cast<int>(samples.size()) - 1;
    for (int k = 1; k < last; ++k) {
        const Vec3& a = samples[kept.back()].position;
        const Vec3& p = samples[k].position;
        const Vec3& b = samples[k + 1].position;
        if ((p - a).norm() < spacing / 4) {
            const Vec3 axis = b - a;
            const double squared = axis.squaredNorm();
            const double t = squared > 0 ? std::clamp((p - a).dot(axis) / squared, 0.0, 1.0) : 0;
            if ((p - a - t * axis).norm() < spacing * 0.05) continue;
        }
        kept.push_back(k);
    }
    kept.push_back(last);
    if (kept.size() < 4) {
        kept.resize(samples.size());
        std::iota(kept.begin(), kept.end(), 0);
    }
    return kept;
}

}  // namespace

std::vector<Vec3> densify(const std::vector<ArcSample>& samples, double spacing) {
    std::vector<Vec3> result;
    const std::vector<int> kept = corners_to_keep(samples, spacing);
    result.push_back(samples.front().position);
    for (std::size_t k = 1; k < kept.size(); ++k) {
        const Vec3& a = samples[kept[k - 1]].position;
        const Vec3& b = samples[kept[k]].position;
        const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
        for (int i = 1; i <= pieces; ++i) {
            const double t = static_cast<double>(i) / pieces;
            result.push_back(i == pieces ? b : Vec3((1 - t) * a + t * b));
        }
    }
    return result;
}

std::vector<int> resample_arcs(WorkingNetwork& network, const ScaleInterval& scale, int threads) {
    std::vector<int> pending;
    for (int a = 0; a < static_cast<int>(network.arcs.size()); ++a) {
        if (network.arcs[a].needs_resampling()) pending.push_back(a);
    }
    std::vector<int> valence(network.nodes.size(), 0);
    for (const WorkingArc& arc : network.arcs) {
        if (!arc.is_alive) continue;
        ++valence[arc.nodes[0]];
        ++valence[arc.nodes[1]];
    }
    std::vector<Resampling> results(pending.size());
    tbb::task_arena arena(std::max(1, threads));
    arena.execute([&] {
        tbb::parallel_for(std::size_t{0}, pending.size(), [&](std::size_t i) {
            const WorkingArc& arc = network.arcs[pending[i]];
            ResamplingOptions options;
            options.is_start_fixed = arc.is_closed() && valence[arc.nodes[0]] > 2;
            results[i] = resample_arc(arc.points, arc.is_closed(), scale, options);
        });
    });
    std::vector<int> unrepresentable;
    for (std::size_t i = 0; i < pending.size(); ++i) {
        WorkingArc& arc = network.arcs[pending[i]];
        const Resampling& resampling = results[i];
        if (resampling.is_unrepresentable) {
            unrepresentable.push_back(pending[i]);
            continue;
        }
        network.rotate_closed(pending[i], resampling.start);
        arc.chain = resampling.chain;
        for (int& sample : arc.chain) sample -= resampling.start;
        arc.long_segment = resampling.long_segment;
        arc.is_short = resampling.is_short;
        arc.orbit_classes.clear();
    }
    return unrepresentable;
}

}  // namespace fcn
