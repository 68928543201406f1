#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiment/config.h"

namespace experiment {

/// A problem of a campaign: a labeling problem, or a mesh to adapt and remesh.
struct PlannedProblem {
    std::string name;  ///< unique within the campaign
    std::string file;  ///< relative to the campaign's folder
    std::string
        group;  ///< what is not independent has the same one: the mesh; generated ones are apart
    std::string hash;  ///< of the content, 16 hexadecimal digits
    bool is_study = false;
    std::int64_t labels = 0, conflicts = 0, bonuses = 0, rules = 0;
    double units_per_one = 1;
    std::optional<std::int64_t> optimum;      ///< known by construction
    std::map<std::string, std::string> tags;  ///< mesh, detector, scale, mode, target, iteration
};

/// One run that is to be made.
struct Job {
    std::string key;  ///< 16 hexadecimal digits of everything that matters to its result
    std::size_t problem = 0, solver = 0;  ///< indices into the plan
    std::uint64_t seed = 1;
    std::uint64_t renaming = 0;  ///< of labels and rules; 0: as they are
};

/// Everything that a campaign consists of. The order of the jobs is the order of the runs: blocks
/// of one problem, within which the solvers take turns in a random order, so that none of them has
/// the machine's good hour for itself.
struct Plan {
    std::string name, description;
    std::string config_file, config_text;
    std::vector<PlannedProblem> problems;
    std::vector<SolverConfig> solvers;
    ReportConfig report;
    std::vector<Job> jobs;
};

/// Jobs of a configuration on the problems that it gave. Deterministic. Throws InputError when two
/// jobs would have the same key.
Plan make_plan(const CampaignConfig& config, std::vector<PlannedProblem> problems);

nlohmann::json to_json(const Plan& plan);
Plan plan_from(const nlohmann::json& json, const std::string& source);

/// FOLDER/plan.json, written atomically.
void write_plan(const Plan& plan, const std::filesystem::path& folder);
Plan read_plan(const std::filesystem::path& folder);

/// "solver on problem, seed 3, renaming 2".
std::string describe(const Plan& plan, const Job& job);

}  // namespace experiment
