// What was run and what was not. A reader must not have to guess which numbers are missing, nor
// why.
#include <algorithm>
#include <map>
#include <set>

#include "experiment/report_numbers.h"
#include "experiment/report_sections.h"

namespace experiment {
namespace {

constexpr std::size_t kMostListed = 40;

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
    return count_text(static_cast<double>(count)) + " " + (count == 1 ? one : many);
}

std::string solver_limits(const SolverConfig& solver) {
    std::string text = solver.limits.seconds ? decimal_text(*solver.limits.seconds, 3) : "";
    if (const std::size_t point = text.find('.'); point != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') text.pop_back();
    }
    if (!text.empty()) text += " s";
    if (solver.limits.ticks) {
        text += (text.empty() ? "" : ", ") + count_text(static_cast<double>(*solver.limits.ticks)) +
                " ticks";
    }
    if (solver.limits.gap > 0) text += ", gap " + percent_text(solver.limits.gap);
    if (solver.threads > 1) text += ", " + std::to_string(solver.threads) + " threads";
    return text.empty() ? "none" : text;
}

/// How to get a solver that is not there.
std::string install_command(const SolverConfig& solver) {
    static const std::map<std::string, std::string> kCommands{
        {"glpk", "apt-get install glpk-utils"},
        {"clasp", "apt-get install clasp"},
        {"toulbar2", "apt-get install toulbar2"},
        {"highs", "scripts/setup_solvers.sh highspy"},
        {"scip", "scripts/setup_solvers.sh pyscipopt"},
        {"cp-sat", "scripts/setup_solvers.sh ortools"},
        {"gurobi", "scripts/setup_solvers.sh gurobipy"}};
    const auto it = kCommands.find(solver.solver);
    if (it != kCommands.end()) return it->second;
    return solver.program.empty() ? "" : "the program of: " + solver.program;
}

/// Names of problems, some of them when they are many.
std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t k = 0; k < std::min(names.size(), kMostListed); ++k) {
        text += (k == 0 ? "" : ", ") + names[k];
    }
    if (names.size() > kMostListed) {
        text += " and " + std::to_string(names.size() - kMostListed) + " more (runs.csv)";
    }
    return text;
}

/// Problems whose runs by a solver ended so, each once, and what the solver said.
struct NotTaken {
    std::vector<std::string> problems;
    std::set<std::string> messages;
};

NotTaken not_taken(const CampaignRuns& campaign, std::size_t solver, Outcome outcome) {
    NotTaken result;
    std::set<std::size_t> problems;
    for (std::size_t j = 0; j < campaign.plan.jobs.size(); ++j) {
        const auto& record = campaign.records[j];
        if (campaign.plan.jobs[j].solver != solver || !record || record->outcome != outcome) {
            continue;
        }
        problems.insert(campaign.plan.jobs[j].problem);
        if (!record->message.empty()) result.messages.insert(record->message);
    }
    for (const std::size_t p : problems) result.problems.push_back(campaign.plan.problems[p].name);
    return result;
}

std::string quoted_messages(const std::set<std::string>& messages) {
    if (messages.empty()) return "";
    std::string text = " It says: " + *messages.begin();
    if (messages.size() > 1)
        text += " (and " + std::to_string(messages.size() - 1) + " other words)";
    return text + ".";
}

bool is_gurobi(const SolverConfig& solver) {
    return solver.solver.find("gurobi") != std::string::npos ||
           solver.name.find("gurobi") != std::string::npos ||
           solver.name.find("Gurobi") != std::string::npos;
}

void add_gurobi(const ReportInput& input, Document& document) {
    const Plan& plan = input.campaign.plan;
    Section section{"Where Gurobi could not be measured", "gurobi", {}};
    for (std::size_t s = 0; s < plan.solvers.size(); ++s) {
        if (!is_gurobi(plan.solvers[s])) continue;
        const NotTaken found = not_taken(input.campaign, s, Outcome::NotApplicable);
        if (found.problems.empty()) continue;
        section.blocks.emplace_back(
            Paragraph{plan.solvers[s].name + ": " +
                      counted(found.problems.size(), "problem is", "problems are") +
                      " beyond what its licence allows: " + listed(found.problems) + "."});
    }
    if (section.blocks.empty()) return;
    section.blocks.emplace_back(
        Paragraph{"Whoever has a licence and the campaign's folder makes these runs alone with the "
                  "first command; "
                  "the second one makes the whole campaign, in a new folder:"});
    const std::string licence = "GRB_LICENSE_FILE=/path/to/gurobi.lic scalefcn-experiment ";
    section.blocks.emplace_back(CommandLine{licence + "resume DIR --again not-applicable"});
    section.blocks.emplace_back(CommandLine{licence + "run " + plan.config_file + " -o DIR"});
    add_section(document, std::move(section));
}

std::string problems_text(std::size_t problems, std::size_t studies) {
    const std::string of_studies = counted(studies, "remeshing study", "remeshing studies");
    if (problems == 0) return of_studies;
    return counted(problems, "problem", "problems") + (studies > 0 ? " and " + of_studies : "");
}

/// Runs that failed, by solver and kind, with what was said.
void add_failures(const ReportInput& input, Document& document) {
    static const std::vector<std::pair<Outcome, const char*>> kFailures{
        {Outcome::Crash, "crashed"},
        {Outcome::Timeout, "ended from outside, over the time"},
        {Outcome::OutOfMemory, "ran out of memory"},
        {Outcome::DiskFull, "wrote more than they may"}};
    const Plan& plan = input.campaign.plan;
    BulletList list;
    for (std::size_t s = 0; s < plan.solvers.size(); ++s) {
        for (const auto& [outcome, verb] : kFailures) {
            const NotTaken found = not_taken(input.campaign, s, outcome);
            if (found.problems.empty()) continue;
            list.items.push_back(plan.solvers[s].name + ": runs on " +
                                 counted(found.problems.size(), "problem ", "problems ") + verb +
                                 ": " + listed(found.problems) + "." +
                                 quoted_messages(found.messages));
        }
    }
    if (list.items.empty()) return;
    add_section(document, {"Failures",
                           "failures",
                           {Paragraph{"Unsolved at the limit, in all tables."}, std::move(list)}});
}

/// Runs of more than a second whose processes had to share their processor.
std::string starved_runs(const CampaignRuns& campaign) {
    constexpr double kShare = 0.8;
    std::size_t starved = 0, long_runs = 0;
    for (const auto& record : campaign.records) {
        if (!record || record->measures.wall_seconds < 1) continue;
        const Measures& m = record->measures;
        ++long_runs;
        starved += m.user_seconds + m.system_seconds < kShare * m.wall_seconds;
    }
    if (starved == 0) return "";
    return std::to_string(starved) + " of the " + counted(long_runs, "run", "runs") +
           " that lasted a second or more had less than 80% of one processor: they waited, for "
           "other work on the machine or for the disk. Where time is limited, it is the clock on "
           "the wall that counts, so these runs were given less than the others.";
}

void add_wrong(const ReportInput& input, Document& document) {
    const auto& wrong = input.comparison.check.wrong_jobs;
    if (wrong.empty()) return;
    BulletList list;
    for (const std::size_t j : wrong) {
        list.items.push_back(describe(input.campaign.plan, input.campaign.plan.jobs[j]) + ": " +
                             input.campaign.records[j]->message);
    }
    add_section(document,
                {"Wrong answers",
                 "wrong",
                 {Paragraph{counted(wrong.size(), "run", "runs") +
                            " gave an answer that the runner refuted. They count as unsolved at "
                            "the limit, and their bounds are not used."},
                  std::move(list)}});
}

struct OutcomeCounts {
    std::size_t planned = 0, made = 0, by_time = 0, by_work = 0;
    std::map<Outcome, std::size_t> outcomes;
    double peak_mib = 0;
};

Table outcome_table(const ReportInput& input) {
    static const std::vector<Outcome> kKinds{
        Outcome::Optimal, Outcome::Feasible,      Outcome::Infeasible, Outcome::NoSolution,
        Outcome::Timeout, Outcome::OutOfMemory,   Outcome::DiskFull,   Outcome::Crash,
        Outcome::Wrong,   Outcome::NotApplicable, Outcome::Missing};
    const Plan& plan = input.campaign.plan;
    std::vector<OutcomeCounts> counts(plan.solvers.size());
    std::map<Outcome, std::size_t> totals;
    for (std::size_t j = 0; j < plan.jobs.size(); ++j) {
        OutcomeCounts& count = counts[plan.jobs[j].solver];
        ++count.planned;
        if (!input.campaign.records[j]) continue;
        const Record& record = *input.campaign.records[j];
        ++count.made;
        ++count.outcomes[record.outcome];
        ++totals[record.outcome];
        count.by_time += record.stop_reason == "time-limit";
        count.by_work += record.stop_reason == "work-limit";
        count.peak_mib = std::max(count.peak_mib, record.measures.peak_mib);
    }
    Table table;
    table.caption =
        "Runs by how they ended, in the runner's judgement. Kinds that never occurred "
        "are left out.";
    table.columns = {"solver", "limits", "memory limit [MiB]", "runs", "planned"};
    for (const Outcome kind : kKinds) {
        if (totals.contains(kind)) table.columns.push_back(to_string(kind));
    }
    table.columns.insert(table.columns.end(),
                         {"stopped by time", "by work", "over its time limit", "peak [MiB]"});
    for (std::size_t s = 0; s < plan.solvers.size(); ++s) {
        const auto number = [](std::size_t n) {
            return TableCell(std::to_string(n), static_cast<double>(n));
        };
        std::vector<TableCell> row{
            plan.solvers[s].name, solver_limits(plan.solvers[s]),
            number(static_cast<std::size_t>(plan.solvers[s].limits.memory_mib)),
            number(counts[s].made), number(counts[s].planned)};
        for (const Outcome kind : kKinds) {
            if (totals.contains(kind)) row.push_back(number(counts[s].outcomes[kind]));
        }
        row.push_back(number(counts[s].by_time));
        row.push_back(number(counts[s].by_work));
        row.push_back(number(input.comparison.solvers[s].runs_over_limit));
        row.emplace_back(decimal_text(counts[s].peak_mib, 0), counts[s].peak_mib);
        table.rows.push_back(std::move(row));
    }
    return table;
}

/// A row for each value of what was found out once, not run by run.
Table provenance_table(const CampaignRuns& campaign) {
    static const std::set<std::string> kOfEachRun{"instance", "seed", "renaming", "command"};
    std::map<std::string, std::map<std::string, std::size_t>> values;
    for (const auto& record : campaign.records) {
        if (!record || !record->provenance.is_object()) continue;
        for (const auto& [key, value] : record->provenance.items()) {
            if (kOfEachRun.contains(key)) continue;
            ++values[key][value.is_string() ? value.get<std::string>() : value.dump()];
        }
    }
    Table table{{"what", "value", "runs"}, {}, "Where the runs come from.", false};
    for (const auto& [key, counts] : values) {
        for (const auto& [value, runs] : counts) {
            table.rows.push_back(
                {key, value, TableCell(std::to_string(runs), static_cast<double>(runs))});
        }
    }
    return table;
}

/// The percentile bootstrap of clusters covers too little when these are few.
std::string few_groups(const Plan& plan) {
    constexpr std::size_t kEnough = 10;
    std::set<std::string> groups;
    for (const PlannedProblem& problem : plan.problems) groups.insert(problem.group);
    if (groups.size() < 2 || groups.size() >= kEnough) return "";
    return " There are " + std::to_string(groups.size()) +
           " groups here; with fewer than ten such intervals are too narrow.";
}

}  // namespace

void add_section(Document& document, Section section) {
    if (!section.blocks.empty()) document.sections.push_back(std::move(section));
}

void add_overview(const ReportInput& input, Document& document) {
    const Plan& plan = input.campaign.plan;
    std::set<std::string> groups;
    std::size_t studies = 0, made = 0;
    for (const PlannedProblem& problem : plan.problems) {
        groups.insert(problem.group);
        studies += problem.is_study;
    }
    for (const auto& record : input.campaign.records) made += record.has_value();
    BulletList list;
    list.items.push_back(problems_text(plan.problems.size() - studies, studies) + " in " +
                         counted(groups.size(), "group", "groups") + ", " +
                         counted(plan.solvers.size(), "solver", "solvers") + ", " +
                         counted(made, "run", "runs") + " of " + std::to_string(plan.jobs.size()) +
                         " made.");
    if (studies < plan.problems.size()) {
        list.items.push_back(
            "Every value is of labels that the runner evaluated itself. No claim of any run "
            "contradicts a checked value of another.");
    }
    const std::size_t baseline = baseline_of(plan);
    const SolverSummary& best = input.comparison.virtual_best;
    if (best.taken > 0) {
        list.items.push_back("All exact solvers together prove " + std::to_string(best.proven) +
                             " of the " + counted(best.taken, "problem", "problems") +
                             " that any of them took; the baseline, " +
                             plan.solvers[baseline].name + ", " +
                             std::to_string(input.comparison.solvers[baseline].proven) + ".");
    }
    const std::string starved = starved_runs(input.campaign);
    if (!starved.empty()) list.items.push_back(starved);
    Section section{"At a glance", "overview", {}};
    section.blocks.emplace_back(std::move(list));
    section.blocks.emplace_back(outcome_table(input));
    add_section(document, std::move(section));
    add_wrong(input, document);
    add_failures(input, document);
}

void add_gaps_in_the_record(const ReportInput& input, Document& document) {
    const Plan& plan = input.campaign.plan;
    BulletList list;
    std::size_t open = 0;
    for (const auto& record : input.campaign.records) open += !record.has_value();
    if (open > 0) {
        list.items.push_back(counted(open, "run is", "runs are") +
                             " not yet made; they are in no table. scalefcn-experiment resume DIR "
                             "makes them.");
    }
    for (std::size_t s = 0; s < plan.solvers.size(); ++s) {
        const NotTaken missing = not_taken(input.campaign, s, Outcome::Missing);
        if (!missing.problems.empty()) {
            const std::string how = install_command(plan.solvers[s]);
            list.items.push_back(
                plan.solvers[s].name +
                " is not installed: " + counted(missing.problems.size(), "problem", "problems") +
                " without it." + (how.empty() ? "" : " To install it: " + how + ".") +
                " Then: scalefcn-experiment resume DIR --again missing." +
                quoted_messages(missing.messages));
        }
        const NotTaken refused = not_taken(input.campaign, s, Outcome::NotApplicable);
        if (!refused.problems.empty()) {
            list.items.push_back(plan.solvers[s].name + " cannot take " +
                                 counted(refused.problems.size(), "problem", "problems") + ": " +
                                 listed(refused.problems) + "." +
                                 quoted_messages(refused.messages));
        }
    }
    if (input.study.runs_without_result > 0) {
        list.items.push_back(counted(input.study.runs_without_result, "study run", "study runs") +
                             " ended without a result; they are in no mean of the study.");
    }
    if (!list.items.empty()) {
        add_section(document, {"What is missing", "missing", {std::move(list)}});
    }
    add_gurobi(input, document);
}

void add_method(const ReportInput& input, Document& document) {
    const ReportConfig& r = input.campaign.plan.report;
    BulletList rules;
    rules.items = {
        "Every problem counts once for a solver, by the median over its seeds and renamings.",
        "Times are " +
            std::string(r.clock == "wall" ? "wall time"
                                          : "user and system time of all "
                                            "the run's processes") +
            ", from the operating system. An exact solver is one that claims "
            "bounds; it has solved a problem when it proves it. Runs without a proof, and runs "
            "that "
            "timed out, crashed, ran out of memory or disk, or were wrong, count at the limit, and "
            "in "
            "PAR10 at ten times the limit.",
        "The shift of geometric means is " + decimal_text(r.shift_seconds, 3) +
            " s; in ratios times below " + decimal_text(r.floor_seconds, 3) +
            " s count as that much; times within a factor of " + decimal_text(kTieFactor, 1) +
            " are ties.",
        "Intervals are 95% percentile bootstraps that draw whole groups (all problems of a mesh; a "
        "generated problem is a group of its own), " +
            std::to_string(r.resamplings) + " times; without a second group there is none." +
            few_groups(input.campaign.plan),
        "The gap to the best known value is (best - value) / max(1, |best|), and likewise to the "
        "best bound; without a solution it is 100%. Primal integrals run over " +
            seconds_text(input.comparison.horizon) + " s of the solvers' own clock.",
        "What a solver cannot take, and what is not installed, is left out of its means; the "
        "number of problems stands beside them. Two solvers are compared on the problems that both "
        "took."};
    if (input.comparison.uses_largest_time) {
        rules.items.push_back(
            "Solvers that had a work limit and no time limit count at the "
            "largest time of any run where they did not solve.");
    }
    Section section{"How this was counted", "method", {}};
    section.blocks.emplace_back(std::move(rules));
    section.blocks.emplace_back(provenance_table(input.campaign));
    if (!input.versions.empty()) {
        Table table{{"solver", "version"}, {}, "Solvers that are programs of their own.", false};
        for (const auto& [name, version] : input.versions) table.rows.push_back({name, version});
        section.blocks.emplace_back(std::move(table));
    }
    add_section(document, std::move(section));
}

}  // namespace experiment
