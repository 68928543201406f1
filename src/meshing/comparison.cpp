// Ways to make a triangle mesh of one scale, side by side: what the paper compares with (its
// figures 1, 7, 9 and 10), and CGAL's remesher on the same features. All are measured alike.
#include "meshing/comparison.h"

#include <ctime>
#include <exception>
#include <memory>
#include <stdexcept>

#include "geometry/errors.h"
#include "geometry/mesh_curves.h"
#include "meshing/baselines.h"
#include "meshing/reference_surface.h"
#include "meshing/self_intersections.h"

namespace fcn {
namespace {

const std::string kCurvature = "curvature-";

RemeshOptions options_of(const ComparisonInput& input, bool is_protecting = true) {
    RemeshOptions options;
    options.edge_length = kEdgeLengthFactor * input.rmin;
    options.iterations = input.iterations;
    options.is_protecting = is_protecting;
    options.reference = input.reference;
    return options;
}

double threshold_of(const std::string& name) {
    try {
        return std::stod(name.substr(kCurvature.size()));
    } catch (const std::logic_error&) {
        throw InputError("remesher " + name + ": no curvature threshold after " + kCurvature);
    }
}

RemeshResult make(const std::string& name, const ComparisonInput& input, std::size_t vertex_count) {
    const LoadedMesh& mesh = input.mesh;
    const RemeshOptions with = options_of(input), without = options_of(input, false);
    if (name == "own") return remesh_triangles(mesh, input.adapted, with);
    if (name == "own-initial") return remesh_triangles(mesh, input.initial, with);
    if (name == "own-plain") return remesh_triangles(mesh, {}, without);
    if (name.starts_with(kCurvature))
        return remesh_triangles(mesh, above_curvature(input.initial, threshold_of(name)), with);
    if (name == "filtered") {
        RemeshOptions of_another = without;
        of_another.reference = nullptr;
        return remesh_triangles(filter_detail(mesh, input.rmin), {}, of_another);
    }
    if (name == "quadrics") {
        RemeshResult result;
        result.mesh = decimate_by_quadrics(mesh, vertex_count);
        return result;
    }
    if (name == "cgal") return remesh_with_cgal(mesh, input.adapted, with);
    if (name == "cgal-constrained")
        return remesh_with_cgal(mesh, input.adapted, with, CgalFeatures::Constrained);
    if (name == "cgal-initial") return remesh_with_cgal(mesh, input.initial, with);
    if (name == "cgal-plain") return remesh_with_cgal(mesh, {}, without);
    throw InputError("no remesher is called " + name);
}

bool is_known(const std::string& name) {
    for (const std::string& known : remesher_names())
        if (name == known) return true;
    return name.starts_with(kCurvature) && threshold_of(name) >= 0;
}

}  // namespace

std::vector<std::string> remesher_names() {
    return {"own",       "own-initial", "own-plain", "curvature-0.5",    "curvature-0.8",
            "quadrics",  "filtered",    "cgal",      "cgal-constrained", "cgal-initial",
            "cgal-plain"};
}

void measure_row(const ComparisonInput& input, ComparisonRow& row) {
    if (row.mesh.mesh.n_faces() == 0) {
        row.failure = "no faces";
        return;
    }
    row.quality = measure_triangles(row.mesh.mesh);
    row.edges = measure_edges(row.mesh.mesh, input.rmin, input.ratio * input.rmin);
    const std::unique_ptr<ReferenceSurface> own =
        input.reference ? nullptr : std::make_unique<ReferenceSurface>(input.mesh.mesh);
    const ReferenceSurface& surface = input.reference ? *input.reference : *own;
    row.distance = measure_distance(row.mesh.mesh, input.mesh.mesh, surface, input.sample_spacing);
    row.normals = measure_normals(row.mesh.mesh, input.mesh.mesh, surface, input.sample_spacing);
    row.self_intersections = self_intersections(row.mesh.mesh).size();
    row.features = measure_features(row.mesh.mesh, input.adapted, input.sample_spacing);
}

ComparisonRow run_remesher(const std::string& name, const ComparisonInput& input,
                           std::size_t vertex_count) {
    if (!is_known(name)) throw InputError("no remesher is called " + name);
    ComparisonRow row;
    row.name = name;
    try {
        const std::clock_t start = std::clock();
        RemeshResult result = make(name, input, vertex_count);
        row.cpu_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        row.mesh = std::move(result.mesh);
        row.mesh.curves = chain_vertex_pairs(result.feature_edges);
        row.broken_segments = result.broken_segments.size();
        row.forced_faces = result.forced_faces.size();
        row.warnings = std::move(result.warnings);
        measure_row(input, row);
    } catch (const std::exception& error) {
        row.failure = error.what();
    }
    return row;
}

}  // namespace fcn
