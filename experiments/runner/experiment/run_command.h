#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiment/plan.h"

namespace experiment {

/// What is started for a run, and where its answer will be.
struct RunCommand {
    std::vector<std::string> words;
    std::string text;  ///< the same for people: to be typed in the campaign's folder
    std::filesystem::path solution_file, result_file;
};

/// For a solver of this project: labeling-solve; for a study: scalefcn-experiment study-run; for a
/// program: its words with {problem} (a plain .lab file), {solution}, {result}, {start}, {time},
/// {gap}, {seed}, {threads}, {memory} (MiB), {sources} and {programs} (folders) replaced; what
/// stands in [ ] is left out where its placeholder has no value. Writes what the program is to read
/// into `scratch`.
RunCommand run_command(const Plan& plan, const Job& job, const std::filesystem::path& home,
                       const std::filesystem::path& scratch);

/// Throws InputError when a program's command is no template: an unknown placeholder, an open
/// quote, no word at all.
void check_command(const SolverConfig& solver);

/// The start of a problem for solvers that get one: FOLDER/starts/HASH.sol.
std::filesystem::path start_file(const std::filesystem::path& folder,
                                 const PlannedProblem& problem);

}  // namespace experiment
