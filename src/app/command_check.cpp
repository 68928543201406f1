#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <numbers>
#include <optional>

#include "app/adaptation_arguments.h"
#include "app/command.h"
#include "app/inputs.h"
#include "app/json_summary.h"

namespace fcn::app {
namespace {

constexpr std::size_t kPrintedViolations = 20;

struct CheckArguments {
    CommonArguments common;
    MeshArguments mesh;
    ScaleArguments scale;
    CriteriaArguments criteria;
    bool has_ratio = false;
    std::string network_path;
    std::string mesh_path;
};

double scale_to_check(const CheckArguments& arguments, const FeatureCurveNetwork& network) {
    if (arguments.scale.is_given())
        return resolve_scale(arguments.scale.request(), network.diagonal);
    if (network.scale > 0) return network.scale;
    throw UsageError(fmt::format("{} does not state its scale: give --scale or --edge-length",
                                 arguments.network_path));
}

void print_violation(const Violation& violation) {
    const bool is_angle = violation.kind == ViolationKind::Angle;
    const double unit = is_angle ? 180 / std::numbers::pi : 1.0;
    const std::string items = violation.second < 0
                                  ? fmt::format("{}", violation.first)
                                  : fmt::format("{} and {}", violation.first, violation.second);
    const Vec3& where = violation.witness_first;
    fmt::print("  {} {}: {:.6g}{}, required {:.6g}, near ({:.5g}, {:.5g}, {:.5g}){}\n",
               to_string(violation.kind), items, violation.measured * unit,
               is_angle ? " degrees" : "", violation.required * unit, where.x(), where.y(),
               where.z(),
               violation.is_exempt         ? " [thin wall]"
               : violation.is_input_forced ? " [forced by the input]"
                                           : "");
}

void print_report(const ConformityReport& report, double rmin) {
    fmt::print("{} at rmin {:.6g}: {} violations, {} forced by the input, {} at thin walls\n",
               report.is_conforming() ? "conforming" : "NOT conforming", rmin, report.counted,
               report.input_forced, report.exempt);
    if (report.long_segments > 0)
        fmt::print("{} arcs carry one long segment each\n", report.long_segments);
    if (report.distance_ratio_pairs > 0)
        fmt::print(
            "surface / straight distance between close curves: at most {:.3g}, {} of {} "
            "pairs over 2\n",
            report.max_distance_ratio, report.distance_ratio_over_two, report.distance_ratio_pairs);
    std::size_t printed = 0;
    for (const Violation& violation : report.violations) {
        if (printed++ == kPrintedViolations) {
            fmt::print("  ... and {} more (--json lists all)\n",
                       report.violations.size() - kPrintedViolations);
            break;
        }
        print_violation(violation);
    }
}

int check(const CheckArguments& arguments) {
    std::optional<LoadedMesh> mesh;
    if (!arguments.mesh_path.empty())
        mesh = load_mesh(arguments.mesh_path, arguments.mesh, arguments.common);
    const FeatureCurveNetwork network = mesh ? read_network_for_mesh(arguments.network_path, *mesh)
                                             : load_network(arguments.network_path);
    ConformityOptions options;
    options.rmin = scale_to_check(arguments, network);
    options.ratio =
        arguments.has_ratio || network.ratio <= 0 ? arguments.criteria.ratio : network.ratio;
    options.is_quad_target = arguments.criteria.is_quad();
    options.is_thin_wall_exempt = arguments.criteria.thin_walls == "exempt";
    const ConformityReport report =
        check_conformity(network, options, mesh ? &mesh->mesh : nullptr);
    if (arguments.common.is_json) {
        Json json{{"network", network_json(network)},
                  {"rmin", options.rmin},
                  {"rmax", options.rmin * options.ratio}};
        json.update(conformity_json(report, true));
        print_json(json);
    } else {
        print_report(report, options.rmin);
    }
    return report.is_conforming() ? kDone : kViolation;
}

}  // namespace

Command add_check_command(CLI::App& program) {
    auto arguments = std::make_shared<CheckArguments>();
    CLI::App* parser = program.add_subcommand(
        "check", "Check independently whether a network conforms to a scale");
    parser->add_option("NETWORK", arguments->network_path, "Adapted network (- for standard input)")
        ->required();
    parser->add_option("--mesh", arguments->mesh_path,
                       "Its mesh: thin walls and surface distances need it");
    add_scale_arguments(*parser, arguments->scale);
    add_criteria_arguments(*parser, arguments->criteria);
    add_mesh_arguments(*parser, arguments->mesh);
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Without --scale, the scale and ratio that the network file states are used.\n"
        "Exit code 5 when there is a violation.\n"
        "Example:\n  scalefcn check part_2pct.fcn.json --scale 2% --mesh part.stl");
    return {parser, [arguments, parser] {
                arguments->has_ratio = parser->count("--ratio") > 0;
                return check(*arguments);
            }};
}

}  // namespace fcn::app
