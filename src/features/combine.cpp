// Merging the networks of several detectors. Each network in turn is compared with what the ones
// before it have given (combine_cuts.cpp): what runs along it is left out, and what remains is
// attached to it. Attachments close to a node go to that node, those close to each other share a
// junction, and the arcs they lie on are split there. Half the tolerance is the reach of fusing, so
// that a dropped remainder of twice the reach keeps the promise that no point is lost farther than
// the tolerance from the result.

#include "features/combine.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "features/combine_cuts.h"
#include "features/edge_chains.h"
#include "geometry/errors.h"
#include "network/drop_unused_nodes.h"

namespace fcn {
namespace {

constexpr double kToleranceEdges = 2;
constexpr double kLargestDefault = 0.01;  ///< in diagonals
constexpr double kSnap = 0.5;             ///< junctions closer than this share one; in reaches

/// Where an arc of the earlier network is asked to have a node.
struct Request {
    double along = 0;     ///< arc length from the arc's start
    int attachment = -1;  ///< who asks; -1: the end of a pinned stretch
};

struct Stretch {
    double first = 0, last = 0;
    Pin pin = Pin::None;
};

class Joiner {
public:
    Joiner(const FeatureCurveNetwork& earlier, const FeatureCurveNetwork& later,
           const SurfaceLines& lines, double reach)
        : earlier_(earlier),
          later_(later),
          lines_(lines),
          reach_(reach),
          tree_(earlier),
          cutter_(earlier, tree_, lines, reach),
          requests_(earlier.arcs.size()),
          stretches_(earlier.arcs.size()) {
        for (const NetworkArc& arc : earlier.arcs) {
            prefix_.push_back({0});
            for (std::size_t i = 1; i < arc.samples.size(); ++i)
                prefix_.back().push_back(
                    prefix_.back().back() +
                    (arc.samples[i].position - arc.samples[i - 1].position).norm());
        }
    }

    FeatureCurveNetwork join() {
        result_ = earlier_;
        result_.arcs.clear();
        cut_later_arcs();
        for (std::size_t a = 0; a < earlier_.arcs.size(); ++a) split_earlier(static_cast<int>(a));
        for (const Piece& piece : pieces_) add_piece(piece);
        result_.notes.insert(result_.notes.end(), later_.notes.begin(), later_.notes.end());
        drop_unused_nodes(result_);
        return std::move(result_);
    }

private:
    struct Piece {
        int arc = -1;  ///< of the later network
        ArcPiece stretch;
        std::array<int, 2> attachments{-1, -1};
    };

    double along(const PolylinePlace& place) const {
        const std::vector<double>& prefix = prefix_[place.arc];
        return (1 - place.t) * prefix[place.interval] + place.t * prefix[place.interval + 1];
    }

    void cut_later_arcs() {
        std::vector<CutEnd> nodes(later_.nodes.size());
        const std::vector<int> valences = later_.valences();
        for (std::size_t n = 0; n < nodes.size(); ++n)
            nodes[n] = {cutter_.place_of(later_.nodes[n]), valences[n] == 1};
        for (std::size_t a = 0; a < later_.arcs.size(); ++a) {
            const NetworkArc& arc = later_.arcs[a];
            const bool is_ring = arc.is_closed() && valences[arc.nodes[0]] == 2;
            ArcCuts cuts = cutter_.cut(arc, {nodes[arc.nodes[0]], nodes[arc.nodes[1]]}, is_ring);
            for (ArcPiece& piece : cuts.pieces) attach(static_cast<int>(a), std::move(piece));
            if (arc.pin == Pin::None) continue;
            for (const auto& places : cuts.fused) pass_pin(places, arc.pin);
        }
    }

    void attach(int arc, ArcPiece stretch) {
        Piece piece{arc, std::move(stretch), {}};
        for (int side = 0; side < 2; ++side) {
            const PolylinePlace& place = piece.stretch.attachments[side];
            piece.attachments[side] = -1;
            if (place.arc < 0) continue;
            piece.attachments[side] = static_cast<int>(node_of_attachment_.size());
            requests_[place.arc].push_back({along(place), piece.attachments[side]});
            node_of_attachment_.push_back(-1);
        }
        pieces_.push_back(std::move(piece));
    }

    /// Hands the pin of a fused stretch to the arcs that stand for it.
    void pass_pin(const std::vector<PolylinePlace>& places, Pin pin) {
        for (std::size_t k = 0; k < places.size();) {
            const int arc = places[k].arc;
            Stretch stretch{1e300, -1e300, pin};
            for (; k < places.size() && places[k].arc == arc; ++k) {
                if (arc < 0) continue;
                stretch.first = std::min(stretch.first, along(places[k]));
                stretch.last = std::max(stretch.last, along(places[k]));
            }
            if (arc < 0 || stretch.last - stretch.first <= kSnap * reach_) continue;
            stretches_[arc].push_back(stretch);
            requests_[arc].push_back({stretch.first, -1});
            requests_[arc].push_back({stretch.last, -1});
        }
    }

    // --- the earlier network -------------------------------------------------------------------

    ArcSample sample_at(int a, double length) const {
        const std::vector<double>& prefix = prefix_[a];
        const auto behind = std::upper_bound(prefix.begin() + 1, prefix.end() - 1, length);
        const auto i = static_cast<std::size_t>(behind - prefix.begin()) - 1;
        const std::vector<ArcSample>& samples = earlier_.arcs[a].samples;
        const double t = (length - prefix[i]) / (prefix[i + 1] - prefix[i]);
        return lines_.between(samples[i], samples[i + 1], std::clamp(t, 0.0, 1.0));
    }

    void resolve(const Request& request, int node) {
        if (request.attachment >= 0) node_of_attachment_[request.attachment] = node;
    }

    void split_earlier(int a) {
        const NetworkArc& arc = earlier_.arcs[a];
        const double length = prefix_[a].back(), snap = kSnap * reach_;
        std::vector<Request>& requests = requests_[a];
        std::ranges::sort(requests, {}, &Request::along);
        std::vector<Request> inner;
        for (const Request& request : requests) {
            const bool is_near_end = length - request.along < request.along;
            const double rest = is_near_end ? length - request.along : request.along;
            if (rest <= snap)
                resolve(request, arc.nodes[is_near_end ? 1 : 0]);
            else
                inner.push_back(request);
        }
        std::vector<std::pair<double, int>> cuts{{0, arc.nodes[0]}};
        for (std::size_t k = 0; k < inner.size();) {
            std::size_t next = k + 1;
            while (next < inner.size() && inner[next].along - inner[next - 1].along <= snap) ++next;
            const double at = (inner[k].along + inner[next - 1].along) / 2;
            const ArcSample sample = sample_at(a, at);
            const int node = static_cast<int>(result_.nodes.size());
            result_.nodes.push_back({sample.position, sample.surface});
            for (; k < next; ++k) resolve(inner[k], node);
            cuts.emplace_back(at, node);
        }
        cuts.emplace_back(length, arc.nodes[1]);
        for (std::size_t k = 1; k < cuts.size(); ++k) add_part(a, cuts[k - 1], cuts[k]);
    }

    /// The part of an earlier arc between two cuts (arc length, node).
    void add_part(int a, std::pair<double, int> from, std::pair<double, int> to) {
        const NetworkArc& arc = earlier_.arcs[a];
        NetworkArc part = arc;
        part.nodes = {from.second, to.second};
        part.curve = -1;
        const bool is_whole = from.first == 0 && to.first == prefix_[a].back();
        if (!is_whole) {
            std::vector<ArcSample> samples;
            for (std::size_t i = 0; i < arc.samples.size(); ++i)
                if (prefix_[a][i] > from.first && prefix_[a][i] < to.first)
                    samples.push_back(arc.samples[i]);
            part.samples = with_ends(std::move(samples), part.nodes);
            part.origins.clear();
        }
        const double middle = (from.first + to.first) / 2;
        for (const Stretch& stretch : stretches_[a])
            if (part.pin == Pin::None && stretch.first <= middle && middle <= stretch.last)
                part.pin = stretch.pin;
        result_.arcs.push_back(std::move(part));
    }

    // --- the later network ---------------------------------------------------------------------

    int own_node(int node) {
        const auto [found, is_new] =
            node_of_later_.try_emplace(node, static_cast<int>(result_.nodes.size()));
        if (is_new) result_.nodes.push_back(later_.nodes[node]);
        return found->second;
    }

    void add_piece(const Piece& piece) {
        NetworkArc arc = later_.arcs[piece.arc];
        for (int side = 0; side < 2; ++side)
            arc.nodes[side] = piece.attachments[side] >= 0
                                  ? node_of_attachment_[piece.attachments[side]]
                                  : own_node(arc.nodes[side]);
        std::vector<ArcSample> samples = piece.stretch.samples;
        if (piece.attachments[0] < 0) samples.erase(samples.begin());
        if (piece.attachments[1] < 0) samples.pop_back();
        arc.samples = with_ends(std::move(samples), arc.nodes);
        arc.origins.clear();
        arc.curve = -1;
        if (arc.samples.size() >= (arc.is_closed() ? 4 : 2)) result_.arcs.push_back(std::move(arc));
    }

    /// A polyline between two nodes without repeated points; a short closed one is refined.
    std::vector<ArcSample> with_ends(std::vector<ArcSample> inner,
                                     const std::array<int, 2>& nodes) const {
        const auto of_node = [&](int n) {
            return ArcSample{result_.nodes[n].position, result_.nodes[n].surface};
        };
        std::vector<ArcSample> samples{of_node(nodes[0])};
        for (ArcSample& sample : inner)
            if (sample.position != samples.back().position) samples.push_back(sample);
        const ArcSample end = of_node(nodes[1]);
        while (samples.size() > 1 && samples.back().position == end.position) samples.pop_back();
        if (samples.size() > 1 || samples.front().position != end.position) samples.push_back(end);
        if (nodes[0] != nodes[1] || samples.size() < 3 || samples.size() >= 4) return samples;
        const ArcSample middle = lines_.between(samples[0], samples[1], 0.5);
        samples.insert(samples.begin() + 1, middle);
        return samples;
    }

    const FeatureCurveNetwork& earlier_;
    const FeatureCurveNetwork& later_;
    const SurfaceLines& lines_;
    double reach_;
    PolylineTree tree_;
    ArcCutter cutter_;
    std::vector<std::vector<double>> prefix_;  ///< arc length up to each sample
    std::vector<Piece> pieces_;
    std::vector<std::vector<Request>> requests_;   ///< per earlier arc
    std::vector<std::vector<Stretch>> stretches_;  ///< per earlier arc
    std::vector<int> node_of_attachment_;
    std::map<int, int> node_of_later_;
    FeatureCurveNetwork result_;
};

/// Patch numbers of different detectors stay apart.
void renumber_patches(FeatureCurveNetwork& network, int first) {
    for (NetworkArc& arc : network.arcs)
        for (int& patch : arc.patches)
            if (patch >= 0) patch += first;
}

int patch_end(const FeatureCurveNetwork& network) {
    int end = 0;
    for (const NetworkArc& arc : network.arcs)
        end = std::max({end, arc.patches[0] + 1, arc.patches[1] + 1});
    return end;
}

}  // namespace

double default_combine_tolerance(const LoadedMesh& mesh) {
    double total = 0;
    for (const EdgeHandle edge : mesh.mesh.edges()) total += mesh.mesh.calc_edge_length(edge);
    const double mean = total / std::max<double>(1, static_cast<double>(mesh.mesh.n_edges()));
    return std::min(kToleranceEdges * mean, kLargestDefault * bounding_box(mesh.mesh).diagonal());
}

FeatureCurveNetwork combine_networks(const std::vector<FeatureCurveNetwork>& networks,
                                     const LoadedMesh& mesh, const CombineOptions& options) {
    if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance))
        throw InputError("combining networks: tolerance " + std::to_string(options.tolerance) +
                         " is no length");
    const double tolerance =
        options.tolerance > 0 ? options.tolerance : default_combine_tolerance(mesh);
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    const SurfaceLines lines(mesh.mesh, arrays);
    FeatureCurveNetwork result;
    for (const FeatureCurveNetwork& network : networks) {
        FeatureCurveNetwork next = network;
        next.curves.clear();
        next.orbits.clear();
        next.segments.clear();
        for (NetworkArc& arc : next.arcs) arc.curve = -1;
        renumber_patches(next, patch_end(result));
        result = Joiner(result, next, lines, tolerance / 2).join();
    }
    set_provenance(result, mesh);
    return result;
}

}  // namespace fcn
