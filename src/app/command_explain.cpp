#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <numbers>
#include <numeric>

#include "app/command.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "geometry/errors.h"
#include "network/network_io.h"

namespace fcn::app {
namespace {

struct ExplainArguments {
    CommonArguments common;
    std::string network_path;
    int curve = -1;
    int arc = -1;
};

double length_of(const std::vector<Vec3>& polyline) {
    double length = 0;
    for (std::size_t k = 1; k < polyline.size(); ++k)
        length += (polyline[k] - polyline[k - 1]).norm();
    return length;
}

/// Arcs of the initial network that are asked about, ascending.
std::vector<int> arcs_to_explain(const ExplainArguments& arguments,
                                 const FeatureCurveNetwork& network) {
    const int count = static_cast<int>(network.origin_curves.size());
    if (count == 0)
        throw InputError(fmt::format(
            "{}: no adapted network that knows its curves (adapt writes them to .fcn.json)",
            arguments.network_path));
    if (arguments.arc >= count)
        throw InputError(fmt::format("{}: there is no arc {}; the initial network had {}",
                                     arguments.network_path, arguments.arc, count));
    std::vector<int> arcs;
    for (int a = 0; a < count; ++a) {
        const bool is_asked = arguments.arc >= 0     ? a == arguments.arc
                              : arguments.curve >= 0 ? network.origin_curves[a] == arguments.curve
                                                     : true;
        if (is_asked) arcs.push_back(a);
    }
    if (arcs.empty()) {
        const int last = *std::ranges::max_element(network.origin_curves);
        throw InputError(fmt::format("{}: there is no curve {}; the last one is {}",
                                     arguments.network_path, arguments.curve, last));
    }
    return arcs;
}

double kept_length(const FeatureCurveNetwork& network, const std::vector<int>& arcs) {
    double length = 0;
    for (const NetworkArc& arc : network.arcs) {
        for (std::size_t k = 0; k < arc.origins.size(); ++k) {
            if (std::ranges::binary_search(arcs, arc.origins[k]))
                length += (arc.samples[k + 1].position - arc.samples[k].position).norm();
        }
    }
    return length;
}

/// Dropped pieces of the arcs, heaviest first.
std::vector<const DroppedPiece*> dropped_pieces(const FeatureCurveNetwork& network,
                                                const std::vector<int>& arcs) {
    std::vector<const DroppedPiece*> pieces;
    for (const DroppedPiece& piece : network.dropped)
        if (std::ranges::binary_search(arcs, piece.origin_arc)) pieces.push_back(&piece);
    std::ranges::stable_sort(pieces, std::greater<>{}, &DroppedPiece::weight);
    return pieces;
}

/// "arc 47 (curve 12)"; a file may name arcs that it does not know.
std::string name_of(const Blocker& blocker, const FeatureCurveNetwork& network) {
    if (blocker.origin_arc < 0) return "a node that stays as it is";
    const auto arc = static_cast<std::size_t>(blocker.origin_arc);
    if (arc >= network.origin_curves.size()) return fmt::format("arc {}", arc);
    return fmt::format("arc {} (curve {})", arc, network.origin_curves[arc]);
}

std::string relation_of(const Blocker& blocker, double rmin) {
    if (blocker.conflict == "angle")
        return fmt::format("{:.1f} degrees between them",
                           blocker.measured * 180 / std::numbers::pi);
    if (blocker.conflict == "nodes")
        return fmt::format("nodes {:.3g} rmin apart", blocker.measured / rmin);
    if (blocker.conflict == "rule") return "a rule allows only one of the two beside the rest";
    return fmt::format("{:.3g} rmin apart", blocker.measured / rmin);
}

void print_piece(const DroppedPiece& piece, const FeatureCurveNetwork& network) {
    const Vec3& where = piece.polyline[piece.polyline.size() / 2];
    fmt::print("  {} of arc {}, length {:.4g}, weight {:.4g}, near ({:.4g}, {:.4g}, {:.4g})\n",
               piece.reason.empty() ? "dropped piece" : piece.reason, piece.origin_arc,
               length_of(piece.polyline), piece.weight, where.x(), where.y(), where.z());
    for (const Blocker& blocker : piece.blockers)
        fmt::print("    against {}, weight {:.4g}: {}\n", name_of(blocker, network), blocker.weight,
                   relation_of(blocker, network.scale));
    if (piece.margin)
        fmt::print("    instead of these the objective would be {:.4g} lower\n", *piece.margin);
    else if (piece.label >= 0)
        fmt::print("    instead of these it would still break a rule\n");
}

Json piece_json(const DroppedPiece& piece) {
    Json blockers = Json::array();
    for (const Blocker& blocker : piece.blockers)
        blockers.push_back({{"label", blocker.label},
                            {"origin_arc", blocker.origin_arc},
                            {"weight", blocker.weight},
                            {"conflict", blocker.conflict},
                            {"measured", blocker.measured}});
    return {{"origin_arc", piece.origin_arc},
            {"reason", piece.reason},
            {"iteration", piece.iteration},
            {"label", piece.label},
            {"length", length_of(piece.polyline)},
            {"weight", piece.weight},
            {"margin", piece.margin ? Json(*piece.margin) : Json(nullptr)},
            {"blockers", std::move(blockers)}};
}

int explain(const ExplainArguments& arguments) {
    const FeatureCurveNetwork network = read_network(arguments.network_path);
    const std::vector<int> arcs = arcs_to_explain(arguments, network);
    const std::vector<const DroppedPiece*> pieces = dropped_pieces(network, arcs);
    const double kept = kept_length(network, arcs);
    const double dropped = std::accumulate(
        pieces.begin(), pieces.end(), 0.0,
        [](double sum, const DroppedPiece* p) { return sum + length_of(p->polyline); });
    if (arguments.common.is_json) {
        Json list = Json::array();
        for (const DroppedPiece* piece : pieces) list.push_back(piece_json(*piece));
        print_json({{"arcs", arcs},
                    {"rmin", network.scale},
                    {"kept_length", kept},
                    {"dropped_length", dropped},
                    {"dropped", std::move(list)}});
        return kDone;
    }
    const std::string what = arguments.arc >= 0 ? fmt::format("arc {}", arguments.arc)
                             : arguments.curve >= 0
                                 ? fmt::format("curve {} ({} arcs)", arguments.curve, arcs.size())
                                 : fmt::format("all {} arcs", arcs.size());
    fmt::print("{} at rmin {:.6g}: length {:.4g} kept, {:.4g} dropped in {} pieces\n", what,
               network.scale, kept, dropped, pieces.size());
    for (const DroppedPiece* piece : pieces) print_piece(*piece, network);
    return kDone;
}

}  // namespace

Command add_explain_command(CLI::App& program) {
    auto arguments = std::make_shared<ExplainArguments>();
    CLI::App* parser = program.add_subcommand(
        "explain", "Why an adaptation dropped what it dropped, heaviest pieces first");
    parser->add_option("NETWORK", arguments->network_path, "Adapted network (.fcn.json)")
        ->required();
    auto* curve = parser
                      ->add_option("--curve", arguments->curve,
                                   "Only this supporting curve of the initial network, from 0")
                      ->check(CLI::NonNegativeNumber);
    parser->add_option("--arc", arguments->arc, "Only this arc of the initial network, from 0")
        ->check(CLI::NonNegativeNumber)
        ->excludes(curve);
    add_common_arguments(*parser, arguments->common);
    parser->footer("Example:\n  scalefcn explain out/part/2pct/adapted.fcn.json --curve 12");
    return {parser, [arguments] { return explain(*arguments); }};
}

}  // namespace fcn::app
