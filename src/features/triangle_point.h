#pragma once

#include "geometry/mesh.h"

namespace fcn {

/// Barycentric coordinates of the point of triangle abc that is closest to `point`; also right
/// for degenerate triangles.
Vec3 closest_barycentric(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace fcn
