// A job's key is the hash of everything that its result depends on, names included: the problem's
// content, the solver with its options and limits, seed and renaming. So a changed configuration
// makes new runs where it matters and keeps the others.
#include "experiment/plan.h"

#include <algorithm>
#include <random>
#include <set>

#include "experiment/hash.h"
#include "experiment/json_values.h"
#include "experiment/pattern.h"
#include "labeling/errors.h"
#include "labeling/text_file.h"

namespace experiment {
namespace {

using nlohmann::json;

json to_json(const Limits& l) {
    return {{"seconds", or_null(l.seconds)},
            {"ticks", or_null(l.ticks)},
            {"gap", l.gap},
            {"memory_mib", l.memory_mib},
            {"disk_mib", l.disk_mib},
            {"margin_seconds", l.margin_seconds}};
}

Limits limits_from(const json& j) {
    Limits l;
    if (!j.at("seconds").is_null()) l.seconds = j.at("seconds").get<double>();
    if (!j.at("ticks").is_null()) l.ticks = j.at("ticks").get<std::int64_t>();
    l.gap = j.at("gap");
    l.memory_mib = j.at("memory_mib");
    l.disk_mib = j.at("disk_mib");
    l.margin_seconds = j.at("margin_seconds");
    return l;
}

json to_json(const SolverConfig& s) {
    return {{"name", s.name},
            {"solver", s.solver},
            {"program", s.program},
            {"options", s.options},
            {"start", s.start},
            {"threads", s.threads},
            {"limits", to_json(s.limits)},
            {"seeds", s.seeds},
            {"renamings", s.renamings},
            {"problems", s.problems}};
}

SolverConfig solver_from(const json& j) {
    SolverConfig s;
    s.name = j.at("name");
    s.solver = j.at("solver");
    s.program = j.at("program");
    s.options = j.at("options").get<std::map<std::string, std::string>>();
    s.start = j.at("start");
    s.threads = j.at("threads");
    s.limits = limits_from(j.at("limits"));
    s.seeds = j.at("seeds").get<std::vector<std::uint64_t>>();
    s.renamings = j.at("renamings").get<std::vector<std::uint64_t>>();
    s.problems = j.at("problems").get<std::vector<std::string>>();
    return s;
}

json to_json(const PlannedProblem& p) {
    return {{"name", p.name},
            {"file", p.file},
            {"group", p.group},
            {"hash", p.hash},
            {"is_study", p.is_study},
            {"labels", p.labels},
            {"conflicts", p.conflicts},
            {"bonuses", p.bonuses},
            {"rules", p.rules},
            {"units_per_one", p.units_per_one},
            {"optimum", or_null(p.optimum)},
            {"tags", p.tags}};
}

PlannedProblem problem_from(const json& j) {
    PlannedProblem p;
    p.name = j.at("name");
    p.file = j.at("file");
    p.group = j.at("group");
    p.hash = j.at("hash");
    p.is_study = j.at("is_study");
    p.labels = j.at("labels");
    p.conflicts = j.at("conflicts");
    p.bonuses = j.at("bonuses");
    p.rules = j.at("rules");
    p.units_per_one = j.at("units_per_one");
    if (!j.at("optimum").is_null()) p.optimum = j.at("optimum").get<std::int64_t>();
    p.tags = j.at("tags").get<std::map<std::string, std::string>>();
    return p;
}

bool takes(const SolverConfig& solver, const PlannedProblem& problem) {
    if (solver.problems.empty()) return true;
    return std::any_of(solver.problems.begin(), solver.problems.end(),
                       [&](const std::string& p) { return matches(p, problem.name); });
}

std::string key_of(const PlannedProblem& problem, const SolverConfig& solver, const Job& job) {
    json what = to_json(solver);
    for (const char* k : {"seeds", "renamings", "problems"}) what.erase(k);
    return content_hash(problem.name + "\n" + problem.hash + "\n" + what.dump() + "\n" +
                        std::to_string(job.seed) + "\n" + std::to_string(job.renaming));
}

/// A study hands on solver, seed, work and gap, and would drop anything else in silence.
void require_fit_for_study(const SolverConfig& solver, const PlannedProblem& problem) {
    const char* what = !solver.program.empty()                                    ? "a program"
                       : !solver.options.empty()                                  ? "options"
                       : !solver.start.empty()                                    ? "a start"
                       : solver.threads != 1                                      ? "threads"
                       : solver.renamings.size() != 1 || solver.renamings[0] != 0 ? "renamings"
                                                                                  : nullptr;
    if (what == nullptr) return;
    throw labeling::InputError("solver '" + solver.name + "' has " + what + ", which the study " +
                               problem.name + " cannot take: it knows solver, seeds, work and gap");
}

/// Every run on one problem, in a random order.
std::vector<Job> jobs_on(const Plan& plan, std::size_t problem, std::mt19937_64& engine) {
    std::vector<Job> jobs;
    for (std::size_t s = 0; s < plan.solvers.size(); ++s) {
        const SolverConfig& solver = plan.solvers[s];
        if (!takes(solver, plan.problems[problem])) continue;
        if (plan.problems[problem].is_study) require_fit_for_study(solver, plan.problems[problem]);
        for (const std::uint64_t seed : solver.seeds) {
            for (const std::uint64_t renaming : solver.renamings) {
                jobs.push_back({"", problem, s, seed, renaming});
                jobs.back().key = key_of(plan.problems[problem], solver, jobs.back());
            }
        }
    }
    for (std::size_t k = jobs.size(); k > 1; --k) std::swap(jobs[k - 1], jobs[engine() % k]);
    return jobs;
}

}  // namespace

Plan make_plan(const CampaignConfig& config, std::vector<PlannedProblem> problems) {
    Plan plan;
    plan.name = config.name;
    plan.description = config.description;
    plan.config_file = config.file.filename().string();
    plan.config_text = config.text;
    plan.problems = std::move(problems);
    plan.solvers = config.solvers;
    plan.report = config.report;
    std::mt19937_64 engine(config.shuffle);
    std::set<std::string> keys;
    for (std::size_t p = 0; p < plan.problems.size(); ++p) {
        for (Job& job : jobs_on(plan, p, engine)) {
            if (!keys.insert(job.key).second) {
                throw labeling::InputError("two runs are the same: " + describe(plan, job));
            }
            plan.jobs.push_back(std::move(job));
        }
    }
    if (plan.jobs.empty()) {
        throw labeling::InputError(config.file.string() + ": no solver takes any of the problems");
    }
    return plan;
}

json to_json(const Plan& plan) {
    json problems = json::array(), solvers = json::array(), jobs = json::array();
    for (const PlannedProblem& p : plan.problems) problems.push_back(to_json(p));
    for (const SolverConfig& s : plan.solvers) solvers.push_back(to_json(s));
    for (const Job& j : plan.jobs) {
        jobs.push_back({{"key", j.key},
                        {"problem", j.problem},
                        {"solver", j.solver},
                        {"seed", j.seed},
                        {"renaming", j.renaming}});
    }
    const ReportConfig& r = plan.report;
    return {{"name", plan.name},
            {"description", plan.description},
            {"config_file", plan.config_file},
            {"config", plan.config_text},
            {"problems", problems},
            {"solvers", solvers},
            {"report",
             {{"baseline", r.baseline},
              {"floor", r.floor_seconds},
              {"shift", r.shift_seconds},
              {"resamplings", r.resamplings},
              {"clock", r.clock}}},
            {"jobs", jobs}};
}

Plan plan_from(const json& j, const std::string& source) {
    try {
        Plan plan;
        plan.name = j.at("name");
        plan.description = j.at("description");
        plan.config_file = j.at("config_file");
        plan.config_text = j.at("config");
        for (const json& p : j.at("problems")) plan.problems.push_back(problem_from(p));
        for (const json& s : j.at("solvers")) plan.solvers.push_back(solver_from(s));
        const json& r = j.at("report");
        plan.report = {r.at("baseline"), r.at("floor"), r.at("shift"), r.at("resamplings"),
                       r.at("clock")};
        for (const json& entry : j.at("jobs")) {
            Job job{entry.at("key"), entry.at("problem"), entry.at("solver"), entry.at("seed"),
                    entry.at("renaming")};
            if (job.problem >= plan.problems.size() || job.solver >= plan.solvers.size()) {
                throw labeling::InputError(source + ": a job of nothing that is there");
            }
            plan.jobs.push_back(std::move(job));
        }
        return plan;
    } catch (const json::exception& error) {
        throw labeling::InputError(source + ": no plan of a campaign: " + error.what());
    }
}

void write_plan(const Plan& plan, const std::filesystem::path& folder) {
    labeling::write_text_file(folder / "plan.json", to_json(plan).dump(1) + "\n");
}

Plan read_plan(const std::filesystem::path& folder) {
    const auto file = folder / "plan.json";
    if (!std::filesystem::exists(file)) {
        throw labeling::InputError(folder.string() + ": no campaign here (no plan.json)");
    }
    const json j = json::parse(labeling::read_text_file(file), nullptr, false);
    if (j.is_discarded()) throw labeling::InputError(file.string() + ": not JSON");
    return plan_from(j, file.string());
}

std::string describe(const Plan& plan, const Job& job) {
    std::string text = plan.solvers[job.solver].name + " on " + plan.problems[job.problem].name +
                       ", seed " + std::to_string(job.seed);
    if (job.renaming != 0) text += ", renaming " + std::to_string(job.renaming);
    return text;
}

}  // namespace experiment
