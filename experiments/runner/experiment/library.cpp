// The conflict-graph library: what campaigns have found out about problems, in files that need
// nothing of this project to be read. Best values are checked again from the labels when they are
// written; bounds are the smallest that an exact solver claimed and nobody refuted.
#include "experiment/library.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "experiment/best_solution.h"
#include "experiment/cross_check.h"
#include "experiment/json_values.h"
#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/proving_search.h"
#include "labeling/text_file.h"
#include "labeling_mip/mip_solvers.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Everything known of one problem.
struct Entry {
    PlannedProblem problem;
    const LibrarySource* source = nullptr;  ///< the first that has it
    std::vector<const LibrarySource*> all;
    std::optional<std::int64_t> value, bound;
    std::set<std::string> value_by, proven_by;
    std::optional<double> fastest_proof;  ///< processor seconds
    std::string fastest_prover;

    bool is_proven() const { return value && bound && *value >= *bound; }
};

/// By the rules of the report: whose claims count is decided in one place.
void take_run(Entry& entry, const SolverConfig& config, const Record& record) {
    if (record.outcome == Outcome::Wrong) return;
    const std::string solver = config.name + (config.start.empty() ? "" : " (given a start)");
    const auto bound = claimed_bound(record, config);
    if (record.value) {
        if (!entry.value || *record.value > *entry.value) {
            entry.value = record.value;
            entry.value_by.clear();
        }
        if (*record.value == *entry.value) entry.value_by.insert(solver);
    }
    if (bound && (!entry.bound || *bound < *entry.bound)) entry.bound = bound;
    const bool is_proof =
        record.outcome == Outcome::Optimal && record.value && bound && *bound <= *record.value;
    if (!is_proof) return;
    entry.proven_by.insert(solver);
    const double seconds = record.measures.user_seconds + record.measures.system_seconds;
    if (!entry.fastest_proof || seconds < *entry.fastest_proof) {
        entry.fastest_proof = seconds;
        entry.fastest_prover = solver;
    }
}

std::map<std::string, Entry> collect(const std::vector<LibrarySource>& sources) {
    std::map<std::string, Entry> entries;  // by hash
    for (const LibrarySource& source : sources) {
        const Plan& plan = source.campaign.plan;
        for (const PlannedProblem& problem : plan.problems) {
            if (problem.is_study) continue;
            Entry& entry = entries[problem.hash];
            if (entry.source == nullptr) {
                entry.problem = problem;
                entry.source = &source;
                if (problem.optimum) entry.value = entry.bound = problem.optimum;
            }
            entry.all.push_back(&source);
        }
        for (std::size_t k = 0; k < plan.jobs.size(); ++k) {
            const PlannedProblem& problem = plan.problems[plan.jobs[k].problem];
            if (problem.is_study || !source.campaign.records[k]) continue;
            take_run(entries[problem.hash], plan.solvers[plan.jobs[k].solver],
                     *source.campaign.records[k]);
        }
    }
    // Problems of two campaigns may have one name and, since something has changed, two contents.
    std::set<std::string> names;
    for (auto& [hash, entry] : entries) {
        if (!names.insert(entry.problem.name).second) {
            entry.problem.name += "-" + hash.substr(0, 8);
            names.insert(entry.problem.name);
        }
    }
    return entries;
}

/// The best labels that any of the campaigns kept.
std::optional<labeling::Solution> best_labels(const Entry& entry,
                                              const labeling::LabelingProblem& problem) {
    std::optional<labeling::Solution> best;
    for (const LibrarySource* source : entry.all) {
        const fs::path file = best_solution_file(source->folder, entry.problem.hash);
        if (!fs::exists(file)) continue;
        labeling::Solution solution = labeling::read_solution(file, problem);
        const auto check = labeling::check_solution(problem, solution);
        if (!check.is_feasible) continue;
        solution.value = check.value;
        if (!best || solution.value > best->value) best = std::move(solution);
    }
    return best;
}

std::string in_units(const PlannedProblem& problem, std::optional<std::int64_t> value) {
    if (!value) return "-";
    char text[40];
    std::snprintf(text, sizeof text, "%.4f", static_cast<double>(*value) / problem.units_per_one);
    return text;
}

json metadata(const Entry& entry, const std::optional<labeling::Solution>& labels,
              bool has_certificate) {
    const PlannedProblem& p = entry.problem;
    return {{"name", p.name},
            {"hash", p.hash},
            {"group", p.group},
            {"labels", p.labels},
            {"conflicts", p.conflicts},
            {"bonuses", p.bonuses},
            {"rules", p.rules},
            {"units_per_one", p.units_per_one},
            {"origin", p.tags},
            {"best_value", or_null(entry.value)},
            {"best_bound", or_null(entry.bound)},
            {"proven", entry.is_proven()},
            {"value_found_by", entry.value_by},
            {"proven_by", entry.proven_by},
            {"fastest_proof_cpu_seconds", or_null(entry.fastest_proof)},
            {"fastest_prover", entry.fastest_prover},
            {"has_labels", labels.has_value()},
            {"labels_value", labels ? json(labels->value) : json()},
            {"has_certificate", has_certificate}};
}

/// A proof that the best labels are optimal; nothing within the nodes.
std::optional<std::string> certificate(const labeling::LabelingProblem& problem,
                                       const labeling::Solution& best, std::int64_t nodes) {
    constexpr std::size_t kMostBytes = std::size_t{1} << 26;
    labeling::ProofOptions options;
    options.node_limit = nodes;
    options.most_bytes = kMostBytes;
    const auto proof = labeling::prove_optimality(problem, best, labeling::clp_factory(), options);
    if (!proof.is_complete) return std::nullopt;
    return proof.proof;
}

std::string scoreboard(const std::map<std::string, Entry>& entries) {
    std::vector<const Entry*> sorted;
    std::map<std::string, std::pair<int, int>> solvers;  // proven, best value
    std::map<std::string, int> fastest;
    int proven = 0;
    for (const auto& [hash, entry] : entries) {
        sorted.push_back(&entry);
        proven += entry.is_proven();
        for (const std::string& name : entry.proven_by) ++solvers[name].first;
        for (const std::string& name : entry.value_by) ++solvers[name].second;
        if (!entry.fastest_prover.empty()) ++fastest[entry.fastest_prover];
    }
    std::sort(sorted.begin(), sorted.end(),
              [](const Entry* a, const Entry* b) { return a->problem.name < b->problem.name; });
    std::string text = "# Scoreboard\n\n" + std::to_string(entries.size()) + " problems, " +
                       std::to_string(proven) + " solved to proven optimality.\n\n" +
                       "| solver | proven | fastest proof | best value |\n|---|---|---|---|\n";
    for (const auto& [name, counts] : solvers) {
        text += "| " + name + " | " + std::to_string(counts.first) + " | " +
                std::to_string(fastest[name]) + " | " + std::to_string(counts.second) + " |\n";
    }
    text +=
        "\n| problem | labels | conflicts | bonuses | rules | best value | best bound | gap | "
        "fastest proof, CPU s | by |\n|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Entry* e : sorted) {
        const PlannedProblem& p = e->problem;
        char gap[40] = "-";
        if (e->value && e->bound) {
            const double scale = std::max(1.0, std::abs(static_cast<double>(*e->value)));
            std::snprintf(gap, sizeof gap, "%.4f%%",
                          100 * static_cast<double>(*e->bound - *e->value) / scale);
        }
        char seconds[40] = "-";
        if (e->fastest_proof) std::snprintf(seconds, sizeof seconds, "%.2f", *e->fastest_proof);
        text += "| " + p.name + " | " + std::to_string(p.labels) + " | " +
                std::to_string(p.conflicts) + " | " + std::to_string(p.bonuses) + " | " +
                std::to_string(p.rules) + " | " + in_units(p, e->value) + " | " +
                in_units(p, e->bound) + " | " + (e->is_proven() ? "proven" : gap) + " | " +
                seconds + " | " + e->fastest_prover + " |\n";
    }
    return text;
}

}  // namespace

LibraryResult export_library(const std::vector<LibrarySource>& sources, const fs::path& folder,
                             const LibraryOptions& options) {
    const auto entries = collect(sources);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw labeling::InputError(folder.string() + ": " + error.message());
    LibraryResult result;
    json manifest = json::array();
    for (const auto& [hash, entry] : entries) {
        const std::string& name = entry.problem.name;
        if (entry.value && entry.bound && *entry.value > *entry.bound) {
            throw labeling::InputError(name +
                                       ": a run claims a bound below another run's value; "
                                       "'report' says which");
        }
        const auto problem = labeling::read_problem(entry.source->folder / entry.problem.file);
        labeling::write_problem(problem, folder / (name + ".lab.gz"));
        labeling::write_problem(problem, folder / (name + ".mps.gz"));
        const auto best = best_labels(entry, problem);
        if (best) labeling::write_solution(*best, folder / (name + ".sol.gz"));
        std::optional<std::string> proof;
        if (best && entry.is_proven() && options.proof_nodes > 0) {
            proof = certificate(problem, *best, options.proof_nodes);
            if (proof) labeling::write_text_file(folder / (name + ".pbp.gz"), *proof);
        }
        const json about = metadata(entry, best, proof.has_value());
        labeling::write_text_file(folder / (name + ".json"), about.dump(1) + "\n");
        manifest.push_back(about);
        ++result.problems;
        result.proven += entry.is_proven();
        result.certificates += proof.has_value();
        if (options.tell) options.tell(name);
    }
    labeling::write_text_file(folder / "manifest.json", manifest.dump(1) + "\n");
    labeling::write_text_file(folder / "scoreboard.md", scoreboard(entries));
    return result;
}

}  // namespace experiment
