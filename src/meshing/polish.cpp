// The last few percent of bad triangles. Incremental remeshing equalises lengths and valences and
// so improves angles on the average; beside protected edges, which it may not touch, it leaves the
// odd needle. Here the bad triangles are taken worst first, and of flipping one of their edges,
// collapsing one, and moving one of their free vertices that change is made which raises the
// smallest angle of the faces it touches most (Freitag, Ollivier-Gooch 1997, on a surface: a move
// is a small pattern search in the tangent plane, projected back). A change that turns a face
// noticeably is refused, so that the shape stays as it is.
#include "meshing/polish.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "meshing/edge_corners.h"

namespace fcn {
namespace {

constexpr double kMaxTurn = 0.9;               ///< cosine between a face's normal before and after
constexpr double kMinGain = 0.003;             ///< radians
constexpr double kLongest = 1.6;               ///< in L: a collapse makes no longer edge
constexpr double kFarthestFromSurface = 0.05;  ///< in L: of the middle of a new edge

struct Triangle {
    double angle = 0;            ///< smallest, radians
    Vec3 normal = Vec3::Zero();  ///< unit
};

Triangle measure(const Vec3& a, const Vec3& b, const Vec3& c) {
    Triangle triangle;
    const Vec3 cross = (b - a).cross(c - a);
    const double twice_area = cross.norm();
    if (!(twice_area > 0)) return triangle;
    triangle.normal = cross / twice_area;
    triangle.angle = std::min({std::atan2(twice_area, (b - a).dot(c - a)),
                               std::atan2(twice_area, (c - b).dot(a - b)),
                               std::atan2(twice_area, (a - c).dot(b - c))});
    return triangle;
}

enum class Kind { Flip, Collapse, Move };

struct Change {
    Kind kind = Kind::Flip;
    double gain = 0;  ///< radians, of the smallest angle of the faces touched
    EdgeHandle edge;
    HalfedgeHandle halfedge;
    VertexHandle vertex;
    Vec3 position = Vec3::Zero();
};

class Polisher {
public:
    Polisher(const MarkedMesh& input, const SurfaceQueries& reference, const PolishOptions& options)
        : work_(input),
          mesh_(work_.mesh),
          reference_(reference),
          options_(options),
          is_bound_(work_.is_fixed_vertex) {
        request_status(mesh_);
        for (const EdgeHandle edge : mesh_.edges()) {
            if (!is_marked(edge) && !mesh_.is_boundary(edge)) continue;
            const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
            is_bound_[index(mesh_.from_vertex_handle(h))] = true;
            is_bound_[index(mesh_.to_vertex_handle(h))] = true;
        }
    }

    MarkedMesh run() {
        for (int round = 0; round < options_.max_rounds; ++round)
            if (improve_once() == 0) break;
        return compacted(work_);
    }

private:
    static std::size_t index(VertexHandle vertex) { return static_cast<std::size_t>(vertex.idx()); }
    bool is_marked(EdgeHandle edge) const {
        return work_.edge_role[static_cast<std::size_t>(edge.idx())] != EdgeRole::Free;
    }

    Triangle measure_face(FaceHandle face) const {
        const auto v = face_vertices(mesh_, face);
        return measure(mesh_.point(v[0]), mesh_.point(v[1]), mesh_.point(v[2]));
    }

    /// One sweep over the bad triangles, worst first; the number of changes made.
    std::size_t improve_once() {
        std::vector<std::pair<double, int>> bad;
        for (const FaceHandle face : mesh_.faces()) {
            const double angle = measure_face(face).angle;
            if (angle < options_.good_angle) bad.emplace_back(angle, face.idx());
        }
        std::sort(bad.begin(), bad.end());
        std::size_t count = 0;
        for (const auto& [angle, i] : bad) {
            const FaceHandle face(i);
            if (mesh_.status(face).deleted()) continue;
            if (measure_face(face).angle >= options_.good_angle) continue;
            if (const auto change = best_change(face)) {
                apply(*change);
                ++count;
            }
        }
        return count;
    }

    std::optional<Change> best_change(FaceHandle face) {
        std::optional<Change> best;
        const auto consider = [&](const std::optional<Change>& change) {
            if (change && change->gain > kMinGain && (!best || change->gain > best->gain))
                best = change;
        };
        for (const HalfedgeHandle h : mesh_.fh_range(face)) {
            consider(flip(mesh_.edge_handle(h)));
            consider(collapse(h));
            consider(collapse(mesh_.opposite_halfedge_handle(h)));
            consider(move(mesh_.from_vertex_handle(h)));
        }
        return best;
    }

    bool is_near_surface(const Vec3& point) const {
        return reference_.closest(point).distance <= kFarthestFromSurface * options_.edge_length;
    }

    std::optional<Change> flip(EdgeHandle edge) {
        if (is_marked(edge) || mesh_.is_boundary(edge) || !mesh_.is_flip_ok(edge)) return {};
        const auto [a, b, c, d] = edge_corners(mesh_, edge);
        const Triangle first = measure(a, b, c), second = measure(b, a, d);
        const Triangle third = measure(c, d, b), fourth = measure(d, c, a);
        const double turn =
            std::min(std::max(third.normal.dot(first.normal), third.normal.dot(second.normal)),
                     std::max(fourth.normal.dot(first.normal), fourth.normal.dot(second.normal)));
        if (turn < kMaxTurn || third.normal.dot(fourth.normal) < kMaxTurn) return {};
        Change change;
        change.kind = Kind::Flip;
        change.edge = edge;
        change.gain = std::min(third.angle, fourth.angle) - std::min(first.angle, second.angle);
        if (change.gain <= kMinGain || !is_near_surface(0.5 * (c + d))) return {};
        return change;
    }

    /// The fan around a vertex if it stood at `target`; nullopt if a face would turn. Faces with
    /// `without` as a corner are left out.
    std::optional<double> fan_angle(VertexHandle vertex, const Vec3& target,
                                    VertexHandle without = VertexHandle()) const {
        double smallest = std::numeric_limits<double>::infinity();
        for (const HalfedgeHandle out : mesh_.voh_range(vertex)) {
            if (mesh_.is_boundary(out)) continue;
            const VertexHandle b = mesh_.to_vertex_handle(out);
            const VertexHandle c = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(out));
            if (b == without || c == without) continue;
            const Triangle before = measure(mesh_.point(vertex), mesh_.point(b), mesh_.point(c));
            const Triangle after = measure(target, mesh_.point(b), mesh_.point(c));
            if (after.normal.dot(before.normal) < kMaxTurn) return {};
            smallest = std::min(smallest, after.angle);
        }
        return smallest;
    }

    std::optional<Change> collapse(HalfedgeHandle halfedge) {
        const VertexHandle from = mesh_.from_vertex_handle(halfedge);
        const VertexHandle to = mesh_.to_vertex_handle(halfedge);
        if (is_bound_[index(from)] || !mesh_.is_collapse_ok(halfedge)) return {};
        const Vec3& target = mesh_.point(to);
        for (const VertexHandle around : mesh_.vv_range(from))
            if ((mesh_.point(around) - target).norm() > kLongest * options_.edge_length) return {};
        const auto before = fan_angle(from, mesh_.point(from));
        const auto after = fan_angle(from, target, to);
        if (!before || !after || *after <= *before + kMinGain) return {};
        for (const VertexHandle around : mesh_.vv_range(from))
            if (around != to && !is_near_surface(0.5 * (mesh_.point(around) + target))) return {};
        Change change;
        change.kind = Kind::Collapse;
        change.halfedge = halfedge;
        change.gain = *after - *before;
        return change;
    }

    /// Pattern search: eight directions in the tangent plane, steps from L/4 down to L/64.
    std::optional<Change> move(VertexHandle vertex) const {
        if (is_bound_[index(vertex)]) return {};
        const Vec3 start = mesh_.point(vertex);
        const auto before = fan_angle(vertex, start);
        if (!before || *before >= options_.good_angle) return {};
        Vec3 normal = Vec3::Zero();
        for (const FaceHandle face : mesh_.vf_range(vertex)) normal += measure_face(face).normal;
        if (!(normal.norm() > 1e-6)) return {};
        int axis = 0;
        normal.normalized().cwiseAbs().minCoeff(&axis);
        const Vec3 u = normal.cross(Vec3::Unit(axis)).normalized();
        const Vec3 v = normal.cross(u).normalized();
        Change change;
        change.kind = Kind::Move;
        change.vertex = vertex;
        change.position = start;
        double best = *before;
        for (double step = options_.edge_length / 4; step >= options_.edge_length / 64;) {
            bool is_better = false;
            const Vec3 center = change.position;
            for (int k = 0; k < 8; ++k) {
                const double angle = k * 0.7853981633974483;
                const Vec3 wish = center + step * (std::cos(angle) * u + std::sin(angle) * v);
                const ClosestPoint closest = reference_.closest(wish);
                if (closest.distance > step) continue;
                const auto after = fan_angle(vertex, closest.position);
                if (!after || *after <= best + 1e-6) continue;
                best = *after;
                change.position = closest.position;
                is_better = true;
            }
            if (!is_better) step /= 2;
        }
        change.gain = best - *before;
        return change;
    }

    void apply(const Change& change) {
        if (change.kind == Kind::Flip) {
            mesh_.flip(change.edge);
        } else if (change.kind == Kind::Move) {
            mesh_.set_point(change.vertex, change.position);
        } else {
            merge_roles(change.halfedge);
            mesh_.collapse(change.halfedge);
        }
    }

    /// The from-vertex is free, so of each pair of sides that become one only one can be marked.
    void merge_roles(HalfedgeHandle halfedge) {
        for (const HalfedgeHandle side : {halfedge, mesh_.opposite_halfedge_handle(halfedge)}) {
            if (mesh_.is_boundary(side)) continue;
            const HalfedgeHandle next = mesh_.next_halfedge_handle(side);
            auto& a = work_.edge_role[static_cast<std::size_t>(mesh_.edge_handle(next).idx())];
            auto& b = work_.edge_role[static_cast<std::size_t>(
                mesh_.edge_handle(mesh_.next_halfedge_handle(next)).idx())];
            a = b = std::max(a, b);
        }
    }

    MarkedMesh work_;
    Mesh& mesh_;
    const SurfaceQueries& reference_;
    PolishOptions options_;
    std::vector<bool> is_bound_;  ///< per vertex: neither moves nor vanishes
};

}  // namespace

MarkedMesh polish(const MarkedMesh& input, const SurfaceQueries& reference,
                  const PolishOptions& options) {
    return Polisher(input, reference, options).run();
}

}  // namespace fcn
