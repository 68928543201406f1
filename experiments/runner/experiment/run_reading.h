#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment/campaign_runs.h"
#include "experiment/cross_check.h"
#include "experiment/primal_integral.h"

namespace experiment {

/// Whether a solver's run counts in tables. Only Taken ones do; the others are no zeros.
enum class Standing { NotRun, NotApplicable, Missing, Taken };

/// A run under the campaign's rules of counting.
struct RunReading {
    Standing standing = Standing::NotRun;
    bool has_value = false;    ///< ended by itself with labels that passed the check
    bool is_proven = false;    ///< its claim closes the gap that was allowed; or infeasible
    bool was_stopped = false;  ///< by a limit of time or work
    double seconds = 0;        ///< measured, by the campaign's clock
    double limit = 0;          ///< seconds that an unsolved run counts
    std::optional<std::int64_t> value;
    double gap_to_best = 1;   ///< 1 without a value; NaN when no solution is known
    double gap_to_bound = 1;  ///< 1 without a value; NaN when no bound is known
    std::vector<GapStep> steps;

    /// Measured when proven, else the limit.
    double counted() const { return is_proven ? seconds : limit; }
};

/// Reads the runs of a campaign.
class RunReader {
public:
    RunReader(const CampaignRuns& campaign, const CrossCheck& check);

    RunReading read(std::size_t job) const;
    /// User and system, or wall.
    double seconds(const Record& record) const;
    /// Of an unsolved run of a solver: its time limit (of processor time: times its threads), or,
    /// when only work is limited, the largest time of any run.
    double limit(const SolverConfig& solver) const;
    /// Time over which primal integrals run: the largest time limit, or else the longest run, by
    /// the solvers' own clock.
    double horizon() const { return horizon_; }
    bool uses_largest_time() const { return uses_largest_; }

private:
    const CampaignRuns& campaign_;
    const CrossCheck& check_;
    double largest_seconds_ = 0, horizon_ = 0;
    bool uses_largest_ = false;
};

/// Closes the allowed gap by its own claim, or says infeasible.
bool is_proven(const Record& record, const SolverConfig& solver);

}  // namespace experiment
