// The authors' three measures (Yoshizawa, Belyaev, Seidel 2005, section 4, and the manual of their
// program): ridgeness, the integral of the curvature; sphericalness, the mean of a window of
// Koenderink's shape index; cyclideness, the integral of the functional whose minima are Dupin's
// cyclides, times the line's length to make it dimensionless. The manual does not say what the
// window is: ours is 1 for cylinders and saddles and falls to 0 at the sphere as a squared cosine.
//
// Two more are ours, since cyclideness as it is taken, between vertices on either side of the line,
// depends on how far these are from it: sharpness is the square of the ratio of the radius of
// curvature to the width over which curvature falls off across the line; significance compares that
// fall within the neighbourhood of a fit with the fit's own standard error, so what noise makes has
// a significance of a few on any mesh. Both are medians along the line, weighted by length: edges
// that run along the line and fits that touch an unseen crease make wild quotients.

#include "features/crest_measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fcn {
namespace {

constexpr double kRounding = 1e-10;  // of the curvature over the radius

double shape_window(const CrestPoint& point) {
    const double difference = point.kappa - point.kappa_other;
    const double index =
        2 / std::numbers::pi * std::atan2(point.kappa + point.kappa_other, difference);
    if (index <= 0.5) return 1;
    const double cosine = std::cos(std::numbers::pi * (index - 0.5));
    return cosine * cosine;
}

/// The value at which half of the weight is reached.
double weighted_median(std::vector<std::pair<double, double>> values) {
    std::sort(values.begin(), values.end());
    double total = 0, below = 0;
    for (const auto& [value, weight] : values) total += weight;
    for (const auto& [value, weight] : values) {
        below += weight;
        if (below >= total / 2) return value;
    }
    return 0;
}

/// Second derivative of the curvature across the line.
double fall(const CrestPoint& point) { return point.run > 0 ? point.drop / point.run : 0; }

double local_significance(const CrestPoint& point) {
    // Exact data has no error but rounding.
    const double least = kRounding * point.kappa / point.radius;
    return fall(point) * point.radius / std::max({point.e_error, least, 1e-300});
}

}  // namespace

CrestMeasures measure(const CrestGraph& graph, const CrestLine& line) {
    CrestMeasures result;
    double window = 0, cyclideness = 0;
    std::vector<std::pair<double, double>> sharpness, significance;
    for (std::size_t k = 1; k < line.points.size(); ++k) {
        const CrestPoint& a = graph.points[line.points[k - 1]];
        const CrestPoint& b = graph.points[line.points[k]];
        const double half = 0.5 * (b.position - a.position).norm();
        for (const CrestPoint* p : {&a, &b}) {
            result.length += half;
            result.ridgeness += half * p->kappa;
            window += half * shape_window(*p);
            cyclideness += half * p->cyclideness;
            sharpness.emplace_back(fall(*p) / (p->kappa * p->kappa * p->kappa), half);
            significance.emplace_back(local_significance(*p), half);
        }
    }
    if (!(result.length > 0)) return result;
    result.sphericalness = window / result.length;
    result.cyclideness = result.length * cyclideness;
    result.sharpness = weighted_median(std::move(sharpness));
    result.significance = weighted_median(std::move(significance));
    return result;
}

}  // namespace fcn
