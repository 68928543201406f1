#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adaptation/adaptation_surface.h"
#include "app/adaptation_arguments.h"
#include "app/detection.h"
#include "app/pin_arguments.h"
#include "app/progress.h"
#include "meshing/reference_surface.h"
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
    std::vector<std::string> baselines;  ///< ways of remesher_names() to take, too
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

/// What every scale of a mesh needs of its surface.
struct SharedSurface {
    SharedSurface(const Mesh& mesh, int threads);

    std::unique_ptr<AdaptationSurface> adaptation;
    std::unique_ptr<ReferenceSurface> reference;
};

/// Adapts, checks, compares solvers and remeshes at one scale. After Ctrl-C the steps that are
/// left are skipped: adaptation.report.status tells.
ScaleRecord process_scale(const MeshRecord& record, const ScaleRequest& scale,
                          const SharedSurface& surface, const PipelineOptions& options,
                          ProgressBar& bar);

/// All scales, several at a time as threads and memory allow; the records in the order of the
/// scales. `finished` gets each when it is done, from any thread and in any order. After Ctrl-C
/// scales that have not begun are left out.
std::vector<ScaleRecord> process_scales(const MeshRecord& record,
                                        const std::vector<ScaleRequest>& scales,
                                        const PipelineOptions& options, ProgressBar& bar,
                                        const std::function<void(const ScaleRecord&)>& finished);

}  // namespace fcn::app
