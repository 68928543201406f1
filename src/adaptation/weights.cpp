// Segment weights and pair bonuses (paper section 5.3.1). Paper mode takes the product
// I L Sym Loop as printed. Best mode departs where the sum over segments misleads: a weight is
// proportional to the segment's length (else finer sampling earns more), curve length enters by
// its root in units of rmin, and creases of 40 degrees and more carry a contrast factor; bonuses
// are multiplied by the pair's smaller sharpness, so that many smooth joints cannot outvote one
// crease, and by 1/100, so that lambda0 = 100 makes a joint worth what a segment of length rmin is.
// (At 100 times that, long smooth chains displace more than they cover.)

#include "adaptation/weights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "adaptation/box_grid.h"

namespace fcn {

namespace {

/// Best mode's unit of lambda0 and lambda1.
constexpr double kBestBonus = 0.01;

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Factor on a bonus: 1 in paper mode.
double pair_sharpness(const SegmentAttributes& a, const SegmentAttributes& b,
                      const AdaptationOptions& options) {
    if (options.mode == AdaptationMode::Paper) return 1.0;
    return kBestBonus * std::min(a.sharpness * a.contrast, b.sharpness * b.contrast);
}

void add_smoothness(const SegmentGraph& graph, const std::vector<SegmentAttributes>& attributes,
                    const AdaptationOptions& options, std::map<std::pair<int, int>, double>& sums) {
    if (options.lambda0 <= 0) return;
    for (int v = 0; v < static_cast<int>(graph.nodes.size()); ++v) {
        const std::vector<int>& star = graph.incident[v];
        for (std::size_t i = 0; i < star.size(); ++i) {
            for (std::size_t j = i + 1; j < star.size(); ++j) {
                if (star[i] == star[j]) continue;
                const double gamma =
                    angle_between(-graph.direction(star[i], v), graph.direction(star[j], v));
                const double a = smoothness(gamma, options.smooth_power);
                if (a <= 0) continue;
                const auto key = std::minmax(star[i], star[j]);
                sums[{key.first, key.second}] +=
                    options.lambda0 * a *
                    pair_sharpness(attributes[star[i]], attributes[star[j]], options);
            }
        }
    }
}

void add_orthogonality(const SegmentGraph& graph, const std::vector<SegmentAttributes>& attributes,
                       const std::vector<std::pair<int, int>>& excluded, const ScaleInterval& scale,
                       const AdaptationOptions& options,
                       std::map<std::pair<int, int>, double>& sums) {
    const int count = static_cast<int>(graph.segments.size());
    const double radius = options.ortho_radius * scale.rmax;
    std::vector<Vec3> midpoints(count);
    std::vector<BoxGrid::Box> boxes(count);
    for (int s = 0; s < count; ++s) {
        const auto& ends = graph.segments[s].nodes;
        midpoints[s] = (graph.nodes[ends[0]].position + graph.nodes[ends[1]].position) / 2;
        boxes[s] = {midpoints[s], midpoints[s]};
    }
    const BoxGrid grid(boxes, radius);
    std::vector<int> near;
    for (int e = 0; e < count; ++e) {
        grid.find(BoxGrid::around(midpoints[e], midpoints[e], radius), near);
        const Vec3 along = graph.direction(e, graph.segments[e].nodes[0]);
        for (int f : near) {
            if (f <= e || (midpoints[f] - midpoints[e]).norm() >= radius) continue;
            if (std::binary_search(excluded.begin(), excluded.end(), std::pair(e, f))) continue;
            const Vec3 other = graph.direction(f, graph.segments[f].nodes[0]);
            const double a = orthogonality(angle_between(along, other), options.smooth_power);
            const double value =
                options.lambda1 * a * pair_sharpness(attributes[e], attributes[f], options);
            if (value > 0) sums[{e, f}] += value;
        }
    }
}

}  // namespace

double crease_contrast(double dihedral) {
    // The step at 40 degrees is what lets a crease above it win against several just below it.
    constexpr double kDegree = std::numbers::pi / 180;
    constexpr double kLow = 20 * kDegree, kCrease = 40 * kDegree;
    constexpr double kBelow = 3, kAbove = 30;
    const double angle = std::abs(dihedral);
    if (angle >= kCrease * (1 - 1e-9)) return kAbove;
    return std::pow(kBelow, std::clamp((angle - kLow) / (kCrease - kLow), 0.0, 1.0));
}

double segment_weight(const SegmentAttributes& attributes, const ScaleInterval& scale,
                      const AdaptationOptions& options) {
    const double symmetry = attributes.is_symmetric ? options.alpha_sym : 1.0;
    const double loop = attributes.is_on_loop ? options.alpha_loop : 1.0;
    if (options.mode == AdaptationMode::Paper) {
        return attributes.sharpness * attributes.curve_length * symmetry * loop;
    }
    return attributes.sharpness * attributes.contrast *
           std::sqrt(attributes.curve_length / scale.rmin) * symmetry * loop * attributes.length /
           scale.rmin;
}

double smoothness(double gamma, double power) {
    if (gamma > std::numbers::pi / 4) return 0.0;
    return std::pow(std::max(0.0, std::cos(2 * gamma)), power);
}

double orthogonality(double gamma, double power) {
    return std::pow(std::abs(std::cos(2 * gamma)), 2 * power);
}

std::vector<PairBonus> pair_bonuses(const SegmentGraph& graph,
                                    const std::vector<SegmentAttributes>& attributes,
                                    const std::vector<std::pair<int, int>>& excluded,
                                    const ScaleInterval& scale, const AdaptationOptions& options) {
    std::map<std::pair<int, int>, double> sums;
    add_smoothness(graph, attributes, options, sums);
    if (options.lambda1 > 0) {
        add_orthogonality(graph, attributes, excluded, scale, options, sums);
    }
    std::vector<PairBonus> result;
    result.reserve(sums.size());
    for (const auto& [pair, value] : sums) result.push_back({pair.first, pair.second, value});
    return result;
}

}  // namespace fcn
