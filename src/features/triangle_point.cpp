// The closest point of a triangle is the foot of the perpendicular where that lies inside, else
// the closest point of one of the three sides.

#include "features/triangle_point.h"

#include <algorithm>
#include <limits>

namespace fcn {

Vec3 closest_barycentric(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = (b - a).cross(c - a);
    const double squared = normal.squaredNorm();
    if (squared > 0) {
        const double u = (c - b).cross(point - b).dot(normal) / squared;
        const double v = (a - c).cross(point - c).dot(normal) / squared;
        const double w = 1 - u - v;
        if (u >= 0 && v >= 0 && w >= 0) return {u, v, w};
    }
    const Vec3 corners[3] = {a, b, c};
    Vec3 best = Vec3::Zero();
    double best_distance = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        const Vec3& from = corners[i];
        const Vec3 side = corners[(i + 1) % 3] - from;
        const double length = side.squaredNorm();
        const double t = length > 0 ? std::clamp((point - from).dot(side) / length, 0.0, 1.0) : 0;
        const double distance = (from + t * side - point).squaredNorm();
        if (distance >= best_distance) continue;
        best_distance = distance;
        best = Vec3::Zero();
        best[i] = 1 - t;
        best[(i + 1) % 3] = t;
    }
    return best;
}

}  // namespace fcn
