#pragma once

#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "experiment/database.h"
#include "labeling/text_file.h"
#include "labeling_mip/external_process.h"

namespace experiment::testing {

namespace fs = std::filesystem;

inline std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

struct ProgramResult {
    labeling::ProgramOutcome outcome;
    std::string output, errors;
};

/// Runs the experiment runner in `folder`; `change` may set limits of the process.
inline ProgramResult run_experiment(const fs::path& folder, std::vector<std::string> words,
                                    const std::function<void(labeling::ProgramRun&)>& change = {}) {
    const labeling::ScratchFolder logs;
    labeling::ProgramRun run;
    run.words = std::move(words);
    run.words.insert(run.words.begin(), SCALEFCN_BINARY_DIR "/bin/scalefcn-experiment");
    run.folder = folder;
    run.output_file = logs.path() / "output";
    run.error_file = logs.path() / "errors";
    if (change) change(run);
    ProgramResult result;
    result.outcome = labeling::run_program(run);
    result.output = content(run.output_file);
    result.errors = content(run.error_file);
    return result;
}

/// What must be the same in two campaigns, however often one of them was killed: per run everything
/// but times, memory and where it ran.
inline std::map<std::string, std::string> answers(const fs::path& folder) {
    std::map<std::string, std::string> result;
    for (const Record& r : Database(folder).records()) {
        std::string text = to_string(r.outcome) + " " + r.status + " " + r.stop_reason + " " +
                           std::to_string(r.value.value_or(-1)) + " " +
                           std::to_string(r.bound.value_or(-1)) + " " + std::to_string(r.work);
        for (const TracePoint& p : r.trace) {
            text += " " + std::to_string(p.work) + ":" + std::to_string(p.value.value_or(-1)) +
                    ":" + std::to_string(p.bound.value_or(-1));
        }
        result[r.key] = text;
    }
    return result;
}

}  // namespace experiment::testing
