// Which vertices of quads belong on which curves. A map follows a network softly (Gehre, Lim,
// Kobbelt 2016, section 6.2), so lines of quads run beside the curves at some distance, and only
// those that are close and parallel are taken to mean them: both ends of an edge see the same arc
// within reach, and the edge is about as long as the piece of the arc between the points they see.
// A vertex slides along the piece of its curve around the point it sees, which keeps it off other
// stretches of the same curve.
#include "meshing/quad_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace fcn {
namespace {

constexpr double kStep = 0.1;    ///< between points of a curve, in edge lengths
constexpr double kWindow = 1.5;  ///< that a vertex may slide either way, in edge lengths

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A curve with points at even distances.
struct Curve {
    std::vector<Vec3> points;
    bool is_closed = false;
    int arc = -1;
};

Curve even_curve(const std::vector<Vec3>& polyline, double step, int arc) {
    Curve curve;
    curve.arc = arc;
    curve.is_closed = polyline.size() > 2 && polyline.front() == polyline.back();
    double length = 0;
    for (std::size_t i = 1; i < polyline.size(); ++i)
        length += (polyline[i] - polyline[i - 1]).norm();
    const int count = std::max(curve.is_closed ? 3 : 1, static_cast<int>(std::ceil(length / step)));
    curve.points.push_back(polyline.front());
    double walked = 0;
    std::size_t i = 1;
    for (int k = 1; k < count; ++k) {
        const double goal = length * k / count;
        while (i + 1 < polyline.size() && walked + (polyline[i] - polyline[i - 1]).norm() < goal) {
            walked += (polyline[i] - polyline[i - 1]).norm();
            ++i;
        }
        const Vec3 along = polyline[i] - polyline[i - 1];
        const double share = along.norm() > 0 ? (goal - walked) / along.norm() : 0;
        curve.points.push_back(polyline[i - 1] + std::clamp(share, 0.0, 1.0) * along);
    }
    curve.points.push_back(polyline.back());
    return curve;
}

/// The point of a curve that a vertex sees.
struct Sight {
    int curve = -1, point = -1;
    double distance = 0;
};

/// Points of curves by cells.
class CurvePoints {
public:
    CurvePoints(const std::vector<Curve>& curves, double reach) : curves_(curves), reach_(reach) {
        for (std::size_t c = 0; c < curves.size(); ++c)
            for (std::size_t i = 0; i < curves[c].points.size(); ++i)
                cells_[cell(curves[c].points[i])].push_back(
                    {static_cast<int>(c), static_cast<int>(i), 0});
    }

    /// The nearest within reach.
    Sight nearest(const Vec3& p) const {
        Sight best;
        const auto [x, y, z] = cell(p);
        for (long i = x - 1; i <= x + 1; ++i)
            for (long j = y - 1; j <= y + 1; ++j)
                for (long k = z - 1; k <= z + 1; ++k) {
                    const auto found = cells_.find({i, j, k});
                    if (found == cells_.end()) continue;
                    for (Sight sight : found->second) {
                        sight.distance =
                            (curves_[at(sight.curve)].points[at(sight.point)] - p).norm();
                        const bool is_nearer = best.curve < 0 || sight.distance < best.distance;
                        if (sight.distance <= reach_ && is_nearer) best = sight;
                    }
                }
        return best;
    }

private:
    std::array<long, 3> cell(const Vec3& p) const {
        return {std::lround(p[0] / reach_), std::lround(p[1] / reach_), std::lround(p[2] / reach_)};
    }
    const std::vector<Curve>& curves_;
    double reach_;
    std::map<std::array<long, 3>, std::vector<Sight>> cells_;
};

std::vector<Vec3> window(const Curve& curve, int middle, int half) {
    const int count = static_cast<int>(curve.points.size());
    std::vector<Vec3> points;
    if (curve.is_closed && count - 1 > 2 * half) {
        for (int i = middle - half; i <= middle + half; ++i)
            points.push_back(curve.points[at((i % (count - 1) + count - 1) % (count - 1))]);
        return points;
    }
    const int from = curve.is_closed ? 0 : std::max(0, middle - half);
    const int to = curve.is_closed ? count - 1 : std::min(count - 1, middle + half);
    for (int i = from; i <= to; ++i) points.push_back(curve.points[at(i)]);
    return points;
}

/// Boundary loops as vertices in order, each cut at its corners; corners are ends.
std::vector<std::vector<Vec3>> boundary_pieces(const Mesh& surface, double corner_degrees) {
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
        }
    }
    return pieces;
}

class CurveDrawing {
public:
    CurveDrawing(QuadMesh& mesh, const QuadCurveOptions& options)
        : mesh_(mesh), options_(options), opposite_(opposite_halfedges(mesh)) {
        constraints_.curve.assign(mesh.points.size(), QuadConstraints::kFree);
        is_boundary_.assign(mesh.points.size(), false);
        for (std::size_t h = 0; h < opposite_.size(); ++h)
            if (opposite_[h] < 0) is_boundary_[at(from(h))] = is_boundary_[at(to(h))] = true;
        half_window_ = static_cast<int>(kWindow / kStep);
    }

    void draw_boundary(const Mesh& surface) {
        std::vector<Curve> curves;
        for (const auto& piece : boundary_pieces(surface, options_.corner_degrees))
            curves.push_back(even_curve(piece, kStep * options_.edge_length, -1));
        // Far enough to see the boundary from wherever the map ended.
        const CurvePoints points(curves, options_.edge_length);
        for (int v = 0; v < vertex_count(); ++v) {
            if (!is_boundary_[at(v)]) continue;
            const Sight sight = points.nearest(mesh_.points[at(v)]);
            if (sight.curve >= 0)
                slide(v, curves[at(sight.curve)], sight.point);
            else
                constraints_.curve[at(v)] = QuadConstraints::kFixed;
        }
        for (const Curve& curve : curves)
            if (!curve.is_closed || is_corner_loop(curve)) pin_nearest(curve.points.front(), true);
    }

    void draw_network(const FeatureCurveNetwork& network) {
        std::vector<Curve> curves;
        for (std::size_t a = 0; a < network.arcs.size(); ++a) {
            if (network.arcs[a].kind == ArcKind::Boundary) continue;
            std::vector<Vec3> polyline;
            for (const ArcSample& sample : network.arcs[a].samples)
                polyline.push_back(sample.position);
            if (polyline.size() > 1)
                curves.push_back(
                    even_curve(polyline, kStep * options_.edge_length, static_cast<int>(a)));
        }
        const CurvePoints points(curves, options_.reach * options_.edge_length);
        sights_.clear();
        for (const Vec3& p : mesh_.points) sights_.push_back(points.nearest(p));
        for (std::size_t h = 0; h < opposite_.size(); ++h)
            if (opposite_[h] < static_cast<int>(h) && is_along(h, curves)) take(h, curves);
        pin_nodes(network);
    }

    QuadConstraints finish() { return std::move(constraints_); }

private:
    int vertex_count() const { return static_cast<int>(mesh_.points.size()); }
    int from(std::size_t h) const { return mesh_.faces[h / 4][h % 4]; }
    int to(std::size_t h) const { return mesh_.faces[h / 4][(h + 1) % 4]; }

    static bool is_corner_loop(const Curve& curve) {
        const Vec3 in = curve.points.back() - curve.points[curve.points.size() - 2];
        const Vec3 out = curve.points[1] - curve.points[0];
        return in.stableNormalized().dot(out.stableNormalized()) < 0.7;
    }

    void slide(int v, const Curve& curve, int middle) {
        constraints_.curve[at(v)] = static_cast<int>(constraints_.curves.size());
        constraints_.curves.push_back(window(curve, middle, half_window_));
    }

    /// Draws the nearest vertex of a curve to the point, if one is near.
    void pin_nearest(const Vec3& point, bool on_boundary) {
        int best = -1;
        double least = 0.75 * options_.edge_length;
        for (int v = 0; v < vertex_count(); ++v) {
            if (constraints_.curve[at(v)] < 0 || is_boundary_[at(v)] != on_boundary) continue;
            const double distance = (mesh_.points[at(v)] - point).norm();
            if (distance >= least || constraints_.curves[at(constraints_.curve[at(v)])].size() == 1)
                continue;
            least = distance;
            best = v;
        }
        if (best >= 0) constraints_.curves[at(constraints_.curve[at(best)])] = {point};
    }

    bool is_along(std::size_t h, const std::vector<Curve>& curves) const {
        const Sight& a = sights_[at(from(h))];
        const Sight& b = sights_[at(to(h))];
        if (a.curve < 0 || a.curve != b.curve || a.point == b.point) return false;
        const Curve& curve = curves[at(a.curve)];
        const Vec3 along = curve.points[at(b.point)] - curve.points[at(a.point)];
        const Vec3 edge = mesh_.points[at(to(h))] - mesh_.points[at(from(h))];
        const double steps = std::abs(a.point - b.point);
        const double count = static_cast<double>(curve.points.size() - 1);
        const double way = curve.is_closed ? std::min(steps, count - steps) : steps;
        return along.normalized().dot(edge.stableNormalized()) >
                   std::cos(options_.most_degrees * std::numbers::pi / 180) &&
               along.norm() > 0.4 * edge.norm() &&
               way * kStep * options_.edge_length < 2 * edge.norm();
    }

    void take(std::size_t h, const std::vector<Curve>& curves) {
        for (const int v : {from(h), to(h)}) {
            const Sight& sight = sights_[at(v)];
            if (constraints_.curve[at(v)] == QuadConstraints::kFree)
                slide(v, curves[at(sight.curve)], sight.point);
        }
        QuadFeatureEdge edge;
        edge.from = from(h);
        edge.to = to(h);
        edge.arc = curves[at(sights_[at(from(h))].curve)].arc;
        mesh_.feature_edges.push_back(edge);
    }

    void pin_nodes(const FeatureCurveNetwork& network) {
        std::vector<int> ends(network.nodes.size(), 0);
        for (const NetworkArc& arc : network.arcs)
            for (const int node : arc.nodes) ++ends[at(node)];
        for (std::size_t n = 0; n < ends.size(); ++n)
            if (ends[n] > 0 && ends[n] != 2) pin_nearest(network.nodes[n].position, false);
    }

    QuadMesh& mesh_;
    const QuadCurveOptions& options_;
    std::vector<int> opposite_;
    std::vector<bool> is_boundary_;
    std::vector<Sight> sights_;
    QuadConstraints constraints_;
    int half_window_ = 0;
};

}  // namespace

QuadConstraints draw_to_curves(QuadMesh& mesh, const Mesh& surface,
                               const FeatureCurveNetwork& network,
                               const QuadCurveOptions& options) {
    CurveDrawing drawing(mesh, options);
    drawing.draw_boundary(surface);
    drawing.draw_network(network);
    return drawing.finish();
}

}  // namespace fcn
