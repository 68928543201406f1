// Curves as they are drawn. Segments are chords and leave the surface between their nodes; they are
// drawn as their closest points on the surface, so that they neither vanish in it nor hover: what
// is seen is the polygon that the remesher gets.
#include "report/drawn_curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fcn {
namespace {

double distance_to_chord(const Vec3& point, const Vec3& from, const Vec3& to) {
    const Vec3 along = to - from;
    const double square = along.squaredNorm();
    const double t = square > 0 ? std::clamp((point - from).dot(along) / square, 0.0, 1.0) : 0;
    return (point - from - t * along).norm();
}

}  // namespace

bool is_pinned(const NetworkArc& arc) {
    return arc.kind != ArcKind::Feature || arc.pin == Pin::Keep;
}

Polyline polyline_of(const NetworkArc& arc) {
    Polyline points;
    for (const ArcSample& sample : arc.samples) points.push_back(sample.position);
    return points;
}

Polyline chord_on_surface(const Vec3& from, const Vec3& to, const SurfaceQueries& surface,
                          int pieces) {
    const double reach = 0.3 * (to - from).norm();
    Polyline points;
    for (int i = 0; i <= pieces; ++i) {
        const double t = static_cast<double>(i) / pieces;
        const Vec3 chord = (1 - t) * from + t * to;
        const ClosestPoint closest = surface.closest(chord);
        points.push_back(closest.distance <= reach ? closest.position : chord);
    }
    return points;
}

Polyline laid_on_surface(const Polyline& points, const SurfaceQueries& surface, double finest) {
    Polyline result;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double length = (points[i] - points[i - 1]).norm();
        const int pieces = static_cast<int>(std::clamp(std::ceil(length / finest), 1.0, 1000.0));
        const Polyline laid = chord_on_surface(points[i - 1], points[i], surface, pieces);
        result.insert(result.end(), laid.begin() + (i > 1 ? 1 : 0), laid.end());
    }
    return result;
}

Polyline simplified(const Polyline& points, double tolerance) {
    if (points.size() < 3) return points;
    // Douglas and Peucker's halving, on a stack of its own: arcs can have very many samples.
    std::vector<bool> is_left(points.size(), false);
    is_left.front() = is_left.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        std::size_t farthest = first;
        double distance = tolerance;
        for (std::size_t i = first + 1; i < last; ++i) {
            const double d = distance_to_chord(points[i], points[first], points[last]);
            if (d > distance) {
                distance = d;
                farthest = i;
            }
        }
        if (farthest == first) continue;
        is_left[farthest] = true;
        open.emplace_back(first, farthest);
        open.emplace_back(farthest, last);
    }
    Polyline result;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_left[i]) result.push_back(points[i]);
    return result;
}

PictureLayer quad_edges(const QuadMesh& mesh) {
    PictureLayer layer{{}, {70, 80, 95}, 1};
    const std::vector<int> opposite = opposite_halfedges(mesh);
    for (std::size_t h = 0; h < opposite.size(); ++h) {
        if (opposite[h] > static_cast<int>(h)) continue;
        const auto& face = mesh.faces[h / 4];
        layer.polylines.push_back({mesh.points[static_cast<std::size_t>(face[h % 4])],
                                   mesh.points[static_cast<std::size_t>(face[(h + 1) % 4])]});
    }
    return layer;
}

}  // namespace fcn
