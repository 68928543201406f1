// Which curves may be asked to lie on lines of the grid. A coordinate that is constant along a
// curve needs a field that follows it on both sides, and the same coordinate on both; edges along
// which the field is astray are left soft. Around a vertex the field's turns say how many quads
// each sector between two such curves will have. A sector without any would have to vanish: of two
// curves that leave a node within one arm of the field the less important one keeps away from the
// node until there is room for quads between them. The same goes for a curve that the field
// crosses by a corner where the curve itself is straight.
#include "meshing/hard_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace fcn {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;
constexpr double kAgreeing = kQuarter / 2;  ///< of both sides of an edge, radians
constexpr double kCorner = 0.4 * kQuarter;  ///< where a curve turns by more it may have a corner
constexpr double kTurningReach = 0.5;       ///< in h, within which turning is measured

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Quarters of the field from h, counter-clockwise around its origin, to the next edge that is
/// marked or at the boundary, or back to h; h has a face.
int quarters_from(const Mesh& mesh, const CrossField& field, const std::vector<bool>& is_marked,
                  HalfedgeHandle first) {
    const bool is_open =
        is_marked[at(mesh.edge_handle(first).idx())] || mesh.is_boundary(mesh.edge_handle(first));
    // As vertex_indices(): the sum of rotations and corners is a multiple of a quarter.
    double sum = is_open ? -nearest_arm(mesh, field, first) : 0;
    for (HalfedgeHandle h = first;;) {
        sum += corner_angle(mesh, h);
        const HalfedgeHandle in = mesh.prev_halfedge_handle(h);
        const HalfedgeHandle next = mesh.opposite_halfedge_handle(in);
        if (mesh.is_boundary(next) || is_marked[at(mesh.edge_handle(next).idx())]) {
            sum += nearest_arm(mesh, field, in);
            break;
        }
        sum -= arm_rotation(mesh, field, in);
        if (next == first) break;
        h = next;
    }
    return static_cast<int>(std::lround(sum / kQuarter));
}

class CurveFinder {
public:
    CurveFinder(const QuadDomain& domain, const CrossField& field, const HardCurveOptions& options)
        : domain_(domain),
          mesh_(domain.mesh),
          field_(field),
          options_(options),
          is_taken_(mesh_.n_edges(), false) {}

    std::vector<HardCurve> run() {
        std::vector<HardCurve> result;
        std::vector<HardCurve> waiting = candidates();
        while (!waiting.empty()) {
            std::stable_sort(
                waiting.begin(), waiting.end(),
                [](const HardCurve& a, const HardCurve& b) { return a.importance > b.importance; });
            std::vector<HardCurve> pieces;
            for (HardCurve& curve : waiting) {
                mark(curve, true);
                const std::vector<bool> is_bad = bad_places(curve);
                if (std::none_of(is_bad.begin(), is_bad.end(), [](bool b) { return b; })) {
                    result.push_back(std::move(curve));
                    continue;
                }
                mark(curve, false);
                for (HardCurve& piece : without(curve, is_bad)) pieces.push_back(std::move(piece));
            }
            waiting = std::move(pieces);
        }
        std::stable_sort(result.begin(), result.end(), [](const HardCurve& a, const HardCurve& b) {
            return a.importance > b.importance;
        });
        return result;
    }

private:
    double length(int edge) const { return mesh_.calc_edge_length(EdgeHandle(edge)); }
    double fold(int edge) const {
        const HalfedgeHandle h = mesh_.halfedge_handle(EdgeHandle(edge), 0);
        const Vec3 a = face_normal(mesh_, mesh_.face_handle(h));
        const Vec3 b = face_normal(mesh_, mesh_.opposite_face_handle(h));
        return std::atan2(a.cross(b).norm(), a.dot(b));
    }

    /// Whether both sides see the edge along the same arm of the field.
    bool follows(EdgeHandle edge) const {
        const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
        const HalfedgeHandle back = mesh_.opposite_halfedge_handle(h);
        const double here = nearest_arm(mesh_, field_, h), there = nearest_arm(mesh_, field_, back);
        const double most = options_.most_off_degrees * kQuarter / 90;
        if (std::abs(here) > most || std::abs(there) > most) return false;
        const double apart = arm_rotation(mesh_, field_, h);
        return std::abs(apart - (there - here)) < kAgreeing;
    }

    /// Chains of edges of one arc along which the field goes.
    std::vector<HardCurve> candidates() const {
        std::map<int, std::vector<int>> by_arc;
        for (const EdgeHandle edge : mesh_.edges()) {
            const int arc = domain_.edge_arc[at(edge.idx())];
            if (arc >= 0 && !mesh_.is_boundary(edge)) by_arc[arc].push_back(edge.idx());
        }
        std::vector<HardCurve> result;
        for (const auto& [arc, edges] : by_arc) {
            double sum = 0, total = 0;
            for (const int edge : edges) {
                sum += length(edge) * fold(edge);
                total += length(edge);
            }
            if (sum < total * options_.least_fold_degrees * kQuarter / 90) continue;
            std::vector<int> good;
            for (const int edge : edges)
                if (follows(EdgeHandle(edge))) good.push_back(edge);
            for (HardCurve& curve : chains(arc, good)) result.push_back(std::move(curve));
        }
        return result;
    }

    /// Edges of one arc in order, one curve a connected piece; short ones are left out.
    std::vector<HardCurve> chains(int arc, const std::vector<int>& edges) const {
        std::map<int, std::vector<int>> at_vertex;
        for (const int edge : edges)
            for (const int v : ends(edge)) at_vertex[v].push_back(edge);
        std::vector<HardCurve> result;
        std::vector<int> left = edges;
        const auto is_left = [&](int edge) {
            return std::find(left.begin(), left.end(), edge) != left.end();
        };
        const auto follow = [&](int vertex, int edge) {
            HardCurve curve;
            curve.arc = arc;
            while (edge >= 0) {
                curve.edges.push_back(edge);
                left.erase(std::find(left.begin(), left.end(), edge));
                vertex = ends(edge)[0] == vertex ? ends(edge)[1] : ends(edge)[0];
                edge = -1;
                if (at_vertex[vertex].size() != 2) break;
                for (const int next : at_vertex[vertex])
                    if (is_left(next)) edge = next;
            }
            add(std::move(curve), result);
        };
        for (const auto& [vertex, around] : at_vertex)
            if (around.size() != 2)
                for (const int edge : around)
                    if (is_left(edge)) follow(vertex, edge);
        while (!left.empty()) follow(ends(left.front())[0], left.front());
        return result;
    }
    std::array<int, 2> ends(int edge) const {
        const HalfedgeHandle h = mesh_.halfedge_handle(EdgeHandle(edge), 0);
        return {mesh_.from_vertex_handle(h).idx(), mesh_.to_vertex_handle(h).idx()};
    }

    void add(HardCurve curve, std::vector<HardCurve>& result) const {
        double sum = 0, total = 0;
        for (const int edge : curve.edges) {
            sum += length(edge) * fold(edge);
            total += length(edge);
        }
        if (total < options_.least_length * options_.edge_length) return;
        curve.importance = sum / options_.edge_length;
        result.push_back(std::move(curve));
    }

    /// Vertices along a curve, one more than edges.
    std::vector<int> vertices(const HardCurve& curve) const {
        const auto& edges = curve.edges;
        const auto first = ends(edges[0]);
        int vertex = first[0];
        if (edges.size() > 1) {
            const auto second = ends(edges[1]);
            if (vertex == second[0] || vertex == second[1]) vertex = first[1];
        }
        std::vector<int> result{vertex};
        for (const int edge : edges)
            result.push_back(ends(edge)[0] == result.back() ? ends(edge)[1] : ends(edge)[0]);
        return result;
    }

    void mark(const HardCurve& curve, bool is_taken) {
        for (const int edge : curve.edges) is_taken_[at(edge)] = is_taken;
    }

    /// Per vertex of a marked curve: whether not all sectors there have room.
    std::vector<bool> bad_places(const HardCurve& curve) const {
        const std::vector<int> along = vertices(curve);
        std::vector<bool> result;
        for (std::size_t i = 0; i < along.size(); ++i) {
            bool is_bad = false;
            int edges = 0, straight = 0;
            const VertexHandle vertex(along[i]);
            for (const HalfedgeHandle h : mesh_.voh_range(vertex)) {
                const bool is_open = is_taken_[at(mesh_.edge_handle(h).idx())] ||
                                     mesh_.is_boundary(mesh_.edge_handle(h));
                edges += is_open;
                if (!is_open || mesh_.is_boundary(h)) continue;
                const int quarters = quarters_from(mesh_, field_, is_taken_, h);
                is_bad = is_bad || quarters < 1;
                straight += quarters >= 2;
            }
            if (edges == 2 && !is_bad && straight < 2 && !mesh_.is_boundary(vertex))
                is_bad = turning(vertex) < kCorner;
            result.push_back(is_bad);
        }
        return result;
    }

    /// By how much the two marked edges at a vertex, and what follows, turn; radians.
    double turning(VertexHandle vertex) const {
        std::vector<Vec3> ways;
        for (const HalfedgeHandle h : mesh_.voh_range(vertex)) {
            if (!is_taken_[at(mesh_.edge_handle(h).idx())]) continue;
            HalfedgeHandle last = h;
            double gone = mesh_.calc_edge_length(h);
            while (gone < kTurningReach * options_.edge_length) {
                HalfedgeHandle next;
                int count = 0;
                for (const HalfedgeHandle out : mesh_.voh_range(mesh_.to_vertex_handle(last))) {
                    if (!is_taken_[at(mesh_.edge_handle(out).idx())] ||
                        out == mesh_.opposite_halfedge_handle(last))
                        continue;
                    next = out;
                    ++count;
                }
                if (count != 1) break;
                last = next;
                gone += mesh_.calc_edge_length(last);
            }
            ways.push_back(mesh_.point(mesh_.to_vertex_handle(last)) - mesh_.point(vertex));
        }
        return std::atan2(ways[0].cross(ways[1]).norm(), -ways[0].dot(ways[1]));
    }

    /// What is left of a curve when it ends where it is bad, and keeps its distance.
    std::vector<HardCurve> without(const HardCurve& curve, const std::vector<bool>& is_bad) const {
        const std::vector<int> along = vertices(curve);
        std::vector<bool> is_gone(curve.edges.size(), false);
        for (std::size_t i = 0; i < along.size(); ++i) {
            if (!is_bad[i]) continue;
            for (const int direction : {-1, 1}) {
                double gone = 0;
                for (std::size_t k = i;;) {
                    if (direction < 0 ? k == 0 : k + 1 == along.size()) break;
                    if (gone > 0 && has_room(along[i], along[k])) break;
                    const std::size_t edge = direction < 0 ? k - 1 : k;
                    k = direction < 0 ? k - 1 : k + 1;
                    is_gone[edge] = true;
                    gone += length(curve.edges[edge]);
                }
            }
        }
        return without_edges(curve, is_gone);
    }

public:
    std::vector<HardCurve> without_edges(const HardCurve& curve,
                                         const std::vector<bool>& is_gone) const {
        std::vector<int> rest;
        for (std::size_t i = 0; i < is_gone.size(); ++i)
            if (!is_gone[i]) rest.push_back(curve.edges[i]);
        return chains(curve.arc, rest);
    }

private:
    /// Whether a curve that had to leave the marked ones at one vertex is far enough from those at
    /// another.
    bool has_room(int from, int vertex) const {
        const double least = options_.least_distance * options_.edge_length;
        const Vec3& p = mesh_.point(VertexHandle(vertex));
        if ((mesh_.point(VertexHandle(from)) - p).norm() < least) return false;
        for (const EdgeHandle edge : mesh_.edges()) {
            if (!is_taken_[at(edge.idx())] && !mesh_.is_boundary(edge)) continue;
            for (const int v : ends(edge.idx()))
                if ((mesh_.point(VertexHandle(v)) - p).norm() < least) return false;
        }
        return true;
    }

    const QuadDomain& domain_;
    const Mesh& mesh_;
    const CrossField& field_;
    const HardCurveOptions& options_;
    std::vector<bool> is_taken_;
};

}  // namespace

std::vector<HardCurve> find_hard_curves(const QuadDomain& domain, const CrossField& field,
                                        const HardCurveOptions& options) {
    return CurveFinder(domain, field, options).run();
}

std::vector<HardCurve> without_edges(const QuadDomain& domain, const HardCurve& curve,
                                     const std::vector<bool>& is_gone,
                                     const HardCurveOptions& options) {
    return CurveFinder(domain, {}, options).without_edges(curve, is_gone);
}

}  // namespace fcn
