#pragma once

#include <map>
#include <utility>

#include "experiment/plan.h"

namespace experiment {

/// How long the rest of a campaign takes, by what its runs have taken so far.
class RemainingTime {
public:
    RemainingTime(const Plan& plan, int jobs) : plan_(plan), jobs_(jobs) {}
    void is_left(const Job& job) { ++left_[job.solver][job.problem]; }
    void has_ended(const Job& job, double wall_seconds);
    /// Seconds, at least and at most. A run whose solver has met the problem before counts with the
    /// mean of then, less and plus a quarter. Of a solver that has ended two runs the others count
    /// with the mean, less and plus two standard errors of predicting so many further ones, since
    /// problems differ. Anything else counts with nothing, and with its limit.
    std::pair<double, double> bounds() const;

private:
    struct Times {
        double sum = 0, squares = 0;
        int count = 0;
        void add(double seconds);
        double mean() const { return sum / count; }
        double variance() const;
    };
    struct Bounds {
        double least = 0, most = 0;
    };
    Bounds bounds_of(std::size_t solver) const;

    const Plan& plan_;
    int jobs_ = 1;
    std::map<std::size_t, std::map<std::size_t, int>> left_;  ///< by solver and problem
    std::map<std::size_t, Times> by_solver_;
    std::map<std::pair<std::size_t, std::size_t>, Times> by_problem_;
};

}  // namespace experiment
