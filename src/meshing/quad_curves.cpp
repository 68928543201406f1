// Which vertices of quads belong on which curves. Some lines of quads lie on curves from the
// beginning (lines_on_curves.h); their vertices keep to them. Other curves are followed softly
// (Gehre, Lim, Kobbelt 2016, section 6.2), so lines of quads run beside them; quad_paths.h finds
// these, and here they come onto the curve at distances between those that they had and even ones.
// Long curves choose first. A vertex slides along the piece of its curve around its place, which
// keeps it off other stretches of the same curve.
#include "meshing/quad_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "meshing/quad_paths.h"

namespace fcn {
namespace {

constexpr double kStep = 0.1;       ///< between points of a curve, in edge lengths
constexpr int kWindow = 15;         ///< points that a vertex may slide either way
constexpr double kLeastHalved = 4;  ///< edge lengths; shorter pieces are not halved
constexpr double kLeastArc = 1;     ///< edge lengths; shorter arcs are left alone
constexpr double kAtNode = 0.01;    ///< edge lengths

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Boundary loops, each cut at its corners, which are ends.
std::vector<std::vector<Vec3>> boundary_pieces(const Mesh& surface, double corner_degrees,
                                               std::vector<Vec3>& all_corners) {
    std::vector<std::vector<Vec3>> pieces;
    std::vector<bool> is_seen(surface.n_halfedges(), false);
    const double flattest = std::cos(corner_degrees * std::numbers::pi / 180);
    for (const HalfedgeHandle start : surface.halfedges()) {
        if (!surface.is_boundary(start) || is_seen[at(start.idx())]) continue;
        std::vector<Vec3> loop;
        HalfedgeHandle h = start;
        do {
            is_seen[at(h.idx())] = true;
            loop.push_back(surface.point(surface.from_vertex_handle(h)));
            h = surface.next_halfedge_handle(h);
        } while (h != start);
        std::vector<std::size_t> corners;
        const std::size_t n = loop.size();
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 in = (loop[i] - loop[(i + n - 1) % n]).stableNormalized();
            const Vec3 out = (loop[(i + 1) % n] - loop[i]).stableNormalized();
            if (in.dot(out) < flattest) corners.push_back(i);
        }
        if (corners.empty()) {
            loop.push_back(loop.front());
            pieces.push_back(loop);
        }
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const std::size_t to = k + 1 < corners.size() ? corners[k + 1] : corners[0] + n;
            std::vector<Vec3>& piece = pieces.emplace_back();
            for (std::size_t i = corners[k]; i <= to; ++i) piece.push_back(loop[i % n]);
            all_corners.push_back(loop[corners[k]]);
        }
    }
    return pieces;
}

class CurveMoves {
public:
    CurveMoves(QuadMesh& mesh, const QuadCurveOptions& options)
        : mesh_(mesh), options_(options), paths_(mesh, options.reach * options.edge_length) {
        constraints_.curve.assign(mesh.points.size(), QuadConstraints::kFree);
    }

    void constrain_boundary(const Mesh& surface) {
        std::vector<Vec3> corners;
        std::vector<SampledCurve> curves;
        for (const auto& piece : boundary_pieces(surface, options_.corner_degrees, corners))
            curves.push_back(sample_curve(piece, kStep * options_.edge_length));
        std::vector<int> vertices;
        for (int v = 0; v < static_cast<int>(mesh_.points.size()); ++v)
            if (paths_.is_boundary(v)) vertices.push_back(v);
        for (const int v : vertices) slide_on_nearest(v, curves);
        for (const Vec3& corner : corners) {
            const auto nearer = [&](int a, int b) {
                return (mesh_.points[at(a)] - corner).norm() <
                       (mesh_.points[at(b)] - corner).norm();
            };
            const auto best = std::min_element(vertices.begin(), vertices.end(), nearer);
            if (best == vertices.end() ||
                (mesh_.points[at(*best)] - corner).norm() > options_.reach * options_.edge_length)
                continue;
            pin(*best, corner);
            vertices.erase(best);
        }
    }

    /// Lines that are on arcs: their vertices slide along these, and stay at corners.
    void keep_lines(const FeatureCurveNetwork& network) {
        const LinesOnCurves& lines = options_.lines;
        covered_.resize(network.arcs.size());
        std::map<int, SampledCurve> curves;
        const auto curve_of = [&](int a) -> const SampledCurve& {
            const auto [it, is_new] = curves.try_emplace(a);
            if (is_new)
                it->second = sample_curve(polyline_of(network, a), kStep * options_.edge_length);
            return it->second;
        };
        for (const QuadFeatureEdge& edge : lines.edges) {
            if (!options_.is_free.empty() && options_.is_free[at(edge.arc)]) continue;
            mesh_.feature_edges.push_back(edge);
            const SampledCurve& curve = curve_of(edge.arc);
            covered_[at(edge.arc)].resize(curve.points.size(), -1);
            cover(curve, edge);
            for (const int v : {edge.from, edge.to}) {
                if (constraints_.curve[at(v)] != QuadConstraints::kFree) continue;
                paths_.take(v);
                const int own = lines.arc[at(v)];
                if (lines.is_corner[at(v)] || own < 0) {
                    pin(v, Vec3(mesh_.points[at(v)]));
                } else {
                    const SampledCurve& along = curve_of(own);
                    slide(v, along, nearest_point(along, mesh_.points[at(v)]));
                }
            }
        }
    }

    void move_network(const FeatureCurveNetwork& network) {
        choose_nodes(network);
        std::vector<std::size_t> order(network.arcs.size());
        std::iota(order.begin(), order.end(), 0);
        std::vector<double> lengths;
        for (const NetworkArc& arc : network.arcs) lengths.push_back(arc.length());
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return lengths[a] > lengths[b]; });
        for (const std::size_t a : order) {
            if (!is_used(network, a) || lengths[a] < kLeastArc * options_.edge_length) continue;
            move_arc(network, static_cast<int>(a));
        }
    }

    QuadConstraints finish() { return std::move(constraints_); }

private:
    bool is_used(const FeatureCurveNetwork& network, std::size_t arc) const {
        return network.arcs[arc].kind != ArcKind::Boundary &&
               network.arcs[arc].samples.size() > 1 &&
               (options_.is_left_out.empty() || !options_.is_left_out[arc]);
    }

    static std::vector<Vec3> polyline_of(const FeatureCurveNetwork& network, int a) {
        std::vector<Vec3> polyline;
        for (const ArcSample& sample : network.arcs[at(a)].samples)
            polyline.push_back(sample.position);
        return polyline;
    }
    static int nearest_point(const SampledCurve& curve, const Vec3& p) {
        const auto nearer = [&](const Vec3& a, const Vec3& b) {
            return (a - p).squaredNorm() < (b - p).squaredNorm();
        };
        return static_cast<int>(std::min_element(curve.points.begin(), curve.points.end(), nearer) -
                                curve.points.begin());
    }
    /// The points of a curve along an edge that lies on it, with the nearer end.
    void cover(const SampledCurve& curve, const QuadFeatureEdge& edge) {
        std::vector<int>& covered = covered_[at(edge.arc)];
        const int a = nearest_point(curve, mesh_.points[at(edge.from)]);
        const int b = nearest_point(curve, mesh_.points[at(edge.to)]);
        const int way = static_cast<int>(curve.forward(a, b)), step = way < 0 ? -1 : 1;
        const int count = curve.last();
        for (int i = 0; i <= std::abs(way); ++i) {
            int place = a + step * i;
            if (curve.is_closed) place = ((place % count) + count) % count;
            covered[at(place)] = 2 * i < std::abs(way) ? edge.from : edge.to;
            if (curve.is_closed && place == 0) covered[at(count)] = covered[at(place)];
        }
    }

    void pin(int v, const Vec3& p) {
        mesh_.points[at(v)] = p;
        constraints_.curve[at(v)] = static_cast<int>(constraints_.curves.size());
        constraints_.curves.push_back({p});
    }

    void slide(int v, const SampledCurve& curve, double parameter) {
        constraints_.curve[at(v)] = static_cast<int>(constraints_.curves.size());
        constraints_.curves.push_back(curve.window(parameter, kWindow));
    }

    void slide_on_nearest(int v, const std::vector<SampledCurve>& curves) {
        const SampledCurve* best = nullptr;
        int parameter = 0;
        double least = 0;
        for (const SampledCurve& curve : curves) {
            for (int i = 0; i <= curve.last(); ++i) {
                const double distance = (curve.points[at(i)] - mesh_.points[at(v)]).squaredNorm();
                if (best && distance >= least) continue;
                best = &curve;
                parameter = i;
                least = distance;
            }
        }
        if (best)
            slide(v, *best, parameter);
        else
            constraints_.curve[at(v)] = QuadConstraints::kFixed;
    }

    /// Vertices for the nodes at which arcs meet.
    void choose_nodes(const FeatureCurveNetwork& network) {
        node_vertices_.assign(network.nodes.size(), -1);
        std::vector<int> ends(network.nodes.size(), 0);
        for (std::size_t a = 0; a < network.arcs.size(); ++a)
            if (is_used(network, a))
                for (const int node : network.arcs[a].nodes) ++ends[at(node)];
        for (std::size_t n = 0; n < ends.size(); ++n) {
            if (ends[n] < 3) continue;
            const int v = paths_.nearest(network.nodes[n].position);
            if (v < 0 || constraints_.curve[at(v)] != QuadConstraints::kFree) continue;
            node_vertices_[n] = v;
            paths_.take(v);
        }
        const LinesOnCurves& lines = options_.lines;  // what is at nodes already
        for (std::size_t n = 0; n < ends.size(); ++n)
            for (std::size_t v = 0; v < lines.is_corner.size(); ++v)
                if (lines.is_corner[v] && (mesh_.points[v] - network.nodes[n].position).norm() <
                                              kAtNode * options_.edge_length)
                    node_vertices_[n] = static_cast<int>(v);
    }

    /// An arc, or what no line lies on of it.
    void move_arc(const FeatureCurveNetwork& network, int a) {
        const std::vector<Vec3> polyline = polyline_of(network, a);
        const std::vector<int> covered = covered_.empty() ? std::vector<int>() : covered_[at(a)];
        if (covered.empty()) return move_piece(network, a, polyline);
        const SampledCurve curve = sample_curve(polyline, kStep * options_.edge_length);
        for (std::size_t i = 0; i < covered.size();) {
            std::size_t end = i;
            while (end < covered.size() && covered[end] < 0) ++end;
            const auto first = curve.points.begin() + static_cast<std::ptrdiff_t>(i);
            if (static_cast<double>(end - i) * kStep >= kLeastArc)
                move_piece(network, a, {first, first + static_cast<std::ptrdiff_t>(end - i)});
            i = end + 1;
        }
    }

    /// A piece of an arc, or what can be moved of its halves.
    void move_piece(const FeatureCurveNetwork& network, int a, const std::vector<Vec3>& polyline) {
        const SampledCurve curve = sample_curve(polyline, kStep * options_.edge_length);
        const NetworkArc& arc = network.arcs[at(a)];
        const bool is_first = polyline.front() == arc.samples.front().position;
        const bool is_last = polyline.back() == arc.samples.back().position;
        const int from = is_first ? node_vertices_[at(arc.nodes[0])] : -1;
        const int to = is_last ? node_vertices_[at(arc.nodes[1])] : -1;
        QuadPaths::Path path = paths_.find(curve, from, to);
        if (path.is_empty() && from >= 0) path = paths_.find(curve, -1, to);
        if (path.is_empty() && to >= 0) path = paths_.find(curve, from, -1);
        if (path.is_empty() && (from >= 0 || to >= 0)) path = paths_.find(curve, -1, -1);
        if (path.is_empty()) {
            if (curve.length < kLeastHalved * options_.edge_length) return;
            const auto middle = curve.points.begin() + curve.last() / 2;
            move_piece(network, a, {curve.points.begin(), middle + 1});
            move_piece(network, a, {middle, curve.points.end()});
            return;
        }
        follow(network, a, curve, path, from, to);
    }

    void follow(const FeatureCurveNetwork& network, int a, const SampledCurve& curve,
                const QuadPaths::Path& path, int from, int to) {
        const NetworkArc& arc = network.arcs[at(a)];
        const std::size_t count = path.vertices.size();
        for (std::size_t i = 0; i + 1 < count; ++i) {
            QuadFeatureEdge edge;
            edge.from = path.vertices[i];
            edge.to = path.vertices[i + 1];
            edge.arc = a;
            mesh_.feature_edges.push_back(edge);
        }
        const double first = path.parameters.front();
        const double span = path.parameters.back() - first;
        for (std::size_t i = 0; i < count; ++i) {
            const int v = path.vertices[i];
            const double even =
                first + span * static_cast<double>(i) / static_cast<double>(count - 1);
            const double place = 0.5 * (even + path.parameters[i]);
            if (v == from || v == to) {
                if (constraints_.curve[at(v)] == QuadConstraints::kFree)
                    pin(v, network.nodes[at(arc.nodes[v == from ? 0 : 1])].position);
            } else if (constraints_.curve[at(v)] == QuadConstraints::kFree) {
                mesh_.points[at(v)] = curve.at(place);
                slide(v, curve, place);
            }
        }
    }

    QuadMesh& mesh_;
    const QuadCurveOptions& options_;
    QuadPaths paths_;
    QuadConstraints constraints_;
    std::vector<int> node_vertices_;
    std::vector<std::vector<int>> covered_;  ///< per arc and point: a vertex on a line; -1: none
};

}  // namespace

QuadConstraints move_to_curves(QuadMesh& mesh, const Mesh& surface,
                               const FeatureCurveNetwork& network,
                               const QuadCurveOptions& options) {
    CurveMoves moves(mesh, options);
    moves.constrain_boundary(surface);
    moves.keep_lines(network);
    moves.move_network(network);
    return moves.finish();
}

}  // namespace fcn
