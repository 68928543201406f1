#pragma once

#include <utility>
#include <vector>

#include "experiment/plan.h"

namespace experiment {

/// How long the rest of a campaign takes, by what its runs have taken so far.
class RemainingTime {
public:
    RemainingTime(const Plan& plan, int jobs);
    void is_left(const Job& job) { ++left_[job.solver]; }
    void has_ended(const Job& job, double wall_seconds);
    /// Seconds, at least and at most. A solver of which two runs have ended counts with their mean,
    /// less and plus two standard errors; another one with nothing, and with its limit.
    std::pair<double, double> bounds() const;

private:
    struct Times {
        double sum = 0, squares = 0;
        int count = 0;
    };
    const Plan& plan_;
    int jobs_ = 1;
    std::vector<int> left_;
    std::vector<Times> times_;
};

}  // namespace experiment
