#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "labeling/problem.h"
#include "labeling/solver.h"

/// What the comparisons of labeling solvers share.
namespace labeling_runs {

/// Every solver that this build knows, external ones too.
labeling::SolverRegistry every_solver();

/// A solver with options of its own, written NAME:KEY=VALUE:...
struct Variant {
    std::string text;
    std::string solver;
    std::map<std::string, std::string> extra;
};

/// Throws InputError that names what is not KEY=VALUE.
Variant parse_variant(const std::string& text);

/// A file itself, or the files NAME.lab and NAME.lab.gz below a folder, sorted.
std::vector<std::filesystem::path> problem_files(const std::filesystem::path& path);

/// The file's name up to .lab.
std::string problem_name(const std::filesystem::path& file);

/// The same problem with its labels renamed and its rules in another order.
labeling::LabelingProblem renamed(const labeling::LabelingProblem& problem, std::uint64_t seed);

/// Of this process and of all children that have ended.
double processor_seconds();

}  // namespace labeling_runs
