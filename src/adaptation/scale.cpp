// The scale interval and its angle bounds (paper section 4.1). In a triangle whose edges all lie
// in [rmin, rmax] the extreme angles occur where edges sit at the ends of the interval; with
// rho = rmax / rmin the law of cosines leaves two candidates for each bound. The paper prints one
// of them with the ratio inverted; both are taken here. For quads the same is done with a diagonal
// in sqrt(2) [rmin, rmax], and a corner is two such half angles.

#include "adaptation/scale.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/errors.h"

namespace fcn {

namespace {

double triangle_min_angle(double rho) {
    return std::min(std::acos(rho / 2), 2 * std::asin(1 / (2 * rho)));
}

double triangle_max_angle(double rho) {
    return std::max(2 * std::asin(rho / 2), std::acos(1 / (2 * rho)));
}

double quad_min_angle(double rho) {
    return 2 * std::min(std::asin(1 / (std::sqrt(2.0) * rho)),
                        std::acos((rho * rho + 1) / (2 * std::sqrt(2.0) * rho)));
}

double quad_max_angle(double rho) {
    return 2 * std::max(std::asin(std::min(1.0, rho / std::sqrt(2.0))),
                        std::acos((rho * rho + 1) / (2 * std::sqrt(2.0) * rho)));
}

}  // namespace

bool ScaleInterval::contains(double length) const {
    return length >= rmin * (1 - kScaleTolerance) && length <= rmax * (1 + kScaleTolerance);
}

bool ScaleInterval::is_feasible_angle(double angle) const {
    for (int k = 1; k <= multiples; ++k) {
        if (angle >= k * alpha_min * (1 - kScaleTolerance) &&
            angle <= k * alpha_max * (1 + kScaleTolerance)) {
            return true;
        }
    }
    return false;
}

ScaleInterval make_scale(double rmin, double ratio, ElementType target) {
    if (!(rmin > 0) || !std::isfinite(rmin)) {
        throw InputError("scale must be a positive length, not " + std::to_string(rmin));
    }
    if (!(ratio >= 1.01) || !(ratio < std::sqrt(3.0))) {
        throw InputError("ratio rmax/rmin must lie in [1.01, 1.7320), not " +
                         std::to_string(ratio));
    }
    ScaleInterval scale;
    scale.rmin = rmin;
    scale.rmax = ratio * rmin;
    scale.height = std::sqrt(rmin * rmin - scale.rmax * scale.rmax / 4);
    scale.target = target;
    scale.triangle_alpha_min = triangle_min_angle(ratio);
    if (target == ElementType::Triangle) {
        scale.alpha_min = triangle_min_angle(ratio);
        scale.alpha_max = triangle_max_angle(ratio);
        scale.multiples = 3;
    } else {
        scale.alpha_min = quad_min_angle(ratio);
        scale.alpha_max = quad_max_angle(ratio);
        scale.multiples = 2;
    }
    return scale;
}

}  // namespace fcn
