#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment/campaign_runs.h"

namespace experiment {

/// What all runs together know of a problem.
struct ProblemKnowledge {
    std::optional<std::int64_t> best_value;  ///< checked, of any run; or the planned optimum
    std::optional<std::int64_t> best_bound;  ///< the smallest claimed; or the planned optimum
    std::optional<std::size_t> best_value_job, best_bound_job;  ///< of the plan; none: planned
    bool is_proven_infeasible = false;                          ///< some run says so
};

/// Two claims that cannot both be true.
struct Contradiction {
    std::size_t problem = 0;
    std::string text;  ///< one line that names both runs
};

struct CrossCheck {
    std::vector<ProblemKnowledge> problems;  ///< per problem of the plan
    std::vector<Contradiction> contradictions;
    std::vector<std::size_t> wrong_jobs;  ///< runs that were found to be wrong by themselves
};

/// Sets every claim against every checked value. Problems with the same content count as one.
/// Studies are left out: each of their solvers adapts another sequence of problems. Bounds of runs
/// that are wrong or crashed are not used; their checked values are.
CrossCheck cross_check(const CampaignRuns& campaign);

/// What a run claims that no solution exceeds: its bound, or its value when it says optimal and no
/// gap was allowed. Nothing when it claims nothing, or is wrong.
std::optional<std::int64_t> claimed_bound(const Record& record, const SolverConfig& solver);

}  // namespace experiment
