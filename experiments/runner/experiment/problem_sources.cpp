#include "experiment/problem_sources.h"

#include <fstream>
#include <map>
#include <set>

#include "experiment/hash.h"
#include "experiment/mesh_sources.h"
#include "experiment/pattern.h"
#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/generators.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;
using labeling::InputError;
using labeling::LabelingProblem;

LabelingProblem without_rules(const LabelingProblem& problem) {
    labeling::ProblemBuilder builder;
    for (const auto weight : problem.weights()) builder.add_label(weight);
    for (const auto& c : problem.conflicts()) builder.add_conflict(c.first, c.second);
    for (const auto& b : problem.bonuses()) builder.add_bonus(b.first, b.second, b.value);
    builder.set_units_per_one(problem.units_per_one());
    return builder.build();
}

/// The name up to the extensions that problems have.
std::string problem_name(const fs::path& file) {
    std::string name = file.filename().string();
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    return fs::path(name).stem().string();
}

class Maker {
public:
    Maker(const CampaignConfig& config, const fs::path& folder,
          const std::function<void(const std::string&)>& tell)
        : config_(config), folder_(folder), tell_(tell) {
        fs::create_directories(folder_ / "problems");
    }

    std::vector<PlannedProblem> make() {
        for (const ProblemConfig& source : config_.problems) {
            try {
                if (!source.files.empty()) {
                    from_files(source);
                } else if (!source.family.empty()) {
                    from_family(source);
                } else {
                    from_meshes(source);
                }
            } catch (const InputError& error) {
                throw InputError(config_.file.string() + ":" + std::to_string(source.line) + ": " +
                                 error.what());
            }
        }
        return std::move(problems_);
    }

private:
    void add(const LabelingProblem& given, PlannedProblem planned, const ProblemConfig& source) {
        const LabelingProblem bare = source.drops_rules ? without_rules(given) : LabelingProblem();
        const LabelingProblem& problem = source.drops_rules ? bare : given;
        if (source.drops_rules) {
            planned.name += "_no-rules";
            planned.tags["rules"] = "dropped";
        }
        if (!names_.insert(planned.name).second) {
            throw InputError("two problems are named " + planned.name);
        }
        if (!source.group.empty()) planned.group = source.group;
        planned.file = "problems/" + planned.name + ".lab.gz";
        planned.hash = hexadecimal(problem.hash());
        planned.labels = problem.label_count();
        planned.conflicts = static_cast<std::int64_t>(problem.conflict_count());
        planned.bonuses = static_cast<std::int64_t>(problem.bonus_count());
        planned.rules = static_cast<std::int64_t>(problem.rule_count());
        planned.units_per_one = problem.units_per_one();
        labeling::write_problem(problem, folder_ / planned.file);
        problems_.push_back(std::move(planned));
    }

    /// Problems of one mesh belong together; their names begin with the mesh's.
    void from_files(const ProblemConfig& source) {
        const fs::path home = fs::absolute(config_.file).parent_path();
        for (const std::string& pattern : source.files) {
            const auto files = matching_files(pattern, home);
            if (files.empty()) throw InputError("files: nothing matches " + pattern);
            tell_(pattern + ": " + std::to_string(files.size()) + " files");
            for (const fs::path& file : files) {
                PlannedProblem planned;
                planned.name = problem_name(file);
                planned.group = planned.name.substr(0, planned.name.find('_'));
                planned.tags["source"] = "file";
                add(labeling::read_problem(file), std::move(planned), source);
            }
        }
    }

    /// Every combination of the options' values.
    void from_family(const ProblemConfig& source) {
        std::vector<std::map<std::string, std::string>> choices{{}};
        for (const auto& [key, values] : source.family_options) {
            std::vector<std::map<std::string, std::string>> longer;
            for (const auto& choice : choices) {
                for (const std::string& value : values) {
                    longer.push_back(choice);
                    longer.back()[key] = value;
                }
            }
            choices = std::move(longer);
        }
        tell_(source.family + ": " + std::to_string(choices.size()) + " generated");
        for (const auto& choice : choices) {
            const auto generated = labeling::generate_problem(source.family, choice);
            PlannedProblem planned;
            planned.name = source.family;
            for (const auto& [key, value] : choice) planned.name += "_" + key + value;
            planned.group = planned.name;  // generated apart from each other: independent
            planned.tags = choice;
            planned.tags["source"] = "generated";
            planned.tags["family"] = source.family;
            if (generated.optimum && !source.drops_rules) {
                planned.optimum = generated.optimum->value;
            }
            add(generated.problem, std::move(planned), source);
        }
    }

    void from_meshes(const ProblemConfig& source) {
        const auto meshes =
            mesh_sources(source.meshes, fs::absolute(config_.file).parent_path(), folder_);
        for (const MeshSource& mesh : meshes) {
            for (const std::string& detector : source.detectors) {
                for (const std::string& scale : source.scales) {
                    for (const std::string& mode : source.modes) {
                        for (const std::string& target : source.targets) {
                            from_mesh(source, mesh,
                                      {scale, detector, mode, target, source.adapt_options,
                                       source.iterations == "first"});
                        }
                    }
                }
            }
        }
    }

    void from_mesh(const ProblemConfig& source, const MeshSource& mesh,
                   const AdaptRequest& request) {
        const std::string name = adaptation_name(mesh.name, request);
        PlannedProblem planned;
        planned.group = mesh.name;
        planned.tags = {{"source", "mesh"},       {"mesh", mesh.name},
                        {"scale", request.scale}, {"detector", request.detector},
                        {"mode", request.mode},   {"target", request.target}};
        if (source.is_study) return add_study(mesh, request, name, std::move(planned));
        tell_("adapting " + name);
        const auto files = adapted_problems(mesh, request, folder_);
        for (std::size_t k = 0; k < files.size(); ++k) {
            if (k > 0 && request.wants_first_only) break;
            PlannedProblem one = planned;
            one.name = name + "_" + std::to_string(k + 1);
            one.tags["iteration"] = std::to_string(k + 1);
            const LabelingProblem problem = labeling::read_problem(files[k]);
            if (problem.label_count() == 0) {
                tell_(one.name + ": no labels, left out");
                continue;
            }
            add(problem, std::move(one), source);
        }
    }

    void add_study(const MeshSource& mesh, const AdaptRequest& request, const std::string& name,
                   PlannedProblem planned) {
        if (!names_.insert(name).second) throw InputError("two problems are named " + name);
        planned.name = name;
        planned.is_study = true;
        planned.file = fs::relative(mesh.file, folder_).string();
        std::ifstream file(mesh.file, std::ios::binary);
        planned.hash = content_hash(std::string(std::istreambuf_iterator<char>(file), {}));
        for (const std::string& option : request.options) {
            planned.tags["options"] += (planned.tags["options"].empty() ? "" : " ") + option;
        }
        problems_.push_back(std::move(planned));
    }

    const CampaignConfig& config_;
    const fs::path folder_;
    const std::function<void(const std::string&)>& tell_;
    std::set<std::string> names_;
    std::vector<PlannedProblem> problems_;
};

}  // namespace

std::vector<PlannedProblem> make_problems(const CampaignConfig& config, const fs::path& folder,
                                          const std::function<void(const std::string&)>& tell) {
    return Maker(config, folder, tell).make();
}

}  // namespace experiment
