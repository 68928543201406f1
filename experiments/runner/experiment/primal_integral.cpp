// The primal integral of Berthold (Measuring the impact of primal heuristics, 2013): how far a
// solver's best solution was from the best known one, over the time it had. A run that ends early
// keeps its last gap to the end of the time, so giving up does not pay.
#include "experiment/primal_integral.h"

#include <algorithm>
#include <cmath>

namespace experiment {

double primal_gap(std::optional<std::int64_t> value, std::int64_t best) {
    if (!value) return 1;
    const double scale = std::max(1.0, std::abs(static_cast<double>(best)));
    const double gap = (static_cast<double>(best) - static_cast<double>(*value)) / scale;
    return std::clamp(gap, 0.0, 1.0);
}

std::vector<GapStep> gap_steps(const std::vector<TracePoint>& trace,
                               std::optional<std::int64_t> end_value, double end_seconds,
                               std::int64_t best, double limit_seconds) {
    std::vector<GapStep> steps{{0, 1}};
    if (!end_value) return steps;
    const auto take = [&](double seconds, std::int64_t value) {
        const double gap = primal_gap(value, best);
        if (seconds > limit_seconds || gap >= steps.back().gap) return;
        steps.push_back({std::max(seconds, steps.back().seconds), gap});
    };
    for (const TracePoint& point : trace) {
        if (point.value) take(point.seconds, std::min(*point.value, *end_value));
    }
    take(std::min(end_seconds, limit_seconds), *end_value);
    return steps;
}

double primal_integral(const std::vector<GapStep>& steps, double limit_seconds) {
    double area = 0;
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const double end = k + 1 < steps.size() ? steps[k + 1].seconds : limit_seconds;
        area += steps[k].gap * std::max(0.0, end - steps[k].seconds);
    }
    return area;
}

std::optional<double> time_to_gap(const std::vector<GapStep>& steps, double target) {
    for (const GapStep& step : steps) {
        if (step.gap <= target) return step.seconds;
    }
    return std::nullopt;
}

}  // namespace experiment
