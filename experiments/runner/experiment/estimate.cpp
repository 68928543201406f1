#include "experiment/estimate.h"

#include <algorithm>
#include <cmath>

namespace experiment {
namespace {

constexpr double kStartUp = 0.1;         ///< of a process, where nothing is known
constexpr double kSameProblem = 0.25;    ///< so different are runs of one solver on one problem
constexpr double kTicksPerSecond = 1e7;  ///< where a program counts ticks alone: what ours do
constexpr double kWithoutAnyLimit = 60;  ///< seconds

double longest(const Limits& limits) {
    const double limit = limits.seconds ? 1.1 * *limits.seconds + limits.margin_seconds
                         : limits.ticks ? static_cast<double>(*limits.ticks) / kTicksPerSecond
                                        : kWithoutAnyLimit;
    return limit + kStartUp;
}

}  // namespace

void RemainingTime::Times::add(double seconds) {
    sum += seconds;
    squares += seconds * seconds;
    ++count;
}

double RemainingTime::Times::variance() const {
    return std::max(0.0, (squares - sum * mean()) / (count - 1));
}

void RemainingTime::has_ended(const Job& job, double wall_seconds) {
    by_solver_[job.solver].add(wall_seconds);
    by_problem_[{job.solver, job.problem}].add(wall_seconds);
    auto& left = left_[job.solver];
    if (--left[job.problem] == 0) left.erase(job.problem);
}

RemainingTime::Bounds RemainingTime::bounds_of(std::size_t solver) const {
    Bounds bounds;
    int unmet = 0;
    const double limit = longest(plan_.solvers[solver].limits);
    for (const auto& [problem, count] : left_.at(solver)) {
        const auto met = by_problem_.find({solver, problem});
        if (met == by_problem_.end()) {
            unmet += count;
            continue;
        }
        const double mean = met->second.mean();
        bounds.least += count * (1 - kSameProblem) * mean;
        bounds.most += count * std::min(limit, (1 + kSameProblem) * mean);
    }
    const auto times = by_solver_.find(solver);
    if (times == by_solver_.end() || times->second.count < 2) {
        bounds.most += unmet * limit;
    } else if (unmet > 0) {
        const double mean = times->second.mean();
        const double error =
            2 * std::sqrt(times->second.variance() * (1.0 / times->second.count + 1.0 / unmet));
        bounds.least += unmet * std::max(0.0, mean - error);
        bounds.most += unmet * std::min(limit, mean + error);
    }
    return bounds;
}

std::pair<double, double> RemainingTime::bounds() const {
    Bounds sum;
    for (const auto& [solver, problems] : left_) {
        const Bounds bounds = bounds_of(solver);
        sum.least += bounds.least;
        sum.most += bounds.most;
    }
    return {sum.least / jobs_, sum.most / jobs_};
}

}  // namespace experiment
