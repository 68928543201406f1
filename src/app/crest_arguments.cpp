#include "app/crest_arguments.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/command.h"
#include "app/length.h"
#include "features/edge_chains.h"
#include "network/crest_file.h"

namespace fcn::app {
namespace {

constexpr double kMost = 1e12;
constexpr double kFewestEdges = 1.5;
constexpr double kMostEdges = 50;

/// "3" is edges around, "1%" a share of the diagonal, "auto" leaves it to the noise.
void set_scale(const std::string& text, double diagonal, CrestOptions& options) {
    options.rings = options.radius = 0;
    if (text == "auto") return;
    const Length length = parse_length(text, "--crest-scale");
    if (length.is_percent) {
        options.radius = length.resolve(diagonal);
        return;
    }
    options.rings = length.value;
    if (options.rings < kFewestEdges || options.rings > kMostEdges)
        throw UsageError(fmt::format("--crest-scale {}: edges must lie in [{}, {}]", text,
                                     kFewestEdges, kMostEdges));
}

/// The files one beside the other: ridges and ravines share no points.
FeatureCurveNetwork import_crests(const LoadedMesh& mesh, const CrestArguments& arguments) {
    const CrestFile::Measures thresholds{arguments.ridgeness.value_or(0),
                                         arguments.sphericalness.value_or(0),
                                         arguments.cyclideness.value_or(0)};
    FeatureCurveNetwork network;
    int first_patch = 0;
    for (const std::string& path : arguments.import_paths) {
        FeatureCurveNetwork part = read_crest_network(path, thresholds, mesh.mesh, first_patch);
        const int first_node = static_cast<int>(network.nodes.size());
        first_patch += static_cast<int>(part.nodes.size());
        network.nodes.insert(network.nodes.end(), part.nodes.begin(), part.nodes.end());
        network.notes.insert(network.notes.end(), part.notes.begin(), part.notes.end());
        for (NetworkArc& arc : part.arcs) {
            for (int& node : arc.nodes) node += first_node;
            network.arcs.push_back(std::move(arc));
        }
    }
    set_provenance(network, mesh);
    return network;
}

void add_thresholds(CLI::App& parser, const char* group, CrestArguments& arguments) {
    const auto add = [&](const char* name, auto& value, double most, const char* text) {
        return parser.add_option(name, value, text)->group(group)->check(CLI::Range(0.0, most));
    };
    const CrestOptions defaults;
    add("--crest-significance", arguments.options.min_significance, kMost,
        "How far a line must stand out from the errors of the fits")
        ->capture_default_str();
    add("--crest-sharpness", arguments.options.min_sharpness, kMost,
        "How fast curvature must fall off across a line, over its cube")
        ->capture_default_str();
    add("--crest-ridgeness", arguments.ridgeness, kMost, "Least integral of |curvature| along it")
        ->default_str(fmt::format("{}", defaults.min_ridgeness));
    add("--crest-sphericalness", arguments.sphericalness, 1,
        "Least mean distance from a sphere, 0 to 1 (cylinder)")
        ->default_str(fmt::format("{}", defaults.min_sphericalness));
    add("--crest-cyclideness", arguments.cyclideness, kMost,
        "Least length times integral of sqrt(e_max^2 + e_min^2), Yoshizawa's T")
        ->default_str(fmt::format("{}", defaults.min_cyclideness));
    add("--crest-radii", arguments.options.min_radii, kMost, "Least length in radii of the fits")
        ->capture_default_str();
    parser.add_option("--crest-min-length", arguments.min_length, "Least length of a line")
        ->group(group);
}

}  // namespace

void add_crest_arguments(CLI::App& parser, CrestArguments& arguments) {
    constexpr const char* kGroup = "Crest lines (crest)";
    parser.add_option("--crest-kind", arguments.kind, "both, ridges, ravines")
        ->group(kGroup)
        ->check(CLI::IsMember({"both", "ridges", "ravines"}))
        ->capture_default_str();
    parser
        .add_option("--crest-scale", arguments.scale,
                    "Radius of the fits: a number of edges, a share of the diagonal (1%), or auto "
                    "(3 edges, more where there is noise)")
        ->group(kGroup)
        ->capture_default_str();
    add_thresholds(parser, kGroup, arguments);
    parser
        .add_option("--crest-gap", arguments.options.gap,
                    "Gaps of so many edges are bridged where tangents agree")
        ->group(kGroup)
        ->check(CLI::Range(0.0, kMostEdges))
        ->capture_default_str();
    parser
        .add_flag("--crest-alone", arguments.is_alone, "No sharp edges first; fits run across them")
        ->group(kGroup);
    parser
        .add_option("--import", arguments.import_paths,
                    "Take the lines from ridges.txt, ravines.txt of Yoshizawa's program instead; "
                    "its three thresholds apply where given")
        ->group(kGroup)
        ->expected(1, 64);
}

FeatureCurveNetwork detect_crests(const LoadedMesh& mesh, const CrestArguments& arguments,
                                  const SharpOptions& sharp, double diagonal, int threads) {
    if (!arguments.import_paths.empty()) return import_crests(mesh, arguments);
    CrestOptions options = arguments.options;
    if (arguments.kind == "ridges") options.kind = CrestKind::Ridges;
    if (arguments.kind == "ravines") options.kind = CrestKind::Ravines;
    set_scale(arguments.scale, diagonal, options);
    options.min_ridgeness = arguments.ridgeness.value_or(options.min_ridgeness);
    options.min_sphericalness = arguments.sphericalness.value_or(options.min_sphericalness);
    options.min_cyclideness = arguments.cyclideness.value_or(options.min_cyclideness);
    if (!arguments.min_length.empty())
        options.min_length =
            parse_length(arguments.min_length, "--crest-min-length").resolve(diagonal);
    options.is_sharp_first = !arguments.is_alone;
    options.sharp_angle = sharp.high_angle;
    options.sharp_low_angle = sharp.low_angle;
    options.threads = threads;
    return detect_crest(mesh, options);
}

}  // namespace fcn::app
