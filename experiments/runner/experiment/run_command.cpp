#include "experiment/run_command.h"

#include <map>

#include "experiment/programs.h"
#include "labeling/formats.h"
#include "labeling/renaming.h"
#include "labeling/text_file.h"
#include "labeling_mip/external_command.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.10g", value);
    return text;
}

/// Words as a shell would have to be told them; programs of ours by name, files as seen from
/// `home`.
std::string for_people(const std::vector<std::string>& words, const fs::path& home) {
    const std::string prefix = home.string() + "/";
    const std::string programs = own_program("labeling-solve").parent_path().string() + "/";
    std::string text;
    for (const std::string& word : words) {
        std::string plain = word;
        for (const std::string& start : {prefix, programs}) {
            if (start.size() > 1 && plain.starts_with(start)) plain.erase(0, start.size());
        }
        const bool needs_quotes =
            plain.empty() || plain.find_first_of(" \t\"'$&|;<>()*?[]{}") != std::string::npos;
        text += text.empty() ? "" : " ";
        if (!needs_quotes) {
            text += plain;
            continue;
        }
        text += "'";
        for (const char c : plain) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
        text += "'";
    }
    return text;
}

void add(std::vector<std::string>& words, std::initializer_list<std::string> more) {
    words.insert(words.end(), more);
}

std::vector<std::string> solve_words(const PlannedProblem& problem, const SolverConfig& solver,
                                     const Job& job, const fs::path& home, const RunCommand& c) {
    std::vector<std::string> words{own_program("labeling-solve").string(),
                                   (home / problem.file).string()};
    add(words, {"--solver", solver.solver, "--seed", std::to_string(job.seed)});
    add(words, {"--threads", std::to_string(solver.threads)});
    if (solver.limits.seconds) add(words, {"--time", number(*solver.limits.seconds)});
    if (solver.limits.ticks) add(words, {"--work", std::to_string(*solver.limits.ticks)});
    if (solver.limits.gap > 0) add(words, {"--gap", number(solver.limits.gap)});
    for (const auto& [key, value] : solver.options) add(words, {"--set", key + "=" + value});
    if (!solver.start.empty()) add(words, {"--start", start_file(home, problem).string()});
    if (job.renaming != 0) add(words, {"--rename", std::to_string(job.renaming)});
    add(words, {"-o", c.solution_file.string(), "--result", c.result_file.string()});
    return words;
}

/// Files of a program's run, in one folder.
struct ProgramFiles {
    fs::path problem, start, solution, result;
};

std::vector<std::string> template_words(const SolverConfig& solver, std::uint64_t seed,
                                        const ProgramFiles& files) {
    const std::map<std::string, std::string> values{
        {"problem", files.problem.string()},
        {"solution", files.solution.string()},
        {"result", files.result.string()},
        {"start", solver.start.empty() ? "" : files.start.string()},
        {"time", solver.limits.seconds ? number(*solver.limits.seconds) : ""},
        {"gap", solver.limits.gap > 0 ? number(solver.limits.gap) : ""},
        {"seed", std::to_string(seed)},
        {"threads", std::to_string(solver.threads)},
        {"memory", std::to_string(solver.limits.memory_mib)},
        {"sources", source_folder().string()},
        {"programs", own_program("labeling-solve").parent_path().string()}};
    auto words = labeling::command_words(solver.program, values);
    if (words.empty() || words[0].empty()) throw labeling::InputError("no program in the command");
    return words;
}

/// Problem and start are told in the names of this renaming.
std::vector<std::string> program_words(const PlannedProblem& problem, const SolverConfig& solver,
                                       const Job& job, const fs::path& home,
                                       const fs::path& scratch, const RunCommand& c) {
    const auto original = labeling::read_problem(home / problem.file);
    const auto renamed = labeling::rename_labels(original, job.renaming);
    const ProgramFiles files{scratch / "problem.lab", scratch / "start.sol", c.solution_file,
                             c.result_file};
    labeling::write_problem(renamed.problem, files.problem);
    if (!solver.start.empty()) {
        const auto start = labeling::read_solution(start_file(home, problem), original);
        labeling::write_solution(labeling::renamed_solution(renamed, start), files.start);
    }
    return template_words(solver, job.seed, files);
}

std::vector<std::string> study_words(const PlannedProblem& problem, const SolverConfig& solver,
                                     const Job& job, const fs::path& home, const RunCommand& c) {
    std::vector<std::string> words{own_program("scalefcn-experiment").string(), "study-run",
                                   (home / problem.file).string()};
    const auto tag = [&](const char* key) {
        const auto it = problem.tags.find(key);
        return it == problem.tags.end() ? std::string() : it->second;
    };
    add(words, {"--scale", tag("scale"), "--detector", tag("detector"), "--mode", tag("mode")});
    add(words, {"--target", tag("target"), "--options", tag("options")});
    add(words, {"--solver", solver.solver, "--seed", std::to_string(job.seed)});
    if (solver.limits.ticks) add(words, {"--work", std::to_string(*solver.limits.ticks)});
    if (solver.limits.gap > 0) add(words, {"--gap", number(solver.limits.gap)});
    add(words, {"-o", c.solution_file.string(), "--result", c.result_file.string()});
    return words;
}

}  // namespace

void check_command(const SolverConfig& solver) {
    template_words(solver, 1, {"problem", "start", "solution", "result"});
}

fs::path start_file(const fs::path& folder, const PlannedProblem& problem) {
    return folder / "starts" / (problem.hash + ".sol");
}

RunCommand run_command(const Plan& plan, const Job& job, const fs::path& home,
                       const fs::path& scratch) {
    const PlannedProblem& problem = plan.problems.at(job.problem);
    const SolverConfig& solver = plan.solvers.at(job.solver);
    RunCommand command;
    command.solution_file = scratch / "solution.sol";
    command.result_file = scratch / "result.json";
    command.words = problem.is_study ? study_words(problem, solver, job, home, command)
                    : solver.program.empty()
                        ? solve_words(problem, solver, job, home, command)
                        : program_words(problem, solver, job, home, scratch, command);
    command.text = for_people(command.words, home);
    return command;
}

}  // namespace experiment
