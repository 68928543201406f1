#pragma once

#include <filesystem>
#include <string>

#include "experiment/config.h"
#include "experiment/record.h"
#include "labeling/problem.h"
#include "labeling_mip/external_process.h"

namespace experiment {

enum class ForcedEnd { None, Time, Memory, Disk };

/// What was seen of a run.
struct Observed {
    labeling::ProgramOutcome outcome;
    ForcedEnd forced = ForcedEnd::None;
    int orphans_left = 0;
    std::filesystem::path result_file, solution_file, error_file;
};

/// Reads the answer, checks its labels against `problem`, and sets everything of the record that
/// depends on it. Never throws for what a solver did.
void judge(const Observed& seen, const labeling::LabelingProblem& problem,
           const SolverConfig& solver, Record& record);

/// The same for a study, whose answer is numbers alone; keeps its network's segments in
/// HOME/segments/KEY.txt.
void judge_study(const Observed& seen, Record& record, const std::filesystem::path& home);

}  // namespace experiment
