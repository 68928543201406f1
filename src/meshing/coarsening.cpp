// From chains of small edges to edges of the target length, before the remesher proper runs. The
// remesher may not touch a protected edge, so a curve must already be in the pieces it is to have
// in the end. The collapses are those of incremental remeshing (Botsch, Kobbelt 2004) with its
// feature rules: fixed vertices stay, vertices of a curve move along the curve only. The threshold
// grows from pass to pass, so that faces beside a bent curve have grown before the curve cuts its
// corners; flips between the passes remove the slivers that block collapses. A last pass collapses
// what is left of a chain whatever the lengths around it. A collapse is refused if the link
// condition fails or if a face turns by more than a limit or degenerates.
#include "meshing/coarsening.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "meshing/edge_corners.h"

namespace fcn {
namespace {

constexpr double kShort = 0.8, kLong = 4.0 / 3;  ///< in L
constexpr double kMaxTurnFree = 0.5;    ///< cosine between a face's normal before and after
constexpr double kMaxTurnChain = 0.1;   ///< the same where a chain cuts a corner
constexpr double kMinShape = 0.02;      ///< altitude over longest side below which a face is bad
constexpr double kFlipFlatness = 0.85;  ///< cosine between faces for which a flip keeps the shape
constexpr double kCornerCosine = 0.7071067811865476;  ///< borders that turn more keep the vertex

struct FaceShape {
    Vec3 normal = Vec3::Zero();  ///< unit
    double quality = 0;          ///< smallest altitude / longest side
};

FaceShape shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    FaceShape shape;
    const Vec3 cross = (b - a).cross(c - a);
    const double twice_area = cross.norm();
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    if (!(twice_area > 0) || !(longest > 0)) return shape;
    shape.normal = cross / twice_area;
    shape.quality = twice_area / (longest * longest);
    return shape;
}

class Coarsener {
public:
    Coarsener(const MarkedMesh& input, const CoarseningOptions& options)
        : work_(input), mesh_(work_.mesh), options_(options) {
        request_status(mesh_);
        fix_corners();
    }

    MarkedMesh run() {
        const double length = options_.edge_length;
        for (const double share : {0.1, 0.2, 0.4, kShort}) {
            for (int round = 0; round < options_.max_rounds; ++round) {
                const std::size_t collapsed = collapse_below(share * length);
                flip_bad_edges();
                if (collapsed == 0) break;
            }
        }
        for (int round = 0; round < options_.max_rounds; ++round) {
            if (straighten_chains() == 0 && unblock_chains() == 0) break;
            flip_bad_edges();
        }
        split_long_marked_edges();
        return compacted(work_);
    }

private:
    bool is_marked(EdgeHandle edge) const {
        return work_.edge_role[static_cast<std::size_t>(edge.idx())] != EdgeRole::Free;
    }
    bool is_fixed(VertexHandle vertex) const {
        return work_.is_fixed_vertex[static_cast<std::size_t>(vertex.idx())];
    }
    EdgeRole& role(EdgeHandle edge) {
        return work_.edge_role[static_cast<std::size_t>(edge.idx())];
    }

    std::vector<HalfedgeHandle> marked_halfedges(VertexHandle vertex) const {
        std::vector<HalfedgeHandle> marked;
        for (const HalfedgeHandle out : mesh_.voh_range(vertex))
            if (is_marked(mesh_.edge_handle(out))) marked.push_back(out);
        return marked;
    }

    /// Ends, junctions and corners of curves, and where one kind of curve turns into another.
    void fix_corners() {
        for (const VertexHandle vertex : mesh_.vertices()) {
            const auto marked = marked_halfedges(vertex);
            if (marked.empty() || is_fixed(vertex)) continue;
            bool is_corner = marked.size() != 2 || role(mesh_.edge_handle(marked[0])) !=
                                                       role(mesh_.edge_handle(marked[1]));
            if (!is_corner && role(mesh_.edge_handle(marked[0])) == EdgeRole::Border) {
                const Vec3 a = mesh_.calc_edge_vector(marked[0]).normalized();
                const Vec3 b = mesh_.calc_edge_vector(marked[1]).normalized();
                is_corner = -a.dot(b) < kCornerCosine;
            }
            if (is_corner) work_.is_fixed_vertex[static_cast<std::size_t>(vertex.idx())] = true;
        }
    }

    struct Limits {
        double max_edge = 0;  ///< new edges may be this long, or as long as the old ones
        double max_turn = 0;  ///< cosine
        double min_quality = 0;
    };

    /// Whether the from-vertex may vanish into the to-vertex as far as curves are concerned.
    bool is_move_allowed(HalfedgeHandle halfedge) const {
        const VertexHandle from = mesh_.from_vertex_handle(halfedge);
        if (is_fixed(from)) return false;
        const bool is_on_curve = !marked_halfedges(from).empty() || mesh_.is_boundary(from);
        return !is_on_curve || is_marked(mesh_.edge_handle(halfedge));
    }

    bool keeps_faces(HalfedgeHandle halfedge, const Limits& limits) const {
        const VertexHandle from = mesh_.from_vertex_handle(halfedge);
        const VertexHandle to = mesh_.to_vertex_handle(halfedge);
        const Vec3& target = mesh_.point(to);
        double longest_before = limits.max_edge;
        for (const VertexHandle around : mesh_.vv_range(from))
            longest_before =
                std::max(longest_before, (mesh_.point(around) - mesh_.point(from)).norm());
        for (const VertexHandle around : mesh_.vv_range(from))
            if ((mesh_.point(around) - target).norm() > longest_before) return false;
        for (const HalfedgeHandle out : mesh_.voh_range(from)) {
            if (mesh_.is_boundary(out)) continue;
            const VertexHandle b = mesh_.to_vertex_handle(out);
            const VertexHandle c = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(out));
            if (b == to || c == to) continue;
            const FaceShape before = shape_of(mesh_.point(from), mesh_.point(b), mesh_.point(c));
            const FaceShape after = shape_of(target, mesh_.point(b), mesh_.point(c));
            if (after.quality < std::min(limits.min_quality, before.quality)) return false;
            if (after.quality <= 0) return false;
            // The normal of a needle says little: compare with what lies across its far edge.
            const Vec3 reference = before.quality > 1e-3 ? before.normal : across(out, before);
            if (after.normal.dot(reference) < limits.max_turn) return false;
        }
        return true;
    }

    /// Normal of the face across the edge opposite to the from-vertex of `out`.
    Vec3 across(HalfedgeHandle out, const FaceShape& own) const {
        const HalfedgeHandle far = mesh_.opposite_halfedge_handle(mesh_.next_halfedge_handle(out));
        if (mesh_.is_boundary(far)) return own.normal;
        const auto v = face_vertices(mesh_, mesh_.face_handle(far));
        const FaceShape other = shape_of(mesh_.point(v[0]), mesh_.point(v[1]), mesh_.point(v[2]));
        return other.quality > own.quality ? other.normal : own.normal;
    }

    bool is_collapse_possible(HalfedgeHandle halfedge, const Limits& limits) {
        return is_move_allowed(halfedge) && mesh_.is_collapse_ok(halfedge) &&
               keeps_curves(halfedge) && keeps_faces(halfedge, limits);
    }

    /// The two triangles at a collapsed edge vanish, and two pairs of their sides become one edge:
    /// never two different curves, and never an edge of a curve that closes on itself.
    bool keeps_curves(HalfedgeHandle halfedge) const {
        for (const HalfedgeHandle side : {halfedge, mesh_.opposite_halfedge_handle(halfedge)}) {
            if (mesh_.is_boundary(side)) continue;
            const HalfedgeHandle next = mesh_.next_halfedge_handle(side);
            const HalfedgeHandle last = mesh_.next_halfedge_handle(next);
            if (is_marked(mesh_.edge_handle(next)) && is_marked(mesh_.edge_handle(last)))
                return false;
        }
        return true;
    }

    void collapse(HalfedgeHandle halfedge) {
        for (const HalfedgeHandle side : {halfedge, mesh_.opposite_halfedge_handle(halfedge)}) {
            if (mesh_.is_boundary(side)) continue;
            const HalfedgeHandle next = mesh_.next_halfedge_handle(side);
            const EdgeHandle a = mesh_.edge_handle(next);
            const EdgeHandle b = mesh_.edge_handle(mesh_.next_halfedge_handle(next));
            role(a) = role(b) = std::max(role(a), role(b));
        }
        mesh_.collapse(halfedge);
    }

    std::size_t collapse_below(double threshold) {
        std::vector<std::pair<double, int>> queue;
        for (const EdgeHandle edge : mesh_.edges()) {  // skips deleted ones
            const double length = mesh_.calc_edge_length(edge);
            if (length < threshold) queue.emplace_back(length, edge.idx());
        }
        std::sort(queue.begin(), queue.end());
        const Limits free{kLong * options_.edge_length, kMaxTurnFree, kMinShape};
        const Limits chain{kLong * options_.edge_length, kMaxTurnChain, kMinShape};
        std::size_t count = 0;
        for (const auto& [length, index] : queue) {
            const EdgeHandle edge(index);
            if (mesh_.status(edge).deleted() || !(mesh_.calc_edge_length(edge) < threshold))
                continue;
            for (unsigned side = 0; side < 2; ++side) {
                const HalfedgeHandle halfedge = mesh_.halfedge_handle(edge, side);
                if (!is_collapse_possible(halfedge, is_marked(edge) ? chain : free)) continue;
                collapse(halfedge);
                ++count;
                break;
            }
        }
        return count;
    }

    /// Collapses the remaining inner vertices of feature chains, shortest edge first.
    std::size_t straighten_chains() {
        std::vector<std::pair<double, int>> queue;
        for (const EdgeHandle edge : mesh_.edges())
            if (role(edge) == EdgeRole::Feature)
                queue.emplace_back(mesh_.calc_edge_length(edge), edge.idx());
        std::sort(queue.begin(), queue.end());
        const Limits limits{std::numeric_limits<double>::infinity(), kMaxTurnChain, 1e-4};
        std::size_t count = 0;
        for (const auto& [length, index] : queue) {
            const EdgeHandle edge(index);
            for (unsigned side = 0; side < 2 && !mesh_.status(edge).deleted(); ++side) {
                const HalfedgeHandle halfedge = mesh_.halfedge_handle(edge, side);
                if (!is_collapse_possible(halfedge, limits)) continue;
                collapse(halfedge);
                ++count;
            }
        }
        return count;
    }

    /// A chain cannot be collapsed where an edge beside it already joins what the collapse would
    /// join (the link condition). Splits such edges.
    std::size_t unblock_chains() {
        std::vector<EdgeHandle> blocking;
        for (const EdgeHandle edge : mesh_.edges()) {
            if (role(edge) != EdgeRole::Feature) continue;
            for (unsigned side = 0; side < 2; ++side)
                collect_blocking(mesh_.halfedge_handle(edge, side), blocking);
        }
        std::sort(blocking.begin(), blocking.end());
        blocking.erase(std::unique(blocking.begin(), blocking.end()), blocking.end());
        for (const EdgeHandle edge : blocking) split_in_half(edge);
        return blocking.size();
    }

    /// Free edges from the to-vertex to neighbours of the from-vertex that are not opposite.
    void collect_blocking(HalfedgeHandle halfedge, std::vector<EdgeHandle>& blocking) const {
        if (!is_move_allowed(halfedge)) return;
        const VertexHandle to = mesh_.to_vertex_handle(halfedge);
        const auto opposite_vertex = [&](HalfedgeHandle side) {
            return mesh_.is_boundary(side)
                       ? VertexHandle()
                       : VertexHandle(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(side)));
        };
        const VertexHandle left = opposite_vertex(halfedge);
        const VertexHandle right = opposite_vertex(mesh_.opposite_halfedge_handle(halfedge));
        for (const VertexHandle around : mesh_.vv_range(mesh_.from_vertex_handle(halfedge))) {
            if (around == to || around == left || around == right) continue;
            const HalfedgeHandle there = mesh_.find_halfedge(to, around);
            if (there.is_valid() && !is_marked(mesh_.edge_handle(there)))
                blocking.push_back(mesh_.edge_handle(there));
        }
    }

    void flip_bad_edges() {
        for (int sweep = 0; sweep < 3; ++sweep) {
            std::size_t count = 0;
            for (const EdgeHandle edge : mesh_.edges()) {
                if (is_marked(edge) || mesh_.is_boundary(edge) || !is_flip_better(edge)) continue;
                mesh_.flip(edge);
                ++count;
            }
            if (count == 0) return;
        }
    }

    bool is_flip_better(EdgeHandle edge) const {
        if (!mesh_.is_flip_ok(edge)) return false;
        const auto [a, b, c, d] = edge_corners(mesh_, edge);
        const FaceShape first = shape_of(a, b, c), second = shape_of(b, a, d);
        const FaceShape third = shape_of(c, d, b), fourth = shape_of(d, c, a);
        const double before = std::min(first.quality, second.quality);
        const double after = std::min(third.quality, fourth.quality);
        if (!(after > before * 1.05)) return false;
        // A needle has no normal worth keeping: the other face's stands for the surface.
        const Vec3 reference = first.quality > second.quality ? first.normal : second.normal;
        const bool is_flat = before < 1e-3 || first.normal.dot(second.normal) > kFlipFlatness;
        return is_flat && third.normal.dot(reference) > kFlipFlatness &&
               fourth.normal.dot(reference) > kFlipFlatness;
    }

    void split_long_marked_edges() {
        const double longest = kLong * options_.edge_length * (1 - 1e-9);
        std::vector<EdgeHandle> queue;
        for (const EdgeHandle edge : mesh_.edges())
            if (is_marked(edge) && mesh_.calc_edge_length(edge) > longest) queue.push_back(edge);
        for (std::size_t i = 0; i < queue.size(); ++i) {
            const EdgeHandle edge = queue[i];
            const EdgeHandle rest = split_in_half(edge);
            for (const EdgeHandle half : {edge, rest})
                if (mesh_.calc_edge_length(half) > longest) queue.push_back(half);
        }
    }

    /// Splits an edge and its faces at its midpoint; returns the new half.
    EdgeHandle split_in_half(EdgeHandle edge) {
        const EdgeRole kept = role(edge);
        std::array<int, 2> label{-1, -1};
        for (unsigned side = 0; side < 2; ++side) {
            const HalfedgeHandle h = mesh_.halfedge_handle(edge, side);
            if (!mesh_.is_boundary(h))
                label[side] =
                    work_.face_label[static_cast<std::size_t>(mesh_.face_handle(h).idx())];
        }
        const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
        const VertexHandle from = mesh_.from_vertex_handle(h), to = mesh_.to_vertex_handle(h);
        const VertexHandle middle = mesh_.add_vertex(0.5 * (mesh_.point(from) + mesh_.point(to)));
        mesh_.split(edge, middle);
        work_.is_fixed_vertex.resize(mesh_.n_vertices(), false);
        work_.edge_role.resize(mesh_.n_edges(), EdgeRole::Free);
        work_.face_label.resize(mesh_.n_faces(), -1);
        EdgeHandle rest;
        for (const VertexHandle end : {from, to}) {
            const EdgeHandle half = mesh_.edge_handle(mesh_.find_halfedge(end, middle));
            role(half) = kept;
            if (half != edge) rest = half;
        }
        const HalfedgeHandle forward = mesh_.find_halfedge(from, middle);
        const HalfedgeHandle onward = mesh_.find_halfedge(middle, to);
        for (unsigned side = 0; side < 2; ++side) {
            for (HalfedgeHandle part : {forward, onward}) {
                if (side == 1) part = mesh_.opposite_halfedge_handle(part);
                if (mesh_.is_boundary(part)) continue;
                const auto face = static_cast<std::size_t>(mesh_.face_handle(part).idx());
                work_.face_label[face] = label[side];
            }
        }
        return rest;
    }

    MarkedMesh work_;
    Mesh& mesh_;
    CoarseningOptions options_;
};

}  // namespace

MarkedMesh coarsen(const MarkedMesh& input, const CoarseningOptions& options) {
    return Coarsener(input, options).run();
}

}  // namespace fcn
