// Means and curves of the usual comparisons of solvers: the shifted geometric mean of Achterberg
// (Constraint Integer Programming, 2007, appendix A.3), performance profiles of Dolan and Moré
// (2002), cactus plots of the SAT competitions, and a power law by least squares of logarithms.
#include "experiment/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace experiment {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Sums of squares around the means.
struct Moments {
    double mean_x = 0, mean_y = 0, xx = 0, yy = 0, xy = 0;
};

Moments moments(const Points& points) {
    Moments m;
    for (const auto& [x, y] : points) {
        m.mean_x += x;
        m.mean_y += y;
    }
    m.mean_x /= static_cast<double>(points.size());
    m.mean_y /= static_cast<double>(points.size());
    for (const auto& [x, y] : points) {
        m.xx += (x - m.mean_x) * (x - m.mean_x);
        m.yy += (y - m.mean_y) * (y - m.mean_y);
        m.xy += (x - m.mean_x) * (y - m.mean_y);
    }
    return m;
}

/// Ranks from 1; equal values share the mean of theirs.
std::vector<double> ranks(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> result(values.size());
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
        const double rank = static_cast<double>(begin + 1 + end) / 2;
        for (std::size_t k = begin; k < end; ++k) result[order[k]] = rank;
    }
    return result;
}

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) return kNothing;
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    if (values.size() % 2 == 1) return values[half];
    // Also right when both are infinite, which a difference would not be.
    return values[half - 1] == values[half] ? values[half] : (values[half - 1] + values[half]) / 2;
}

double mean(const std::vector<double>& values) {
    if (values.empty()) return kNothing;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double geometric_mean(const std::vector<double>& values) {
    if (values.empty()) return kNothing;
    double sum = 0;
    for (const double v : values) sum += std::log(v);
    return std::exp(sum / static_cast<double>(values.size()));
}

double shifted_geometric_mean(const std::vector<double>& values, double shift) {
    if (values.empty()) return kNothing;
    double sum = 0;
    for (const double v : values) sum += std::log(v + shift);
    return std::exp(sum / static_cast<double>(values.size())) - shift;
}

Points performance_profile(std::vector<double> ratios, std::size_t count) {
    Points points;
    std::sort(ratios.begin(), ratios.end());
    for (std::size_t k = 0; k < ratios.size() && std::isfinite(ratios[k]); ++k) {
        if (k + 1 < ratios.size() && ratios[k + 1] == ratios[k]) continue;
        points.emplace_back(ratios[k], static_cast<double>(k + 1) / static_cast<double>(count));
    }
    return points;
}

Points cactus(std::vector<double> solved_seconds) {
    std::sort(solved_seconds.begin(), solved_seconds.end());
    Points points;
    for (std::size_t k = 0; k < solved_seconds.size(); ++k) {
        points.emplace_back(static_cast<double>(k + 1), solved_seconds[k]);
    }
    return points;
}

std::optional<PowerLaw> fit_power_law(const Points& points) {
    if (points.size() < 3) return std::nullopt;
    Points logs;
    for (const auto& [x, y] : points) logs.emplace_back(std::log(x), std::log(y));
    const Moments m = moments(logs);
    if (m.xx < 1e-12) return std::nullopt;
    PowerLaw law;
    law.exponent = m.xy / m.xx;
    law.factor = std::exp(m.mean_y - law.exponent * m.mean_x);
    law.r_squared = m.yy > 0 ? m.xy * m.xy / (m.xx * m.yy) : 1;
    law.points = points.size();
    return law;
}

std::optional<double> rank_correlation(const Points& points) {
    if (points.size() < 3) return std::nullopt;
    std::vector<double> xs, ys;
    for (const auto& [x, y] : points) {
        xs.push_back(x);
        ys.push_back(y);
    }
    xs = ranks(xs);
    ys = ranks(ys);
    Points ranked;
    for (std::size_t k = 0; k < xs.size(); ++k) ranked.emplace_back(xs[k], ys[k]);
    const Moments m = moments(ranked);
    if (m.xx <= 0 || m.yy <= 0) return std::nullopt;
    return m.xy / std::sqrt(m.xx * m.yy);
}

}  // namespace experiment
