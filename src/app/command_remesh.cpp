#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <numbers>
#include <optional>

#include "app/adaptation_arguments.h"
#include "app/command.h"
#include "app/field_outputs.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "app/outputs.h"
#include "app/quad_summary.h"
#include "geometry/errors.h"
#include "geometry/mesh_curves.h"
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
    std::vector<std::string> outputs;
    std::vector<std::string> field_outputs;
    int iterations = 10;
    double curvature_tolerance = 0;
    std::string with = "own";
    std::string tier = "best";
    std::string guidance = "network";
    double threshold_degrees = 45;
};

Json places_json(const std::vector<RefinedPlace>& places) {
    Json json = Json::array();
    for (const RefinedPlace& place : places)
        json.push_back({{"position", {place.position[0], place.position[1], place.position[2]}},
                        {"edge_length", place.edge_length}});
    return json;
}

/// rmin as asked for, or else that of the adapted network.
double scale_of(const std::optional<ScaleRequest>& request, const LoadedMesh& mesh,
                const FeatureCurveNetwork& network, const std::string& network_path) {
    if (request) return resolve_scale(*request, bounding_box(mesh.mesh).diagonal());
    if (network.scale <= 0) {
        throw InputError(network_path +
                         ": not an adapted network, so it has no scale; give --scale or "
                         "--edge-length");
    }
    return network.scale;
}

/// The mesh, the network, and how long edges should be.
struct RemeshInputs {
    LoadedMesh mesh;
    FeatureCurveNetwork network;
    double edge_length = 0;
};

RemeshInputs read_inputs(const RemeshArguments& arguments) {
    RemeshInputs inputs;
    std::optional<ScaleRequest> request;
    if (arguments.network_path.empty() || arguments.scale.is_given())
        request = arguments.scale.request();
    inputs.mesh = load_mesh(arguments.input, arguments.mesh, arguments.common);
    if (!arguments.network_path.empty())
        inputs.network = read_network_for_mesh(arguments.network_path, inputs.mesh);
    inputs.edge_length =
        kEdgeLengthFactor * scale_of(request, inputs.mesh, inputs.network, arguments.network_path);
    return inputs;
}

int remesh_to_quads(const RemeshArguments& arguments) {
    for (const std::string& output : arguments.outputs)
        prepare_output(output, OutputKind::Quads, arguments.common);
    if (arguments.with != "own")
        throw UsageError("--with " + arguments.with + " goes with --type tri");
    if (arguments.tier == "pairing" && !arguments.field_outputs.empty())
        throw UsageError("--field: quads by pairing follow no field");
    const FieldOutputs field_outputs =
        prepare_field_outputs(arguments.field_outputs, arguments.outputs, arguments.common);
    const RemeshInputs inputs = read_inputs(arguments);
    QuadOptions options;
    options.edge_length = inputs.edge_length;
    options.iterations = arguments.iterations;
    options.best_tier = arguments.tier == "pairing" ? QuadTier::Pairing : QuadTier::Field;
    options.guidance = arguments.guidance == "none"        ? QuadGuidance::None
                       : arguments.guidance == "threshold" ? QuadGuidance::Threshold
                                                           : QuadGuidance::Network;
    options.threshold = arguments.threshold_degrees * std::numbers::pi / 180;
    const QuadResult result = remesh_quads(inputs.mesh, inputs.network, options);
    for (const std::string& warning : result.warnings) print_warning(arguments.common, warning);
    require_field(field_outputs, result);
    std::vector<std::string> files = arguments.outputs;
    for (const std::string& output : files) save_quads(output, result.mesh);
    if (result.field)
        for (std::string& file : save_field(field_outputs, *result.field, inputs.mesh.mesh))
            files.push_back(std::move(file));
    if (std::ranges::find(arguments.outputs, "-") != arguments.outputs.end()) return kDone;
    const QuadQuality quality = measure_quads(result.mesh, inputs.edge_length);
    if (arguments.common.is_json) {
        Json json = quad_result_json(result, !arguments.common.is_timeless);
        json["quads"] = quad_quality_json(quality);
        json["files"] = files;
        print_json(json);
        return kDone;
    }
    fmt::print("{}\nmade by {}{}{}\n", quad_quality_text(quality), to_string(result.tier),
               result.reason.empty() ? "" : ": ", result.reason);
    for (const std::string& output : files) fmt::print("wrote {}\n", output);
    return kDone;
}

int remesh(const RemeshArguments& arguments) {
    if (arguments.type == "quad") return remesh_to_quads(arguments);
    if (!arguments.field_outputs.empty()) throw UsageError("--field goes with --type quad");
    for (const std::string& output : arguments.outputs) {
        prepare_output(output, OutputKind::MeshWithCurves, arguments.common);
        if (holds_curves_alone(output) && arguments.network_path.empty())
            throw UsageError(output + ": holds curves alone, and there are none without --network");
    }
    const RemeshInputs inputs = read_inputs(arguments);
    const LoadedMesh& mesh = inputs.mesh;
    const FeatureCurveNetwork& network = inputs.network;
    RemeshOptions options;
    options.iterations = arguments.iterations;
    options.curvature_tolerance = arguments.curvature_tolerance;
    options.is_protecting = !arguments.network_path.empty();
    options.edge_length = inputs.edge_length;
    RemeshResult result = arguments.with == "cgal" ? remesh_with_cgal(mesh, network, options)
                                                   : remesh_triangles(mesh, network, options);
    for (const std::string& warning : result.warnings) print_warning(arguments.common, warning);
    result.mesh.curves = chain_vertex_pairs(result.feature_edges);
    for (const std::string& output : arguments.outputs) save_mesh(output, result.mesh);
    if (std::ranges::find(arguments.outputs, "-") != arguments.outputs.end()) return kDone;
    const TriangleQuality quality = measure_triangles(result.mesh.mesh);
    if (arguments.common.is_json) {
        Json json{{"edge_length", options.edge_length},
                  {"feature_edges", result.feature_edges.size()},
                  {"broken_segments", result.broken_segments},
                  {"forced_faces", result.forced_faces},
                  {"new_intersections", result.new_intersections},
                  {"refined_places", places_json(result.refined_places)},
                  {"triangles", quality_json(quality, options.edge_length)},
                  {"warnings", result.warnings},
                  {"files", arguments.outputs}};
        if (!arguments.common.is_timeless) json["seconds"] = result.seconds;
        print_json(json);
        return kDone;
    }
    fmt::print(
        "{} vertices, {} triangles of edge length {:.5g}; smallest angle {:.2f} degrees, "
        "{:.2f} % under 15, {:.2f} % under 30\n",
        quality.vertices, quality.faces, options.edge_length, quality.min_angle_degrees,
        100 * quality.share_under_15, 100 * quality.share_under_30);
    if (!result.refined_places.empty())
        fmt::print(
            "edges are shorter around {} places, where that length cannot carry the surface\n",
            result.refined_places.size());
    for (const std::string& output : arguments.outputs) fmt::print("wrote {}\n", output);
    return kDone;
}

}  // namespace

Command add_remesh_command(CLI::App& program) {
    auto arguments = std::make_shared<RemeshArguments>();
    CLI::App* parser = program.add_subcommand(
        "remesh", "Make a mesh of triangles or quads of one edge length on a network");
    parser->add_option("MESH", arguments->input, "Triangle mesh (- for standard input)")
        ->required();
    parser->add_option(
        "--network", arguments->network_path,
        "Network whose curves stay as they are; without one nothing is protected. The scale "
        "of an adapted one holds unless another is given");
    parser
        ->add_option("-o,--output", arguments->outputs,
                     "Mesh file by extension (- for OFF on standard output), several with commas; "
                     "OBJ, PLY, Medit, gmsh and VTP also hold the network's curves, .sharp and .fl "
                     "these alone; quads: OBJ, OFF, VTU")
        ->delimiter(',')
        ->required();
    parser->add_option("--type", arguments->type, "Elements: tri, quad")
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
    parser
        ->add_option("--tier", arguments->tier,
                     "Quads: best, or pairing (of triangles, without a cross field)")
        ->check(CLI::IsMember({"best", "pairing"}))
        ->capture_default_str();
    parser
        ->add_option("--guidance", arguments->guidance,
                     "Quads: what the cross field follows: network, none, or threshold (the "
                     "network's arcs above a curvature)")
        ->check(CLI::IsMember({"network", "none", "threshold"}))
        ->capture_default_str();
    parser
        ->add_option("--threshold", arguments->threshold_degrees,
                     "Degrees that the surface turns by at an arc, with --guidance threshold")
        ->check(CLI::Range(0.0, 180.0))
        ->capture_default_str();
    parser
        ->add_option("--field", arguments->field_outputs,
                     "Quads: .rosy file for the cross field on MESH's faces; with a mesh file "
                     "behind a comma, on the finer triangles written there, which carried it")
        ->delimiter(',');
    add_scale_arguments(*parser, arguments->scale);
    add_mesh_arguments(*parser, arguments->mesh);
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Example:\n"
        "  scalefcn remesh part.stl --network part_2pct.fcn.json -o part_2pct.obj\n"
        "  scalefcn remesh part.stl --network part_2pct.fcn.json -o part_2pct.mesh,part_2pct.vtp\n"
        "  scalefcn remesh part.stl --network part_2pct.fcn.json --type quad -o part_quads.obj\n"
        "  scalefcn remesh part.stl --network part_2pct.fcn.json --type quad -o quads.obj "
        "--field part.rosy\n"
        "  scalefcn remesh part.stl --edge-length 2.4 -o part_plain.obj");
    return {parser, [arguments] { return remesh(*arguments); }};
}

}  // namespace fcn::app
