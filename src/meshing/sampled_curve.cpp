// Curves at even steps, so that places along them are plain numbers.
#include "meshing/sampled_curve.h"

#include <algorithm>
#include <cmath>

namespace fcn {

Vec3 SampledCurve::at(double parameter) const {
    double t = parameter;
    if (is_closed) t -= last() * std::floor(t / last());
    t = std::clamp(t, 0.0, static_cast<double>(last()));
    const int i = std::min(static_cast<int>(t), last() - 1);
    const Vec3& a = points[static_cast<std::size_t>(i)];
    const Vec3& b = points[static_cast<std::size_t>(i + 1)];
    return a + (t - i) * (b - a);
}

double SampledCurve::forward(double from, double to) const {
    const double way = to - from;
    return is_closed ? std::remainder(way, last()) : way;
}

std::vector<Vec3> SampledCurve::window(double parameter, int half) const {
    const int middle = static_cast<int>(std::lround(parameter));
    std::vector<Vec3> result;
    if (!is_closed || 2 * half >= last()) {
        const int from = is_closed ? 0 : std::clamp(middle - half, 0, last());
        const int to = is_closed ? last() : std::clamp(middle + half, 0, last());
        for (int i = from; i <= to; ++i) result.push_back(points[static_cast<std::size_t>(i)]);
        return result;
    }
    for (int i = middle - half; i <= middle + half; ++i)
        result.push_back(points[static_cast<std::size_t>((i % last() + last()) % last())]);
    return result;
}

SampledCurve sample_curve(const std::vector<Vec3>& polyline, double step) {
    SampledCurve curve;
    curve.is_closed = polyline.size() > 2 && polyline.front() == polyline.back();
    for (std::size_t i = 1; i < polyline.size(); ++i)
        curve.length += (polyline[i] - polyline[i - 1]).norm();
    const int least = curve.is_closed ? 3 : 1;
    const int count = std::max(least, static_cast<int>(std::ceil(curve.length / step)));
    curve.points.push_back(polyline.front());
    double walked = 0;
    std::size_t i = 1;
    for (int k = 1; k < count; ++k) {
        const double goal = curve.length * k / count;
        double piece = (polyline[i] - polyline[i - 1]).norm();
        while (i + 1 < polyline.size() && walked + piece < goal) {
            walked += piece;
            ++i;
            piece = (polyline[i] - polyline[i - 1]).norm();
        }
        const double share = piece > 0 ? std::clamp((goal - walked) / piece, 0.0, 1.0) : 0;
        curve.points.push_back(polyline[i - 1] + share * (polyline[i] - polyline[i - 1]));
    }
    curve.points.push_back(polyline.back());
    return curve;
}

}  // namespace fcn
