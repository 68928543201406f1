#include "experiment/estimate.h"

#include <algorithm>
#include <cmath>

namespace experiment {

RemainingTime::RemainingTime(const Plan& plan, int jobs)
    : plan_(plan), jobs_(jobs), left_(plan.solvers.size()), times_(plan.solvers.size()) {}

void RemainingTime::has_ended(const Job& job, double wall_seconds) {
    Times& t = times_[job.solver];
    t.sum += wall_seconds;
    t.squares += wall_seconds * wall_seconds;
    ++t.count;
    --left_[job.solver];
}

std::pair<double, double> RemainingTime::bounds() const {
    constexpr double kStartUp = 0.1;  // of a process, where nothing is known
    double least = 0, most = 0;
    for (std::size_t s = 0; s < times_.size(); ++s) {
        const Times& t = times_[s];
        const Limits& limits = plan_.solvers[s].limits;
        // Where a program counts ticks alone, ten million a second is what ours do.
        const double limit = limits.seconds ? 1.1 * *limits.seconds + limits.margin_seconds
                             : limits.ticks ? static_cast<double>(*limits.ticks) / 1e7
                                            : 60;
        double low = 0, high = limit + kStartUp;
        if (t.count >= 2) {
            const double mean = t.sum / t.count;
            const double variance = std::max(0.0, (t.squares - t.sum * mean) / (t.count - 1));
            const double error = 2 * std::sqrt(variance / t.count);
            low = std::max(0.0, mean - error);
            high = mean + error;
        }
        least += low * left_[s];
        most += high * left_[s];
    }
    return {least / jobs_, most / jobs_};
}

}  // namespace experiment
