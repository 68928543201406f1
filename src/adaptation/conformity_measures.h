#pragma once

#include "geometry/mesh.h"

namespace fcn::conformity {

/// Closest points of two closed segments.
struct SegmentDistance {
    double distance = 0;
    Vec3 first = Vec3::Zero();   ///< on segment a0 a1
    Vec3 second = Vec3::Zero();  ///< on segment b0 b1
};
SegmentDistance segment_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

/// Closest point of the closed segment a0 a1; a0 when the segment is a point.
Vec3 closest_on_segment(const Vec3& point, const Vec3& a0, const Vec3& a1);

/// Angle at `apex` between the directions to `a` and `b`, [0, pi]; exact to rounding for tiny and
/// for straight angles. 0 when a direction vanishes.
double angle_at(const Vec3& apex, const Vec3& a, const Vec3& b);

/// Feasible angles between two segments that share a node: the union over k = 1 .. multiples of
/// [k smallest, k largest] (DESIGN 4.1).
struct AngleBounds {
    double smallest = 0;  ///< radians
    double largest = 0;
    int multiples = 0;
    bool contains(double angle, double tolerance) const;
    /// The end of an interval that is closest to `angle`.
    double nearest_bound(double angle) const;
};

/// Bounds of one corner of an element whose edges lie in [1, ratio] (and whose diagonal, for
/// quads, in sqrt(2) [1, ratio]). Derived from the law of cosines alone: see the source.
AngleBounds angle_bounds(double ratio, bool is_quad);

}  // namespace fcn::conformity
