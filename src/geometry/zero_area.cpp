// Faces without area: three different corners on one line, to the rounding error of the
// coordinates. Such a face has no normal, so it makes a false crease with each neighbour. Dropping
// it would open a crack along its longest edge, where the middle corner does not appear in the
// neighbour. Flipping that edge gives the neighbour the middle corner instead and changes the
// surface by rounding only. Passes repeat while any flip helps, because a strip of such faces
// unwinds from its ends. What is left (hardly any edge to flip, or the corner almost on another)
// is for the caller to drop or weld.

#include <algorithm>

#include "geometry/polygon_soup.h"

namespace fcn {

namespace {

bool has_no_area(const Vec3& a, const Vec3& b, const Vec3& c, double precision) {
    const double longest =
        std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    const double doubled_area = (b - a).cross(c - a).norm();
    const double magnitude =
        std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
    // Height <= rounding error of the coordinates; written so that no area at all also counts.
    return !(doubled_area > 4 * precision * magnitude * longest) || doubled_area == 0;
}

bool has_no_area(const Mesh& mesh, FaceHandle face, double precision) {
    const auto [a, b, c] = face_vertices(mesh, face);
    return has_no_area(mesh.point(a), mesh.point(b), mesh.point(c), precision);
}

HalfedgeHandle longest_halfedge(const Mesh& mesh, FaceHandle face) {
    HalfedgeHandle best;
    double best_length = -1;
    HalfedgeHandle halfedge = mesh.halfedge_handle(face);
    for (int i = 0; i < 3; ++i) {
        const double length = (mesh.point(mesh.to_vertex_handle(halfedge)) -
                               mesh.point(mesh.from_vertex_handle(halfedge)))
                                  .squaredNorm();
        if (length > best_length) {
            best_length = length;
            best = halfedge;
        }
        halfedge = mesh.next_halfedge_handle(halfedge);
    }
    return best;
}

/// Flips the face's longest edge if both faces then have area and still face the same way.
bool flip_away(Mesh& mesh, std::vector<int>& labels, FaceHandle face, double precision) {
    const HalfedgeHandle longest = longest_halfedge(mesh, face);
    const EdgeHandle edge = mesh.edge_handle(longest);
    if (mesh.is_boundary(edge) || !mesh.is_flip_ok(edge)) return false;
    const HalfedgeHandle opposite = mesh.opposite_halfedge_handle(longest);
    const FaceHandle neighbour = mesh.face_handle(opposite);
    const Vec3& a = mesh.point(mesh.from_vertex_handle(longest));
    const Vec3& b = mesh.point(mesh.to_vertex_handle(longest));
    const Vec3& middle = mesh.point(mesh.to_vertex_handle(mesh.next_halfedge_handle(longest)));
    const Vec3& far = mesh.point(mesh.to_vertex_handle(mesh.next_halfedge_handle(opposite)));
    if (has_no_area(a, far, middle, precision) || has_no_area(far, b, middle, precision)) {
        return false;
    }
    const Vec3 normal = face_normal(mesh, neighbour);
    if ((far - a).cross(middle - a).dot(normal) <= 0 ||
        (b - far).cross(middle - far).dot(normal) <= 0) {
        return false;
    }
    if (!labels.empty()) labels[face.idx()] = labels[neighbour.idx()];
    mesh.flip(edge);
    return true;
}

}  // namespace

std::vector<int> flip_zero_area_faces(Mesh& mesh, std::vector<int>& labels, double precision,
                                      RepairReport& report) {
    std::vector<int> pending;
    for (const auto face : mesh.faces()) {
        if (has_no_area(mesh, face, precision)) pending.push_back(face.idx());
    }
    for (bool is_progressing = true; is_progressing && !pending.empty();) {
        std::vector<int> left;
        for (int face : pending) {
            if (flip_away(mesh, labels, FaceHandle(face), precision)) {
                ++report.degenerate_face_count;
            } else {
                left.push_back(face);
            }
        }
        is_progressing = left.size() < pending.size();
        pending = std::move(left);
    }
    return pending;
}

}  // namespace fcn
