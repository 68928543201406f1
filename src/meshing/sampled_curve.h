#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// A polyline with points at even distances along it.
struct SampledCurve {
    std::vector<Vec3> points;  ///< two at least; the last of a closed one repeats the first
    bool is_closed = false;
    double length = 0;

    int last() const { return static_cast<int>(points.size()) - 1; }
    /// At a parameter counted in points, 0 .. last(); any if the curve is closed.
    Vec3 at(double parameter) const;
    /// From one parameter to another one, in the shorter way around if the curve is closed.
    double forward(double from, double to) const;
    /// The points within `half` points of a parameter.
    std::vector<Vec3> window(double parameter, int half) const;
};

/// Points at most `step` > 0 apart.
SampledCurve sample_curve(const std::vector<Vec3>& polyline, double step);

}  // namespace fcn
