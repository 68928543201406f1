// Intrinsic triangulations of flat cone metrics (Sharp, Soliman, Crane 2019, "Navigating intrinsic
// triangulations"; removal of flat vertices by flips to degree 3: Liu, Gillespie, Chislett, Sharp,
// Jacobson, Crane 2023, "Surface simplification using intrinsic error metrics"). Every face carries
// a frame of its own, and how it comes from the map's is known symbolically, so that an edge's
// image can be computed for other translations than those that it was made with.
#include "meshing/intrinsic_triangulation.h"

#include <algorithm>
#include <cmath>

namespace fcn {
namespace {

constexpr double kLeastArea = 1e-9;  ///< twice, in quads

}  // namespace

IntrinsicTriangulation::IntrinsicTriangulation(const Mesh& mesh, const MapProblem& problem,
                                               const VertexSectors& sectors,
                                               const Eigen::VectorXd& all_values)
    : corners_(3 * mesh.n_faces()), sides_(3 * mesh.n_faces()), slot_of_(at(sectors.count()), -1) {
    const CutMesh& cut = problem.cut;
    std::vector<int> slot_of_halfedge(mesh.n_halfedges(), -1);
    for (const FaceHandle face : mesh.faces()) {
        HalfedgeHandle h = mesh.halfedge_handle(face);
        const auto& names = sectors.of_corner[at(face.idx())];
        for (int i = 0; i < 3; ++i, h = mesh.next_halfedge_handle(h)) {
            const int slot = 3 * face.idx() + i;
            slot_of_halfedge[at(h.idx())] = slot;
            const int copy = cut.copies[at(face.idx())][at(i)];
            corners_[at(slot)] = {names[at(i)], copy, {}, all_values.segment<2>(2 * copy)};
            slot_of_[at(names[at(i)])] = slot;
        }
    }
    for (const HalfedgeHandle h : mesh.halfedges()) {
        const int slot = slot_of_halfedge[at(h.idx())];
        if (slot >= 0 && !problem.is_hard[at(mesh.edge_handle(h).idx())])
            sides_[at(slot)].opposite =
                slot_of_halfedge[at(mesh.opposite_halfedge_handle(h).idx())];
    }
    for (std::size_t c = 0; c < cut.chains.size(); ++c) {
        const int unknown = 2 * (cut.copy_count + static_cast<int>(c));
        translations_.emplace_back(all_values.segment<2>(unknown));
        for (const HalfedgeHandle h : cut.chains[c]) {
            Side& side = sides_[at(slot_of_halfedge[at(h.idx())])];
            if (side.opposite < 0) continue;
            SymbolicTransition crossing;
            crossing.turns = -cut.turns[at(h.idx())] & 3;
            crossing.terms.push_back({static_cast<int>(c), {1, 0}});
            sides_[at(side.opposite)].crossing = inverse(crossing);
            side.crossing = std::move(crossing);
        }
    }
}

double IntrinsicTriangulation::orientation(const Vec2& a, const Vec2& b, const Vec2& c) const {
    const Vec2 u = b - a, v = c - a;
    return u[0] * v[1] - u[1] * v[0];
}

IntrinsicTriangulation::Corner IntrinsicTriangulation::seen_from(const SymbolicTransition& change,
                                                                 const Corner& corner) const {
    return {corner.vertex, corner.copy, composed(change, corner.from_copy),
            change.apply(corner.position, translations_)};
}

void IntrinsicTriangulation::set_corner(int slot, Corner corner) {
    slot_of_[at(corner.vertex)] = slot;
    corners_[at(slot)] = std::move(corner);
}

bool IntrinsicTriangulation::can_flip(int slot, double& quality, double least_at_origin) const {
    const Side& side = sides_[at(slot)];
    if (side.opposite < 0 || side.opposite / 3 == slot / 3) return false;
    const Vec2& a = corners_[at(slot)].position;
    const Vec2& b = corners_[at(next(slot))].position;
    const Vec2& c = corners_[at(previous(slot))].position;
    const Vec2 d = sides_[at(side.opposite)].crossing.apply(
        corners_[at(previous(side.opposite))].position, translations_);
    const double one = orientation(a, d, c), other = orientation(d, b, c);
    if (one < least_at_origin || other < kLeastArea) return false;
    const double longest =
        std::max({(a - d).squaredNorm(), (d - c).squaredNorm(), (c - a).squaredNorm(),
                  (d - b).squaredNorm(), (b - c).squaredNorm()});
    quality = std::min(one, other) / longest;
    return true;
}

/// Puts neighbours back after the sides of some faces got new slots; the slots may be neighbours of
/// each other.
void IntrinsicTriangulation::glue_outer(const std::vector<OuterSide>& outer) {
    std::vector<Side> old;
    for (const OuterSide& o : outer) old.push_back(sides_[at(o.old_slot)]);
    for (std::size_t i = 0; i < outer.size(); ++i) {
        Side side = old[i];
        side.crossing = composed(side.crossing, outer[i].to_old);
        const auto partner = std::find_if(outer.begin(), outer.end(), [&](const OuterSide& o) {
            return o.old_slot == side.opposite;
        });
        if (side.opposite >= 0 && partner != outer.end()) {
            side.crossing = composed(inverse(partner->to_old), side.crossing);
            side.opposite = partner->new_slot;
        } else if (side.opposite >= 0) {
            sides_[at(side.opposite)].opposite = outer[i].new_slot;
            sides_[at(side.opposite)].crossing = inverse(side.crossing);
        }
        sides_[at(outer[i].new_slot)] = std::move(side);
    }
}

void IntrinsicTriangulation::flip(int slot) {
    const int across = sides_[at(slot)].opposite;
    const SymbolicTransition to_there = sides_[at(slot)].crossing;
    const SymbolicTransition to_here = sides_[at(across)].crossing;
    const int f = 3 * (slot / 3), g = 3 * (across / 3);
    const Corner a = corners_[at(slot)], b = corners_[at(next(slot))];
    const Corner c = corners_[at(previous(slot))];
    const Corner d = seen_from(to_here, corners_[at(previous(across))]);
    glue_outer({{next(across), f, to_there},
                {previous(slot), f + 2, {}},
                {previous(across), g, to_there},
                {next(slot), g + 1, {}}});
    set_corner(f, a);
    set_corner(f + 1, d);
    set_corner(f + 2, c);
    set_corner(g, d);
    set_corner(g + 1, b);
    set_corner(g + 2, c);
    sides_[at(f + 1)] = {g + 2, {}};
    sides_[at(g + 2)] = {f + 1, {}};
}

/// Slots out of a vertex, counter-clockwise; at a boundary from the first to the last face.
std::vector<int> IntrinsicTriangulation::fan(int vertex, bool& is_closed) const {
    int start = slot_of_[at(vertex)];
    is_closed = true;
    for (int slot = start;;) {  // clockwise to a boundary
        const int back = sides_[at(slot)].opposite;
        if (back < 0) {
            is_closed = false;
            start = slot;
            break;
        }
        slot = next(back);
        if (slot == start) break;
    }
    std::vector<int> result;
    for (int slot = start; slot >= 0;) {
        result.push_back(slot);
        slot = sides_[at(previous(slot))].opposite;
        if (slot == start) break;
    }
    return result;
}

bool IntrinsicTriangulation::remove(int vertex) {
    if (slot_of_[at(vertex)] < 0) return false;
    for (;;) {
        bool is_closed = true;
        const std::vector<int> star = fan(vertex, is_closed);
        if (star.size() == (is_closed ? 3U : 2U)) break;
        if (star.size() < 3) return false;
        int best = -1;
        double best_quality = -1;
        // a last flip may leave the vertex on a straight edge: it goes at once
        const double least = star.size() == (is_closed ? 4U : 3U) ? -kLeastArea : kLeastArea;
        for (const int slot : star) {
            double quality = 0;
            const int across = sides_[at(slot)].opposite;
            if (across < 0 || corners_[at(next(slot))].vertex == vertex ||
                corners_[at(previous(slot))].vertex == vertex ||
                corners_[at(previous(across))].vertex == vertex)
                continue;  // what takes the edge's place would lead here, too
            if (can_flip(slot, quality, least) && quality > best_quality) {
                best = slot;
                best_quality = quality;
            }
        }
        if (best < 0) return false;
        flip(best);
    }
    bool is_closed = true;
    const std::vector<int> star = fan(vertex, is_closed);
    std::vector<int> faces;
    for (const int slot : star) {
        faces.push_back(slot / 3);
        if (corners_[at(next(slot))].vertex == vertex ||
            corners_[at(previous(slot))].vertex == vertex)
            return false;
    }
    std::sort(faces.begin(), faces.end());
    if (std::unique(faces.begin(), faces.end()) != faces.end()) return false;
    // all in the frame of the first face
    std::vector<SymbolicTransition> to_face(1);
    for (std::size_t i = 1; i < star.size(); ++i)
        to_face.push_back(composed(sides_[at(previous(star[i - 1]))].crossing, to_face[i - 1]));
    std::vector<Corner> rim;
    for (std::size_t i = 0; i < star.size(); ++i)
        rim.push_back(seen_from(inverse(to_face[i]), corners_[at(next(star[i]))]));
    if (!is_closed)
        rim.push_back(seen_from(inverse(to_face.back()), corners_[at(previous(star.back()))]));
    if (orientation(rim[0].position, rim[1].position, rim[2].position) < kLeastArea) return false;
    const int f = 3 * (star[0] / 3);
    std::vector<OuterSide> outer;
    for (std::size_t i = 0; i < star.size(); ++i)
        outer.push_back({next(star[i]), f + static_cast<int>(i), to_face[i]});
    glue_outer(outer);
    for (std::size_t i = 0; i < star.size(); ++i) {
        if (star[i] / 3 == star[0] / 3) continue;
        for (int k = 0; k < 3; ++k) {
            corners_[at(3 * (star[i] / 3) + k)] = {};
            sides_[at(3 * (star[i] / 3) + k)] = {};
        }
    }
    for (int k = 0; k < 3; ++k) set_corner(f + k, rim[at(k)]);
    if (!is_closed) sides_[at(f + 2)] = {-1, {}};
    slot_of_[at(vertex)] = -1;
    return true;
}

void IntrinsicTriangulation::make_delaunay() {
    std::vector<int> queue;
    for (int slot = 0; slot < slot_count(); ++slot)
        if (is_alive(slot)) queue.push_back(slot);
    std::size_t budget = 50 * queue.size() + 1000;
    const auto cotangent = [&](int slot) {  // of the angle across from a side
        const Vec2& tip = corners_[at(previous(slot))].position;
        const Vec2 u = corners_[at(slot)].position - tip,
                   v = corners_[at(next(slot))].position - tip;
        return u.dot(v) / (u[0] * v[1] - u[1] * v[0]);
    };
    while (!queue.empty() && budget-- > 0) {
        const int slot = queue.back();
        queue.pop_back();
        double quality = 0;
        const int across = sides_[at(slot)].opposite;
        if (across < 0 || cotangent(slot) + cotangent(across) >= -1e-9 ||
            !can_flip(slot, quality, kLeastArea))
            continue;
        const int f = 3 * (slot / 3), g = 3 * (across / 3);
        flip(slot);
        for (const int side : {f, f + 2, g, g + 1}) queue.push_back(side);
    }
}

}  // namespace fcn
