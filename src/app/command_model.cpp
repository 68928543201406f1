#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.h"
#include "app/common_arguments.h"
#include "app/json_summary.h"
#include "app/outputs.h"
#include "geometry/errors.h"
#include "geometry/models.h"

namespace fcn::app {
namespace {

struct ModelArguments {
    CommonArguments common;
    ModelOptions model;
    bool is_list = false;
    std::string name;
    std::string output;
};

int list_models(const CommonArguments& common) {
    Json list = Json::array();
    for (const ModelInfo& model : model_list()) {
        if (!common.is_json) fmt::print("{:<20}{}\n", model.name, model.description);
        list.push_back({{"name", model.name}, {"description", model.description}});
    }
    if (common.is_json) print_json({{"models", list}});
    return kDone;
}

/// Whatever is wrong with a model was typed on the command line.
LoadedMesh make_named(const ModelArguments& arguments) {
    try {
        return make_model(arguments.name, arguments.model);
    } catch (const InputError& error) {
        throw UsageError(error.what());
    }
}

int make(ModelArguments& arguments) {
    if (arguments.is_list) return list_models(arguments.common);
    if (arguments.name.empty())
        throw UsageError("model: NAME is missing (scalefcn model --list shows the names)");
    const std::string output =
        arguments.output.empty() ? arguments.name + ".off" : arguments.output;
    prepare_output(output, OutputKind::Mesh, arguments.common);
    arguments.model.seed = arguments.common.seed;
    const LoadedMesh mesh = make_named(arguments);
    save_mesh(output, mesh);
    if (output == "-") return kDone;
    if (arguments.common.is_json)
        print_json({{"mesh", mesh_json(mesh)}, {"files", {output}}});
    else
        fmt::print("{}: {} vertices, {} triangles\nwrote {}\n", arguments.name,
                   mesh.mesh.n_vertices(), mesh.mesh.n_faces(), output);
    return kDone;
}

}  // namespace

Command add_model_command(CLI::App& program) {
    auto arguments = std::make_shared<ModelArguments>();
    CLI::App* parser = program.add_subcommand("model", "Make one of the built-in models");
    parser->add_option("NAME", arguments->name, "Which one; --list shows them");
    parser->add_flag("--list", arguments->is_list, "Show the names and what they are");
    parser->add_option("-o,--output", arguments->output,
                       "Mesh file (default NAME.off; - for OFF on standard output)");
    parser->add_option("--resolution", arguments->model.resolution, "Mesh edge length")
        ->capture_default_str();
    parser->add_option("--spacing", arguments->model.spacing, "Distance between features")
        ->capture_default_str();
    parser->add_option("--count", arguments->model.count, "Number of ribs, steps, teeth, petals")
        ->capture_default_str();
    parser
        ->add_option("--noise", arguments->model.noise,
                     "Standard deviation of the noise, in resolutions")
        ->capture_default_str();
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Example:\n  scalefcn model ribs --count 12 --spacing 0.03 --resolution 0.01 -o ribs.off");
    return {parser, [arguments] { return make(*arguments); }};
}

}  // namespace fcn::app
