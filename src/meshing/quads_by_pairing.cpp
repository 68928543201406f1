// Quads without a field: triangles of twice the edge length with the network as edges are paired
// and all faces are cut at the middles of their edges, so that nothing is left that is not a quad
// whatever the pairing does (Johnston, Sullivan, Kwasnik 1991 mix triangles and quads this way).
// Curves: the middle of an edge made of two segments of the network is the node between them, that
// of another one lies on the curve that the edge stands for. Where triangles cannot carry the
// joined segments as single edges, the segments are left apart and the triangles are made again.
// The flat pieces of flat faces have no inverted corners; moving to the surface and smoothing may
// not make any. Only middles that begin off their edge, and pairs of triangles that are not flat,
// can; if smoothing does not untangle them, they give way: first the middles, then the pairs.
// Where the result is far from the surface, all is made again with shorter edges around.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "geometry/errors.h"
#include "meshing/coarse_network.h"
#include "meshing/midpoint_split.h"
#include "meshing/quad_faults.h"
#include "meshing/quad_shape.h"
#include "meshing/quad_smoothing.h"
#include "meshing/reference_surface.h"
#include "meshing/remesh.h"
#include "meshing/remesh_quads.h"
#include "meshing/size_sources.h"

namespace fcn {
namespace {

constexpr double kLeastSine = 0.1;   ///< of a triangle's three quads, for a middle off its edge
constexpr double kLeastShare = 0.2;  ///< of an edge, between its middle and its ends
constexpr int kMaxRemeshes = 5;      ///< of triangles, in all
constexpr double kFar = 0.4;         ///< in h: quads farther from the surface ask for shorter edges
constexpr double kShrink = 0.6;      ///< of the triangles' edges there, an attempt
constexpr double kShortest = 0.4;    ///< in h: triangles' edges are not asked to be shorter
constexpr int kManyFaces = 500000;   ///< of the input, from which on there is one attempt

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The coarse triangles and what their edges are of the network.
class PairableMaker {
public:
    PairableMaker(const LoadedMesh& input, const CoarseNetwork& coarse,
                  const RemeshResult& remeshed)
        : input_(input), coarse_(coarse), remeshed_(remeshed) {
        const Mesh& mesh = remeshed.mesh.mesh;
        for (const VertexHandle v : mesh.vertices()) triangles.points.push_back(mesh.point(v));
        for (const FaceHandle f : mesh.faces()) add_face(mesh, f);
        mark_curves();
        for (std::size_t e = 0; e < triangles.edges.size(); ++e) place_middle(e);
    }

    PairableTriangles triangles;
    std::vector<FeatureSource> sources;     ///< per edge, of the coarse network
    std::vector<bool> is_feature;           ///< per edge
    std::vector<std::vector<Vec3>> curves;  ///< per edge where its middle may be; empty: anywhere
    std::vector<int> middle_node;           ///< per edge, -1: none

private:
    const Vec3& point(int v) const { return triangles.points[at(v)]; }

    void add_face(const Mesh& mesh, FaceHandle f) {
        const auto v = face_vertices(mesh, f);
        triangles.triangles.push_back({v[0].idx(), v[1].idx(), v[2].idx()});
        std::array<int, 3> edges{};
        for (std::size_t i = 0; i < 3; ++i) {
            const int a = v[i].idx(), b = v[(i + 1) % 3].idx();
            const auto [entry, is_new] = edge_of_.try_emplace(
                {std::min(a, b), std::max(a, b)}, static_cast<int>(triangles.edges.size()));
            edges[i] = entry->second;
            if (is_new)
                triangles.edges.push_back({a, b, f.idx(), -1, false, 0.5 * (point(a) + point(b))});
            else
                triangles.edges[at(entry->second)].right = f.idx();
        }
        triangles.triangle_edges.push_back(edges);
    }

    void mark_curves() {
        sources.resize(triangles.edges.size());
        is_feature.resize(triangles.edges.size());
        curves.resize(triangles.edges.size());
        middle_node.assign(triangles.edges.size(), -1);
        edges_of_segment_.assign(coarse_.parts.size(), 0);
        for (std::size_t i = 0; i < remeshed_.feature_edges.size(); ++i) {
            const auto [a, b] = remeshed_.feature_edges[i];
            const int e = edge_of_.at({std::min(a, b), std::max(a, b)});
            is_feature[at(e)] = true;
            sources[at(e)] = remeshed_.feature_sources[i];
            if (sources[at(e)].segment >= 0) ++edges_of_segment_[at(sources[at(e)].segment)];
        }
        const std::vector<int>& labels = remeshed_.mesh.face_labels;
        for (std::size_t e = 0; e < triangles.edges.size(); ++e) {
            TriangleEdge& edge = triangles.edges[e];
            edge.is_curve = is_feature[e] || edge.right < 0 ||
                            (!labels.empty() && labels[at(edge.left)] != labels[at(edge.right)]);
        }
    }

    void place_middle(std::size_t e) {
        TriangleEdge& edge = triangles.edges[e];
        if (!edge.is_curve) return;
        curves[e] = {point(edge.from), point(edge.to)};
        const int segment = sources[e].segment;
        if (segment >= 0 && coarse_.middle[at(segment)] >= 0 &&
            edges_of_segment_[at(segment)] == 1) {
            middle_node[e] = coarse_.middle[at(segment)];
            const Vec3& p = coarse_.network.nodes[at(middle_node[e])].position;
            curves[e] = {p};
            if (can_be_middle(edge, p)) edge.middle = p;
            return;
        }
        const std::vector<Vec3> samples = samples_of(sources[e]);
        const Vec3 p =
            samples.empty() ? on_border(edge) : closest_on_polyline(samples, edge.middle);
        if (!can_be_middle(edge, p)) return;
        edge.middle = p;
        curves[e] = {point(edge.from), p, point(edge.to)};
    }

    std::vector<Vec3> samples_of(const FeatureSource& source) const {
        std::vector<Vec3> points;
        if (source.arc < 0) return points;
        const NetworkArc& arc = coarse_.network.arcs[at(source.arc)];
        int first = 0, last = static_cast<int>(arc.samples.size()) - 1;
        if (source.segment >= 0) {
            first = coarse_.network.segments[at(source.segment)].first_sample;
            last = coarse_.network.segments[at(source.segment)].last_sample;
        }
        for (int i = first; i <= last; ++i) points.push_back(arc.samples[at(i)].position);
        return points;
    }

    /// On the border that the edge stands for: of the input's mesh, or of its labels.
    Vec3 on_border(const TriangleEdge& edge) {
        if (!borders_) {
            std::vector<std::array<Vec3, 3>> pieces;
            const Mesh& mesh = input_.mesh;
            for (const EdgeHandle e : mesh.edges()) {
                const HalfedgeHandle h = mesh.halfedge_handle(e, 0);
                const auto label = [&](HalfedgeHandle side) {
                    const FaceHandle f = mesh.face_handle(side);
                    return input_.face_labels.empty() ? 0 : input_.face_labels[at(f.idx())];
                };
                if (!mesh.is_boundary(e) && label(h) == label(mesh.opposite_halfedge_handle(h)))
                    continue;
                const Vec3 &a = mesh.point(mesh.from_vertex_handle(h)),
                           &b = mesh.point(mesh.to_vertex_handle(h));
                pieces.push_back({a, b, b});
            }
            borders_ = std::make_unique<ReferenceSurface>(pieces);
        }
        if (borders_->face_count() == 0) return edge.middle;
        const double reach = 0.5 * (point(edge.to) - point(edge.from)).norm();
        const ReferencePoint there = borders_->closest(edge.middle, Vec3::Zero(), reach, -1);
        return there.face < 0 ? edge.middle : there.position;
    }

    /// Whether both triangles could still be cut there, with the other middles on their edges.
    bool can_be_middle(const TriangleEdge& edge, const Vec3& p) const {
        const Vec3 &a = point(edge.from), &b = point(edge.to);
        if (std::min((p - a).norm(), (p - b).norm()) < kLeastShare * (b - a).norm()) return false;
        for (const int f : {edge.left, edge.right}) {
            if (f < 0) continue;
            const auto& corners = triangles.triangles[at(f)];
            std::array<Vec3, 3> middles;
            Vec3 centre = Vec3::Zero();
            for (std::size_t i = 0; i < 3; ++i) {
                const int from = corners[i], to = corners[(i + 1) % 3];
                const bool is_this = std::minmax(from, to) == std::minmax(edge.from, edge.to);
                middles[i] = is_this ? p : Vec3(0.5 * (point(from) + point(to)));
                centre += point(from) / 3;
            }
            for (std::size_t i = 0; i < 3; ++i)
                if (scaled_jacobian({point(corners[i]), middles[i], centre, middles[(i + 2) % 3]}) <
                    kLeastSine)
                    return false;
        }
        return true;
    }

    const LoadedMesh& input_;
    const CoarseNetwork& coarse_;
    const RemeshResult& remeshed_;
    std::map<std::pair<int, int>, int> edge_of_;
    std::vector<int> edges_of_segment_;
    std::unique_ptr<ReferenceSurface> borders_;
};

struct CoarseTriangles {
    CoarseNetwork coarse;
    RemeshResult remeshed;
};

/// What the attempts have learned and cost so far.
struct Trials {
    std::vector<RefinedPlace> refined;
    std::vector<bool> kept_apart;  ///< per segment: it cannot be joined to another one
    int remeshes = 0;
};

/// Triangles of length 2 h; segments that do not become single edges are not joined.
CoarseTriangles coarse_triangles(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                                 const QuadOptions& options, const ReferenceSurface& reference,
                                 Trials& trials) {
    RemeshOptions triangles;
    triangles.edge_length = 2 * options.edge_length;
    triangles.iterations = options.iterations;
    triangles.is_protecting = !network.arcs.empty();
    triangles.reference = &reference;
    triangles.refined_places = trials.refined;
    const double longest = 4.0 / 3 * triangles.edge_length * (1 - 1e-6);
    while (true) {
        CoarseTriangles result{join_segments(network, longest, trials.kept_apart), {}};
        result.remeshed = remesh_triangles(mesh, result.coarse.network, triangles);
        ++trials.remeshes;
        std::vector<int> count(result.coarse.parts.size(), 0);
        for (const FeatureSource& source : result.remeshed.feature_sources)
            if (source.segment >= 0) ++count[at(source.segment)];
        bool is_broken = false;
        for (std::size_t s = 0; s < count.size(); ++s) {
            if (count[s] == 1 || result.coarse.middle[s] < 0) continue;
            is_broken = true;
            for (const int part : result.coarse.parts[s]) trials.kept_apart[at(part)] = true;
        }
        if (!is_broken || trials.remeshes >= kMaxRemeshes) return result;
        if (trials.remeshes + 1 == kMaxRemeshes)
            trials.kept_apart.assign(trials.kept_apart.size(), true);
    }
}

class QuadsByPairing {
public:
    QuadsByPairing(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                   const QuadOptions& options, const ReferenceSurface& reference, Trials& trials)
        : network_(network),
          options_(options),
          reference_(reference),
          base_(coarse_triangles(mesh, network, options, reference, trials)),
          made_(mesh, base_.coarse, base_.remeshed) {}

    QuadResult run() {
        enum { AllAsPlanned, StraightEdges, NoPairs };
        QuadResult result;
        for (const int way : {AllAsPlanned, StraightEdges, NoPairs}) {
            if (way >= StraightEdges) straighten();
            result.mesh = make(way < NoPairs);
            result.inverted_corners = count_inverted_corners(result.mesh);
            if (result.inverted_corners == 0) break;
        }
        result.tier = QuadTier::Pairing;
        result.edge_length = options_.edge_length;
        result.warnings = base_.remeshed.warnings;
        list_broken(result);
        return result;
    }

private:
    /// Every middle on its edge; it may still be drawn to its curve later.
    void straighten() {
        for (TriangleEdge& edge : made_.triangles.edges)
            edge.middle =
                0.5 * (made_.triangles.points[at(edge.from)] + made_.triangles.points[at(edge.to)]);
    }

    QuadMesh make(bool is_pairing) {
        const std::vector<int> gone =
            is_pairing ? pair_triangles(made_.triangles) : std::vector<int>{};
        MidpointSplit split =
            split_at_middles(made_.triangles, gone, base_.remeshed.mesh.face_labels);
        QuadConstraints constraints;
        constraints.curve.assign(split.mesh.points.size(), QuadConstraints::kFree);
        for (std::size_t e = 0; e < made_.triangles.edges.size(); ++e) {
            const TriangleEdge& edge = made_.triangles.edges[e];
            if (!edge.is_curve) continue;
            const int middle = split.edge_vertex[e];
            constraints.curve[at(edge.from)] = constraints.curve[at(edge.to)] =
                QuadConstraints::kFixed;
            constraints.curve[at(middle)] = static_cast<int>(constraints.curves.size());
            constraints.curves.push_back(made_.curves[e]);
            if (made_.is_feature[e]) add_feature_edges(e, middle, split.mesh);
        }
        QuadSmoothingOptions smoothing;
        smoothing.edge_length = options_.edge_length;
        smoothing.rounds = options_.smoothing_rounds;
        smooth_quads(split.mesh, constraints, reference_, smoothing);
        return std::move(split.mesh);
    }

    void add_feature_edges(std::size_t e, int middle, QuadMesh& mesh) const {
        const TriangleEdge& edge = made_.triangles.edges[e];
        const FeatureSource& source = made_.sources[e];
        std::array<int, 2> segments{-1, -1};  // from the edge's origin on
        if (source.segment >= 0) {
            const auto& parts = base_.coarse.parts[at(source.segment)];
            const NetworkSegment& whole = base_.coarse.network.segments[at(source.segment)];
            const Vec3& start = base_.coarse.network.nodes[at(whole.nodes[0])].position;
            const Vec3 &from = mesh.points[at(edge.from)], &to = mesh.points[at(edge.to)];
            const bool is_along = (from - start).norm() <= (to - start).norm();
            segments = parts[1] < 0 ? std::array{parts[0], parts[0]}
                       : is_along   ? parts
                                    : std::array{parts[1], parts[0]};
        }
        mesh.feature_edges.push_back({edge.from, middle, source.arc, segments[0]});
        mesh.feature_edges.push_back({middle, edge.to, source.arc, segments[1]});
    }

    /// Segments that are not a chain of feature edges between their nodes.
    void list_broken(QuadResult& result) const {
        const double tolerance = 1e-6 * options_.edge_length;
        std::vector<std::array<bool, 2>> is_reached(network_.segments.size(), {false, false});
        for (const QuadFeatureEdge& edge : result.mesh.feature_edges) {
            if (edge.segment < 0) continue;
            for (std::size_t k = 0; k < 2; ++k) {
                const int node = network_.segments[at(edge.segment)].nodes[k];
                const Vec3& p = network_.nodes[at(node)].position;
                for (const int v : {edge.from, edge.to})
                    if ((result.mesh.points[at(v)] - p).norm() <= tolerance)
                        is_reached[at(edge.segment)][k] = true;
            }
        }
        for (std::size_t s = 0; s < is_reached.size(); ++s)
            if (!is_reached[s][0] || !is_reached[s][1])
                result.broken_segments.push_back(static_cast<int>(s));
        std::erase_if(result.warnings, [](const std::string& warning) {
            return warning.find("are not single edges") != std::string::npos;
        });
        if (!result.broken_segments.empty())
            result.warnings.push_back(std::to_string(result.broken_segments.size()) + " of " +
                                      std::to_string(network_.segments.size()) +
                                      " segments are no chains of edges between their nodes");
    }

    const FeatureCurveNetwork& network_;
    const QuadOptions& options_;
    const ReferenceSurface& reference_;
    CoarseTriangles base_;
    PairableMaker made_;
};

}  // namespace

QuadResult quads_by_pairing(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                            const QuadOptions& options) {
    if (!(options.edge_length > 0) || !std::isfinite(options.edge_length))
        throw InputError("quads: edge length must be > 0, it is " +
                         std::to_string(options.edge_length));
    const auto start = std::chrono::steady_clock::now();
    std::unique_ptr<ReferenceSurface> own;
    if (options.reference == nullptr) own = std::make_unique<ReferenceSurface>(mesh.mesh);
    const ReferenceSurface& reference = options.reference ? *options.reference : *own;
    const double h = options.edge_length;
    const bool is_large = mesh.mesh.n_faces() >= kManyFaces;
    SizeSources sources(2 * h);
    Trials trials{{}, std::vector<bool>(network.segments.size(), false), 0};
    QuadResult result;
    double least = std::numeric_limits<double>::infinity();
    while (trials.remeshes < kMaxRemeshes) {
        QuadResult one = QuadsByPairing(mesh, network, options, reference, trials).run();
        const QuadDistance far = find_far_places(one.mesh, mesh.mesh, reference, kFar * h, 0.5 * h);
        // Inverted corners are worse than any distance.
        const double severity = far.largest / h + 1e6 * one.inverted_corners;
        if (severity < least) result = std::move(one);
        least = std::min(least, severity);
        if (far.places.empty() || is_large) break;
        for (const Vec3& p : far.places) {
            const double now = std::min(2 * h, sources.limit(p));
            trials.refined.push_back({p, std::max(kShortest * h, kShrink * now)});
        }
        for (std::size_t i = sources.sources().size(); i < trials.refined.size(); ++i)
            sources.add(trials.refined[i].position, trials.refined[i].edge_length);
    }
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace fcn
