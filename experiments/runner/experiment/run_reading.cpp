// How a run counts. Ended from outside, crashed or refuted: unsolved at the limit, and its value is
// none, whatever it left behind; a value that passed the check still serves as best known value.
#include "experiment/run_reading.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace experiment {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Standing standing_of(const std::optional<Record>& record) {
    if (!record) return Standing::NotRun;
    if (record->outcome == Outcome::NotApplicable) return Standing::NotApplicable;
    if (record->outcome == Outcome::Missing) return Standing::Missing;
    return Standing::Taken;
}

double gap_below(std::optional<std::int64_t> value, std::optional<std::int64_t> best) {
    return best ? primal_gap(value, *best) : kUnknown;
}

}  // namespace

bool is_proven(const Record& record, const SolverConfig& solver) {
    if (record.outcome == Outcome::Infeasible) return true;
    if (!is_solved(record.outcome) || !record.value) return false;
    const auto bound = claimed_bound(record, solver);
    if (!bound) return false;
    const double value = static_cast<double>(*record.value);
    const double allowed = solver.limits.gap * std::max(1.0, std::abs(value));
    return static_cast<double>(*bound) - value <= allowed;
}

RunReader::RunReader(const CampaignRuns& campaign, const CrossCheck& check)
    : campaign_(campaign), check_(check) {
    double longest = 0;
    for (const auto& record : campaign.records) {
        if (!record) continue;
        largest_seconds_ = std::max(largest_seconds_, seconds(*record));
        longest = std::max(longest, record->solver_seconds);
    }
    for (const SolverConfig& solver : campaign.plan.solvers) {
        if (!solver.limits.seconds) uses_largest_ = true;
        horizon_ = std::max(horizon_, solver.limits.seconds.value_or(0));
    }
    if (horizon_ == 0) horizon_ = longest;
}

double RunReader::seconds(const Record& record) const {
    const Measures& m = record.measures;
    return campaign_.plan.report.clock == "wall" ? m.wall_seconds
                                                 : m.user_seconds + m.system_seconds;
}

double RunReader::limit(const SolverConfig& solver) const {
    if (!solver.limits.seconds) return largest_seconds_;
    const int threads = campaign_.plan.report.clock == "wall" ? 1 : solver.threads;
    return *solver.limits.seconds * threads;
}

RunReading RunReader::read(std::size_t job) const {
    RunReading reading;
    const auto& record = campaign_.records[job];
    reading.standing = standing_of(record);
    if (reading.standing != Standing::Taken) return reading;
    const SolverConfig& solver = campaign_.plan.solvers[campaign_.plan.jobs[job].solver];
    const ProblemKnowledge& known = check_.problems[campaign_.plan.jobs[job].problem];
    reading.has_value = is_solved(record->outcome) && record->value;
    reading.is_proven = experiment::is_proven(*record, solver);
    reading.was_stopped =
        record->stop_reason == "time-limit" || record->stop_reason == "work-limit";
    reading.seconds = seconds(*record);
    reading.limit = limit(solver);
    if (reading.has_value) reading.value = record->value;
    reading.gap_to_best = gap_below(reading.value, known.best_value);
    reading.gap_to_bound = gap_below(reading.value, known.best_bound);
    if (known.best_value) {
        reading.steps = gap_steps(record->trace, reading.value, record->solver_seconds,
                                  *known.best_value, horizon_);
    }
    return reading;
}

}  // namespace experiment
