// The last steps of incremental remeshing (Botsch, Kobbelt 2004, section 3): each free vertex moves
// to the area-weighted centre of its star within its tangent plane, and back onto the reference
// surface. Both are one step here, vertex by vertex, each seeing where the ones before it went: a
// move is checked where it ends, and halved while a face would turn or become a needle. A vertex
// that lies on the surface and would hardly move stays.
#include "meshing/crossing_guard.h"
#include "meshing/remeshing_steps.h"
#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kMaxTurn = 0.5;      ///< cosine between a face's normal before and after
constexpr double kPoorCosine = 0.98;  ///< 11 degrees: moves make no worse triangles
constexpr double kRest = 1e-3;        ///< in targets: shorter moves are none
constexpr double kReach = 2;          ///< in targets: farther the surface is not looked for
constexpr int kMaxHalvings = 3;

struct Star {
    Vec3 center = Vec3::Zero(), normal = Vec3::Zero();
    double worst = 0;  ///< cosine of the smallest angle
};

Star measure_star(const WorkingMesh& mesh, int v) {
    Star star;
    const Vec3& p = mesh.point(v);
    double total = 0;
    mesh.visit_star(v, [&](int h) {
        const Vec3 &b = mesh.point(mesh.to(h)), &c = mesh.point(mesh.apex(h));
        const Vec3 cross = (b - p).cross(c - p);
        const double area = cross.norm();
        star.normal += cross;
        star.center += area * (p + b + c);
        total += area;
        star.worst = std::max(star.worst, cosine_of_smallest_angle(p, b, c));
        return true;
    });
    star.center = total > 0 ? Vec3(star.center / (3 * total)) : p;
    const double norm = star.normal.norm();
    if (norm > 0) star.normal /= norm;
    return star;
}

bool keeps_faces(const WorkingMesh& mesh, int v, const Vec3& target, double worst) {
    const Vec3& p = mesh.point(v);
    return mesh.visit_star(v, [&](int h) {
        const Vec3 &b = mesh.point(mesh.to(h)), &c = mesh.point(mesh.apex(h));
        if (triangle_normal(p, b, c).dot(triangle_normal(target, b, c)) < kMaxTurn) return false;
        return cosine_of_smallest_angle(target, b, c) <= std::max(worst, kPoorCosine);
    });
}

}  // namespace

void smooth(WorkingMesh& mesh, const ReferenceSurface& reference, const EdgeTarget& target) {
    CrossingGuard guard(mesh, target.length);
    for (int v = 0; v < mesh.vertex_end(); ++v) {
        if (!mesh.is_vertex_alive(v) || !mesh.is_free(v)) continue;
        const Star star = measure_star(mesh, v);
        const double length = target.at(mesh, v);
        Vec3 move = star.center - mesh.point(v);
        // Twice the way to the area centre is about the way to the centre of the neighbours.
        move = 1.5 * (move - star.normal.dot(move) * star.normal);
        if (mesh.is_placed(v) && move.squaredNorm() < kRest * kRest * length * length) continue;
        for (int halving = 0; halving <= kMaxHalvings; ++halving, move *= 0.5) {
            const ReferencePoint there = reference.closest(mesh.point(v) + move, star.normal,
                                                           kReach * length, mesh.place(v));
            if (there.face < 0 || !keeps_faces(mesh, v, there.position, star.worst) ||
                !guard.allows_move(v, there.position))
                continue;
            mesh.set_point(v, there.position);
            mesh.set_place(v, there.face);
            guard.update_star(v);
            break;
        }
    }
}

}  // namespace fcn
