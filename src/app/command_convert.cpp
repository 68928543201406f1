#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "app/outputs.h"
#include "geometry/errors.h"
#include "labeling/formats.h"
#include "network/mesh_edges.h"
#include "network/written_network.h"

namespace fcn::app {
namespace {

struct ConvertArguments {
    CommonArguments common;
    MeshArguments mesh;
    std::string input;
    std::string output;
    std::string kind;
    std::string detail;
    std::string rows = "strengthened";
    std::string mesh_path;
};

bool is_mesh_only(const std::string& path) {
    const std::string extension = plain_extension(path);
    return extension == ".off" || extension == ".stl";
}

/// File names decide: problems and networks have extensions of their own; .obj, .ply, .mesh and
/// .msh hold either a mesh or a network, and mean the network unless the other side is a mesh.
std::string kind_by_name(const ConvertArguments& arguments) {
    if (!arguments.kind.empty()) return arguments.kind;
    const bool is_problem_in = has_problem_extension(arguments.input);
    const bool is_problem_out = has_problem_extension(arguments.output);
    if (is_problem_in && (is_problem_out || arguments.output == "-")) return "problem";
    if (is_problem_in != is_problem_out)
        throw UsageError(fmt::format("convert: {} and {} are not of one kind (--as tells which)",
                                     arguments.input, arguments.output));
    if (is_mesh_only(arguments.input) || is_mesh_only(arguments.output)) return "mesh";
    return "network";
}

Json convert_problem(const ConvertArguments& arguments) {
    const labeling::LabelingProblem problem = load_problem(arguments.input);
    const auto rows =
        arguments.rows == "paper" ? labeling::RowStyle::Paper : labeling::RowStyle::Strengthened;
    if (arguments.output == "-")
        save_text("-", labeling::format_problem(problem, labeling::ProblemFormat::Lab));
    else
        labeling::write_problem(problem, arguments.output, rows);
    return {{"kind", "problem"},
            {"labels", problem.label_count()},
            {"conflicts", problem.conflict_count()},
            {"bonuses", problem.bonus_count()},
            {"rules", problem.rule_count()}};
}

/// The curves that a file holds beside its mesh. Those that do not run along the mesh's edges are
/// left out, which a warning says.
std::vector<std::vector<int>> curves_beside(const LoadedMesh& mesh,
                                            const ConvertArguments& arguments) {
    // How reading tells that there is none, in every format.
    const std::string none = "no curves in it";
    if (arguments.input == "-" || !has_network_extension(arguments.input)) return {};
    try {
        const FeatureCurveNetwork network = load_network(arguments.input, &mesh.mesh);
        return MeshEdgePaths(mesh.mesh, arguments.input)
            .all(polylines_to_write(network, NetworkDetail::DenseArcs));
    } catch (const fcn::InputError& error) {
        const std::string message = error.what();
        if (!message.ends_with(none))
            print_warning(arguments.common, "curves are left out: " + message);
        return {};
    }
}

Json convert_mesh(const ConvertArguments& arguments) {
    LoadedMesh mesh = load_mesh(arguments.input, arguments.mesh, arguments.common);
    mesh.curves = curves_beside(mesh, arguments);
    save_mesh(arguments.output, mesh);
    return {{"kind", "mesh"},
            {"vertices", mesh.mesh.n_vertices()},
            {"faces", mesh.mesh.n_faces()},
            {"curves", mesh.curves.size()}};
}

Json convert_network(const ConvertArguments& arguments) {
    std::optional<LoadedMesh> mesh;
    if (!arguments.mesh_path.empty())
        mesh = load_mesh(arguments.mesh_path, arguments.mesh, arguments.common);
    const FeatureCurveNetwork network =
        mesh ? read_network_for_mesh(arguments.input, *mesh) : load_network(arguments.input);
    const LoadedMesh* mesh_or_null = mesh ? &*mesh : nullptr;
    if (arguments.detail.empty())
        save_network(arguments.output, network, mesh_or_null);
    else
        save_network(
            arguments.output, network,
            arguments.detail == "dense" ? NetworkDetail::DenseArcs : NetworkDetail::Segments,
            mesh_or_null);
    return {{"kind", "network"},
            {"nodes", network.nodes.size()},
            {"arcs", network.arcs.size()},
            {"segments", network.segments.size()}};
}

int convert(const ConvertArguments& arguments) {
    const std::string kind = kind_by_name(arguments);
    prepare_output(arguments.output,
                   kind == "mesh"      ? OutputKind::MeshWithCurves
                   : kind == "network" ? OutputKind::Network
                                       : OutputKind::Other,
                   arguments.common);
    Json summary = kind == "problem" ? convert_problem(arguments)
                   : kind == "mesh"  ? convert_mesh(arguments)
                                     : convert_network(arguments);
    if (arguments.output == "-") return kDone;
    if (arguments.common.is_json) {
        summary["files"] = {arguments.output};
        print_json(summary);
        return kDone;
    }
    std::string counts;
    for (const auto& [key, value] : summary.items())
        if (value.is_number()) counts += fmt::format(", {} {}", value.dump(), key);
    fmt::print("{}{}\nwrote {}\n", kind, counts, arguments.output);
    return kDone;
}

}  // namespace

Command add_convert_command(CLI::App& program) {
    auto arguments = std::make_shared<ConvertArguments>();
    CLI::App* parser = program.add_subcommand(
        "convert", "Convert networks, labeling problems and meshes, by file name");
    parser->add_option("IN", arguments->input, "File to read")->required();
    parser->add_option("OUT", arguments->output, "File to write (- for standard output)")
        ->required();
    parser
        ->add_option("--as", arguments->kind,
                     "What the files hold when their names leave it open: network, mesh, problem")
        ->check(CLI::IsMember({"network", "mesh", "problem"}));
    parser->add_option("--mesh", arguments->mesh_path,
                       "Mesh of the network; formats of mesh vertices and edges need it");
    parser
        ->add_option("--detail", arguments->detail,
                     "Of a network: dense polylines or segments (default: segments if any)")
        ->check(CLI::IsMember({"dense", "segments"}));
    parser->add_option("--rows", arguments->rows, "Of an .mps, .lp or .opb: strengthened, paper")
        ->check(CLI::IsMember({"strengthened", "paper"}))
        ->capture_default_str();
    add_mesh_arguments(*parser, arguments->mesh);
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Example:\n"
        "  scalefcn convert part.fcn.json part.obj\n"
        "  scalefcn convert problem_1.lab.gz problem_1.mps");
    return {parser, [arguments] { return convert(*arguments); }};
}

}  // namespace fcn::app
