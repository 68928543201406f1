// Two campaigns, usually of two versions of the solvers. A change counts as a regression only when
// a bootstrap over groups says so: single problems always get slower somewhere.
#include "experiment/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "experiment/comparison.h"
#include "experiment/report_numbers.h"

namespace experiment {
namespace {

using nlohmann::json;

constexpr std::size_t kMostListed = 10;

std::map<std::string, std::size_t> problems_by_hash(const Plan& plan) {
    std::map<std::string, std::size_t> problems;
    for (std::size_t p = 0; p < plan.problems.size(); ++p) {
        if (!plan.problems[p].is_study) problems.emplace(plan.problems[p].hash, p);
    }
    return problems;
}

/// Finished: proven by an exact solver, or any solution of another one.
bool is_finished(const Cell& cell, bool is_exact) {
    return is_exact ? cell.is_proven : cell.value.has_value();
}

/// What a cell counts in ratios of times: its own time when finished, else the limit.
double counted(const Cell& cell, bool is_exact, double floor) {
    return std::max(is_exact ? cell.counted : cell.seconds, floor);
}

class CampaignComparer {
public:
    CampaignComparer(const CampaignRuns& before, const CampaignRuns& after)
        : runs_before_(before),
          runs_after_(after),
          before_(compare_solvers(before)),
          after_(compare_solvers(after)),
          by_hash_(problems_by_hash(before.plan)) {}

    CampaignChange compare() {
        CampaignChange change;
        for (std::size_t b = 0; b < runs_after_.plan.solvers.size(); ++b) {
            const SolverConfig& solver = runs_after_.plan.solvers[b];
            const auto& others = runs_before_.plan.solvers;
            const auto found =
                std::find_if(others.begin(), others.end(),
                             [&](const SolverConfig& s) { return s.name == solver.name; });
            if (found == others.end()) {
                change.notes.push_back(solver.name + " is only in the second campaign");
                continue;
            }
            const auto a = static_cast<std::size_t>(found - others.begin());
            note_limits(*found, solver, change);
            SolverChange of_solver = compare_solver(a, b);
            if (of_solver.problems == 0) {
                change.notes.push_back(solver.name + " has no problem in both campaigns");
                continue;
            }
            change.has_regression |= of_solver.is_regression();
            change.solvers.push_back(std::move(of_solver));
        }
        add_notes(change);
        return change;
    }

private:
    static void note_limits(const SolverConfig& a, const SolverConfig& b, CampaignChange& change) {
        const bool are_same = a.limits.seconds == b.limits.seconds &&
                              a.limits.ticks == b.limits.ticks && a.limits.gap == b.limits.gap &&
                              a.threads == b.threads;
        if (!are_same)
            change.notes.push_back(a.name + " has other limits or threads in the second");
        if (a.options != b.options)
            change.notes.push_back(a.name + " has other options in the second");
    }

    static std::set<std::string> distinct(const CampaignRuns& runs, const char* key) {
        std::set<std::string> values;
        for (const auto& record : runs.records) {
            if (!record || !record->provenance.is_object()) continue;
            const auto it = record->provenance.find(key);
            if (it != record->provenance.end()) values.insert(it->dump());
        }
        return values;
    }

    void add_notes(CampaignChange& change) const {
        for (const char* key : {"host", "processor", "compiler", "flags"}) {
            if (distinct(runs_before_, key) != distinct(runs_after_, key)) {
                change.notes.push_back(std::string("the two were not made with the same ") + key);
            }
        }
        if (runs_before_.plan.report.clock != runs_after_.plan.report.clock) {
            change.notes.push_back("the two measure by different clocks");
        }
        for (const Contradiction& c : before_.check.contradictions) {
            change.notes.push_back("a contradiction in the first: " + c.text);
        }
        for (const Contradiction& c : after_.check.contradictions) {
            change.notes.push_back("a contradiction in the second: " + c.text);
            change.has_regression = true;
        }
    }

    SolverChange compare_solver(std::size_t a, std::size_t b) {
        SolverChange change;
        change.solver = runs_after_.plan.solvers[b].name;
        const bool is_exact = before_.solvers[a].is_exact || after_.solvers[b].is_exact;
        std::vector<Grouped> ratios, values, proofs;
        for (std::size_t p = 0; p < runs_after_.plan.problems.size(); ++p) {
            const PlannedProblem& problem = runs_after_.plan.problems[p];
            const auto found = by_hash_.find(problem.hash);
            if (found == by_hash_.end()) continue;
            const Cell& x = before_.cells[a][found->second];
            const Cell& y = after_.cells[b][p];
            if (x.standing != Standing::Taken || y.standing != Standing::Taken) continue;
            ++change.problems;
            if (is_finished(x, is_exact) || is_finished(y, is_exact)) {
                const double floor = runs_after_.plan.report.floor_seconds;
                ratios.push_back(
                    {problem.group, counted(y, is_exact, floor) / counted(x, is_exact, floor)});
            }
            proofs.push_back({problem.group, double(y.is_proven) - double(x.is_proven)});
            if (x.is_proven && !y.is_proven) change.lost_proofs.push_back(problem.name);
            if (y.is_proven && !x.is_proven) change.gained_proofs.push_back(problem.name);
            compare_values(x, y, problem, change, values);
        }
        const auto wrong = [](const SolverSummary& summary) {
            const auto it = summary.outcomes.find(Outcome::Wrong);
            return it == summary.outcomes.end() ? std::size_t{0} : it->second;
        };
        change.wrong_before = wrong(before_.solvers[a]);
        change.wrong_after = wrong(after_.solvers[b]);
        judge(change, ratios, values, proofs);
        return change;
    }

    static void compare_values(const Cell& x, const Cell& y, const PlannedProblem& problem,
                               SolverChange& change, std::vector<Grouped>& values) {
        change.better += y.value > x.value;
        change.worse += y.value < x.value;
        if (y.value < x.value) {
            change.worse_values.push_back(problem.name + ": " + std::to_string(*x.value) + " to " +
                                          (y.value ? std::to_string(*y.value) : "no solution"));
        }
        if (!x.value && !y.value) return;
        // A solution lost or found is a change by the whole of it.
        double relative = y.value ? 1 : -1;
        if (x.value && y.value) {
            const auto from = static_cast<double>(*x.value), to = static_cast<double>(*y.value);
            relative = std::clamp((to - from) / std::max(1.0, std::abs(from)), -1.0, 1.0);
        }
        values.push_back({problem.group, relative});
    }

    void judge(SolverChange& change, const std::vector<Grouped>& ratios,
               const std::vector<Grouped>& values, const std::vector<Grouped>& proofs) const {
        const int resamplings = runs_after_.plan.report.resamplings;
        change.time_ratio = bootstrap(ratios, geometric_mean_of, resamplings);
        change.value_change = bootstrap(values, mean_of, resamplings);
        const Interval proof_change = bootstrap(proofs, mean_of, resamplings);
        change.is_slower = change.time_ratio.is_known && change.time_ratio.low > kNotableRatio;
        change.is_faster = change.time_ratio.is_known && change.time_ratio.high < 1 / kNotableRatio;
        change.is_worse = change.value_change.is_known && change.value_change.high < 0;
        change.loses_proofs = proof_change.is_known && proof_change.high < 0;
        change.is_more_wrong = change.wrong_after > change.wrong_before;
    }

    const CampaignRuns& runs_before_;
    const CampaignRuns& runs_after_;
    Comparison before_, after_;
    std::map<std::string, std::size_t> by_hash_;
};

void list_some(std::ostream& out, const std::string& what, const std::vector<std::string>& names) {
    if (names.empty()) return;
    out << "  " << what << " (" << names.size() << "):\n";
    for (std::size_t k = 0; k < std::min(kMostListed, names.size()); ++k) {
        out << "    " << names[k] << "\n";
    }
    if (names.size() > kMostListed) out << "    and " << names.size() - kMostListed << " more\n";
}

json json_of(const Interval& interval) {
    const auto number = [](double n, bool is_known) {
        return is_known && std::isfinite(n) ? json(n) : json();
    };
    return {{"estimate", number(interval.estimate, true)},
            {"low", number(interval.low, interval.is_known)},
            {"high", number(interval.high, interval.is_known)}};
}

}  // namespace

CampaignChange compare_campaigns(const CampaignRuns& before, const CampaignRuns& after) {
    return CampaignComparer(before, after).compare();
}

/// In a word or two. Without an interval there is nothing to say, good or bad.
std::string verdict(const SolverChange& change) {
    if (change.is_regression()) return "REGRESSION";
    const bool is_known = change.time_ratio.is_known || change.value_change.is_known;
    if (!is_known) return "cannot tell, without a second group of problems";
    return change.is_faster ? "faster" : "no regression";
}

std::string to_text(const CampaignChange& change) {
    std::ostringstream out;
    for (const SolverChange& s : change.solvers) {
        out << s.solver << ", " << s.problems << (s.problems == 1 ? " problem" : " problems")
            << ": " << verdict(s) << "\n";
        out << "  time after / before   " << ratio_interval(s.time_ratio)
            << (s.is_slower ? "  slower" : "") << "\n";
        out << "  values                " << s.better << " better, " << s.worse << " worse; mean "
            << percent_interval(s.value_change) << (s.is_worse ? "  worse" : "") << "\n";
        out << "  proofs                " << s.gained_proofs.size() << " gained, "
            << s.lost_proofs.size() << " lost" << (s.loses_proofs ? "  fewer" : "") << "\n";
        if (s.wrong_before + s.wrong_after > 0) {
            out << "  wrong runs            " << s.wrong_before << " before, " << s.wrong_after
                << " after\n";
        }
        list_some(out, "lost proofs", s.lost_proofs);
        list_some(out, "worse values", s.worse_values);
    }
    for (const std::string& note : change.notes) out << "note: " << note << "\n";
    return out.str();
}

json to_json(const CampaignChange& change) {
    json solvers = json::array();
    for (const SolverChange& s : change.solvers) {
        solvers.push_back({{"solver", s.solver},
                           {"problems", s.problems},
                           {"time_ratio", json_of(s.time_ratio)},
                           {"better", s.better},
                           {"worse", s.worse},
                           {"value_change", json_of(s.value_change)},
                           {"lost_proofs", s.lost_proofs},
                           {"gained_proofs", s.gained_proofs},
                           {"worse_values", s.worse_values},
                           {"wrong_before", s.wrong_before},
                           {"wrong_after", s.wrong_after},
                           {"is_slower", s.is_slower},
                           {"is_faster", s.is_faster},
                           {"is_worse", s.is_worse},
                           {"loses_proofs", s.loses_proofs},
                           {"is_more_wrong", s.is_more_wrong}});
    }
    return {
        {"solvers", solvers}, {"notes", change.notes}, {"has_regression", change.has_regression}};
}

}  // namespace experiment
