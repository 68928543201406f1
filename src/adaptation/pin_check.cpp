// Pins become fixed labels, so two of them that are in conflict leave no choice: the network would
// violate its own scale. This is found before the adaptation by doing its first steps to the pinned
// arcs alone, which is what is left of the network where every feature yields. The largest scale at
// which a pair fits is found by trying: halving until it does, then bisection. It is a scale that
// was seen to fit, not a bound; between two scales that fit there can be one that does not, since
// chains of segments are chosen anew at each.

#include "adaptation/pin_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <set>

#include "adaptation/conflicts.h"
#include "adaptation/network_output.h"
#include "adaptation/thin_wall.h"
#include "adaptation/working_network.h"
#include "geometry/surface_queries.h"

namespace fcn {
namespace {

constexpr std::size_t kExamined = 8;
constexpr int kHalvings = 7;
constexpr int kBisections = 10;
constexpr double kMostSamples = 2e6;
constexpr double kThinWallDistance = 3;  ///< in rmin, as in the adaptation
constexpr double kTouch = 1e-3;          ///< in rmin

struct Finding {
    PinConflict conflict;
    std::set<int> arcs;  ///< of the network, whose chains take part
};

class PinTest {
public:
    PinTest(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
            const AdaptationOptions& options)
        : mesh_(mesh.mesh), network_(network), options_(options), queries_(mesh.mesh) {}

    /// Everything that is wrong with these arcs at a scale, by pair.
    std::vector<Finding> findings(const std::set<int>& arcs, double rmin) const {
        const ScaleInterval scale = make_scale(rmin, options_.ratio, options_.target);
        WorkingNetwork working = pinned_network(arcs, sample_spacing(scale));
        working.merge_regular_nodes([](int) { return true; });
        const std::vector<int> lost = resample_arcs(working, scale, options_.threads);
        std::map<std::pair<int, int>, Finding> found;
        const auto add = [&](const PinConflict& conflict, const std::set<int>& involved) {
            if (!is_user_pin(conflict.first) && !is_user_pin(conflict.second)) return;
            const auto [at, is_new] =
                found.try_emplace({conflict.first, conflict.second}, Finding{conflict, involved});
            if (is_new) return;
            at->second.arcs.insert(involved.begin(), involved.end());
            const bool is_closer = conflict.distance < at->second.conflict.distance;
            if (is_closer || conflict.kind < at->second.conflict.kind)
                at->second.conflict = conflict;
        };
        for (int a = 0; a < static_cast<int>(working.arcs.size()); ++a) {
            const WorkingArc& arc = working.arcs[a];
            const bool is_lost = std::ranges::binary_search(lost, a);
            if (!arc.is_alive || (!arc.is_short && !is_lost)) continue;
            const int own = majority_origin(arc, 0, static_cast<int>(arc.points.size()) - 1);
            add({PinConflict::Kind::Length, own, own, arc.length(), 0, arc.points.front()},
                {arc.origins.begin(), arc.origins.end()});
        }
        const NetworkGraph graph = make_graph(working);
        const ConflictResult conflicts = detect_conflicts(graph.graph, scale, options_at(rmin));
        for (const Conflict& conflict : conflicts.input_forced) {
            const auto [own, own_arcs] = origin(working, graph.sources[conflict.first]);
            const auto [other, other_arcs] = origin(working, graph.sources[conflict.second]);
            std::set<int> involved = own_arcs;
            involved.insert(other_arcs.begin(), other_arcs.end());
            const bool is_angle = conflict.kind == ConflictKind::Angle;
            add({is_angle ? PinConflict::Kind::Angle : PinConflict::Kind::Distance,
                 std::min(own, other), std::max(own, other), conflict.distance, conflict.angle,
                 conflict.witness_first},
                involved);
        }
        std::vector<Finding> result;
        for (auto& [pair, finding] : found) result.push_back(std::move(finding));
        return result;
    }

    double largest_scale(const std::set<int>& arcs, double rmin) const {
        double length = 0;
        for (int a : arcs) length += network_.arcs[a].length();
        double fits = 0, too_large = rmin, scale = rmin;
        for (int k = 0; k < kHalvings; ++k) {
            scale /= 2;
            if (length / (scale / 50) > kMostSamples) break;
            if (findings(arcs, scale).empty()) {
                fits = scale;
                break;
            }
            too_large = scale;
        }
        for (int k = 0; fits > 0 && k < kBisections; ++k) {
            const double middle = (fits + too_large) / 2;
            (findings(arcs, middle).empty() ? fits : too_large) = middle;
        }
        return fits;
    }

private:
    bool is_user_pin(int arc) const { return network_.arcs[arc].kind == ArcKind::Feature; }

    ConflictOptions options_at(double rmin) const {
        ConflictOptions result;
        result.mode = options_.mode;
        result.threads = options_.threads;
        if (options_.mode == AdaptationMode::Best && options_.thin_walls == ThinWalls::Exempt) {
            const auto test = std::make_shared<ThinWallTest>(
                mesh_, queries_, kThinWallDistance * rmin, kTouch * rmin);
            result.is_thin_wall = [test](const Vec3& a, const Vec3& b) { return (*test)(a, b); };
        }
        return result;
    }

    WorkingNetwork pinned_network(const std::set<int>& arcs, double spacing) const {
        WorkingNetwork working;
        for (const NetworkNode& node : network_.nodes) working.nodes.push_back({node.position});
        for (int a : arcs) {
            const NetworkArc& arc = network_.arcs[a];
            WorkingArc copy;
            copy.nodes = arc.nodes;
            copy.points = densify(arc.samples, spacing);
            copy.points.front() = network_.nodes[arc.nodes[0]].position;
            copy.points.back() = network_.nodes[arc.nodes[1]].position;
            copy.origins.assign(copy.points.size() - 1, a);
            copy.sharpness.assign(copy.points.size(), 0);
            copy.crease.assign(copy.points.size(), 0);
            copy.is_pinned = true;
            working.arcs.push_back(std::move(copy));
        }
        return working;
    }

    /// The network's arc that a segment stands for, and all arcs of its chain.
    std::pair<int, std::set<int>> origin(const WorkingNetwork& working,
                                         const SegmentSource& source) const {
        const WorkingArc& arc = working.arcs[source.arc];
        const int last = std::max(source.last_sample, source.first_sample + 1);
        return {majority_origin(arc, source.first_sample, last),
                {arc.origins.begin(), arc.origins.end()}};
    }

    const Mesh& mesh_;
    const FeatureCurveNetwork& network_;
    AdaptationOptions options_;
    SurfaceQueries queries_;
};

}  // namespace

std::string PinConflict::message(double rmin) const {
    const bool is_alone = first == second;
    char where[96], what[160], advice[160];
    std::snprintf(where, sizeof where, "near (%.6g, %.6g, %.6g)", place.x(), place.y(), place.z());
    std::string names = "arc " + std::to_string(first);
    if (!is_alone) names = "arcs " + std::to_string(first) + " and " + std::to_string(second);
    if (kind == Kind::Length)
        std::snprintf(what, sizeof what, " is pinned but only %.2g rmin long", distance / rmin);
    else if (kind == Kind::Angle)
        std::snprintf(what, sizeof what, " %s pinned and %s %.3g degrees", is_alone ? "is" : "are",
                      is_alone ? "turns to" : "meet at", angle * 180 / std::numbers::pi);
    else
        std::snprintf(what, sizeof what, " %s pinned %.2g rmin %s", is_alone ? "is" : "are",
                      distance / rmin, is_alone ? "from itself" : "apart");
    if (largest_scale > 0)
        std::snprintf(advice, sizeof advice, "; %s up to scale %.4g",
                      is_alone ? "it fits" : "both fit", largest_scale);
    else
        std::snprintf(advice, sizeof advice, "; no scale was found at which %s",
                      is_alone ? "it fits" : "both fit");
    return names + what + " " + where + advice;
}

PinCheck check_pins(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                    const AdaptationOptions& options) {
    PinCheck check;
    std::set<int> pinned;
    bool has_user_pin = false;
    for (int a = 0; a < static_cast<int>(network.arcs.size()); ++a) {
        if (network.arcs[a].pin != Pin::Keep) continue;
        pinned.insert(a);
        has_user_pin = has_user_pin || network.arcs[a].kind == ArcKind::Feature;
    }
    if (!has_user_pin) return check;
    const PinTest test(mesh, network, options);
    std::vector<Finding> findings = test.findings(pinned, options.rmin);
    check.conflict_count = findings.size();
    std::ranges::stable_sort(findings, {}, [](const Finding& f) { return f.conflict.distance; });
    findings.resize(std::min(findings.size(), kExamined));
    for (Finding& finding : findings) {
        finding.conflict.largest_scale = test.largest_scale(finding.arcs, options.rmin);
        check.conflicts.push_back(finding.conflict);
    }
    std::ranges::stable_sort(check.conflicts, {}, &PinConflict::largest_scale);
    return check;
}

}  // namespace fcn
