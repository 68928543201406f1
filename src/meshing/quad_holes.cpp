// A hole smaller than a quad comes back as the quad nearest to it left out, which keeps the
// topology of the input. The quad may not touch a boundary, or the mesh would be pinched there.
#include "meshing/quad_holes.h"

#include <algorithm>
#include <limits>

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Vec3 centre(const QuadMesh& mesh, const std::array<int, 4>& face) {
    Vec3 sum = Vec3::Zero();
    for (const int v : face) sum += mesh.points[at(v)];
    return sum / 4;
}

std::vector<bool> boundary_vertices(const QuadMesh& mesh) {
    std::vector<bool> is_boundary(mesh.points.size(), false);
    const std::vector<int> opposite = opposite_halfedges(mesh);
    for (std::size_t h = 0; h < opposite.size(); ++h) {
        if (opposite[h] >= 0) continue;
        is_boundary[at(mesh.faces[h / 4][h % 4])] = true;
        is_boundary[at(mesh.faces[h / 4][(h + 1) % 4])] = true;
    }
    return is_boundary;
}

}  // namespace

int open_holes(QuadMesh& mesh, const std::vector<Vec3>& places) {
    if (places.empty()) return 0;
    std::vector<bool> is_boundary = boundary_vertices(mesh);
    std::vector<bool> is_left_out(mesh.faces.size(), false);
    int opened = 0;
    for (const Vec3& place : places) {
        double nearest = std::numeric_limits<double>::max();
        std::size_t best = mesh.faces.size();
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const auto& face = mesh.faces[f];
            const double distance = (centre(mesh, face) - place).squaredNorm();
            if (distance < nearest &&
                std::none_of(face.begin(), face.end(), [&](int v) { return is_boundary[at(v)]; })) {
                nearest = distance;
                best = f;
            }
        }
        if (best == mesh.faces.size()) continue;
        is_left_out[best] = true;
        for (const int v : mesh.faces[best]) is_boundary[at(v)] = true;
        ++opened;
    }
    std::size_t kept = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        if (is_left_out[f]) continue;
        mesh.faces[kept] = mesh.faces[f];
        if (!mesh.face_labels.empty()) mesh.face_labels[kept] = mesh.face_labels[f];
        ++kept;
    }
    mesh.faces.resize(kept);
    if (!mesh.face_labels.empty()) mesh.face_labels.resize(kept);
    return opened;
}

}  // namespace fcn
