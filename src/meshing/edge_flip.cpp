// The third step of incremental remeshing (Botsch, Kobbelt 2004, section 3): flips that even out
// valences. The target is six, and for vertices of curves, borders and corners what the angle
// around them holds of triangles. Departure: among flips that valences leave open the smallest
// angle decides, and a flip must not bend the surface.
#include <cmath>
#include <vector>

#include "meshing/crossing_guard.h"
#include "meshing/remeshing_steps.h"
#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kFlatness = 0.85;  ///< cosine between faces for which a flip keeps the shape
constexpr double kNeedleCosine = 0.999999;
constexpr double kPoorCosine = 0.94;  ///< 20 degrees: no flip for valence makes worse triangles
constexpr double kThird = 1.0471975511965976;

/// What a flip does to the two faces at h.
struct FlipShape {
    double before = 1, after = 1;  ///< cosine of the smallest angle
    bool keeps_surface = false;
};

FlipShape shape_of_flip(const WorkingMesh& mesh, int h) {
    const int t = mesh.twin(h);
    const Vec3 &a = mesh.point(mesh.from(h)), &b = mesh.point(mesh.to(h));
    const Vec3 &c = mesh.point(mesh.apex(h)), &d = mesh.point(mesh.apex(t));
    FlipShape shape;
    const double first = cosine_of_smallest_angle(a, b, c);
    const double second = cosine_of_smallest_angle(b, a, d);
    shape.before = std::max(first, second);
    shape.after = std::max(cosine_of_smallest_angle(d, c, a), cosine_of_smallest_angle(c, d, b));
    const Vec3 normal_first = triangle_normal(a, b, c), normal_second = triangle_normal(b, a, d);
    // A needle has no normal worth keeping: the other face's stands for the surface.
    const Vec3& normal = first < second ? normal_first : normal_second;
    const bool is_flat =
        shape.before > kNeedleCosine || normal_first.dot(normal_second) > kFlatness;
    shape.keeps_surface = is_flat && triangle_normal(d, c, a).dot(normal) > kFlatness &&
                          triangle_normal(c, d, b).dot(normal) > kFlatness;
    return shape;
}

/// Sum of the angles around a vertex.
double angle_around(const WorkingMesh& mesh, int v) {
    double sum = 0;
    mesh.visit_star(v, [&](int h) {
        sum += angle_at(mesh.point(v), mesh.point(mesh.to(h)), mesh.point(mesh.apex(h)));
        return true;
    });
    return sum;
}

/// Valence minus its target, per vertex of a face at an edge that does not rest.
std::vector<int> excess_valences(const WorkingMesh& mesh) {
    std::vector<int> excess(static_cast<std::size_t>(mesh.vertex_end()), 0);
    std::vector<bool> is_asked_for(excess.size(), false);
    for (int h = 0; h < mesh.halfedge_end(); ++h) {
        if (!mesh.is_first(h)) continue;
        ++excess[static_cast<std::size_t>(mesh.from(h))];
        ++excess[static_cast<std::size_t>(mesh.to(h))];
        if (mesh.is_edge_resting(h)) continue;
        for (const int side : {h, mesh.twin(h)})
            if (side >= 0)
                for (const int v : mesh.corners(WorkingMesh::face(side)))
                    is_asked_for[static_cast<std::size_t>(v)] = true;
    }
    for (int v = 0; v < mesh.vertex_end(); ++v) {
        if (!mesh.is_vertex_alive(v) || !is_asked_for[static_cast<std::size_t>(v)]) continue;
        int target = 6;
        if (!mesh.is_free(v))
            target = std::max(1, static_cast<int>(std::lround(angle_around(mesh, v) / kThird))) +
                     (mesh.is_on_boundary(v) ? 1 : 0);
        excess[static_cast<std::size_t>(v)] -= target;
    }
    return excess;
}

void flip(WorkingMesh& mesh, CrossingGuard& guard, int h) {
    mesh.flip(h);
    guard.update_face(WorkingMesh::face(h));
    guard.update_face(WorkingMesh::face(mesh.twin(h)));
}

}  // namespace

std::size_t flip_for_valence(WorkingMesh& mesh, const EdgeTarget& target) {
    CrossingGuard guard(mesh, target.length);
    std::vector<int> excess = excess_valences(mesh);
    const auto at = [&](int v) -> int& { return excess[static_cast<std::size_t>(v)]; };
    std::size_t count = 0;
    for (int h = 0; h < mesh.halfedge_end(); ++h) {
        if (!mesh.is_first(h) || mesh.twin(h) < 0 || mesh.is_marked(h) || mesh.is_edge_resting(h))
            continue;
        const int a = mesh.from(h), b = mesh.to(h), c = mesh.apex(h), d = mesh.apex(mesh.twin(h));
        // (x - 1)^2 - x^2 = 1 - 2 x, and the other way round.
        const int change = 4 - 2 * at(a) - 2 * at(b) + 2 * at(c) + 2 * at(d);
        if (change > 0) continue;
        const FlipShape shape = shape_of_flip(mesh, h);
        const bool is_better = change < 0 ? shape.after < std::max(shape.before, kPoorCosine)
                                          : shape.after < shape.before - 0.02;
        if (!is_better || !shape.keeps_surface || !mesh.can_flip(h) || !guard.allows_flip(h))
            continue;
        flip(mesh, guard, h);
        --at(a);
        --at(b);
        ++at(c);
        ++at(d);
        ++count;
    }
    return count;
}

std::size_t flip_for_angles(WorkingMesh& mesh, const EdgeTarget& target) {
    CrossingGuard guard(mesh, target.length);
    std::size_t count = 0;
    for (int h = 0; h < mesh.halfedge_end(); ++h) {
        if (!mesh.is_first(h) || mesh.twin(h) < 0 || mesh.is_marked(h) || mesh.is_edge_resting(h))
            continue;
        const FlipShape shape = shape_of_flip(mesh, h);
        if (shape.after >= shape.before - 1e-6 || !shape.keeps_surface || !mesh.can_flip(h) ||
            !guard.allows_flip(h))
            continue;
        flip(mesh, guard, h);
        ++count;
    }
    return count;
}

}  // namespace fcn
