// Measures of DESIGN 4.12, by brute sampling: creases and network become points on a grid of cells,
// and every question is a nearest-point question. Shares nothing with the adaptation.

#include "visible_creases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>

#include "features/features.h"

namespace fcn::experiments {

namespace {

constexpr double kCreaseAngle = 40 * std::numbers::pi / 180;
constexpr double kIsolated = 1.5;  ///< in rmin
constexpr double kCovered = 0.5;   ///< in rmin
constexpr double kCrumb = 3;       ///< in rmin
constexpr double kWhole = 0.98;    ///< share of a curve that counts as all of it
constexpr double kSpacing = 0.1;   ///< of sample points, in rmin

struct Sample {
    Vec3 position = Vec3::Zero();
    int owner = -1;
    double length = 0;
    double along = 0;  ///< arc length from the start of the owner
};

/// Points by cells of a given size; queries reach one cell far at most.
class Cells {
public:
    Cells(const std::vector<Sample>& samples, double size) : samples_(samples), size_(size) {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            cells_[key(samples[i].position)].push_back(static_cast<int>(i));
        }
    }

    /// Whether a sample that passes `accept` lies within `radius` (at most one cell size).
    bool any_within(const Vec3& p, double radius,
                    const std::function<bool(const Sample&)>& accept) const {
        const auto center = key(p);
        for (int code = 0; code < 27; ++code) {
            const auto found = cells_.find(
                {center[0] + code % 3 - 1, center[1] + code / 3 % 3 - 1, center[2] + code / 9 - 1});
            if (found == cells_.end()) continue;
            for (int i : found->second) {
                if ((samples_[i].position - p).norm() <= radius && accept(samples_[i])) return true;
            }
        }
        return false;
    }

private:
    std::array<long, 3> key(const Vec3& p) const {
        return {std::lround(std::floor(p.x() / size_)), std::lround(std::floor(p.y() / size_)),
                std::lround(std::floor(p.z() / size_))};
    }

    const std::vector<Sample>& samples_;
    double size_;
    std::map<std::array<long, 3>, std::vector<int>> cells_;
};

void add_samples(const Vec3& a, const Vec3& b, double spacing, int owner, double along,
                 std::vector<Sample>& samples) {
    const double length = (b - a).norm();
    const int count = std::max(1, static_cast<int>(std::ceil(length / spacing)));
    for (int k = 0; k < count; ++k) {
        const double t = (k + 0.5) / count;
        samples.push_back({a + t * (b - a), owner, length / count, along + t * length});
    }
}

std::vector<Sample> arc_samples(const FeatureCurveNetwork& network, double spacing) {
    std::vector<Sample> samples;
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        const auto& points = network.arcs[a].samples;
        double along = 0;
        for (std::size_t k = 0; k + 1 < points.size(); ++k) {
            add_samples(points[k].position, points[k + 1].position, spacing, static_cast<int>(a),
                        along, samples);
            along += (points[k + 1].position - points[k].position).norm();
        }
    }
    return samples;
}

/// Owner: the connected piece the segment belongs to.
std::vector<Sample> segment_samples(const FeatureCurveNetwork& network, double spacing,
                                    std::vector<int>& piece_of_node) {
    piece_of_node.resize(network.nodes.size());
    std::iota(piece_of_node.begin(), piece_of_node.end(), 0);
    const auto root = [&](int v) {
        while (piece_of_node[v] != v) v = piece_of_node[v];
        return v;
    };
    for (const NetworkSegment& s : network.segments) {
        const int u = root(s.nodes[0]), v = root(s.nodes[1]);
        piece_of_node[std::max(u, v)] = std::min(u, v);
    }
    for (int& piece : piece_of_node) piece = root(piece);
    std::vector<Sample> samples;
    for (const NetworkSegment& s : network.segments) {
        add_samples(network.nodes[s.nodes[0]].position, network.nodes[s.nodes[1]].position, spacing,
                    piece_of_node[s.nodes[0]], 0, samples);
    }
    return samples;
}

/// Groups of arcs that count as "whole": each arc, each extended curve, each component.
std::vector<std::vector<int>> whole_things(const FeatureCurveNetwork& initial) {
    FeatureCurveNetwork with_curves = initial;
    find_curves(with_curves);
    std::vector<std::vector<int>> result;
    for (const NetworkCurve& curve : with_curves.curves) result.push_back(curve.arcs);
    std::vector<int> component(initial.nodes.size());
    std::iota(component.begin(), component.end(), 0);
    for (bool is_changing = true; is_changing;) {
        is_changing = false;
        for (const NetworkArc& arc : initial.arcs) {
            const int low = std::min(component[arc.nodes[0]], component[arc.nodes[1]]);
            for (int v : arc.nodes) {
                is_changing |= component[v] != low;
                component[v] = low;
            }
        }
    }
    std::map<int, std::vector<int>> arcs_of_component;
    for (std::size_t a = 0; a < initial.arcs.size(); ++a) {
        arcs_of_component[component[initial.arcs[a].nodes[0]]].push_back(static_cast<int>(a));
    }
    for (auto& [root, arcs] : arcs_of_component) result.push_back(std::move(arcs));
    return result;
}

}  // namespace

std::vector<IsolatedCrease> isolated_creases(const LoadedMesh& mesh,
                                             const FeatureCurveNetwork& network, double rmin) {
    SharpOptions options;
    options.high_angle = options.low_angle = kCreaseAngle;
    const FeatureCurveNetwork creases = detect_sharp(mesh, options);
    const std::vector<Sample> samples = arc_samples(creases, kSpacing * rmin);
    std::vector<int> pieces;
    // Sampled finely: the distance to the points may exceed that to the segments by 0.0001 rmin.
    const std::vector<Sample> covers = segment_samples(network, 0.02 * rmin, pieces);
    const Cells crease_cells(samples, kIsolated * rmin);
    const Cells cover_cells(covers, kCovered * rmin);
    std::vector<IsolatedCrease> of_arc(creases.arcs.size());
    std::vector<double> length_of;
    for (const NetworkArc& arc : creases.arcs) length_of.push_back(arc.length());
    for (const Sample& sample : samples) {
        const NetworkArc& arc = creases.arcs[sample.owner];
        const auto is_other = [&](const Sample& other) {
            if (other.owner != sample.owner) return true;
            double between = std::abs(other.along - sample.along);
            if (arc.is_closed()) between = std::min(between, length_of[sample.owner] - between);
            return between >= 2 * kIsolated * rmin;  // bends back to itself
        };
        if (crease_cells.any_within(sample.position, kIsolated * rmin, is_other)) {
            continue;
        }
        IsolatedCrease& crease = of_arc[sample.owner];
        crease.length += sample.length;
        if (cover_cells.any_within(sample.position, kCovered * rmin,
                                   [](const Sample&) { return true; })) {
            crease.covered += sample.length;
        } else {
            crease.uncovered_at = sample.position;
        }
    }
    std::erase_if(of_arc, [](const IsolatedCrease& c) { return c.length == 0; });
    return of_arc;
}

int count_crumbs(const FeatureCurveNetwork& initial, const FeatureCurveNetwork& network,
                 double rmin) {
    std::vector<int> piece_of_node;
    const std::vector<Sample> samples = segment_samples(network, 0.02 * rmin, piece_of_node);
    std::map<int, double> length;
    for (const NetworkSegment& s : network.segments) {
        length[piece_of_node[s.nodes[0]]] +=
            (network.nodes[s.nodes[0]].position - network.nodes[s.nodes[1]].position).norm();
    }
    for (const NetworkArc& arc : network.arcs) {
        if (arc.pin == Pin::Keep) length.erase(piece_of_node[arc.nodes[0]]);
    }
    std::erase_if(length, [&](const auto& entry) { return entry.second >= kCrumb * rmin; });
    if (length.empty()) return 0;
    const Cells cells(samples, kCovered * rmin);
    const std::vector<Sample> initial_samples = arc_samples(initial, kSpacing * rmin);
    std::map<int, std::vector<const Sample*>> samples_of_arc;
    for (const Sample& sample : initial_samples) samples_of_arc[sample.owner].push_back(&sample);
    for (const std::vector<int>& arcs : whole_things(initial)) {
        std::map<int, double> covered;
        double total = 0;
        for (int a : arcs) {
            for (const Sample* sample : samples_of_arc[a]) {
                total += sample->length;
                for (const auto& [piece, ignored] : length) {
                    if (cells.any_within(sample->position, kCovered * rmin,
                                         [&](const Sample& s) { return s.owner == piece; })) {
                        covered[piece] += sample->length;
                    }
                }
            }
        }
        for (const auto& [piece, share] : covered) {
            if (share >= kWhole * total) length.erase(piece);
        }
    }
    return static_cast<int>(length.size());
}

}  // namespace fcn::experiments
