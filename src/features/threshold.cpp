// The plain threshold on dihedral angles, for who wants just that, and to compare with. Normals are
// not normalised: an angle exceeds the threshold if the normals' product falls below its cosine
// times their lengths, which is compared squared, signs kept. Every face's normal is computed once,
// not once an edge, from where the mesh keeps its points.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "features/features.h"
#include "geometry/errors.h"

namespace fcn {
namespace {

double signed_square(double x) { return x * std::abs(x); }

}  // namespace

std::vector<bool> edges_above(const Mesh& mesh, double angle) {
    if (!(angle > 0 && angle <= std::numbers::pi))
        throw InputError("sharp edges: angle must lie in (0, 180] degrees, got " +
                         std::to_string(angle * 180 / std::numbers::pi));
    struct Normal {
        Vec3 vector;
        double square;
    };
    const Vec3* points = mesh.points();
    std::vector<Normal> normals(mesh.n_faces());
    for (std::size_t f = 0; f < normals.size(); ++f) {
        const HalfedgeHandle first = mesh.halfedge_handle(FaceHandle(static_cast<int>(f)));
        const HalfedgeHandle second = mesh.next_halfedge_handle(first);
        const Vec3& a = points[mesh.to_vertex_handle(first).idx()];
        const Vec3& b = points[mesh.to_vertex_handle(second).idx()];
        const Vec3& c = points[mesh.to_vertex_handle(mesh.next_halfedge_handle(second)).idx()];
        const Vec3 cross = (b - a).cross(c - a);
        normals[f] = {cross, cross.squaredNorm()};
    }
    const double limit = signed_square(std::cos(angle));
    std::vector<bool> is_above(mesh.n_edges(), false);
    for (std::size_t e = 0; e < is_above.size(); ++e) {
        const HalfedgeHandle h = mesh.halfedge_handle(EdgeHandle(static_cast<int>(e)), 0);
        const int f = mesh.face_handle(h).idx();
        const int g = mesh.face_handle(mesh.opposite_halfedge_handle(h)).idx();
        if (f < 0 || g < 0) continue;
        const double squares = normals[f].square * normals[g].square;
        const double dot = normals[f].vector.dot(normals[g].vector);
        if (squares > 0 && signed_square(dot) <= limit * squares) is_above[e] = true;
    }
    return is_above;
}

std::vector<int> patches_between(const Mesh& mesh, const std::vector<bool>& is_marked_edge) {
    // A union-find forest whose roots are the lowest faces of their trees.
    std::vector<int> parent(mesh.n_faces());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int f) {
        while (parent[f] != f) f = parent[f] = parent[parent[f]];
        return f;
    };
    for (std::size_t e = 0; e < is_marked_edge.size(); ++e) {
        if (is_marked_edge[e]) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(EdgeHandle(static_cast<int>(e)), 0);
        const int f = mesh.face_handle(h).idx();
        const int g = mesh.face_handle(mesh.opposite_halfedge_handle(h)).idx();
        if (f < 0 || g < 0) continue;
        const int first = root(f), second = root(g);
        parent[std::max(first, second)] = std::min(first, second);
    }
    int count = 0;
    for (int f = 0; f < static_cast<int>(parent.size()); ++f)
        parent[f] = parent[f] == f ? count++ : parent[parent[f]];
    return parent;
}

}  // namespace fcn
