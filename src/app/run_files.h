#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/report.h"

namespace fcn::app {

/// Writes problem_<iteration>.lab.gz and problem_<iteration>.sol for every recorded iteration.
std::vector<std::string> write_problems(const AdaptationReport& report,
                                        const std::filesystem::path& folder);

/// Writes step_<iteration>_{resampled,short,kept,dropped}.obj for every recorded iteration: lines,
/// one a segment. What would hold none is not written.
std::vector<std::string> write_steps(const AdaptationReport& report,
                                     const std::filesystem::path& folder);

/// Writes what `run` leaves for one scale: initial.fcn.json, adapted.fcn.json, initial.obj,
/// network.obj, remesh.obj, quads.obj, the field of the quads and the problems. Returns the files
/// in that order. Each is written under a temporary name and renamed.
std::vector<std::string> write_scale_files(const MeshRecord& record, const ScaleRecord& scale,
                                           const std::filesystem::path& folder);

}  // namespace fcn::app
