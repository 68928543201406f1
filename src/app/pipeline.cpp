#include "app/pipeline.h"

#include <fmt/core.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

#include "app/inputs.h"
#include "app/interrupt.h"
#include "app/run_baselines.h"
#include "app/run_quads.h"
#include "labeling/errors.h"
#include "labeling/solver.h"
#include "labeling_mip/mip_solvers.h"

namespace fcn::app {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// Faces of the input times scales that are worked on at a time: about 1 KB of memory each.
constexpr std::size_t kFacesAtOnce = 4'000'000;

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

/// Other people's solvers do not count ticks, and on a hard problem would keep a run for hours.
/// Where equal runs are to give equal bytes they may.
constexpr std::chrono::duration<double> kPeerTime{20};

std::vector<SolverComparison> compare_solvers(const labeling::LabelingProblem& problem,
                                              const std::string& problem_name,
                                              const PipelineOptions& options) {
    const labeling::SolverRegistry registry = labeling::all_solvers();
    const std::vector<std::string> own = labeling::builtin_solvers().names();
    std::vector<SolverComparison> rows;
    for (const std::string& name : options.compared_solvers) {
        if (is_interrupted()) break;
        SolverComparison row;
        try {
            labeling::SolveOptions limits = options.comparison;
            if (!limits.time_limit && !options.common.is_timeless &&
                std::ranges::find(own, name) == own.end())
                limits.time_limit = kPeerTime;
            row = comparison_row(problem, registry.find(name)->solve(problem, limits));
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

SharedSurface::SharedSurface(const Mesh& mesh, int threads)
    : adaptation(nullptr), reference(nullptr) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
        tbb::parallel_invoke([&] { adaptation = std::make_unique<AdaptationSurface>(mesh); },
                             [&] { reference = std::make_unique<ReferenceSurface>(mesh); });
    });
}

ScaleRecord process_scale(const MeshRecord& record, const ScaleRequest& scale,
                          const SharedSurface& surface, const PipelineOptions& options,
                          ProgressBar& bar) {
    ScaleRecord result;
    result.label = scale.label();
    result.rmin = resolve_scale(scale, bounding_box(record.mesh.mesh).diagonal());
    const std::string what = fmt::format("{} {}", record.mesh.name, result.label);
    AdaptationOptions adaptation = options.adaptation;
    adaptation.rmin = result.rmin;
    adaptation.is_recording_problems = true;
    adaptation.surface = surface.adaptation.get();
    result.adaptation = adapt_with_progress(record.mesh, record.initial, adaptation, what, bar);
    result.conformity = check_result(result.adaptation, record.mesh, adaptation);
    const auto& problems = result.adaptation.report.problems;
    if (!problems.empty() && problems.front().label_count() > 0) {
        bar.show(what + ": solvers side by side", 0.85);
        result.solvers = compare_solvers(problems.front(), "iteration 1", options);
    }
    if (options.is_remeshing && !is_interrupted()) {
        bar.show(what + ": remeshing on the adapted and on the initial network", 0.9);
        add_remeshes(result, record, *surface.reference, adaptation.ratio, options.baselines,
                     options.common.thread_count());
    }
    if (options.is_remeshing && adaptation.target == ElementType::Quad && !is_interrupted()) {
        bar.show(what + ": quads", 0.95);
        result.quads = make_quads(result, record, *surface.reference);
        auto& warnings = result.adaptation.report.warnings;
        for (const std::string& warning : result.quads->result.warnings)
            warnings.push_back("quads: " + warning);
    }
    return result;
}

std::vector<ScaleRecord> process_scales(const MeshRecord& record,
                                        const std::vector<ScaleRequest>& scales,
                                        const PipelineOptions& options, ProgressBar& bar,
                                        const std::function<void(const ScaleRecord&)>& finished) {
    const int threads = options.common.thread_count();
    const SharedSurface surface(record.mesh.mesh, threads);
    const std::size_t faces = std::max<std::size_t>(1, record.mesh.mesh.n_faces());
    const auto at_once = static_cast<int>(
        std::clamp<std::size_t>(kFacesAtOnce / faces, 1, static_cast<std::size_t>(threads)));
    std::vector<std::optional<ScaleRecord>> done(scales.size());
    tbb::task_arena arena(at_once);
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, scales.size(), 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t i = range.begin(); i < range.end(); ++i) {
                    if (is_interrupted()) continue;
                    done[i] = process_scale(record, scales[i], surface, options, bar);
                    finished(*done[i]);
                }
            },
            tbb::simple_partitioner());
    });
    std::vector<ScaleRecord> result;
    for (std::optional<ScaleRecord>& scale : done)
        if (scale) result.push_back(std::move(*scale));
    return result;
}

}  // namespace fcn::app
