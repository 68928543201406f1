#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiment/bootstrap.h"
#include "experiment/campaign_runs.h"

namespace experiment {

/// An interval has to be this far from 1 before a change of time is more than chance.
constexpr double kNotableRatio = 1.05;

/// One solver, after against before, on the problems that it took in both campaigns.
struct SolverChange {
    std::string solver;
    std::size_t problems = 0;
    Interval time_ratio;  ///< after / before, floored; where at least one of both is finished
    std::size_t better = 0, worse = 0;  ///< median values
    Interval value_change;              ///< mean of (after - before) / max(1, |before|)
    std::vector<std::string> lost_proofs, gained_proofs;  ///< names of problems
    std::vector<std::string> worse_values;                ///< with both values
    std::size_t wrong_before = 0, wrong_after = 0;        ///< runs
    bool is_slower = false;                               ///< the whole interval is above 1.05
    bool is_faster = false;                               ///< the whole interval is below 1 / 1.05
    bool is_worse = false;       ///< the whole interval of the values is below 0
    bool loses_proofs = false;   ///< net, with an interval of the share that is below 0
    bool is_more_wrong = false;  ///< any more wrong runs than before

    bool is_regression() const { return is_slower || is_worse || loses_proofs || is_more_wrong; }
};

struct CampaignChange {
    std::vector<SolverChange> solvers;  ///< those in both, in the order of the second
    std::vector<std::string> notes;     ///< what makes the comparison less than fair
    bool has_regression = false;
};

/// Same problem (by content) and same solver (by name) in two campaigns. Intervals draw groups;
/// with one group there is none, and nothing is flagged but wrong runs.
CampaignChange compare_campaigns(const CampaignRuns& before, const CampaignRuns& after);

/// For people: a few lines for each solver.
std::string to_text(const CampaignChange& change);
nlohmann::json to_json(const CampaignChange& change);

}  // namespace experiment
