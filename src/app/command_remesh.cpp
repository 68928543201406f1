#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/adaptation_arguments.h"
#include "app/command.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "app/outputs.h"
#include "meshing/measure.h"
#include "meshing/remesh.h"

namespace fcn::app {
namespace {

struct RemeshArguments {
    CommonArguments common;
    MeshArguments mesh;
    ScaleArguments scale;
    std::string input;
    std::string network_path;
    std::string type = "tri";
    std::string output;
    int iterations = 10;
    double curvature_tolerance = 0;
    std::string with = "own";
};

int remesh(const RemeshArguments& arguments) {
    if (arguments.type == "quad")
        throw UsageError("--type quad is not available in this version; use --type tri");
    prepare_output(arguments.output, OutputKind::Mesh, arguments.common);
    const ScaleRequest request = arguments.scale.request();
    const LoadedMesh mesh = load_mesh(arguments.input, arguments.mesh, arguments.common);
    RemeshOptions options;
    options.edge_length =
        kEdgeLengthFactor * resolve_scale(request, bounding_box(mesh.mesh).diagonal());
    options.iterations = arguments.iterations;
    options.curvature_tolerance = arguments.curvature_tolerance;
    options.is_protecting = !arguments.network_path.empty();
    const FeatureCurveNetwork network = options.is_protecting
                                            ? read_network_for_mesh(arguments.network_path, mesh)
                                            : FeatureCurveNetwork{};
    const RemeshResult result = arguments.with == "cgal" ? remesh_with_cgal(mesh, network, options)
                                                         : remesh_triangles(mesh, network, options);
    for (const std::string& warning : result.warnings) print_warning(arguments.common, warning);
    save_mesh(arguments.output, result.mesh);
    if (arguments.output == "-") return kDone;
    const TriangleQuality quality = measure_triangles(result.mesh.mesh);
    if (arguments.common.is_json) {
        Json json{{"edge_length", options.edge_length},
                  {"feature_edges", result.feature_edges.size()},
                  {"broken_segments", result.broken_segments},
                  {"forced_faces", result.forced_faces},
                  {"triangles", quality_json(quality, options.edge_length)},
                  {"warnings", result.warnings},
                  {"files", {arguments.output}}};
        if (!arguments.common.is_timeless) json["seconds"] = result.seconds;
        print_json(json);
        return kDone;
    }
    fmt::print(
        "{} vertices, {} triangles of edge length {:.5g}; smallest angle {:.2f} degrees, "
        "{:.2f} % under 15, {:.2f} % under 30\nwrote {}\n",
        quality.vertices, quality.faces, options.edge_length, quality.min_angle_degrees,
        100 * quality.share_under_15, 100 * quality.share_under_30, arguments.output);
    return kDone;
}

}  // namespace

Command add_remesh_command(CLI::App& program) {
    auto arguments = std::make_shared<RemeshArguments>();
    CLI::App* parser =
        program.add_subcommand("remesh", "Make a triangle mesh of one edge length on a network");
    parser->add_option("MESH", arguments->input, "Triangle mesh (- for standard input)")
        ->required();
    parser->add_option("--network", arguments->network_path,
                       "Network whose curves stay as they are; without one nothing is protected");
    parser
        ->add_option("-o,--output", arguments->output,
                     "Mesh file by extension (- for OFF on standard output)")
        ->required();
    parser->add_option("--type", arguments->type, "Elements: tri (quad: not in this version)")
        ->check(CLI::IsMember({"tri", "quad"}))
        ->capture_default_str();
    parser->add_option("--iterations", arguments->iterations, "Rounds of remeshing")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    parser
        ->add_option("--curvature-tolerance", arguments->curvature_tolerance,
                     "Edges within [L / 1.2, 1.25 L] that deviate from the surface by about this "
                     "share of L (0: all of length L)")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    parser->add_option("--with", arguments->with, "Remesher: own, or cgal to compare with")
        ->check(CLI::IsMember({"own", "cgal"}))
        ->capture_default_str();
    add_scale_arguments(*parser, arguments->scale);
    add_mesh_arguments(*parser, arguments->mesh);
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Example:\n"
        "  scalefcn remesh part.stl --network part_2pct.fcn.json --scale 2% -o part_2pct.obj");
    return {parser, [arguments] { return remesh(*arguments); }};
}

}  // namespace fcn::app
