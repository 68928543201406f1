#include "features/even_polyline.h"

#include <algorithm>

namespace fcn {

std::vector<Vec3> even_points(const NetworkArc& arc, int count) {
    const double step = arc.length() / (arc.is_closed() ? count : count - 1);
    std::vector<Vec3> points;
    double before = 0;
    for (std::size_t k = 0; k + 1 < arc.samples.size(); ++k) {
        const Vec3& a = arc.samples[k].position;
        const Vec3& b = arc.samples[k + 1].position;
        const double length = (b - a).norm();
        while (static_cast<int>(points.size()) < count) {
            const double along = step * static_cast<double>(points.size()) - before;
            if (along > length) break;
            points.push_back(a + (b - a) * (length > 0 ? along / length : 0.0));
        }
        before += length;
    }
    // Rounding may leave the end of the last interval just short of the last step.
    while (static_cast<int>(points.size()) < count) points.push_back(arc.samples.back().position);
    return points;
}

}  // namespace fcn
