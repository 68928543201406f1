#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/mesh.h"

namespace fcn {

/// Unit normal of a triangle; zero where degenerate.
inline Vec3 triangle_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 cross = (b - a).cross(c - a);
    const double norm = cross.norm();
    return norm > 0 ? Vec3(cross / norm) : Vec3(Vec3::Zero());
}

/// Cosine of a triangle's smallest angle, [0.5, 1]; 1 where degenerate. Smaller is better.
inline double cosine_of_smallest_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
    double x = (b - a).squaredNorm(), y = (c - b).squaredNorm(), z = (a - c).squaredNorm();
    if (x > y) std::swap(x, y);
    if (x > z) std::swap(x, z);  // x: the shortest side, across from the smallest angle
    const double product = y * z;
    return product > 0 && x > 0 ? std::min(1.0, (y + z - x) / (2 * std::sqrt(product))) : 1.0;
}

/// Smallest altitude over longest side, [0, 0.866]; 0 where degenerate.
inline double flatness_quality(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return longest > 0 ? (b - a).cross(c - a).norm() / longest : 0;
}

/// Radians at p.
inline double angle_at(const Vec3& p, const Vec3& a, const Vec3& b) {
    return std::atan2((a - p).cross(b - p).norm(), (a - p).dot(b - p));
}

/// A vertex with less than that around it, three times 30 degrees, is the tip of a spike: one of
/// its triangles has an angle under 30 degrees.
constexpr double kSpikeAngle = 1.5707963267948966;

}  // namespace fcn
