// Distances and angle bounds of the conformity checker, from first principles.
//
// Angle bounds. An angle of a triangle with sides a, b and opposite side c has
// cos = (a^2 + b^2 - c^2) / (2ab). Over the box of admissible lengths this is monotone in c, and
// in a (for fixed b, c) of the form a/(2b) + (b^2 - c^2)/(2ab): monotone if b <= c and convex if
// b >= c. So its maximum, the smallest angle, lies at a corner of the box. Its minimum, the largest
// angle, has c = c_max >= a, b, where it is monotone: a corner again. Trying the eight corners
// therefore gives both extremes; a corner that violates the triangle inequality stands for a
// straight angle, as the bound is reached before it. The triangle's box is [1, rho]^3 (DESIGN 4.1;
// paper section 4.1); a quad's corner lies between two sides in [1, rho] and faces a diagonal in
// sqrt(2) [1, rho]. DESIGN 4.1 writes the same numbers in closed form.
//
// Segment distance. The distance of two segments is attained either at the common perpendicular of
// their lines, if its feet lie on both, or at an end point of one of them. All five candidates are
// real pairs of points, so that rounding (nearly parallel lines) can spoil a candidate but never
// the answer: the end points remain.

#include "adaptation/conformity_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fcn::conformity {

Vec3 closest_on_segment(const Vec3& point, const Vec3& a0, const Vec3& a1) {
    const Vec3 direction = a1 - a0;
    const double square = direction.squaredNorm();
    if (square == 0) return a0;
    const double t = (point - a0).dot(direction) / square;
    if (t <= 0) return a0;
    if (t >= 1) return a1;
    return a0 + t * direction;
}

SegmentDistance segment_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
    SegmentDistance best;
    best.distance = std::numeric_limits<double>::infinity();
    const auto offer = [&](const Vec3& first, const Vec3& second) {
        const double distance = (first - second).norm();
        if (distance < best.distance) best = {distance, first, second};
    };
    const Vec3 u = a1 - a0;
    const Vec3 v = b1 - b0;
    const Vec3 normal = u.cross(v);
    const double square = normal.squaredNorm();
    if (square > 0) {
        const double s = (b0 - a0).cross(v).dot(normal) / square;
        const double t = (b0 - a0).cross(u).dot(normal) / square;
        if (s >= 0 && s <= 1 && t >= 0 && t <= 1) offer(a0 + s * u, b0 + t * v);
    }
    offer(a0, closest_on_segment(a0, b0, b1));
    offer(a1, closest_on_segment(a1, b0, b1));
    offer(closest_on_segment(b0, a0, a1), b0);
    offer(closest_on_segment(b1, a0, a1), b1);
    return best;
}

double angle_at(const Vec3& apex, const Vec3& a, const Vec3& b) {
    const Vec3 u = a - apex;
    const Vec3 v = b - apex;
    return std::atan2(u.cross(v).norm(), u.dot(v));
}

bool AngleBounds::contains(double angle, double tolerance) const {
    for (int k = 1; k <= multiples; ++k) {
        if (angle >= k * smallest * (1 - tolerance) && angle <= k * largest * (1 + tolerance)) {
            return true;
        }
    }
    return false;
}

double AngleBounds::nearest_bound(double angle) const {
    double nearest = smallest;
    for (int k = 1; k <= multiples; ++k) {
        for (const double bound : {k * smallest, k * largest}) {
            if (std::abs(angle - bound) < std::abs(angle - nearest)) nearest = bound;
        }
    }
    return nearest;
}

AngleBounds angle_bounds(double ratio, bool is_quad) {
    const double opposite_unit = is_quad ? std::numbers::sqrt2 : 1.0;
    AngleBounds bounds{std::numbers::pi, 0.0, is_quad ? 2 : 3};
    for (const double a : {1.0, ratio}) {
        for (const double b : {1.0, ratio}) {
            for (const double c : {opposite_unit, opposite_unit * ratio}) {
                const double cosine = (a * a + b * b - c * c) / (2 * a * b);
                const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
                bounds.smallest = std::min(bounds.smallest, angle);
                bounds.largest = std::max(bounds.largest, angle);
            }
        }
    }
    return bounds;
}

}  // namespace fcn::conformity
