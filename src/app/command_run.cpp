#include <fmt/core.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "app/adaptation_arguments.h"
#include "app/closing_table.h"
#include "app/command.h"
#include "app/inputs.h"
#include "app/interrupt.h"
#include "app/json_summary.h"
#include "app/outputs.h"
#include "app/pipeline.h"
#include "app/quad_summary.h"
#include "app/run_baselines.h"
#include "app/run_files.h"
#include "app/viewer_script.h"
#include "geometry/errors.h"

namespace fcn::app {
namespace {

struct RunArguments {
    CommonArguments common;
    MeshArguments mesh;
    DetectionArguments detection;
    AdaptationArguments adaptation;
    PinArguments pins;
    LimitArguments comparison{0, 30'000'000, 0};
    std::vector<std::string> inputs;
    std::string scales;
    std::string edge_lengths;
    std::string solvers = "greedy,local-search,branch-and-bound,cbc,auto";
    std::string baselines = "none";
    std::string output = "out";
    bool is_without_remesh = false;
    bool is_without_viewer = false;
    std::string command_line;
};

/// One run over all inputs and what it has left behind so far.
struct Run {
    PipelineOptions options;
    std::vector<ScaleRequest> scales;
    std::filesystem::path folder;
    std::optional<Report> report;
    Json meshes = Json::array();
    std::string closing_text;
    std::set<std::string> used_names;
    int code = kDone;
};

std::vector<ScaleRequest> scale_requests(const RunArguments& arguments) {
    const bool is_edge_length = !arguments.edge_lengths.empty();
    const std::string option = is_edge_length ? "--edge-length" : "--scales";
    const std::string text = is_edge_length             ? arguments.edge_lengths
                             : arguments.scales.empty() ? "1%,2%,4%"
                                                        : arguments.scales;
    std::vector<ScaleRequest> requests;
    std::set<std::string> folders;
    for (const std::string& entry : split_list(text, option)) {
        requests.push_back({parse_length(entry, option), is_edge_length});
        if (!folders.insert(requests.back().folder()).second)
            throw UsageError(fmt::format("{}: {} is given twice", option, entry));
    }
    return requests;
}

std::string folder_of(const std::vector<ScaleRequest>& scales, const std::string& label) {
    for (const ScaleRequest& scale : scales)
        if (scale.label() == label) return scale.folder();
    return label;
}

std::vector<std::string> compared_solvers(const std::string& list) {
    if (list == "none") return {};
    std::vector<std::string> names = split_list(list, "--solvers");
    for (const std::string& name : names) find_solver(name);  // throws for an unknown name
    return names;
}

Run prepare(const RunArguments& arguments, std::size_t mesh_count) {
    Run run;
    run.scales = scale_requests(arguments);
    run.folder = arguments.output;
    std::filesystem::create_directories(run.folder);
    PipelineOptions& options = run.options;
    options.common = arguments.common;
    options.mesh = arguments.mesh;
    options.detection = arguments.detection;
    options.pins = arguments.pins;
    options.pins.rules();  // throws for what is no arc, curve or box
    options.adaptation = arguments.adaptation.options(arguments.common);
    options.compared_solvers = compared_solvers(arguments.solvers);
    options.comparison = arguments.comparison.solve_options(arguments.common);
    options.is_remeshing = !arguments.is_without_remesh;
    if (arguments.baselines != "none")
        options.baselines = split_list(arguments.baselines, "--baselines");
    check_baselines(options.baselines);
    ReportOptions report;
    report.command = arguments.command_line;
    report.has_timings = !arguments.common.is_timeless;
    if (!arguments.is_without_viewer) report.viewer_script = find_viewer_script();
    run.report.emplace(std::move(report), mesh_count);
    return run;
}

/// Meshes of equal names in different folders must not share an output folder.
std::string unused_name(const std::string& name, std::set<std::string>& used) {
    std::string candidate = name.empty() ? "mesh" : name;
    for (int i = 2; !used.insert(candidate).second; ++i) candidate = fmt::format("{}-{}", name, i);
    return candidate;
}

Json scale_json(const ScaleRecord& scale, const MeshRecord& record, const PipelineOptions& options,
                const std::vector<std::string>& files) {
    const bool has_timings = !options.common.is_timeless;
    const double edge_length = kEdgeLengthFactor * scale.rmin;
    Json json{{"scale", scale.label},
              {"rmin", scale.rmin},
              {"rmax", scale.rmin * options.adaptation.ratio},
              {"edge_length", edge_length},
              {"solver", options.adaptation.solver->name()}};
    json.update(adaptation_json(scale.adaptation, record.initial, has_timings));
    json.update(conformity_json(scale.conformity, false));
    json["remesh"] =
        scale.has_remesh ? quality_json(scale.remesh_quality, edge_length) : Json(nullptr);
    json["remesh_on_initial"] =
        scale.has_initial_remesh ? quality_json(scale.initial_quality, edge_length) : Json(nullptr);
    json["quads"] = scale.quads ? quad_record_json(*scale.quads, has_timings) : Json(nullptr);
    json["ways"] = Json::array();
    if (scale.has_remesh)
        json["ways"].push_back(comparison_json(scale.remesh_row, edge_length, false));
    for (const ComparedMesh& compared : scale.compared)
        json["ways"].push_back(comparison_json(compared.row, edge_length, false));
    json["solvers"] = solver_comparisons_json(scale.solvers, has_timings);
    json["files"] = files;
    return json;
}

std::string report_path(const Run& run) { return (run.folder / "report.html").string(); }

Json summary_so_far(const Run& run) {
    return {
        {"interrupted", is_interrupted()}, {"report", report_path(run)}, {"meshes", run.meshes}};
}

/// The networks and meshes of each scale are on disk when it is done, the report and the summary
/// when its mesh is: a killed run loses what was under way.
void run_mesh(const std::string& path, Run& run, const RunArguments& arguments) {
    ProgressBar bar(!arguments.common.is_quiet);
    bar.show(path + ": reading, detecting features", 0);
    MeshRecord record = start_record(path, run.scales, run.options);
    bar.clear();
    for (const std::string& message : record.messages)
        print_note(arguments.common, fmt::format("{}: {}", path, message));
    const std::string name = unused_name(record.mesh.name, run.used_names);
    std::map<std::string, std::vector<std::string>> files;  // by scale
    std::mutex files_lock;
    record.scales =
        process_scales(record, run.scales, run.options, bar, [&](const ScaleRecord& scale) {
            std::vector<std::string> written = write_scale_files(
                record, scale, run.folder / name / folder_of(run.scales, scale.label));
            const std::lock_guard lock(files_lock);
            files[scale.label] = std::move(written);
        });
    bar.clear();
    Json json{{"mesh", mesh_json(record.mesh)},
              {"method", record.method},
              {"network", network_json(record.initial)},
              {"messages", record.messages},
              {"scales", Json::array()}};
    for (const ScaleRecord& scale : record.scales) {
        for (const std::string& warning : scale.adaptation.report.warnings)
            print_warning(arguments.common, fmt::format("{} {}: {}", name, scale.label, warning));
        if (scale.adaptation.report.status == AdaptationStatus::SolverFailed) run.code = kNoResult;
        json["scales"].push_back(scale_json(scale, record, run.options, files[scale.label]));
    }
    bar.show(name + ": report", 0.95);
    run.report->add(record);
    run.meshes.push_back(std::move(json));
    run.closing_text += closing_table(record, !arguments.common.is_timeless);
    save_text(report_path(run), run.report->html());
    save_text((run.folder / "summary.json").string(), summary_so_far(run).dump(2) + "\n");
}

/// A bad mesh among several does not stop the others; alone it does.
void run_all(const std::vector<std::string>& paths, Run& run, const RunArguments& arguments) {
    for (const std::string& path : paths) {
        if (is_interrupted()) break;
        try {
            run_mesh(path, run, arguments);
        } catch (const fcn::InputError& error) {
            if (paths.size() == 1) throw;
            fmt::print(stderr, "scalefcn: {}\nscalefcn: going on with the other meshes\n",
                       error.what());
            run.code = kBadInput;
        }
    }
}

int finish(const Run& run, const RunArguments& arguments) {
    if (run.meshes.empty()) return is_interrupted() ? kNoResult : run.code;
    const Json summary = summary_so_far(run);
    save_text((run.folder / "summary.json").string(), summary.dump(2) + "\n");
    if (arguments.common.is_json)
        print_json(summary);
    else
        fmt::print("{}\nreport: {}\n", run.closing_text, report_path(run));
    if (is_interrupted())
        print_note(arguments.common,
                   "interrupted: what was finished has been written, the last network is the best "
                   "so far");
    return run.code;
}

int run_command(const RunArguments& arguments) {
    // Scales run beside each other, and each on several threads: together no more than asked for.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(arguments.common.thread_count()));
    const std::vector<std::string> paths = expand_mesh_inputs(arguments.inputs);
    Run run = prepare(arguments, paths.size());
    run_all(paths, run, arguments);
    return finish(run, arguments);
}

/// What made the report, without what does not change it.
std::string command_line_of(const CLI::App& parser) {
    std::string text = "scalefcn run";
    for (const CLI::Option* option : parser.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || name == "--threads" || name == "--output" || name == "--json" ||
            name == "--quiet" || name == "--no-timings")
            continue;
        if (!option->get_positional()) text += " " + name;
        if (option->get_expected_max() == 0) continue;
        for (const std::string& value : option->results()) text += " " + value;
    }
    return text;
}

void add_run_arguments(CLI::App& parser, RunArguments& arguments) {
    parser
        .add_option("MESH", arguments.inputs,
                    "Triangle meshes, or folders of them (- for standard input)")
        ->required();
    auto* scales = parser.add_option("--scales,--scale", arguments.scales,
                                     "Scales rmin, comma-separated: mesh units, or % of the "
                                     "diagonal (default 1%,2%,4%)");
    parser
        .add_option("--edge-lengths,--edge-length", arguments.edge_lengths,
                    "Instead of --scales: edge lengths L of the meshes to be made "
                    "(rmin = L / 1.2)")
        ->excludes(scales);
    parser.add_option("-o,--output", arguments.output, "Folder for the report and all files")
        ->capture_default_str();
    parser.add_option("--network", arguments.detection.network_path,
                      "Initial network of the one mesh, instead of detecting features");
    parser
        .add_option("--solvers", arguments.solvers,
                    "Solvers to compare on the first problem of each scale, or none")
        ->capture_default_str();
    parser
        .add_option("--compare-time", arguments.comparison.time_limit,
                    "Seconds for each compared solver (default: 20 for those that count no "
                    "ticks)")
        ->check(CLI::Range(1e-3, 1e9));
    parser
        .add_option("--compare-work", arguments.comparison.work_limit,
                    "Ticks for each compared solver, about 10^7 a second")
        ->check(CLI::Range(std::int64_t{1}, std::numeric_limits<std::int64_t>::max()))
        ->capture_default_str();
    parser.add_flag("--no-remesh", arguments.is_without_remesh, "Do not make triangle meshes");
    parser
        .add_option("--baselines", arguments.baselines,
                    "Other ways to a mesh, measured beside the remesh: own-plain, curvature-0.8, "
                    "quadrics, filtered, cgal, cgal-constrained, cgal-plain, ...")
        ->capture_default_str();
    parser.add_flag("--no-viewer", arguments.is_without_viewer,
                    "A report with pictures only, smaller and without scripts");
}

}  // namespace

Command add_run_command(CLI::App& program) {
    auto arguments = std::make_shared<RunArguments>();
    CLI::App* parser = program.add_subcommand(
        "run", "All of it: detect, adapt to several scales, check, remesh, report");
    add_run_arguments(*parser, *arguments);
    add_adaptation_arguments(*parser, arguments->adaptation);
    add_detection_arguments(*parser, arguments->detection);
    add_pin_arguments(*parser, arguments->pins);
    add_mesh_arguments(*parser, arguments->mesh);
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Writes FOLDER/report.html, FOLDER/summary.json and, for each mesh and scale, networks,\n"
        "a triangle mesh and the labeling problems.\n"
        "Example:\n  scalefcn run part.stl --scales 1%,2%,4% -o out");
    return {parser, [arguments, parser] {
                if (arguments->inputs.size() > 1 && !arguments->detection.network_path.empty())
                    throw UsageError("run: --network goes with one MESH");
                arguments->command_line = command_line_of(*parser);
                return run_command(*arguments);
            }};
}

}  // namespace fcn::app
