// Quads on many meshes at many scales:
//   quads_matrix MESH... [--scales 2,4,6,8] [--ways field,pairing,unguided] [--csv FILE]
//                [--pictures FOLDER]
// Features are sharp edges and boundaries; each scale, in percent of the diagonal, is adapted to
// for quads and is their edge length h. Ways: `field` is what `scalefcn remesh --type quad` does,
// `pairing` its fallback alone, `unguided` the field that knows of no network. Prints Markdown: a
// row a way with averages and worst cases; a row a mesh and scale; why ways fell back; the seconds
// of each step. Hausdorff distances are two-sided and sampled every h / 10; alignment is the mean
// angle between kept segments and the nearest direction of the quads; `triangles` is the distance
// of the triangle remesh of the same network.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "adaptation/adaptation.h"
#include "features/features.h"
#include "geometry/models.h"
#include "labeling_mip/mip_solvers.h"
#include "meshing/measure.h"
#include "meshing/quad_quality.h"
#include "meshing/quads_by_field.h"
#include "meshing/reference_surface.h"
#include "meshing/remesh.h"
#include "report/picture.h"

namespace {

using namespace fcn;

struct Arguments {
    std::vector<std::string> meshes, ways{"field", "pairing", "unguided"};
    std::vector<double> scales{2, 4, 6, 8};
    std::string csv, pictures;
};

struct Row {
    std::string failure;  ///< empty: there is a mesh
    QuadResult result;
    QuadTopology topology;
    QuadQuality quality;
    QuadAlignment alignment;
    double hausdorff = 0;  ///< in h
    double cpu_seconds = 0;

    bool is_sound() const {
        return failure.empty() && topology.fault.empty() && quality.inverted_corners == 0;
    }
};

struct Case {
    std::string mesh;
    double scale = 0, h = 0;
    std::size_t faces = 0;
    double triangle_hausdorff = 0;  ///< in h
    bool has_network = false;
    std::map<std::string, Row> rows;
};

LoadedMesh load(const std::string& name) {
    const std::string prefix = "model:";
    return name.starts_with(prefix) ? make_model(name.substr(prefix.size())) : read_mesh(name);
}

void draw(const Arguments& arguments, const Case& which, const std::string& way, const Row& row,
          const LoadedMesh& input) {
    const QuadMesh& quads = row.result.mesh;
    const auto point = [&](int v) { return quads.points[static_cast<std::size_t>(v)]; };
    PictureLayer edges, features, singular;
    edges.color = {60, 70, 90};
    edges.width = 1;
    features.color = {200, 40, 40};
    singular.color = {20, 110, 220};
    singular.width = 6;
    std::vector<int> valences(quads.points.size(), 0);
    std::vector<bool> is_inner(quads.points.size(), true);
    const std::vector<int> opposite = opposite_halfedges(quads);
    for (std::size_t h = 0; h < opposite.size(); ++h) {
        const int a = quads.faces[h / 4][h % 4], b = quads.faces[h / 4][(h + 1) % 4];
        ++valences[static_cast<std::size_t>(a)];
        if (opposite[h] < 0)
            is_inner[static_cast<std::size_t>(a)] = is_inner[static_cast<std::size_t>(b)] = false;
        if (opposite[h] < static_cast<int>(h)) edges.polylines.push_back({point(a), point(b)});
    }
    for (const QuadFeatureEdge& edge : quads.feature_edges)
        features.polylines.push_back({point(edge.from), point(edge.to)});
    for (std::size_t v = 0; v < valences.size(); ++v) {
        if (!is_inner[v] || valences[v] == 4) continue;
        const Vec3 p = quads.points[v], d = Vec3::Constant(0.04 * which.h);
        singular.polylines.push_back({p - d, p + d});
    }
    PictureOptions options;
    options.seen_as = &input.mesh;
    options.width = 1100;
    options.height = 900;
    char scale[32];
    std::snprintf(scale, sizeof scale, "%g", which.scale);
    write_file_atomically(
        std::filesystem::path(arguments.pictures) / (which.mesh + "-" + scale + "-" + way + ".png"),
        render_png(triangle_mesh(quads), {edges, features, singular}, options));
}

struct Input {
    const LoadedMesh& mesh;
    const FeatureCurveNetwork& adapted;
    const ReferenceSurface& reference;
};

Row run_way(const std::string& way, const Input& input, double h) {
    Row row;
    QuadOptions options;
    options.edge_length = h;
    options.reference = &input.reference;
    if (way == "pairing") options.best_tier = QuadTier::Pairing;
    if (way == "unguided") options.guidance = QuadGuidance::None;
    try {
        const std::clock_t start = std::clock();
        row.result = remesh_quads(input.mesh, input.adapted, options);
        row.cpu_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        row.topology = check_topology(row.result.mesh);
        const QuadTopology wanted = topology_of(input.mesh.mesh);
        if (row.topology.fault.empty() &&
            (row.topology.euler_characteristic != wanted.euler_characteristic ||
             row.topology.boundary_loops != wanted.boundary_loops ||
             row.topology.components != wanted.components))
            row.topology.fault = "another topology than the input's";
        if (!row.topology.fault.empty()) return row;
        row.quality = measure_quads(row.result.mesh, h);
        row.alignment = measure_alignment(row.result.mesh, input.adapted, 0.1 * h);
        row.hausdorff = measure_distance(triangle_mesh(row.result.mesh), input.mesh.mesh,
                                         input.reference, 0.1 * h)
                            .hausdorff /
                        h;
    } catch (const std::exception& error) {
        row.failure = error.what();
    }
    return row;
}

Case run_case(const std::string& name, const LoadedMesh& mesh, const FeatureCurveNetwork& initial,
              const ReferenceSurface& reference, double percent, const Arguments& arguments) {
    Case result;
    result.mesh = std::filesystem::path(name).stem().string();
    if (name.starts_with("model:")) result.mesh = name.substr(6);
    result.scale = percent;
    result.faces = mesh.mesh.n_faces();
    result.h = percent / 100 * bounding_box(mesh.mesh).diagonal();
    AdaptationOptions adaptation;
    adaptation.rmin = result.h / kEdgeLengthFactor;
    adaptation.target = ElementType::Quad;
    adaptation.solver = labeling::all_solvers().find("auto");
    const FeatureCurveNetwork adapted = adapt_network(mesh, initial, adaptation).network;
    result.has_network = !adapted.segments.empty();
    RemeshOptions triangles;
    triangles.edge_length = result.h;
    triangles.reference = &reference;
    result.triangle_hausdorff =
        measure_distance(remesh_triangles(mesh, adapted, triangles).mesh.mesh, mesh.mesh, reference,
                         0.1 * result.h)
            .hausdorff /
        result.h;
    for (const std::string& way : arguments.ways) {
        Row row = run_way(way, {mesh, adapted, reference}, result.h);
        if (!arguments.pictures.empty() && row.is_sound()) draw(arguments, result, way, row, mesh);
        row.result.mesh = {};
        std::fprintf(stderr,
                     "%s %g %% %s: tier %d, %.1f s, %zu quads, Jacobian %.3f (%.3f), "
                     "irregular %.2f %%, Hausdorff %.3f h, alignment %.1f; %s%s%s\n",
                     result.mesh.c_str(), percent, way.c_str(), static_cast<int>(row.result.tier),
                     row.cpu_seconds, row.quality.faces, row.quality.mean_scaled_jacobian,
                     row.quality.min_scaled_jacobian, 100 * row.quality.share_irregular,
                     row.hausdorff, row.alignment.mean_degrees, row.result.reason.c_str(),
                     row.failure.c_str(), row.topology.fault.c_str());
        result.rows[way] = std::move(row);
    }
    return result;
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? std::nan("") : sum / static_cast<double>(values.size());
}

double percent_of(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void print_summary(const std::vector<Case>& cases, const std::vector<std::string>& ways) {
    std::printf(
        "| way | runs | sound | by field | scaled Jacobian: mean | least | irregular | Hausdorff "
        "<= h/2 | or <= 1.1 triangles' | alignment | quads | CPU s |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& way : ways) {
        std::size_t sound = 0, by_field = 0, near = 0, near_enough = 0;
        std::vector<double> jacobians, irregular, alignment;
        double least = 1, quads = 0, seconds = 0;
        for (const Case& one : cases) {
            const Row& row = one.rows.at(way);
            seconds += row.cpu_seconds;
            if (!row.is_sound()) continue;
            ++sound;
            by_field += row.result.tier == QuadTier::Field;
            near += row.hausdorff <= 0.5;
            near_enough += row.hausdorff <= std::max(0.5, 1.1 * one.triangle_hausdorff);
            jacobians.push_back(row.quality.mean_scaled_jacobian);
            irregular.push_back(100 * row.quality.share_irregular);
            if (one.has_network) alignment.push_back(row.alignment.mean_degrees);
            least = std::min(least, row.quality.min_scaled_jacobian);
            quads += static_cast<double>(row.quality.faces);
        }
        std::printf(
            "| %s | %zu | %zu | %.0f %% | %.3f | %.3f | %.2f %% | %.0f %% | %.0f %% | "
            "%.1f | %.0f | %.1f |\n",
            way.c_str(), cases.size(), sound, percent_of(by_field, cases.size()), mean(jacobians),
            least, mean(irregular), percent_of(near, cases.size()),
            percent_of(near_enough, cases.size()), mean(alignment), quads, seconds);
    }
}

void print_cases(const std::vector<Case>& cases, const std::vector<std::string>& ways) {
    std::printf(
        "\n| mesh | scale | way | tier | quads | scaled Jacobian: mean | least | irregular | "
        "Hausdorff/h | triangles | alignment | close pairs | CPU s |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const Case& one : cases) {
        for (const std::string& way : ways) {
            const Row& row = one.rows.at(way);
            if (!row.failure.empty() || !row.topology.fault.empty()) {
                std::printf("| %s | %g %% | %s | failed: %s%s | | | | | | | | | |\n",
                            one.mesh.c_str(), one.scale, way.c_str(), row.failure.c_str(),
                            row.topology.fault.c_str());
                continue;
            }
            std::printf(
                "| %s | %g %% | %s | %d | %zu | %.3f | %.3f | %.2f %% | %.3f | %.3f | %.1f "
                "| %zu | %.1f |\n",
                one.mesh.c_str(), one.scale, way.c_str(), static_cast<int>(row.result.tier),
                row.quality.faces, row.quality.mean_scaled_jacobian,
                row.quality.min_scaled_jacobian, 100 * row.quality.share_irregular, row.hausdorff,
                one.triangle_hausdorff, row.alignment.mean_degrees, row.quality.close_singularities,
                row.cpu_seconds);
        }
    }
}

void print_reasons(const std::vector<Case>& cases, const std::vector<std::string>& ways) {
    std::printf(
        "\nWhat attempts at a field ended with:\n\n| mesh | scale | way | tier | reason |\n"
        "|---|---|---|---|---|\n");
    for (const Case& one : cases)
        for (const std::string& way : ways) {
            const Row& row = one.rows.at(way);
            if (!row.result.reason.empty())
                std::printf("| %s | %g %% | %s | %d | %s |\n", one.mesh.c_str(), one.scale,
                            way.c_str(), static_cast<int>(row.result.tier),
                            row.result.reason.c_str());
        }
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App parser("Quads on many meshes at many scales");
    Arguments arguments;
    parser.add_option("MESH", arguments.meshes, "Meshes, or model:NAME")->required();
    parser.add_option("--scales", arguments.scales, "In percent of the diagonal")->delimiter(',');
    parser.add_option("--ways", arguments.ways, "field, pairing, unguided")->delimiter(',');
    parser.add_option("--pictures", arguments.pictures, "A picture of each mesh in this folder");
    CLI11_PARSE(parser, argc, argv);
    try {
        if (!arguments.pictures.empty()) std::filesystem::create_directories(arguments.pictures);
        std::vector<Case> cases;
        for (const std::string& name : arguments.meshes) {
            const LoadedMesh mesh = load(name);
            const FeatureCurveNetwork initial =
                add_boundaries(detect_sharp(mesh), mesh, BoundaryPolicy::Keep);
            const ReferenceSurface reference(mesh.mesh);
            for (const double percent : arguments.scales)
                cases.push_back(run_case(name, mesh, initial, reference, percent, arguments));
        }
        print_summary(cases, arguments.ways);
        print_cases(cases, arguments.ways);
        print_reasons(cases, arguments.ways);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "quads_matrix: %s\n", error.what());
        return 1;
    }
}
