#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/adaptation_arguments.h"
#include "app/detection.h"
#include "app/pin_arguments.h"
#include "app/progress.h"
#include "report/report.h"

namespace fcn::app {

/// Everything that `run` does to one mesh, apart from writing files.
struct PipelineOptions {
    CommonArguments common;
    MeshArguments mesh;
    DetectionArguments detection;
    PinArguments pins;
    AdaptationOptions adaptation;               ///< rmin is set per scale
    std::vector<std::string> compared_solvers;  ///< side by side on the first problem
    labeling::SolveOptions comparison;          ///< limits of each of them
    bool is_remeshing = true;
};

/// Adapts, and tells `bar` about it as "WHAT: phase".
AdaptationResult adapt_with_progress(const LoadedMesh& mesh, const FeatureCurveNetwork& initial,
                                     AdaptationOptions options, const std::string& what,
                                     ProgressBar& bar);

/// The independent checker with the criteria of `options`; an empty network conforms.
ConformityReport check_result(const AdaptationResult& result, const LoadedMesh& mesh,
                              const AdaptationOptions& options);

/// Each solver on one problem, cold. A solver that fails has its message as status.
std::vector<SolverComparison> compare_solvers(const labeling::LabelingProblem& problem,
                                              const std::string& problem_name,
                                              const PipelineOptions& options);

/// Reads the mesh, makes sure that the scales fit it, finds its features and pins them; the record
/// has no scales yet. InputError if the pins cannot hold at one of the scales.
MeshRecord start_record(const std::string& path, const std::vector<ScaleRequest>& scales,
                        const PipelineOptions& options);

/// Adapts, checks, compares solvers and remeshes at one scale. After Ctrl-C the steps that are
/// left are skipped: adaptation.report.status tells.
ScaleRecord process_scale(const MeshRecord& record, const ScaleRequest& scale,
                          const PipelineOptions& options, ProgressBar& bar);

}  // namespace fcn::app
