#include "app/pipeline.h"

#include <fmt/core.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>

#include "app/inputs.h"
#include "app/interrupt.h"
#include "geometry/mesh_curves.h"
#include "labeling/errors.h"
#include "labeling_mip/mip_solvers.h"

namespace fcn::app {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

SolverComparison comparison_row(const labeling::LabelingProblem& problem,
                                const labeling::SolveResult& result) {
    SolverComparison row;
    row.status = labeling::to_string(result.status);
    const double unit = problem.units_per_one();
    row.value = result.solution ? static_cast<double>(result.solution->value) / unit : kUnknown;
    row.bound = result.bound ? static_cast<double>(*result.bound) / unit : kUnknown;
    row.gap = result.relative_gap().value_or(kUnknown);
    row.seconds = result.seconds;
    return row;
}

/// The mesh of edge length 1.2 rmin (or as asked) on `network`.
RemeshResult remesh_on(const FeatureCurveNetwork& network, const MeshRecord& record, double rmin) {
    RemeshOptions options;
    options.edge_length = kEdgeLengthFactor * rmin;
    return remesh_triangles(record.mesh, network, options);
}

void add_remeshes(ScaleRecord& scale, const MeshRecord& record, const std::string& what,
                  int threads, ProgressBar& bar) {
    if (is_interrupted()) return;
    bar.show(what + ": remeshing on the adapted and on the initial network", 0.9);
    RemeshResult adapted, initial;
    tbb::task_arena arena(threads);
    arena.execute([&] {
        tbb::parallel_invoke(
            [&] { adapted = remesh_on(scale.adaptation.network, record, scale.rmin); },
            [&] { initial = remesh_on(record.initial, record, scale.rmin); });
    });
    scale.remesh_quality = measure_triangles(adapted.mesh.mesh);
    scale.remesh = std::move(adapted.mesh);
    scale.remesh.curves = chain_vertex_pairs(adapted.feature_edges);
    scale.has_remesh = true;
    auto& warnings = scale.adaptation.report.warnings;
    warnings.insert(warnings.end(), adapted.warnings.begin(), adapted.warnings.end());
    scale.initial_quality = measure_triangles(initial.mesh.mesh);
    scale.has_initial_remesh = true;
    scale.compared.push_back(
        {"Remesh on the initial network", std::move(initial.mesh.mesh), scale.initial_quality});
}

}  // namespace

AdaptationResult adapt_with_progress(const LoadedMesh& mesh, const FeatureCurveNetwork& initial,
                                     AdaptationOptions options, const std::string& what,
                                     ProgressBar& bar) {
    options.progress = [&bar, what](const std::string& phase, double fraction) {
        bar.show(fmt::format("{}: {}", what, phase), fraction);
    };
    return adapt_network(mesh, initial, options);
}

ConformityReport check_result(const AdaptationResult& result, const LoadedMesh& mesh,
                              const AdaptationOptions& options) {
    if (result.network.segments.empty()) return {};
    ConformityOptions criteria;
    criteria.rmin = options.rmin;
    criteria.ratio = options.ratio;
    criteria.is_quad_target = options.target == ElementType::Quad;
    criteria.is_thin_wall_exempt = options.thin_walls == ThinWalls::Exempt;
    return check_conformity(result.network, criteria, &mesh.mesh);
}

std::vector<SolverComparison> compare_solvers(const labeling::LabelingProblem& problem,
                                              const std::string& problem_name,
                                              const PipelineOptions& options) {
    const labeling::SolverRegistry registry = labeling::all_solvers();
    std::vector<SolverComparison> rows;
    for (const std::string& name : options.compared_solvers) {
        if (is_interrupted()) break;
        SolverComparison row;
        try {
            row = comparison_row(problem, registry.find(name)->solve(problem, options.comparison));
        } catch (const labeling::InputError& error) {  // e.g. an external program is missing
            row.status = error.what();
            row.value = row.bound = row.gap = row.seconds = kUnknown;
        }
        row.problem = problem_name;
        row.solver = name;
        rows.push_back(std::move(row));
    }
    return rows;
}

MeshRecord start_record(const std::string& path, const std::vector<ScaleRequest>& scales,
                        const PipelineOptions& options) {
    MeshRecord record;
    record.mesh = read_mesh(path, options.mesh.read_options());
    const double diagonal = bounding_box(record.mesh.mesh).diagonal();
    double largest = 0;
    for (const ScaleRequest& scale : scales)
        largest = std::max(largest, resolve_scale(scale, diagonal));
    record.messages = record.mesh.repairs.messages();
    Detection detection =
        detect_network(record.mesh, options.detection, options.common.thread_count());
    add_pins(detection, record.mesh, options.pins, largest);
    record.messages.insert(record.messages.end(), detection.messages.begin(),
                           detection.messages.end());
    for (const ScaleRequest& scale : scales) {
        AdaptationOptions adaptation = options.adaptation;
        adaptation.rmin = resolve_scale(scale, diagonal);
        const std::vector<std::string> conflicts =
            require_pins_hold(detection.network, record.mesh, adaptation, options.pins);
        record.messages.insert(record.messages.end(), conflicts.begin(), conflicts.end());
    }
    record.initial = std::move(detection.network);
    record.method = std::move(detection.method);
    return record;
}

ScaleRecord process_scale(const MeshRecord& record, const ScaleRequest& scale,
                          const PipelineOptions& options, ProgressBar& bar) {
    ScaleRecord result;
    result.label = scale.label();
    result.rmin = resolve_scale(scale, bounding_box(record.mesh.mesh).diagonal());
    const std::string what = fmt::format("{} {}", record.mesh.name, result.label);
    AdaptationOptions adaptation = options.adaptation;
    adaptation.rmin = result.rmin;
    adaptation.is_recording_problems = true;
    result.adaptation = adapt_with_progress(record.mesh, record.initial, adaptation, what, bar);
    result.conformity = check_result(result.adaptation, record.mesh, adaptation);
    const auto& problems = result.adaptation.report.problems;
    if (!problems.empty() && problems.front().label_count() > 0) {
        bar.show(what + ": solvers side by side", 0.85);
        result.solvers = compare_solvers(problems.front(), "iteration 1", options);
    }
    if (options.is_remeshing)
        add_remeshes(result, record, what, options.common.thread_count(), bar);
    return result;
}

}  // namespace fcn::app
