// Small angles that no triangle mesh with these curves is without.
#include "meshing/forced_angles.h"

#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

/// A halfedge out of the vertex at which the face's smallest angle is.
int sharpest_corner(const WorkingMesh& mesh, int face) {
    // It lies across from the shortest side.
    int shortest = 3 * face;
    double least = -1;
    for (int h = 3 * face; h < 3 * face + 3; ++h) {
        const double square = (mesh.point(mesh.to(h)) - mesh.point(mesh.from(h))).squaredNorm();
        if (least < 0 || square < least) {
            least = square;
            shortest = h;
        }
    }
    return WorkingMesh::prev(shortest);
}

/// Whether a corner has so little surface around it that of three triangles one is under 30
/// degrees.
bool is_spike(const WorkingMesh& mesh, int v) {
    if (!mesh.is_fixed(v) || mesh.is_resting(v) || mesh.is_cut(v) || mesh.is_on_boundary(v))
        return false;
    double angles = 0;
    return mesh.visit_star(v, [&](int h) {
        angles += angle_at(mesh.point(v), mesh.point(mesh.to(h)), mesh.point(mesh.apex(h)));
        return angles < kSpikeAngle;
    });
}

}  // namespace

bool is_between_curves(const WorkingMesh& mesh, int face) {
    const int corner = sharpest_corner(mesh, face);
    return mesh.is_marked(corner) && mesh.is_marked(WorkingMesh::prev(corner));
}

bool is_angle_forced(const WorkingMesh& mesh, int face) {
    return is_between_curves(mesh, face) || is_spike(mesh, mesh.from(sharpest_corner(mesh, face)));
}

}  // namespace fcn
