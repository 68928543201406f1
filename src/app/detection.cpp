// `--method auto`: a mechanical part has edges that are clearly sharp or clearly smooth; on a scan
// the angles run on from one to the other. So sharp is taken when the edges above the threshold
// are longer together than those of the grey zone below it, down to the hysteresis angle, and
// long enough to describe the part; VSA otherwise.

#include "app/detection.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "app/command.h"
#include "app/inputs.h"
#include "app/length.h"
#include "features/combine.h"
#include "features/symmetry.h"
#include "features/wire.h"
#include "geometry/errors.h"

namespace fcn::app {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr const char* kMethods[] = {"auto", "sharp", "vsa", "crest", "wire"};

SharpOptions sharp_options(const DetectionArguments& arguments, double diagonal) {
    if (arguments.low_angle_degrees > arguments.sharp_angle_degrees)
        throw UsageError(fmt::format("--low-angle {} must not exceed --sharp-angle {}",
                                     arguments.low_angle_degrees, arguments.sharp_angle_degrees));
    if (arguments.is_plain && (arguments.sign != "both" || !arguments.min_length.empty()))
        throw UsageError("--sharp-plain goes with --sharp-angle alone");
    SharpOptions options;
    options.is_plain = arguments.is_plain;
    options.high_angle = arguments.sharp_angle_degrees * kRadians;
    options.low_angle = arguments.low_angle_degrees * kRadians;
    if (arguments.sign == "convex") options.sign = SharpSign::Convex;
    if (arguments.sign == "concave") options.sign = SharpSign::Concave;
    if (!arguments.min_length.empty())
        options.min_length = parse_length(arguments.min_length, "--min-length").resolve(diagonal);
    return options;
}

std::vector<int> read_seed_faces(const std::string& path, std::size_t face_count) {
    std::istringstream in(read_text(path));
    std::vector<int> seeds;
    for (std::string word; in >> word;) {
        std::size_t used = 0;
        long long face = -1;
        try {
            face = std::stoll(word, &used);
        } catch (const std::exception&) {
            used = 0;
        }
        if (used != word.size() || face < 0 || face >= static_cast<long long>(face_count))
            throw InputError(
                fmt::format("{}: '{}' is not a face index below {}", path, word, face_count));
        seeds.push_back(static_cast<int>(face));
    }
    return seeds;
}

VsaOptions vsa_options(const DetectionArguments& arguments, const Mesh& mesh, int threads) {
    VsaOptions options;
    options.patch_count = arguments.patch_count;
    options.max_iterations = arguments.vsa_iterations;
    options.min_patch_area = arguments.min_patch_area;
    options.is_straightening = !arguments.is_unstraightened;
    options.threads = threads;
    if (!arguments.seed_faces_path.empty())
        options.seed_faces = read_seed_faces(arguments.seed_faces_path, mesh.n_faces());
    return options;
}

bool is_mechanical(const Mesh& mesh, const SharpOptions& options, double diagonal) {
    double sharp = 0;
    double grey = 0;
    for (const EdgeHandle edge : mesh.edges()) {
        const double angle = std::abs(dihedral_angle(mesh, edge));
        if (angle >= options.high_angle)
            sharp += mesh.calc_edge_length(edge);
        else if (angle >= options.low_angle)
            grey += mesh.calc_edge_length(edge);
    }
    return sharp > grey && sharp > diagonal;
}

WireOptions wire_options(const DetectionArguments& arguments, double diagonal, int threads) {
    WireOptions options;
    if (!arguments.wire_length.empty())
        options.length = parse_length(arguments.wire_length, "--wire-length").resolve(diagonal);
    options.attraction = arguments.wire_attraction;
    options.max_anisotropy = arguments.wire_anisotropy;
    options.snap = arguments.wire_snap_percent / 100;
    options.threads = threads;
    return options;
}

/// A user's wires, or links between the loose ends of what the detectors before have found.
FeatureCurveNetwork detect_wires_beside(const std::vector<FeatureCurveNetwork>& networks,
                                        const CombineOptions& combination, const LoadedMesh& mesh,
                                        const DetectionArguments& arguments, double diagonal,
                                        int threads) {
    const WireOptions options = wire_options(arguments, diagonal, threads);
    if (!arguments.wires_path.empty())
        return detect_wires(mesh, read_wires(read_text(arguments.wires_path), arguments.wires_path),
                            options);
    return link_loose_ends(mesh, combine_networks(networks, mesh, combination), options);
}

FeatureCurveNetwork detect_by(const std::string& method, const LoadedMesh& mesh,
                              const DetectionArguments& arguments, double diagonal, int threads) {
    if (method == "vsa") return detect_vsa(mesh, vsa_options(arguments, mesh.mesh, threads));
    if (method == "crest")
        return detect_crests(mesh, arguments.crest, sharp_options(arguments, diagonal), diagonal,
                             threads);
    return detect_sharp(mesh, sharp_options(arguments, diagonal));
}

/// "sharp+vsa" as its parts, each known.
std::vector<std::string> parse_methods(const std::string& text) {
    std::vector<std::string> methods;
    std::istringstream in(text + "+");
    for (std::string method; std::getline(in, method, '+');) {
        if (std::ranges::find(kMethods, method) == std::end(kMethods))
            throw UsageError(
                fmt::format("'{}' is no detector; known: {}, and several "
                            "joined by + (sharp+vsa)",
                            method, fmt::join(kMethods, ", ")));
        if (std::ranges::find(methods, method) != methods.end())
            throw UsageError(fmt::format("{} is named twice", method));
        methods.push_back(method);
    }
    return methods;
}

Detection detect_features(const LoadedMesh& mesh, const DetectionArguments& arguments,
                          double diagonal, int threads) {
    Detection detection;
    CombineOptions combination;
    if (!arguments.fuse_distance.empty())
        combination.tolerance =
            parse_length(arguments.fuse_distance, "--fuse-distance").resolve(diagonal);
    const SharpOptions sharp = sharp_options(arguments, diagonal);
    std::vector<FeatureCurveNetwork> networks;
    std::vector<std::string> done;
    std::vector<std::string> methods = parse_methods(arguments.method);
    const bool has_wires = std::ranges::find(methods, "wire") != methods.end();
    if (!arguments.crest.import_paths.empty() &&
        std::ranges::find(methods, "crest") == methods.end())
        throw UsageError("--import needs crest among the detectors (--method crest)");
    if (!arguments.wires_path.empty() && !has_wires)
        throw UsageError("--seeds needs wire among the detectors (--method sharp+wire)");
    // Without seeds wires link the loose ends of what came before them: of sharp edges at least.
    if (methods.front() == "wire" && arguments.wires_path.empty())
        methods.insert(methods.begin(), "sharp");
    for (std::string method : methods) {
        if (method == "auto") {
            method = is_mechanical(mesh.mesh, sharp, diagonal) ? "sharp" : "vsa";
            detection.messages.push_back(
                fmt::format("feature detector chosen by --method auto: {}", method));
        }
        if (std::ranges::find(done, method) != done.end()) continue;
        done.push_back(method);
        networks.push_back(
            method == "wire"
                ? detect_wires_beside(networks, combination, mesh, arguments, diagonal, threads)
                : detect_by(method, mesh, arguments, diagonal, threads));
    }
    detection.method = fmt::format("{}", fmt::join(done, "+"));
    detection.network = networks.size() == 1 ? std::move(networks.front())
                                             : combine_networks(networks, mesh, combination);
    return detection;
}

/// Fills the orbits of the network and says what was found.
void add_symmetries(Detection& detection, const LoadedMesh& mesh,
                    const DetectionArguments& arguments, double diagonal, int threads) {
    SymmetryOptions options;
    if (!arguments.symmetry_distance.empty())
        options.tolerance =
            parse_length(arguments.symmetry_distance, "--symmetry-distance").resolve(diagonal);
    options.min_coverage = arguments.symmetry_coverage;
    options.threads = threads;
    std::array<int, 3> counts{};
    for (const SurfaceSymmetry& symmetry : add_symmetry_orbits(detection.network, mesh, options))
        ++counts[static_cast<std::size_t>(symmetry.kind)];
    std::size_t members = 0;
    for (const SymmetryOrbit& orbit : detection.network.orbits) members += orbit.members.size();
    detection.messages.push_back(fmt::format(
        "symmetries of the surface: {} reflections, {} rotations, {} translations; {} of {} arcs "
        "are in {} orbits",
        counts[0], counts[1], counts[2], members, detection.network.arcs.size(),
        detection.network.orbits.size()));
}

BoundaryPolicy boundary_policy(const std::string& name) {
    if (name == "adapt") return BoundaryPolicy::Adapt;
    if (name == "ignore") return BoundaryPolicy::Ignore;
    return BoundaryPolicy::Keep;
}

Detection import_network(const LoadedMesh& mesh, const std::string& path) {
    Detection detection;
    detection.method = "import";
    detection.network = read_network_for_mesh(path, mesh);
    return detection;
}

void add_sharp_arguments(CLI::App& parser, DetectionArguments& arguments) {
    constexpr const char* kGroup = "Sharp edges";
    parser
        .add_option("--sharp-angle", arguments.sharp_angle_degrees,
                    "Degrees between normals from which an edge is a feature")
        ->group(kGroup)
        ->check(CLI::Range(0.0, 180.0))
        ->capture_default_str();
    parser
        .add_option("--low-angle", arguments.low_angle_degrees,
                    "Degrees down to which a feature goes on (hysteresis)")
        ->group(kGroup)
        ->check(CLI::Range(0.0, 180.0))
        ->capture_default_str();
    parser
        .add_flag("--sharp-plain", arguments.is_plain,
                  "Every edge of --sharp-angle and no other: no hysteresis, noise is not looked at")
        ->group(kGroup);
    parser.add_option("--sign", arguments.sign, "Which edges: both, convex, concave")
        ->group(kGroup)
        ->check(CLI::IsMember({"both", "convex", "concave"}))
        ->capture_default_str();
    parser
        .add_option("--min-length", arguments.min_length,
                    "Drop connected chains shorter than this length")
        ->group(kGroup);
}

void add_symmetry_arguments(CLI::App& parser, DetectionArguments& arguments) {
    constexpr const char* kGroup = "Symmetry";
    parser
        .add_flag("--symmetry", arguments.is_symmetric,
                  "Look for reflections, rotations and translations of the surface: arcs that they "
                  "exchange stay or go together")
        ->group(kGroup);
    parser
        .add_option("--symmetry-distance", arguments.symmetry_distance,
                    "How far images may be off the surface (default: 0.5% of the diagonal)")
        ->group(kGroup);
    parser
        .add_option("--symmetry-coverage", arguments.symmetry_coverage,
                    "Share of the surface that must land on the surface")
        ->group(kGroup)
        ->check(CLI::Range(0.05, 1.0))
        ->capture_default_str();
}

void add_vsa_arguments(CLI::App& parser, DetectionArguments& arguments) {
    constexpr const char* kGroup = "Variational shape approximation (vsa)";
    parser.add_option("--patches", arguments.patch_count, "Number of patches")
        ->group(kGroup)
        ->check(CLI::Range(2, 10'000'000))
        ->capture_default_str();
    parser.add_option("--vsa-iterations", arguments.vsa_iterations, "Most rounds of clustering")
        ->group(kGroup)
        ->check(CLI::Range(1, 10'000))
        ->capture_default_str();
    parser
        .add_option("--min-patch-area", arguments.min_patch_area,
                    "Dissolve patches smaller than this share of the mean patch")
        ->group(kGroup)
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    parser
        .add_flag("--no-straightening", arguments.is_unstraightened,
                  "Leave the patch borders on mesh edges")
        ->group(kGroup);
    parser
        .add_option("--vsa-seeds", arguments.seed_faces_path,
                    "File with the face indices (from 0) of the first seeds")
        ->group(kGroup);
}

void add_wire_arguments(CLI::App& parser, DetectionArguments& arguments) {
    constexpr const char* kGroup = "Live-wire (wire)";
    parser
        .add_option("--seeds", arguments.wires_path,
                    "File with the seeds of wires (JSON); without one, wires link loose ends of "
                    "the detectors before")
        ->group(kGroup);
    parser
        .add_option("--wire-length", arguments.wire_length,
                    "Width of the features that attract wires (default 2%)")
        ->group(kGroup);
    parser
        .add_option("--wire-snap", arguments.wire_snap_percent,
                    "Seeds (points) move onto features within this % of the diagonal; 0 = none")
        ->group(kGroup)
        ->check(CLI::Range(0.0, 10.0))
        ->capture_default_str();
    parser
        .add_option("--wire-attraction", arguments.wire_attraction,
                    "How much features attract; 0 = shortest paths")
        ->group(kGroup)
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    parser
        .add_option("--wire-anisotropy", arguments.wire_anisotropy,
                    "How much cheaper steps along features can be")
        ->group(kGroup)
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
}

}  // namespace

void add_detection_arguments(CLI::App& parser, DetectionArguments& arguments) {
    parser
        .add_option("--method", arguments.method,
                    "Feature detector: sharp (creases), vsa (borders of nearly flat patches), "
                    "crest (creases, ridges and ravines), "
                    "wire (through seeds, or links between loose ends), auto (sharp for mechanical "
                    "parts, vsa for scans); several joined "
                    "by + (sharp+vsa), where earlier ones win and later ones stop at them")
        ->check([](const std::string& text) {
            try {
                parse_methods(text);
                return std::string();
            } catch (const UsageError& error) {
                return std::string(error.what());
            }
        })
        ->capture_default_str();
    parser.add_option("--fuse-distance", arguments.fuse_distance,
                      "Of several detectors: no curve is lost that is farther than this from "
                      "the others; half of it fuses (default: two mean edges, at most 1%)");
    add_sharp_arguments(parser, arguments);
    add_vsa_arguments(parser, arguments);
    add_crest_arguments(parser, arguments.crest);
    add_wire_arguments(parser, arguments);
    add_symmetry_arguments(parser, arguments);
    constexpr const char* kGroup = "Mesh boundaries and borders between face labels";
    parser
        .add_option("--boundary", arguments.boundary,
                    "keep (pinned: features yield to them), adapt (like features), ignore")
        ->group(kGroup)
        ->check(CLI::IsMember({"keep", "adapt", "ignore"}))
        ->capture_default_str();
    parser
        .add_option("--corner-angle", arguments.corner_angle_degrees,
                    "Degrees by which a boundary turns at a corner")
        ->group(kGroup)
        ->check(CLI::Range(0.0, 180.0))
        ->capture_default_str();
}

Detection detect_network(const LoadedMesh& mesh, const DetectionArguments& arguments, int threads) {
    const double diagonal = bounding_box(mesh.mesh).diagonal();
    Detection detection = arguments.network_path.empty()
                              ? detect_features(mesh, arguments, diagonal, threads)
                              : import_network(mesh, arguments.network_path);
    if (arguments.network_path.empty() || !is_lossless_network(arguments.network_path))
        detection.network =
            add_boundaries(detection.network, mesh, boundary_policy(arguments.boundary),
                           arguments.corner_angle_degrees * kRadians);
    if (detection.network.curves.empty() && !detection.network.is_adapted())
        find_curves(detection.network);  // numbers for --keep curve:N
    const auto& notes = detection.network.notes;
    detection.messages.insert(detection.messages.end(), notes.begin(), notes.end());
    if (arguments.is_symmetric) add_symmetries(detection, mesh, arguments, diagonal, threads);
    if (detection.network.arcs.empty())
        detection.messages.push_back(
            fmt::format("no feature curve found by method {}: the mesh will be remeshed freely "
                        "(try another --method or a lower --sharp-angle)",
                        detection.method));
    return detection;
}

}  // namespace fcn::app
