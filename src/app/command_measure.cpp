#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "app/length.h"
#include "app/quad_summary.h"
#include "geometry/errors.h"
#include "meshing/measure.h"
#include "meshing/quad_files.h"
#include "meshing/remesh.h"

namespace fcn::app {
namespace {

struct MeasureArguments {
    CommonArguments common;
    MeshArguments mesh;
    std::string input;
    std::string reference;
    std::string spacing = "0.5%";
    std::string network_path;
    std::string edge_length;
};

Json distance_json(const MeshDistance& distance, double spacing) {
    return {{"hausdorff", distance.hausdorff},
            {"hausdorff_over_diagonal", distance.hausdorff / distance.diagonal},
            {"forward", distance.forward},
            {"backward", distance.backward},
            {"mean_forward", distance.mean_forward},
            {"mean_backward", distance.mean_backward},
            {"samples", distance.samples},
            {"sample_spacing", spacing},
            {"reference_diagonal", distance.diagonal}};
}

/// The mesh as quads if it is all quads, and only then.
std::optional<QuadMesh> quads_of(const std::string& path) {
    if (path == "-") return std::nullopt;  // standard input can be read once
    std::optional<QuadMesh> quads = read_quads(path);
    if (!quads) return std::nullopt;
    const std::string fault = check_topology(*quads).fault;
    if (!fault.empty()) throw InputError(path + ": these quads are no manifold mesh: " + fault);
    return quads;
}

int measure_quad_mesh(const MeasureArguments& arguments, const QuadMesh& quads) {
    const LoadedMesh reference = load_mesh(arguments.reference, arguments.mesh, arguments.common);
    const double diagonal = bounding_box(reference.mesh).diagonal();
    const double spacing = parse_length(arguments.spacing, "--spacing").resolve(diagonal);
    const bool has_network = !arguments.network_path.empty();
    FeatureCurveNetwork network;
    if (has_network) network = read_network_for_mesh(arguments.network_path, reference);
    const double edge_length =
        !arguments.edge_length.empty()
            ? parse_length(arguments.edge_length, "--edge-length").resolve(diagonal)
            : kEdgeLengthFactor * network.scale;
    const QuadQuality quality = measure_quads(quads, edge_length);
    const QuadTopology topology = check_topology(quads);
    const MeshDistance distance = measure_distance(triangle_mesh(quads), reference.mesh, spacing);
    QuadAlignment alignment;
    if (has_network) alignment = measure_alignment(quads, network, spacing);
    if (arguments.common.is_json) {
        Json json{{"reference", mesh_json(reference)},
                  {"quads", quad_quality_json(quality)},
                  {"topology",
                   {{"components", topology.components},
                    {"boundary_loops", topology.boundary_loops},
                    {"euler_characteristic", topology.euler_characteristic}}},
                  {"distance", distance_json(distance, spacing)}};
        if (edge_length > 0) {
            json["edge_length"] = edge_length;
            json["hausdorff_over_edge_length"] = distance.hausdorff / edge_length;
        }
        if (has_network) json["alignment"] = alignment_json(alignment);
        print_json(json);
        return kDone;
    }
    fmt::print("{}: {}\n", arguments.input, quad_quality_text(quality));
    fmt::print("edges                 {:.5g} .. {:.5g}, mean {:.5g}\n", quality.min_edge,
               quality.max_edge, quality.mean_edge);
    fmt::print("topology              {} components, {} boundary loops, Euler characteristic {}\n",
               topology.components, topology.boundary_loops, topology.euler_characteristic);
    fmt::print("Hausdorff distance    {:.5g} ({:.3f} % of the reference's diagonal {:.5g})\n",
               distance.hausdorff, 100 * distance.hausdorff / distance.diagonal, distance.diagonal);
    if (edge_length > 0)
        fmt::print("close singularities   {} pairs closer than {:.5g}\n",
                   quality.close_singularities, edge_length);
    if (has_network)
        fmt::print("curves to quad lines  {:.2f} degrees off on the average, {:.1f} % over 10\n",
                   alignment.mean_degrees, 100 * alignment.share_over_10);
    return kDone;
}

int measure(const MeasureArguments& arguments) {
    if (const std::optional<QuadMesh> quads = quads_of(arguments.input))
        return measure_quad_mesh(arguments, *quads);
    const LoadedMesh mesh = load_mesh(arguments.input, arguments.mesh, arguments.common);
    const LoadedMesh reference = load_mesh(arguments.reference, arguments.mesh, arguments.common);
    const double spacing = parse_length(arguments.spacing, "--spacing")
                               .resolve(bounding_box(reference.mesh).diagonal());
    const TriangleQuality quality = measure_triangles(mesh.mesh);
    const MeshDistance distance = measure_distance(mesh.mesh, reference.mesh, spacing);
    const NormalDeviation normals = measure_normals(mesh.mesh, reference.mesh, spacing);
    const bool has_network = !arguments.network_path.empty();
    FeatureCurveNetwork network;
    FeatureDeviation features;
    EdgeShares edges;
    if (has_network) {
        network = read_network_for_mesh(arguments.network_path, reference);
        features = measure_features(mesh.mesh, network, spacing);
        if (network.scale > 0)
            edges = measure_edges(mesh.mesh, network.scale, network.ratio * network.scale);
    }
    if (arguments.common.is_json) {
        Json json{{"mesh", mesh_json(mesh)},
                  {"reference", mesh_json(reference)},
                  {"triangles", quality_json(quality)},
                  {"distance", distance_json(distance, spacing)},
                  {"normals", normals_json(normals)}};
        if (has_network) json["features"] = feature_deviation_json(features);
        if (has_network && network.scale > 0)
            json["edges"] = {
                {"below", edges.below}, {"inside", edges.inside}, {"above", edges.above}};
        print_json(json);
        return kDone;
    }
    fmt::print("{}: {} vertices, {} triangles\n", mesh.name, quality.vertices, quality.faces);
    fmt::print("smallest angle        {:.2f} degrees (mean of the triangles' smallest {:.2f})\n",
               quality.min_angle_degrees, quality.mean_min_angle_degrees);
    fmt::print("triangles under 15    {:.2f} %\ntriangles under 30    {:.2f} %\n",
               100 * quality.share_under_15, 100 * quality.share_under_30);
    fmt::print("edges                 {:.5g} .. {:.5g}, mean {:.5g}\n", quality.min_edge,
               quality.max_edge, quality.mean_edge);
    fmt::print("Hausdorff distance    {:.5g} ({:.3f} % of the reference's diagonal {:.5g})\n",
               distance.hausdorff, 100 * distance.hausdorff / distance.diagonal, distance.diagonal);
    fmt::print("mean distance         {:.5g} to the reference, {:.5g} back\n",
               distance.mean_forward, distance.mean_backward);
    fmt::print("normals               {:.2f} degrees off on the average, rms {:.2f}\n",
               normals.mean_degrees, normals.rms_degrees);
    fmt::print(
        "radius ratio          {:.3f} .. 1, mean {:.3f}; valences {} .. {}, {:.1f} % of six\n",
        quality.min_radius_ratio, quality.mean_radius_ratio, quality.min_valence,
        quality.max_valence, 100 * quality.share_regular);
    if (has_network)
        fmt::print("curves to mesh edges  at most {:.5g}, mean {:.5g}; nodes to vertices {:.5g}\n",
                   features.max, features.mean, features.max_node);
    if (has_network && network.scale > 0)
        fmt::print("edges within S        {:.1f} %, shorter {:.1f} %, longer {:.1f} %\n",
                   100 * edges.inside, 100 * edges.below, 100 * edges.above);
    return kDone;
}

}  // namespace

Command add_measure_command(CLI::App& program) {
    auto arguments = std::make_shared<MeasureArguments>();
    CLI::App* parser = program.add_subcommand(
        "measure", "Quality of a mesh of triangles or quads and its distance to a reference");
    parser->add_option("MESH", arguments->input, "The mesh to judge")->required();
    parser->add_option("REFERENCE", arguments->reference, "The surface it should follow")
        ->required();
    parser
        ->add_option("--spacing", arguments->spacing,
                     "Distance between samples; % of the reference's diagonal")
        ->capture_default_str();
    parser->add_option("--network", arguments->network_path,
                       "Network of the reference: how its curves lie in the mesh");
    parser->add_option("--edge-length", arguments->edge_length,
                       "Of quads, as asked for (default: that of the network's scale)");
    add_mesh_arguments(*parser, arguments->mesh);
    add_common_arguments(*parser, arguments->common);
    parser->footer("Example:\n  scalefcn measure out/part/2pct/remesh.obj part.stl");
    return {parser, [arguments] { return measure(*arguments); }};
}

}  // namespace fcn::app
