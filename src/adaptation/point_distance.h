#pragma once

#include <algorithm>

#include "geometry/mesh.h"

namespace fcn {

/// Distance of a point from the closed segment [a, b].
inline double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 d = b - a;
    const double squared = d.squaredNorm();
    const double t = squared > 0 ? std::clamp((p - a).dot(d) / squared, 0.0, 1.0) : 0.0;
    return (p - a - t * d).norm();
}

}  // namespace fcn
