// Surface queries of the conformity checker: closest points with the checker's own tree, the
// normal of the surface at a witness, and plane sections, which give upper bounds of surface
// distances that are exact on planar parts. Independent of src/geometry's queries, so that an
// error there cannot hide a violation.

#include "adaptation/conformity_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adaptation/conformity_measures.h"

namespace fcn::conformity {

FlatMesh::FlatMesh(const Mesh& mesh) {
    points.reserve(mesh.n_vertices());
    for (const auto vertex : mesh.vertices()) points.push_back(mesh.point(vertex));
    faces.resize(mesh.n_faces());
    twins.assign(3 * mesh.n_faces(), -1);
    std::vector<int> slot(mesh.n_halfedges(), -1);
    for (const auto face : mesh.faces()) {
        auto halfedge = mesh.halfedge_handle(face);
        for (int k = 0; k < 3; ++k) {
            faces[face.idx()][k] = mesh.from_vertex_handle(halfedge).idx();
            slot[halfedge.idx()] = 3 * face.idx() + k;
            halfedge = mesh.next_halfedge_handle(halfedge);
        }
    }
    for (const auto halfedge : mesh.halfedges()) {
        if (slot[halfedge.idx()] < 0) continue;
        twins[slot[halfedge.idx()]] = slot[mesh.opposite_halfedge_handle(halfedge).idx()];
    }
    corner_offsets.assign(points.size() + 1, 0);
    for (const auto& face : faces) {
        for (const int vertex : face) ++corner_offsets[vertex + 1];
    }
    for (std::size_t v = 0; v < points.size(); ++v) corner_offsets[v + 1] += corner_offsets[v];
    corners.resize(3 * faces.size());
    std::vector<int> cursor(corner_offsets.begin(), corner_offsets.end() - 1);
    for (int f = 0; f < face_count(); ++f) {
        for (int k = 0; k < 3; ++k) corners[cursor[faces[f][k]]++] = 3 * f + k;
    }
}

Vec3 FlatMesh::cross(int face) const {
    const auto& [a, b, c] = faces[face];
    return (points[b] - points[a]).cross(points[c] - points[a]);
}

Vec3 closest_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = (b - a).cross(c - a);
    const double square = normal.squaredNorm();
    if (square > 0) {
        const double u = (c - b).cross(point - b).dot(normal);
        const double v = (a - c).cross(point - c).dot(normal);
        const double w = (b - a).cross(point - a).dot(normal);
        if (u >= 0 && v >= 0 && w >= 0) return point - (point - a).dot(normal) / square * normal;
    }
    Vec3 best = closest_on_segment(point, a, b);
    for (const Vec3& other : {closest_on_segment(point, b, c), closest_on_segment(point, c, a)}) {
        if ((other - point).squaredNorm() < (best - point).squaredNorm()) best = other;
    }
    return best;
}

std::vector<int> touching_faces(const FlatMesh& mesh, const Foot& foot) {
    constexpr double kRounding = 1e-9;
    std::vector<int> faces{foot.face};
    for (int k = 0; k < 3; ++k) {
        const int halfedge = 3 * foot.face + k;
        const Vec3& from = mesh.points[mesh.origin(halfedge)];
        const Vec3& to = mesh.points[mesh.target(halfedge)];
        const double tolerance = kRounding * (to - from).norm();
        if ((foot.position - from).norm() <= tolerance) {
            const int vertex = mesh.origin(halfedge);
            faces.clear();
            for (int i = mesh.corner_offsets[vertex]; i < mesh.corner_offsets[vertex + 1]; ++i) {
                faces.push_back(mesh.corners[i] / 3);
            }
            return faces;
        }
        const Vec3 closest = closest_on_segment(foot.position, from, to);
        if (mesh.twins[halfedge] >= 0 && (foot.position - closest).norm() <= tolerance) {
            faces.push_back(mesh.twins[halfedge] / 3);
        }
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

namespace {

std::vector<Box> face_boxes(const FlatMesh& mesh) {
    std::vector<Box> boxes(mesh.faces.size());
    for (int f = 0; f < mesh.face_count(); ++f) {
        for (const int vertex : mesh.faces[f]) boxes[f].add(mesh.points[vertex]);
    }
    return boxes;
}

Vec3 unit_normal(const FlatMesh& mesh, int face) {
    const Vec3 cross = mesh.cross(face);
    const double length = cross.norm();
    return length > 0 ? Vec3(cross / length) : Vec3::Zero();
}

Vec3 vertex_normal(const FlatMesh& mesh, int vertex) {
    Vec3 sum = Vec3::Zero();
    for (int i = mesh.corner_offsets[vertex]; i < mesh.corner_offsets[vertex + 1]; ++i) {
        const int corner = mesh.corners[i];
        const double angle = angle_at(mesh.points[vertex], mesh.points[mesh.target(corner)],
                                      mesh.points[mesh.apex(corner)]);
        sum += angle * unit_normal(mesh, corner / 3);
    }
    return sum;
}

Vec3 foot_normal(const FlatMesh& mesh, const Foot& foot) {
    Vec3 normal;
    if (foot.vertex >= 0) {
        normal = vertex_normal(mesh, foot.vertex);
    } else {
        normal = unit_normal(mesh, foot.face);
        const int twin = foot.halfedge >= 0 ? mesh.twins[foot.halfedge] : -1;
        if (twin >= 0) normal += unit_normal(mesh, twin / 3);
    }
    const double length = normal.norm();
    return length > 1e-12 ? Vec3(normal / length) : Vec3::Zero();
}

}  // namespace

Surface::Surface(const Mesh& mesh) : mesh_(mesh), tree_(face_boxes(mesh_)) {}

Foot Surface::project(const Vec3& point, double tolerance) const {
    const auto foot_on = [&](int face) {
        const auto& [a, b, c] = mesh_.faces[face];
        return closest_on_triangle(point, mesh_.points[a], mesh_.points[b], mesh_.points[c]);
    };
    Foot foot;
    foot.face = tree_.closest(point, [&](int face) { return (foot_on(face) - point).norm(); });
    if (foot.face < 0) return foot;
    foot.position = foot_on(foot.face);
    double nearest_edge = tolerance;
    for (int k = 0; k < 3; ++k) {
        const int halfedge = 3 * foot.face + k;
        const Vec3& from = mesh_.points[mesh_.origin(halfedge)];
        const Vec3& to = mesh_.points[mesh_.target(halfedge)];
        if (foot.vertex < 0 && (foot.position - from).norm() <= tolerance) {
            foot.vertex = mesh_.origin(halfedge);
        }
        const double distance =
            (closest_on_segment(foot.position, from, to) - foot.position).norm();
        if (distance <= nearest_edge) {
            nearest_edge = distance;
            foot.halfedge = halfedge;
        }
    }
    if (foot.vertex >= 0) foot.halfedge = -1;
    foot.normal = foot_normal(mesh_, foot);
    return foot;
}

double Surface::walk_section(const Foot& from, const Foot& to, const Vec3& plane_normal,
                             int first_exit, double limit) const {
    const auto side = [&](int vertex) {
        return (mesh_.points[vertex] - from.position).dot(plane_normal);
    };
    double length = 0;
    Vec3 position = from.position;
    int exit = first_exit;
    for (int step = 0; step < mesh_.face_count(); ++step) {
        const double side_origin = side(mesh_.origin(exit));
        const double side_target = side(mesh_.target(exit));
        const double t = std::clamp(side_origin / (side_origin - side_target), 0.0, 1.0);
        const Vec3 crossing =
            (1 - t) * mesh_.points[mesh_.origin(exit)] + t * mesh_.points[mesh_.target(exit)];
        length += (crossing - position).norm();
        position = crossing;
        const int entry = mesh_.twins[exit];
        if (entry < 0 || length > limit) break;
        if (entry / 3 == to.face) return length + (to.position - position).norm();
        // Exactly one of the two other edges joins the two sides (a vertex on the plane counts
        // as above it).
        const int next = FlatMesh::next(entry);
        const bool is_above_target = side(mesh_.origin(next)) >= 0;
        const bool is_above_apex = side(mesh_.target(next)) >= 0;
        exit = is_above_target != is_above_apex ? next : FlatMesh::previous(entry);
    }
    return std::numeric_limits<double>::infinity();
}

double Surface::section_length(const Foot& from, const Foot& to, double limit) const {
    const Vec3 direct = to.position - from.position;
    if (from.face == to.face) return direct.norm();
    Vec3 mean_normal = from.normal + to.normal;
    if (mean_normal.norm() < 1e-3) mean_normal = from.normal;
    const Vec3 plane_normal = direct.cross(mean_normal);
    double best = std::numeric_limits<double>::infinity();
    if (!(plane_normal.norm() > 0)) return best;
    const auto is_above = [&](int vertex) {
        return (mesh_.points[vertex] - from.position).dot(plane_normal) >= 0;
    };
    for (const int face : touching_faces(mesh_, from)) {
        if (face == to.face) return direct.norm();
        for (int exit = 3 * face; exit < 3 * face + 3; ++exit) {
            if (is_above(mesh_.origin(exit)) == is_above(mesh_.target(exit))) continue;
            const double shorter = std::min(limit, best);
            best = std::min(best, walk_section(from, to, plane_normal, exit, shorter));
        }
    }
    return best;
}

}  // namespace fcn::conformity
