#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.h"
#include "app/detection.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "app/outputs.h"

namespace fcn::app {
namespace {

struct DetectArguments {
    CommonArguments common;
    MeshArguments mesh;
    DetectionArguments detection;
    std::string input;
    std::string output;
};

int detect(const DetectArguments& arguments) {
    prepare_output(arguments.output, OutputKind::Network, arguments.common);
    const LoadedMesh mesh = load_mesh(arguments.input, arguments.mesh, arguments.common);
    const Detection detection =
        detect_network(mesh, arguments.detection, arguments.common.thread_count());
    for (const std::string& message : detection.messages) print_note(arguments.common, message);
    save_network(arguments.output, detection.network, &mesh);
    if (arguments.output == "-") return kDone;
    if (arguments.common.is_json) {
        print_json({{"mesh", mesh_json(mesh)},
                    {"method", detection.method},
                    {"network", network_json(detection.network)},
                    {"files", {arguments.output}}});
        return kDone;
    }
    fmt::print("{}: {} arcs, {} nodes, length {:.4g} ({:.2f} diagonals), method {}\nwrote {}\n",
               mesh.name, detection.network.arcs.size(), detection.network.nodes.size(),
               detection.network.total_length(),
               detection.network.total_length() / bounding_box(mesh.mesh).diagonal(),
               detection.method, arguments.output);
    return kDone;
}

}  // namespace

Command add_detect_command(CLI::App& program) {
    auto arguments = std::make_shared<DetectArguments>();
    CLI::App* parser = program.add_subcommand("detect", "Find the feature curves of a mesh");
    parser->add_option("MESH", arguments->input, "Triangle mesh (- for standard input)")
        ->required();
    parser
        ->add_option("-o,--output", arguments->output,
                     "Network file: .fcn.json (lossless), .obj, .ply, .vtp, .polylines.txt, "
                     "...; - for JSON on standard output")
        ->required();
    add_detection_arguments(*parser, arguments->detection);
    add_mesh_arguments(*parser, arguments->mesh);
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Example:\n  scalefcn detect part.stl --method sharp --sharp-angle 30 -o part.fcn.json");
    return {parser, [arguments] { return detect(*arguments); }};
}

}  // namespace fcn::app
