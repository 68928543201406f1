// A seed that is meant for a crease is rarely on it, and a wire that leaves the crease to visit the
// seed has a spur there. So seeds move to the feature beside them. Among edges that are equally
// cheap the closest is taken.

#include <algorithm>
#include <set>
#include <tuple>

#include "features/triangle_point.h"
#include "features/wire_network.h"

namespace fcn {
namespace {

constexpr double kClearlyCheaper = 0.5;
constexpr double kCostStep = 0.05;  ///< costs within one step of each other count as equal
constexpr std::size_t kMostFaces = 2000;

/// Faces around a seed that come within the radius, nearest rings first.
std::vector<int> faces_within(const MeshArrays& arrays, int face, const Vec3& seed, double radius) {
    std::vector<int> faces{face};
    std::set<int> seen{face};
    for (std::size_t k = 0; k < faces.size() && faces.size() < kMostFaces; ++k) {
        for (int next : arrays.face_neighbors[faces[k]]) {
            if (next < 0 || !seen.insert(next).second) continue;
            const auto [a, b, c] = arrays.face_vertices[next];
            const Vec3& p = arrays.points[a];
            const Vec3& q = arrays.points[b];
            const Vec3& r = arrays.points[c];
            const Vec3 t = closest_barycentric(seed, p, q, r);
            if ((t[0] * p + t[1] * q + t[2] * r - seed).norm() <= radius) faces.push_back(next);
        }
    }
    return faces;
}

}  // namespace

SurfacePoint snapped_seed(const MeshArrays& arrays, const WireMetric& metric,
                          const SurfacePoint& seed, double radius) {
    const auto& corners = arrays.face_vertices[seed.face];
    Vec3 position = Vec3::Zero();
    for (int i = 0; i < 3; ++i) position += seed.barycentric[i] * arrays.points[corners[i]];
    const double limit = kClearlyCheaper / metric.gain(seed.face);
    using Rank = std::tuple<int, double, int>;  // cost in steps, distance, edge
    Rank best{1 << 30, 0, -1};
    SurfacePoint result = seed;
    for (int face : faces_within(arrays, seed.face, position, radius)) {
        for (int i = 0; i < 3; ++i) {
            const int edge = arrays.face_edges[face][i];
            if (metric.along(edge) > limit) continue;
            const Vec3& a = arrays.points[arrays.face_vertices[face][i]];
            const Vec3 u = arrays.points[arrays.face_vertices[face][(i + 1) % 3]] - a;
            if (!(u.squaredNorm() > 0)) continue;
            const double t = std::clamp((position - a).dot(u) / u.squaredNorm(), 0.0, 1.0);
            const double distance = (a + t * u - position).norm();
            const Rank rank{static_cast<int>(metric.along(edge) / kCostStep), distance, edge};
            if (distance > radius || rank >= best) continue;
            best = rank;
            result.face = face;
            result.barycentric.setZero();
            result.barycentric[i] = 1 - t;
            result.barycentric[(i + 1) % 3] = t;
        }
    }
    return result;
}

}  // namespace fcn
