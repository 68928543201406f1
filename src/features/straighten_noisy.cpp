// Chains of sharp edges on a noisy mesh zigzag with its vertices, and are longer than the crease:
// by a fortieth at a noise of a tenth of an edge, by a tenth at twice that. They are smoothed as
// patch borders are (straighten.cpp), less strongly, since the chain knows better where it belongs,
// and without rounding corners: a place where the chains of some edges before and behind it turn
// more than anywhere near, and sharply, stays.

#include <cmath>

#include "features/sharp_edges.h"
#include "features/straighten.h"

namespace fcn {
namespace {

constexpr int kReach = 4;  // edges to either side, for the turning
constexpr double kCornerCosine = 0.7;
constexpr double kSmoothing = 5;
constexpr double kShift = 0.5;  // edges

/// Cosine of the turning at a sample of a chain; 1 near its ends.
double turning_cosine(const std::vector<Vec3>& points, int i, bool is_closed) {
    const int count = static_cast<int>(points.size()) - 1;
    if (count < 2 * kReach) return 1;
    if (!is_closed && (i < kReach || i + kReach > count)) return 1;
    const auto at = [&](int k) { return points[is_closed ? (k + count) % count : k]; };
    return (at(i) - at(i - kReach)).normalized().dot((at(i + kReach) - at(i)).normalized());
}

void hold_corners(const MeshArrays& arrays, const EdgeNetwork& edges, int arc,
                  std::vector<bool>& is_held) {
    std::vector<Vec3> points;
    for (int v : edges.arc_vertices[arc]) points.push_back(arrays.points[v]);
    const int count = static_cast<int>(points.size()) - 1;
    const bool is_closed = edges.network.arcs[arc].is_closed();
    std::vector<double> cosines;
    for (int i = 0; i <= count; ++i) cosines.push_back(turning_cosine(points, i, is_closed));
    for (int i = 0; i < count; ++i) {
        if (cosines[i] > kCornerCosine) continue;
        bool is_sharpest = true;
        for (int k = i - 2; k <= i + 2; ++k) {
            const int other = is_closed ? (k + count) % count : k;
            if (other < 0 || other > count) continue;
            if (cosines[other] < cosines[i]) is_sharpest = false;
        }
        if (is_sharpest) is_held[edges.arc_edges[arc][i]] = true;
    }
}

}  // namespace

FeatureCurveNetwork straighten_noisy(const MeshArrays& arrays, const RobustDihedrals& dihedrals,
                                     const EdgeNetwork& edges) {
    if (dihedrals.normals.empty()) return edges.network;
    std::vector<bool> is_held(arrays.edge_count());
    for (int e = 0; e < arrays.edge_count(); ++e) is_held[e] = !dihedrals.is_noisy_edge[e];
    for (std::size_t a = 0; a < edges.network.arcs.size(); ++a)
        hold_corners(arrays, edges, static_cast<int>(a), is_held);
    StraightenOptions options;
    options.smoothing = kSmoothing;
    options.max_shift = kShift;
    return straighten(arrays, edges, is_held, options);
}

}  // namespace fcn
