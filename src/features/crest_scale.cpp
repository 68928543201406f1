// Noise of size s moves the third derivatives of a fit over n vertices within radius r by about
// s / (r^3 sqrt(n)), that is by s h / r^4 on a mesh of edge length h: a little more radius helps a
// lot. More than needed blurs the surface. So radii are tried from the smallest up until the median
// error of the derivatives is small against the square of the surface's curvature, which is the
// unit of such derivatives; or until the radius reaches the radius of curvature, beyond which a fit
// sees another surface.

#include "features/crest_scale.h"

#include <algorithm>
#include <cmath>

namespace fcn {
namespace {

constexpr double kRings[] = {3, 4, 5, 6.5, 8, 10, 13, 16, 20};
constexpr double kLargestError = 0.12;  // of e, in squared curvatures
constexpr double kLargestRadius = 1.5;  // in radii of curvature
constexpr int kSampleCount = 3000;
constexpr double kClip = 0.99;  // quantile beyond which curvatures are outliers

double quantile(std::vector<double> values, double share) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

}  // namespace

double choose_rings(const LocalFitter& fitter, int vertex_count, int threads) {
    std::vector<int> sample;
    const int step = std::max(1, vertex_count / kSampleCount);
    for (int v = 0; v < vertex_count; v += step) sample.push_back(v);
    double chosen = kRings[0];
    for (double rings : kRings) {
        std::vector<double> curvatures, errors, radii;
        for (const VertexFit& fit : fitter.fit_some(sample, {.rings = rings, .threads = threads})) {
            if (!fit.is_valid) continue;
            curvatures.push_back(std::max(std::abs(fit.kappa_max), std::abs(fit.kappa_min)));
            errors.push_back(fit.e_error);
            radii.push_back(fit.radius);
        }
        if (curvatures.empty()) return chosen;
        const double clip = quantile(curvatures, kClip);
        double squares = 0;
        for (double kappa : curvatures) squares += std::min(kappa, clip) * std::min(kappa, clip);
        squares /= static_cast<double>(curvatures.size());
        const double radius = quantile(radii, 0.5);
        if (rings > kRings[0] && radius * radius * squares > kLargestRadius * kLargestRadius) break;
        chosen = rings;
        if (quantile(errors, 0.5) <= kLargestError * squares) break;
    }
    return chosen;
}

}  // namespace fcn
