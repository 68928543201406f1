#include "app/run_baselines.h"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>

#include "app/command.h"
#include "app/interrupt.h"
#include "geometry/errors.h"
#include "meshing/comparison.h"

namespace fcn::app {
namespace {

/// Of distances, in diagonals, as `compare` and `measure` have it; rmin / 2 if that is less.
constexpr double kSampleSpacing = 0.005;

std::string title_of(const std::string& name) {
    static const std::map<std::string, std::string> kTitles{
        {"own", "Remesh on the adapted network, again"},
        {"own-initial", "Remesh on the initial network, again"},
        {"own-plain", "Plain remesh, no features"},
        {"curvature-0.5", "Remesh on curves that turn by 0.5 and more"},
        {"curvature-0.8", "Remesh on curves that turn by 0.8 and more"},
        {"quadrics", "Quadric decimation to as many vertices"},
        {"filtered", "Plain remesh of the filtered surface"},
        {"cgal", "CGAL, adapted network protected"},
        {"cgal-constrained", "CGAL, adapted network constrained"},
        {"cgal-initial", "CGAL, initial network protected"},
        {"cgal-plain", "CGAL, no features"}};
    const auto title = kTitles.find(name);
    return title == kTitles.end() ? name : title->second;
}

}  // namespace

void check_baselines(const std::vector<std::string>& names) {
    const std::vector<std::string> known = remesher_names();
    for (const std::string& name : names)
        if (std::ranges::find(known, name) == known.end())
            throw UsageError(fmt::format("--baselines: no remesher is called {} (known: {})", name,
                                         fmt::join(known, ", ")));
}

void add_remeshes(ScaleRecord& scale, const MeshRecord& record, const ReferenceSurface& reference,
                  double ratio, const std::vector<std::string>& names, int threads) {
    ComparisonInput input{record.mesh, record.initial, scale.adaptation.network};
    input.rmin = scale.rmin;
    input.ratio = ratio;
    input.sample_spacing =
        std::min(scale.rmin / 2, kSampleSpacing * bounding_box(record.mesh.mesh).diagonal());
    input.reference = &reference;
    ComparisonRow adapted, initial;
    tbb::task_arena arena(threads);
    arena.execute([&] {
        tbb::parallel_invoke([&] { adapted = run_remesher("own", input, 0); },
                             [&] { initial = run_remesher("own-initial", input, 0); });
    });
    // The remesh is what was asked for: without it the run has failed.
    if (!adapted.failure.empty()) throw fcn::InputError(record.mesh.name + ": " + adapted.failure);
    auto& warnings = scale.adaptation.report.warnings;
    warnings.insert(warnings.end(), adapted.warnings.begin(), adapted.warnings.end());
    scale.remesh = std::move(adapted.mesh);
    scale.remesh_quality = adapted.quality;
    scale.remesh_row = std::move(adapted);
    scale.remesh_row.mesh = {};
    scale.has_remesh = true;
    scale.has_initial_remesh = initial.failure.empty();
    scale.initial_quality = initial.quality;
    scale.compared.push_back({"Remesh on the initial network", std::move(initial)});
    for (const std::string& name : names) {
        if (is_interrupted()) break;
        ComparisonRow row = run_remesher(name, input, scale.remesh.mesh.n_vertices());
        if (!row.failure.empty()) warnings.push_back(title_of(name) + ": " + row.failure);
        scale.compared.push_back({title_of(name), std::move(row)});
    }
}

}  // namespace fcn::app
