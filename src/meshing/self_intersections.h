#pragma once

#include <array>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// Pairs of triangles that meet in more than the corners they share, smaller index first, sorted.
/// Exact, but for triangles folded onto each other at their edge, to 3e-5 radians; triangles
/// without area are left out. Near-linear time.
std::vector<std::array<int, 2>> self_intersections(
    const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles);
std::vector<std::array<int, 2>> self_intersections(const Mesh& mesh);

/// The same for two triangles, given by the names of their corners and where those are.
bool do_triangles_cross(const std::array<int, 3>& one, const std::array<Vec3, 3>& points_of_one,
                        const std::array<int, 3>& other,
                        const std::array<Vec3, 3>& points_of_other);

}  // namespace fcn
