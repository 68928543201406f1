#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "experiment/campaign_runs.h"
#include "labeling/random.h"

namespace experiment::test {

/// Builds campaigns in memory, run by run.
class CampaignBuilder {
public:
    CampaignBuilder() {
        runs.plan.name = "synthetic";
        runs.plan.config_file = "synthetic.toml";
        runs.plan.report.resamplings = 200;
    }

    std::size_t solver(const std::string& name, double seconds = 10) {
        SolverConfig s;
        s.name = s.solver = name;
        if (seconds > 0) s.limits.seconds = seconds;
        s.seeds = {1};
        s.renamings = {0};
        runs.plan.solvers.push_back(s);
        if (runs.plan.report.baseline.empty()) runs.plan.report.baseline = name;
        return runs.plan.solvers.size() - 1;
    }

    std::size_t problem(const std::string& name, const std::string& group = "mesh",
                        std::int64_t labels = 100) {
        PlannedProblem p;
        p.name = name;
        p.group = group;
        p.hash = "hash-" + name;
        p.labels = labels;
        p.conflicts = 3 * labels;
        runs.plan.problems.push_back(p);
        return runs.plan.problems.size() - 1;
    }

    std::size_t job(std::size_t problem, std::size_t solver, std::uint64_t seed = 1) {
        Job j;
        j.key = "run" + std::to_string(runs.plan.jobs.size());
        j.problem = problem;
        j.solver = solver;
        j.seed = seed;
        runs.plan.jobs.push_back(j);
        runs.records.emplace_back();
        return runs.plan.jobs.size() - 1;
    }

    Record& run(std::size_t problem, std::size_t solver, Outcome outcome, double seconds,
                std::uint64_t seed = 1) {
        const std::size_t j = job(problem, solver, seed);
        Record r;
        r.key = runs.plan.jobs[j].key;
        r.outcome = outcome;
        r.status = to_string(outcome);
        r.solver_seconds = seconds;
        r.measures.user_seconds = seconds;
        r.measures.wall_seconds = 2 * seconds;
        r.provenance = {{"commit", "0123abcd"}};
        runs.records[j] = r;
        return *runs.records[j];
    }

    Record& optimal(std::size_t problem, std::size_t solver, std::int64_t value, double seconds,
                    std::uint64_t seed = 1) {
        Record& r = run(problem, solver, Outcome::Optimal, seconds, seed);
        r.value = r.bound = value;
        r.stop_reason = "finished";
        r.trace = {{seconds / 2, 1, value, {}}, {seconds, 2, value, value}};
        return r;
    }

    Record& feasible(std::size_t problem, std::size_t solver, std::int64_t value,
                     std::optional<std::int64_t> bound, double seconds, std::uint64_t seed = 1) {
        Record& r = run(problem, solver, Outcome::Feasible, seconds, seed);
        r.value = value;
        r.bound = bound;
        r.stop_reason = "time-limit";
        r.trace = {{seconds / 4, 1, value - value / 10, {}}, {seconds / 2, 2, value, bound}};
        return r;
    }

    CampaignRuns runs;
};

/// Everything that a report has a section for, at random.
inline CampaignRuns whole_campaign(std::uint64_t seed, int meshes = 6, int scales = 3) {
    labeling::Random random(seed);
    CampaignBuilder b;
    const std::size_t quick = b.solver("quick"), slow = b.solver("slow"),
                      search = b.solver("search");
    const std::size_t warm = b.solver("slow started"), ablated = b.solver("quick - cuts");
    const std::size_t gurobi = b.solver("gurobi"), glpk = b.solver("glpk");
    b.runs.plan.solvers[warm].solver = "slow";
    b.runs.plan.solvers[warm].start = "local-search";
    b.runs.plan.solvers[ablated].solver = "quick";
    b.runs.plan.solvers[ablated].options["cuts"] = "0";
    for (int m = 0; m < meshes; ++m) {
        for (int s = 0; s < scales; ++s) {
            const std::int64_t labels = 50 << (s + m % 4);
            const std::string mesh = "mesh" + std::to_string(m);
            const auto p = b.problem(mesh + "_" + std::to_string(s), mesh, labels);
            b.runs.plan.problems[p].units_per_one = 1000;
            b.runs.plan.problems[p].tags = {{"mesh", mesh}, {"scale", std::to_string(s)}};
            const std::int64_t best = 1000 * labels + random.below(1000);
            const double base = 1e-6 * std::pow(double(labels), 1.8) * (1 + random.unit());
            const auto exact = [&](std::size_t solver, double seconds) {
                if (seconds < 10) {
                    b.optimal(p, solver, best, seconds);
                } else {
                    b.feasible(p, solver, best - random.below(900), best + 500, 10);
                }
            };
            exact(quick, base * 100);
            exact(slow, base * 2000 * random.unit());
            exact(warm, base * 900 * random.unit());
            exact(ablated, base * 180);
            for (const std::uint64_t run : {1, 2, 3}) {
                b.feasible(p, search, best - random.below(300), {}, 9, run);
            }
            if (labels > 200) {
                b.run(p, gurobi, Outcome::NotApplicable, 0.1).message = "over the licence's size";
            } else {
                exact(gurobi, base * 150);
            }
            b.run(p, glpk, Outcome::Missing, 0).message = "not installed";
        }
    }
    b.job(0, search, 4);
    return b.runs;
}

/// Studies of three solvers; segments are not made.
inline void add_study(CampaignRuns& runs, std::uint64_t seed, int meshes = 5) {
    labeling::Random random(seed);
    for (int m = 0; m < meshes; ++m) {
        for (int s = 0; s < 2; ++s) {
            PlannedProblem p;
            p.group = "mesh" + std::to_string(m);
            p.name = "study_" + p.group + "_" + std::to_string(s);
            p.is_study = true;
            p.tags = {{"mesh", p.group}, {"scale", std::to_string(s + 1) + "%"}};
            runs.plan.problems.push_back(p);
            const double level = random.unit();
            for (std::size_t solver = 0; solver < 3; ++solver) {
                Job j;
                j.key = "study" + std::to_string(runs.plan.jobs.size());
                j.problem = runs.plan.problems.size() - 1;
                j.solver = solver;
                runs.plan.jobs.push_back(j);
                Record r;
                r.key = j.key;
                r.outcome = Outcome::Feasible;
                r.value = 10000 - static_cast<std::int64_t>(solver * random.below(500));
                r.statistics = {{"coverage", 0.8 + 0.1 * level - 0.01 * double(solver)},
                                {"hausdorff_over_diagonal", 0.01 + 0.001 * double(solver)},
                                {"min_angle_degrees", 20 + 10 * level}};
                runs.records.push_back(r);
            }
        }
    }
}

}  // namespace experiment::test
