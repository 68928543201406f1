#include "app/run_baselines.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "app/command.h"
#include "meshing/comparison.h"

namespace fcn::app {
namespace {

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

void add_baselines(ScaleRecord& scale, const MeshRecord& record, double ratio,
                   const std::vector<std::string>& names) {
    ComparisonInput input{record.mesh, record.initial, scale.adaptation.network};
    input.rmin = scale.rmin;
    input.ratio = ratio;
    input.sample_spacing = scale.rmin / 2;
    for (const std::string& name : names) {
        ComparisonRow row = run_remesher(name, input, scale.remesh.mesh.n_vertices());
        if (row.failure.empty())
            scale.compared.push_back({title_of(name), std::move(row.mesh.mesh), row.quality});
        else
            scale.adaptation.report.warnings.push_back(title_of(name) + ": " + row.failure);
    }
}

}  // namespace fcn::app
