#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "app/adaptation_arguments.h"
#include "app/command.h"
#include "app/inputs.h"
#include "app/interrupt.h"
#include "app/json_summary.h"
#include "app/outputs.h"
#include "app/pipeline.h"
#include "app/quad_summary.h"
#include "geometry/errors.h"
#include "meshing/comparison.h"
#include "meshing/quad_comparison.h"
#include "meshing/reference_surface.h"

namespace fcn::app {
namespace {

struct CompareArguments {
    CommonArguments common;
    MeshArguments mesh;
    DetectionArguments detection;
    ScaleArguments scale;
    AdaptationArguments adaptation;
    std::string input;
    std::string type = "tri";
    std::string ways;
    std::string folder;
    std::string spacing = "0.5%";
    int iterations = 10;
};

bool is_quad(const CompareArguments& arguments) { return arguments.type == "quad"; }

std::vector<std::string> chosen_ways(const CompareArguments& arguments) {
    if (!arguments.ways.empty()) return split_list(arguments.ways, "--ways");
    return is_quad(arguments) ? quad_way_names() : remesher_names();
}

void print_header(const CompareArguments& arguments, const ComparisonInput& input,
                  double diagonal) {
    if (arguments.common.is_json) return;
    fmt::print("edge length {:.5g}; distances in % of the diagonal {:.5g}, samples every {:.5g}\n",
               kEdgeLengthFactor * input.rmin, diagonal, input.sample_spacing);
    if (is_quad(arguments))
        fmt::print("{:<17} {:>8} {:>9} {:>12} {:>8} {:>11} {:>11} {:>11}\n", "way", "tier", "quads",
                   "mean Jacobian", "least", "irregular", "Hausdorff", "off curves");
    else
        fmt::print("{:<17} {:>9} {:>9} {:>10} {:>10} {:>11} {:>11} {:>13}\n", "way", "triangles",
                   "smallest", "under 15", "under 30", "Hausdorff", "mean", "mean curves");
}

void print_comparison_row(const ComparisonRow& row) {
    if (!row.failure.empty()) {
        fmt::print("{:<17} failed: {}\n", row.name, row.failure);
        return;
    }
    const double diagonal = row.distance.diagonal;
    fmt::print("{:<17} {:>9} {:>9.2f} {:>8.3f} % {:>8.3f} % {:>9.4f} % {:>9.5f} % {:>11.4f} %\n",
               row.name, row.quality.faces, row.quality.min_angle_degrees,
               100 * row.quality.share_under_15, 100 * row.quality.share_under_30,
               100 * row.distance.hausdorff / diagonal, 100 * row.distance.mean_forward / diagonal,
               100 * row.features.mean / diagonal);
}

void print_quad_row(const QuadComparisonRow& row) {
    if (!row.failure.empty()) {
        fmt::print("{:<17} failed: {}\n", row.name, row.failure);
        return;
    }
    fmt::print("{:<17} {:>8} {:>9} {:>13.3f} {:>8.3f} {:>9.2f} % {:>9.4f} % {:>8.2f} deg\n",
               row.name, to_string(row.result.tier), row.quality.faces,
               row.quality.mean_scaled_jacobian, row.quality.min_scaled_jacobian,
               100 * row.quality.share_irregular,
               100 * row.distance.hausdorff / row.distance.diagonal, row.alignment.mean_degrees);
}

std::string mesh_path(const CompareArguments& arguments, const std::string& way) {
    return (std::filesystem::path(arguments.folder) / (way + ".obj")).string();
}

Json compare_triangles(const CompareArguments& arguments, const std::vector<std::string>& ways,
                       const ComparisonInput& input) {
    Json rows = Json::array();
    std::size_t vertices = std::max<std::size_t>(4, input.mesh.mesh.n_vertices() / 10);
    for (const std::string& way : ways) {
        if (is_interrupted()) break;
        ComparisonRow row = run_remesher(way, input, vertices);
        if (way == "own" && row.failure.empty()) vertices = row.quality.vertices;
        if (!arguments.folder.empty() && row.failure.empty())
            save_mesh(mesh_path(arguments, way), row.mesh);
        if (!arguments.common.is_json) print_comparison_row(row);
        rows.push_back(
            comparison_json(row, kEdgeLengthFactor * input.rmin, !arguments.common.is_timeless));
    }
    return rows;
}

Json compare_quads(const CompareArguments& arguments, const std::vector<std::string>& ways,
                   ComparisonInput input) {
    const ReferenceSurface reference(input.mesh.mesh);
    input.reference = &reference;
    Json rows = Json::array();
    for (const std::string& way : ways) {
        if (is_interrupted()) break;
        const QuadComparisonRow row = run_quad_way(way, input);
        if (!arguments.folder.empty() && row.failure.empty())
            save_quads(mesh_path(arguments, way), row.result.mesh);
        if (!arguments.common.is_json) print_quad_row(row);
        rows.push_back(quad_comparison_json(row, !arguments.common.is_timeless));
    }
    return rows;
}

int compare(CompareArguments& arguments) {
    const std::vector<std::string> ways = chosen_ways(arguments);
    if (is_quad(arguments)) arguments.adaptation.criteria.target = "quad";
    AdaptationOptions options = arguments.adaptation.options(arguments.common);
    const ScaleRequest scale = arguments.scale.request();
    const LoadedMesh mesh = load_mesh(arguments.input, arguments.mesh, arguments.common);
    const double diagonal = bounding_box(mesh.mesh).diagonal();
    options.rmin = resolve_scale(scale, diagonal);
    const Detection detection =
        detect_network(mesh, arguments.detection, arguments.common.thread_count());
    if (!arguments.folder.empty()) std::filesystem::create_directories(arguments.folder);
    ProgressBar bar(!arguments.common.is_quiet);
    const AdaptationResult adapted =
        adapt_with_progress(mesh, detection.network, options, mesh.name, bar);
    bar.clear();
    const ComparisonInput input{mesh,
                                detection.network,
                                adapted.network,
                                options.rmin,
                                options.ratio,
                                arguments.iterations,
                                parse_length(arguments.spacing, "--spacing").resolve(diagonal)};
    print_header(arguments, input, diagonal);
    const Json rows = is_quad(arguments) ? compare_quads(arguments, ways, input)
                                         : compare_triangles(arguments, ways, input);
    if (arguments.common.is_json)
        print_json({{"mesh", mesh_json(mesh)},
                    {"rmin", options.rmin},
                    {"edge_length", kEdgeLengthFactor * options.rmin},
                    {"sample_spacing", input.sample_spacing},
                    {"ways", rows}});
    return kDone;
}

}  // namespace

Command add_compare_command(CLI::App& program) {
    auto arguments = std::make_shared<CompareArguments>();
    CLI::App* parser = program.add_subcommand(
        "compare", "Remeshes at one scale with, without and with other choices of features");
    parser->add_option("MESH", arguments->input, "Triangle mesh (- for standard input)")
        ->required();
    parser->add_option("--network", arguments->detection.network_path,
                       "Initial network; without one, features are detected");
    parser->add_option("--type", arguments->type, "Elements: tri, quad")
        ->check(CLI::IsMember({"tri", "quad"}))
        ->capture_default_str();
    parser->add_option("--ways", arguments->ways,
                       "Comma-separated (default: all): own, own-initial, own-plain, curvature-T "
                       "(T in radians), quadrics, filtered, cgal, cgal-constrained, cgal-initial, "
                       "cgal-plain; of quads: own, own-initial, own-plain, curvature-T, filtered, "
                       "filtered-K (below K rmin), pairing");
    parser->add_option("-o,--output", arguments->folder, "Folder for the meshes, WAY.obj each");
    parser->add_option("--spacing", arguments->spacing, "Distance between samples")
        ->capture_default_str();
    parser->add_option("--iterations", arguments->iterations, "Rounds of remeshing")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    add_scale_arguments(*parser, arguments->scale);
    add_adaptation_arguments(*parser, arguments->adaptation);
    add_detection_arguments(*parser, arguments->detection);
    add_mesh_arguments(*parser, arguments->mesh);
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Example:\n  scalefcn compare part.stl --scale 2%\n"
        "  scalefcn compare part.stl --scale 2% --type quad -o ways");
    return {parser, [arguments] { return compare(*arguments); }};
}

}  // namespace fcn::app
