// Ways to quads of one scale, side by side: what the paper compares with (its figures 10 and 11),
// and pairing. All are measured alike, against the surface that was given.
#include "meshing/quad_comparison.h"

#include <ctime>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>

#include "geometry/errors.h"
#include "meshing/baselines.h"
#include "meshing/reference_surface.h"

namespace fcn {
namespace {

const std::string kCurvature = "curvature-", kFiltered = "filtered-";

/// The number behind a prefix, > 0 or, for curvatures, >= 0.
std::optional<double> number_behind(const std::string& name, const std::string& prefix) {
    if (!name.starts_with(prefix)) return std::nullopt;
    const std::string text = name.substr(prefix.size());
    try {
        std::size_t end = 0;
        const double number = std::stod(text, &end);
        if (end == text.size() && number >= 0 && number < 1e6) return number;
    } catch (const std::logic_error&) {
    }
    throw InputError("way to quads " + name + ": no number >= 0 after " + prefix);
}

QuadResult make(const std::string& name, const ComparisonInput& input) {
    QuadOptions options;
    options.edge_length = kEdgeLengthFactor * input.rmin;
    options.iterations = input.iterations;
    options.reference = input.reference;
    if (name == "own") return remesh_quads(input.mesh, input.adapted, options);
    if (name == "own-initial") return remesh_quads(input.mesh, input.initial, options);
    if (name == "pairing") {
        options.best_tier = QuadTier::Pairing;
        return remesh_quads(input.mesh, input.adapted, options);
    }
    if (const std::optional<double> threshold = number_behind(name, kCurvature)) {
        options.guidance = QuadGuidance::Threshold;
        options.threshold = *threshold;
        return remesh_quads(input.mesh, input.initial, options);
    }
    options.guidance = QuadGuidance::None;
    if (name == "own-plain") return remesh_quads(input.mesh, input.adapted, options);
    const double detail = name == "filtered" ? 1 : number_behind(name, kFiltered).value_or(0);
    options.reference = nullptr;  // of another surface
    return remesh_quads(filter_detail(input.mesh, detail * input.rmin), {}, options);
}

bool is_known(const std::string& name) {
    for (const std::string& known : quad_way_names())
        if (name == known) return true;
    return number_behind(name, kCurvature) || number_behind(name, kFiltered);
}

void measure(const ComparisonInput& input, QuadComparisonRow& row) {
    const QuadMesh& quads = row.result.mesh;
    const QuadTopology topology = check_topology(quads), wanted = topology_of(input.mesh.mesh);
    row.failure = topology.fault;
    if (row.failure.empty() && (topology.euler_characteristic != wanted.euler_characteristic ||
                                topology.boundary_loops != wanted.boundary_loops ||
                                topology.components != wanted.components))
        row.failure = "another topology than the input's";
    if (!row.failure.empty()) return;
    const std::unique_ptr<ReferenceSurface> own =
        input.reference ? nullptr : std::make_unique<ReferenceSurface>(input.mesh.mesh);
    row.quality = measure_quads(quads, kEdgeLengthFactor * input.rmin);
    row.distance =
        measure_distance(triangle_mesh(quads), input.mesh.mesh,
                         input.reference ? *input.reference : *own, input.sample_spacing);
    row.alignment = measure_alignment(quads, input.adapted, input.sample_spacing);
}

}  // namespace

std::vector<std::string> quad_way_names() {
    return {"own",           "own-initial", "own-plain", "curvature-0.5",
            "curvature-0.8", "filtered",    "pairing"};
}

QuadComparisonRow run_quad_way(const std::string& name, const ComparisonInput& input) {
    if (!is_known(name)) throw InputError("no way to quads is called " + name);
    QuadComparisonRow row;
    row.name = name;
    try {
        const std::clock_t start = std::clock();
        row.result = make(name, input);
        row.cpu_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        measure(input, row);
    } catch (const std::exception& error) {
        row.failure = error.what();
    }
    return row;
}

}  // namespace fcn
