// Everything in the tables, and more, for those who would rather count themselves.
#include "experiment/report_csv.h"

#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

namespace experiment {
namespace {

std::string field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

std::string field(double number) {
    if (std::isnan(number)) return "";
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", number);
    return text;
}

template <class Integer>
requires std::is_integral_v<Integer> std::string field(Integer number) {
    return std::to_string(number);
}

template <class Number>
std::string field(const std::optional<Number>& number) {
    return number ? field(*number) : "";
}

class CsvRow {
public:
    template <class Value>
    CsvRow& add(const Value& value) {
        text_ += (is_first_ ? "" : ",") + field(value);
        is_first_ = false;
        return *this;
    }
    CsvRow& add(const char* value) { return add(std::string(value)); }
    CsvRow& add_all(std::initializer_list<const char*> values) {
        for (const char* value : values) add(value);
        return *this;
    }
    std::string line() const { return text_ + "\r\n"; }

private:
    std::string text_;
    bool is_first_ = true;
};

/// Names of all tags, statistics and provenance entries that occur, sorted.
struct Keys {
    std::set<std::string> tags, statistics, provenance;
};

Keys keys_of(const CampaignRuns& campaign) {
    Keys keys;
    for (const PlannedProblem& problem : campaign.plan.problems) {
        for (const auto& [key, value] : problem.tags) keys.tags.insert(key);
    }
    for (const auto& record : campaign.records) {
        if (!record) continue;
        for (const auto& [key, value] : record->statistics) keys.statistics.insert(key);
        if (!record->provenance.is_object()) continue;
        for (const auto& [key, value] : record->provenance.items()) keys.provenance.insert(key);
    }
    return keys;
}

std::string options_text(const SolverConfig& solver) {
    std::string text;
    for (const auto& [key, value] : solver.options) {
        text += (text.empty() ? "" : " ") + key + "=" + value;
    }
    return text;
}

template <class Map>
auto value_or_nothing(const Map& map, const std::string& key) {
    const auto it = map.find(key);
    return it == map.end() ? std::optional<typename Map::mapped_type>()
                           : std::optional<typename Map::mapped_type>(it->second);
}

void add_problem(CsvRow& row, const PlannedProblem& problem) {
    row.add(problem.name).add(problem.group).add(problem.hash);
    row.add(problem.is_study ? 1 : 0);
    row.add(problem.labels).add(problem.conflicts).add(problem.bonuses).add(problem.rules);
    row.add(problem.units_per_one).add(problem.optimum);
}

void add_solver(CsvRow& row, const SolverConfig& solver) {
    row.add(solver.name).add(solver.solver).add(solver.program).add(options_text(solver));
    row.add(solver.start).add(solver.threads).add(solver.limits.seconds).add(solver.limits.ticks);
    row.add(solver.limits.gap).add(solver.limits.memory_mib);
}

void add_outcome(CsvRow& row, const Record& record) {
    const Measures& m = record.measures;
    row.add(to_string(record.outcome)).add(record.status).add(record.stop_reason);
    row.add(record.value).add(record.bound).add(m.wall_seconds).add(m.user_seconds);
    row.add(m.system_seconds).add(record.solver_seconds).add(record.work).add(m.peak_mib);
    row.add(m.instructions).add(m.load).add(m.processor).add(m.exit_code).add(m.signal);
    row.add(m.started_at).add(record.message).add(record.command);
}

constexpr std::size_t kOutcomeColumns = 19;

/// What the report makes of a run.
void add_reading(CsvRow& row, const RunReading& reading, double horizon) {
    if (reading.standing != Standing::Taken) {
        for (int k = 0; k < 5; ++k) row.add("");
        return;
    }
    row.add(reading.is_proven ? 1 : 0).add(reading.counted());
    row.add(reading.gap_to_best).add(reading.gap_to_bound);
    row.add(reading.steps.empty() ? std::nan("") : primal_integral(reading.steps, horizon));
}

std::string runs_header(const Keys& keys) {
    CsvRow row;
    row.add_all({"run",          "problem",       "group",          "hash",
                 "is_study",     "labels",        "conflicts",      "bonuses",
                 "rules",        "units_per_one", "optimum",        "name",
                 "solver",       "program",       "options",        "start",
                 "threads",      "limit_seconds", "limit_ticks",    "limit_gap",
                 "limit_mib",    "seed",          "renaming",       "outcome",
                 "status",       "stop_reason",   "value",          "bound",
                 "wall_seconds", "user_seconds",  "system_seconds", "solver_seconds",
                 "work",         "peak_mib",      "instructions",   "load",
                 "processor",    "exit_code",     "signal",         "started_at",
                 "message",      "command",       "is_proven",      "counted_seconds",
                 "gap_to_best",  "gap_to_bound",  "primal_integral"});
    for (const std::string& key : keys.tags) row.add("tag_" + key);
    for (const std::string& key : keys.statistics) row.add("statistic_" + key);
    for (const std::string& key : keys.provenance) row.add("provenance_" + key);
    return row.line();
}

void add_provenance(CsvRow& row, const Record& record, const Keys& keys) {
    for (const std::string& key : keys.provenance) {
        const bool is_there = record.provenance.is_object() && record.provenance.contains(key);
        if (!is_there) {
            row.add("");
            continue;
        }
        const auto& value = record.provenance[key];
        row.add(value.is_string() ? value.get<std::string>() : value.dump());
    }
}

/// Labels of a job's solver, for whose a best value or bound is.
std::string owner(const Plan& plan, std::optional<std::size_t> job, bool is_known) {
    if (job) return plan.solvers[plan.jobs[*job].solver].name;
    return is_known ? "by construction" : "";
}

}  // namespace

std::string runs_csv(const CampaignRuns& campaign, const Comparison& comparison) {
    const Plan& plan = campaign.plan;
    const Keys keys = keys_of(campaign);
    const RunReader reader(campaign, comparison.check);
    std::string text = runs_header(keys);
    for (std::size_t j = 0; j < plan.jobs.size(); ++j) {
        const Job& job = plan.jobs[j];
        const PlannedProblem& problem = plan.problems[job.problem];
        CsvRow row;
        row.add(job.key);
        add_problem(row, problem);
        add_solver(row, plan.solvers[job.solver]);
        row.add(job.seed).add(job.renaming);
        const auto& record = campaign.records[j];
        if (record) {
            add_outcome(row, *record);
        } else {
            row.add("not-run");
            for (std::size_t k = 1; k < kOutcomeColumns; ++k) row.add("");
        }
        add_reading(row, problem.is_study ? RunReading{} : reader.read(j), comparison.horizon);
        for (const std::string& key : keys.tags) row.add(value_or_nothing(problem.tags, key));
        const Record nothing;
        const Record& known = record ? *record : nothing;
        for (const std::string& key : keys.statistics) {
            row.add(value_or_nothing(known.statistics, key));
        }
        add_provenance(row, known, keys);
        text += row.line();
    }
    return text;
}

std::string problems_csv(const CampaignRuns& campaign, const Comparison& comparison) {
    const Plan& plan = campaign.plan;
    const Keys keys = keys_of(campaign);
    CsvRow header;
    header.add_all({"problem", "group", "hash", "is_study", "labels", "conflicts", "bonuses",
                    "rules", "units_per_one", "optimum", "file", "best_value", "best_value_by",
                    "best_bound", "best_bound_by", "gap", "is_infeasible"});
    for (const std::string& key : keys.tags) header.add("tag_" + key);
    std::string text = header.line();
    for (std::size_t p = 0; p < plan.problems.size(); ++p) {
        const ProblemKnowledge& known = comparison.check.problems[p];
        CsvRow row;
        add_problem(row, plan.problems[p]);
        row.add(plan.problems[p].file);
        row.add(known.best_value);
        row.add(owner(plan, known.best_value_job, known.best_value.has_value()));
        row.add(known.best_bound);
        row.add(owner(plan, known.best_bound_job, known.best_bound.has_value()));
        row.add(known.best_value && known.best_bound
                    ? primal_gap(known.best_value, *known.best_bound)
                    : std::nan(""));
        row.add(known.is_proven_infeasible ? 1 : 0);
        for (const std::string& key : keys.tags) {
            row.add(value_or_nothing(plan.problems[p].tags, key));
        }
        text += row.line();
    }
    return text;
}

std::string pairs_csv(const CampaignRuns& campaign, const Comparison& comparison) {
    const Plan& plan = campaign.plan;
    CsvRow header;
    header.add_all({"a", "b", "common", "both_proven", "only_a", "only_b", "faster_a", "faster_b",
                    "ties", "time_b_over_a", "time_low", "time_high", "better_a", "better_b",
                    "equal", "gap_b_minus_a", "gap_low", "gap_high"});
    std::string text = header.line();
    for (std::size_t a = 0; a < plan.solvers.size(); ++a) {
        for (std::size_t b = a + 1; b < plan.solvers.size(); ++b) {
            const PairComparison pair = compare_pair(campaign, comparison, a, b);
            if (pair.common == 0) continue;
            CsvRow row;
            const auto add_interval = [&](const Interval& interval) {
                row.add(interval.estimate);
                row.add(interval.is_known ? interval.low : std::nan(""));
                row.add(interval.is_known ? interval.high : std::nan(""));
            };
            row.add(plan.solvers[a].name).add(plan.solvers[b].name).add(pair.common);
            row.add(pair.both_proven).add(pair.only_a).add(pair.only_b);
            row.add(pair.faster_a).add(pair.faster_b).add(pair.ties);
            // A time without a proof is the limit: of a heuristic it says nothing.
            const bool are_exact = comparison.solvers[a].is_exact && comparison.solvers[b].is_exact;
            add_interval(are_exact ? pair.time_ratio : Interval{std::nan("")});
            row.add(pair.better_a).add(pair.better_b).add(pair.equal);
            add_interval(pair.gap_difference);
            text += row.line();
        }
    }
    return text;
}

std::string study_csv(const CampaignRuns& campaign, const StudyComparison& study) {
    CsvRow header;
    header.add_all({"problem", "group", "solver", "runs", "objective", "gap_to_best"});
    for (const StudyMeasure& measure : study.measures) header.add(measure.key);
    std::string text = header.line();
    for (const StudyEntry& entry : study.entries) {
        const PlannedProblem& problem = campaign.plan.problems[entry.problem];
        CsvRow row;
        row.add(problem.name).add(problem.group);
        row.add(campaign.plan.solvers[entry.solver].name).add(entry.runs);
        row.add(entry.value).add(entry.gap);
        for (std::size_t m = 0; m < study.measures.size(); ++m) {
            row.add(entry.measures[m] / study.measures[m].factor);
        }
        text += row.line();
    }
    return text;
}

}  // namespace experiment
