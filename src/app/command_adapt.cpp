#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/adaptation_arguments.h"
#include "app/command.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "app/outputs.h"
#include "app/pin_arguments.h"
#include "app/pipeline.h"
#include "app/run_files.h"

namespace fcn::app {
namespace {

struct AdaptArguments {
    CommonArguments common;
    MeshArguments mesh;
    DetectionArguments detection;
    ScaleArguments scale;
    AdaptationArguments adaptation;
    PinArguments pins;
    std::string input;
    std::string output;
    std::string problem_folder;
    std::string step_folder;
};

Json summary_json(const AdaptationOptions& options, const FeatureCurveNetwork& initial,
                  const AdaptationResult& result, const ConformityReport& conformity,
                  bool has_timings) {
    Json json{{"rmin", options.rmin},
              {"rmax", options.rmin * options.ratio},
              {"edge_length", kEdgeLengthFactor * options.rmin},
              {"solver", options.solver->name()}};
    json.update(adaptation_json(result, initial, has_timings));
    json.update(conformity_json(conformity, false));
    return json;
}

void print_summary(const AdaptationResult& result, const FeatureCurveNetwork& initial,
                   const ConformityReport& conformity, double rmin) {
    const AdaptationReport& report = result.report;
    fmt::print("{} arcs at rmin {:.5g}: kept {} arcs as {} segments, {} iterations, {}{}\n",
               initial.arcs.size(), rmin, result.network.arcs.size(),
               result.network.segments.size(), report.iterations.size(), to_string(report.status),
               report.is_optimal ? ", each proven optimal" : "");
    fmt::print("coverage {:.1f} %, {}\n", 100 * report.coverage,
               conformity.is_conforming()
                   ? "strictly conforming"
                   : fmt::format("{} violations of strict conformity", conformity.counted));
}

int exit_code(const AdaptationResult& result) {
    return result.report.status == AdaptationStatus::SolverFailed ? kNoResult : kDone;
}

int adapt(const AdaptArguments& arguments) {
    prepare_output(arguments.output, OutputKind::Network, arguments.common);
    arguments.pins.rules();  // a wrong command line is known before the mesh is read
    const ScaleRequest scale = arguments.scale.request();
    AdaptationOptions options = arguments.adaptation.options(arguments.common);
    const LoadedMesh mesh = load_mesh(arguments.input, arguments.mesh, arguments.common);
    options.rmin = resolve_scale(scale, bounding_box(mesh.mesh).diagonal());
    Detection detection =
        detect_network(mesh, arguments.detection, arguments.common.thread_count());
    add_pins(detection, mesh, arguments.pins, options.rmin);
    for (const std::string& message : detection.messages) print_note(arguments.common, message);
    for (const std::string& message :
         require_pins_hold(detection.network, mesh, options, arguments.pins))
        print_warning(arguments.common, message);
    options.is_recording_steps = !arguments.step_folder.empty();
    options.is_recording_problems = !arguments.problem_folder.empty();

    ProgressBar bar(!arguments.common.is_quiet);
    const AdaptationResult result =
        adapt_with_progress(mesh, detection.network, options, mesh.name, bar);
    const ConformityReport conformity = check_result(result, mesh, options);
    bar.clear();
    for (const std::string& warning : result.report.warnings)
        print_warning(arguments.common, warning);
    save_network(arguments.output, result.network, &mesh);
    std::vector<std::string> files = write_problems(result.report, arguments.problem_folder);
    files.insert(files.begin(), arguments.output);
    if (options.is_recording_steps)
        for (std::string& file : write_steps(result.report, arguments.step_folder))
            files.push_back(std::move(file));
    if (result.report.status == AdaptationStatus::Interrupted)
        print_note(arguments.common, "interrupted: this is the best network so far");
    if (arguments.output == "-") return exit_code(result);
    if (arguments.common.is_json) {
        Json json = summary_json(options, detection.network, result, conformity,
                                 !arguments.common.is_timeless);
        json["files"] = files;
        print_json(json);
        return exit_code(result);
    }
    print_summary(result, detection.network, conformity, options.rmin);
    for (const std::string& file : files) fmt::print("wrote {}\n", file);
    return exit_code(result);
}

}  // namespace

Command add_adapt_command(CLI::App& program) {
    auto arguments = std::make_shared<AdaptArguments>();
    CLI::App* parser =
        program.add_subcommand("adapt", "Pick the best network that a scale can carry");
    parser->add_option("MESH", arguments->input, "Triangle mesh (- for standard input)")
        ->required();
    parser->add_option("--network", arguments->detection.network_path,
                       "Initial network; without one, features are detected");
    parser
        ->add_option("-o,--output", arguments->output,
                     "Network file by extension (- for JSON on standard output)")
        ->required();
    parser->add_option("--save-problems", arguments->problem_folder,
                       "Folder for every labeling problem and its solution");
    parser->add_option("--save-steps", arguments->step_folder,
                       "Folder for what each iteration looks like, as lines in OBJ files");
    add_scale_arguments(*parser, arguments->scale);
    add_adaptation_arguments(*parser, arguments->adaptation);
    add_detection_arguments(*parser, arguments->detection);
    add_pin_arguments(*parser, arguments->pins);
    add_mesh_arguments(*parser, arguments->mesh);
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Example:\n"
        "  scalefcn adapt part.stl --network part.fcn.json --scale 2% -o part_2pct.fcn.json");
    return {parser, [arguments] { return adapt(*arguments); }};
}

}  // namespace fcn::app
