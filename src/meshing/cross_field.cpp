// Discrete connection of a triangle mesh and what a cross field turns against it (Crane, Desbrun,
// Schroeder 2010, "Trivial connections on discrete surfaces"; Ray, Vallet, Li, Levy 2008, "N-
// symmetry direction field design"). Going around a vertex counter-clockwise, the rotations of the
// arm and the angle defect of the vertex add up to whole quarters: the index. Over all vertices the
// rotations cancel, which leaves the sum of the defects (Gauss, Bonnet). At a boundary vertex the
// defect is that of the half plane, and the way from an edge of the boundary to the nearest arm
// and back is part of the rotation; these cancel along the boundary, so that the theorem holds
// there too and corners of a boundary have indices of their own.
#include "meshing/cross_field.h"

#include <cmath>
#include <numbers>

namespace fcn {
namespace {

constexpr double kPi = std::numbers::pi, kQuarter = kPi / 2;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

double wrap(double angle) {
    angle = std::remainder(angle, 2 * kPi);
    return angle <= -kPi ? angle + 2 * kPi : angle;
}

/// In radians, counter-clockwise from the first face around a vertex to the last.
double turning_around(const Mesh& mesh, const CrossField& field, VertexHandle v) {
    const HalfedgeHandle start = mesh.halfedge_handle(v);
    if (!start.is_valid()) return 0;
    // At a boundary vertex OpenMesh's halfedge has no face; the first face lies clockwise of it.
    const bool is_boundary = mesh.is_boundary(v);
    HalfedgeHandle first = start;
    if (is_boundary)  // counter-clockwise first: the halfedge whose opposite has no face
        for (const HalfedgeHandle h : mesh.voh_range(v))
            if (mesh.is_boundary(mesh.opposite_halfedge_handle(h))) first = h;
    double sum = is_boundary ? kPi + nearest_arm(mesh, field, first) : 2 * kPi;
    HalfedgeHandle h = first;
    while (true) {
        sum -= corner_angle(mesh, h);
        const HalfedgeHandle in = mesh.prev_halfedge_handle(h);
        const HalfedgeHandle next = mesh.opposite_halfedge_handle(in);
        if (mesh.is_boundary(next)) {
            sum -= nearest_arm(mesh, field, in);
            break;
        }
        sum += arm_rotation(mesh, field, in);
        if (next == first) break;
        h = next;
    }
    return sum;
}

}  // namespace

double corner_angle(const Mesh& mesh, HalfedgeHandle h) {
    const Vec3& p = mesh.point(mesh.from_vertex_handle(h));
    const Vec3 a = mesh.point(mesh.to_vertex_handle(h)) - p;
    const Vec3 b = mesh.point(mesh.from_vertex_handle(mesh.prev_halfedge_handle(h))) - p;
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

double nearest_arm(const Mesh& mesh, const CrossField& field, HalfedgeHandle h) {
    return std::remainder(field.angles[at(mesh.face_handle(h).idx())] - halfedge_angle(mesh, h),
                          kQuarter);
}

double halfedge_angle(const Mesh& mesh, HalfedgeHandle h) {
    const HalfedgeHandle first = mesh.halfedge_handle(mesh.face_handle(h));
    if (h == first) return 0;
    if (mesh.prev_halfedge_handle(h) == first) return kPi - corner_angle(mesh, h);
    return wrap(kPi + corner_angle(mesh, first));
}

double frame_rotation(const Mesh& mesh, HalfedgeHandle h) {
    return wrap(halfedge_angle(mesh, mesh.opposite_halfedge_handle(h)) + kPi -
                halfedge_angle(mesh, h));
}

double arm_rotation(const Mesh& mesh, const CrossField& field, HalfedgeHandle h) {
    const HalfedgeHandle across = mesh.opposite_halfedge_handle(h);
    return wrap(field.angles[at(mesh.face_handle(across).idx())] -
                field.angles[at(mesh.face_handle(h).idx())] - frame_rotation(mesh, h) -
                field.turns[at(h.idx())] * kQuarter);
}

std::vector<int> nearest_turns(const Mesh& mesh, const std::vector<double>& angles) {
    std::vector<int> turns(mesh.n_halfedges(), 0);
    for (const EdgeHandle edge : mesh.edges()) {
        if (mesh.is_boundary(edge)) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const HalfedgeHandle across = mesh.halfedge_handle(edge, 1);
        const double between = angles[at(mesh.face_handle(across).idx())] -
                               angles[at(mesh.face_handle(h).idx())] - frame_rotation(mesh, h);
        const int turn = static_cast<int>(std::lround(wrap(between) / kQuarter));
        turns[at(h.idx())] = ((turn % 4) + 4) % 4;
        turns[at(across.idx())] = (4 - turns[at(h.idx())]) % 4;
    }
    return turns;
}

std::vector<int> vertex_indices(const Mesh& mesh, const CrossField& field) {
    std::vector<int> indices(mesh.n_vertices(), 0);
    for (const VertexHandle v : mesh.vertices())
        indices[at(v.idx())] =
            static_cast<int>(std::lround(turning_around(mesh, field, v) / kQuarter));
    return indices;
}

std::string first_fault(const Mesh& mesh, const CrossField& field) {
    if (field.angles.size() != mesh.n_faces())
        return std::to_string(field.angles.size()) + " angles for " +
               std::to_string(mesh.n_faces()) + " faces";
    if (field.turns.size() != mesh.n_halfedges())
        return std::to_string(field.turns.size()) + " turns for " +
               std::to_string(mesh.n_halfedges()) + " halfedges";
    for (std::size_t f = 0; f < field.angles.size(); ++f)
        if (!std::isfinite(field.angles[f]))
            return "the angle of face " + std::to_string(f) + " is not finite";
    for (const HalfedgeHandle h : mesh.halfedges()) {
        const int turn = field.turns[at(h.idx())];
        const int back = field.turns[at(mesh.opposite_halfedge_handle(h).idx())];
        if (turn < 0 || turn > 3 || back < 0 || back > 3 || (turn + back) % 4 != 0)
            return "the turns of halfedge " + std::to_string(h.idx()) + " are " +
                   std::to_string(turn) + " and back " + std::to_string(back);
        if (mesh.is_boundary(mesh.edge_handle(h)) && turn != 0)
            return "the turns of boundary halfedge " + std::to_string(h.idx()) + " are not 0";
    }
    return {};
}

}  // namespace fcn
