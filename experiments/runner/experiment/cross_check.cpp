// The comparison of every claim with every checked value. A value is a fact, since the runner
// evaluated the labels itself; a bound, an optimality and an infeasibility are claims. A claim
// below a fact is a fault of the claiming solver (or of the runner): no table over such runs means
// anything, so the report stops.
#include "experiment/cross_check.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace experiment {
namespace {

std::string quoted(const Plan& plan, std::size_t job) {
    const std::string& key = plan.jobs[job].key;
    return describe(plan, plan.jobs[job]) + (key.empty() ? "" : " (run " + key + ")");
}

/// Problems with the same content: the first of them, for each.
std::vector<std::size_t> first_equals(const Plan& plan) {
    std::map<std::string, std::size_t> first;
    std::vector<std::size_t> result;
    for (std::size_t p = 0; p < plan.problems.size(); ++p) {
        const std::string& hash = plan.problems[p].hash;
        result.push_back(hash.empty() ? p : first.emplace(hash, p).first->second);
    }
    return result;
}

class Checker {
public:
    explicit Checker(const CampaignRuns& campaign)
        : campaign_(campaign), first_(first_equals(campaign.plan)) {
        result_.problems.resize(campaign.plan.problems.size());
    }

    CrossCheck check() {
        take_planned();
        each_run([this](std::size_t job, const Record& record) { take(job, record); });
        each_run([this](std::size_t job, const Record& record) { compare(job, record); });
        for (std::size_t p = 0; p < first_.size(); ++p) {
            if (first_[p] != p) result_.problems[p] = result_.problems[first_[p]];
        }
        return std::move(result_);
    }

private:
    template <class Visit>
    void each_run(const Visit& visit) {
        for (std::size_t j = 0; j < campaign_.plan.jobs.size(); ++j) {
            const std::size_t problem = campaign_.plan.jobs[j].problem;
            if (campaign_.plan.problems[problem].is_study) continue;
            if (campaign_.records[j]) visit(j, *campaign_.records[j]);
        }
    }

    std::size_t problem_of(std::size_t job) const {
        return first_[campaign_.plan.jobs[job].problem];
    }
    const SolverConfig& solver_of(std::size_t job) const {
        return campaign_.plan.solvers[campaign_.plan.jobs[job].solver];
    }

    void take_planned() {
        planned_.resize(first_.size());
        for (std::size_t p = 0; p < first_.size(); ++p) {
            const auto& optimum = campaign_.plan.problems[p].optimum;
            if (!optimum) continue;
            planned_[first_[p]] = optimum;
            result_.problems[first_[p]].best_value = optimum;
            result_.problems[first_[p]].best_bound = optimum;
        }
    }

    void take(std::size_t job, const Record& record) {
        ProblemKnowledge& known = result_.problems[problem_of(job)];
        if (record.outcome == Outcome::Wrong) result_.wrong_jobs.push_back(job);
        if (record.outcome == Outcome::Infeasible) known.is_proven_infeasible = true;
        if (record.value && (!known.best_value || *record.value > *known.best_value)) {
            known.best_value = record.value;
            known.best_value_job = job;
        }
        const auto bound = claimed_bound(record, solver_of(job));
        if (bound && (!known.best_bound || *bound < *known.best_bound)) {
            known.best_bound = bound;
            known.best_bound_job = job;
        }
    }

    void accuse(std::size_t job, const std::string& text) {
        const std::size_t problem = campaign_.plan.jobs[job].problem;
        result_.contradictions.push_back(
            {problem, campaign_.plan.problems[problem].name + ": " + text});
    }

    /// The fact that a claim of `problem` is held against, in words.
    std::string fact(std::size_t problem) const {
        const ProblemKnowledge& known = result_.problems[problem];
        const std::string value = std::to_string(*known.best_value);
        if (!known.best_value_job) return "the optimum known by construction is " + value;
        return "the checked value of " + quoted(campaign_.plan, *known.best_value_job) + " is " +
               value;
    }

    void compare(std::size_t job, const Record& record) {
        const std::size_t problem = problem_of(job);
        const ProblemKnowledge& known = result_.problems[problem];
        if (record.value && planned_[problem] && *record.value > *planned_[problem]) {
            accuse(job, "the checked value of " + quoted(campaign_.plan, job) + " is " +
                            std::to_string(*record.value) +
                            ", the optimum known by construction is " +
                            std::to_string(*planned_[problem]));
        }
        if (!known.best_value) return;
        if (record.outcome == Outcome::Infeasible) {
            accuse(job, quoted(campaign_.plan, job) + " says infeasible, but " + fact(problem));
        }
        const auto bound = claimed_bound(record, solver_of(job));
        if (bound && *bound < *known.best_value) {
            const char* verb =
                record.outcome == Outcome::Optimal ? " says optimal at " : " claims the bound ";
            accuse(job, quoted(campaign_.plan, job) + verb + std::to_string(*bound) + ", but " +
                            fact(problem));
        }
    }

    const CampaignRuns& campaign_;
    std::vector<std::size_t> first_;
    std::vector<std::optional<std::int64_t>> planned_;
    CrossCheck result_;
};

}  // namespace

std::optional<std::int64_t> claimed_bound(const Record& record, const SolverConfig& solver) {
    const bool is_refuted = record.outcome == Outcome::Wrong;
    const bool is_failed = record.outcome == Outcome::Crash || record.outcome == Outcome::Missing ||
                           record.outcome == Outcome::NotApplicable;
    if (is_refuted || is_failed) return std::nullopt;
    if (record.outcome != Outcome::Optimal || !record.value) return record.bound;
    if (solver.limits.gap > 0 && record.bound) return record.bound;
    // To say optimal is to say that nothing is better by more than the gap.
    const double value = static_cast<double>(*record.value);
    const auto slack =
        static_cast<std::int64_t>(std::floor(solver.limits.gap * std::max(1.0, std::abs(value))));
    const std::int64_t implied = *record.value + slack;
    return record.bound ? std::min(*record.bound, implied) : implied;
}

CrossCheck cross_check(const CampaignRuns& campaign) { return Checker(campaign).check(); }

}  // namespace experiment
