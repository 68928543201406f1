#pragma once

#include <algorithm>
#include <array>

#include "geometry/mesh.h"

namespace fcn {

using QuadCorners = std::array<Vec3, 4>;

/// Half of it is the quad's area, if the quad is flat; its direction is the quad's normal.
inline Vec3 area_vector(const QuadCorners& q) { return (q[2] - q[0]).cross(q[3] - q[1]); }

/// Per corner, the sine of its angle about the unit `normal`, [-1, 1]; 0 where an edge has no
/// length. With the direction of the area vector: the scaled Jacobian of the corner.
inline std::array<double, 4> corner_sines(const QuadCorners& q, const Vec3& normal) {
    std::array<double, 4> sines{};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 next = q[(i + 1) % 4] - q[i], last = q[(i + 3) % 4] - q[i];
        const double lengths = next.norm() * last.norm();
        sines[i] = lengths > 0 ? next.cross(last).dot(normal) / lengths : 0;
    }
    return sines;
}

/// The least over the corners; <= 0: a corner is inverted. A quad without area has 0.
inline double scaled_jacobian(const QuadCorners& q) {
    const Vec3 area = area_vector(q);
    const double norm = area.norm();
    if (!(norm > 0)) return 0;
    const auto sines = corner_sines(q, area / norm);
    return *std::min_element(sines.begin(), sines.end());
}

}  // namespace fcn
