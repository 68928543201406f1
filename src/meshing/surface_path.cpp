// Connecting two nearby surface points over the surface. The cut of the surface with a plane is the
// level set of a linear function: with every vertex strictly on one side (zero counts as positive)
// each face that is entered is left through exactly one other edge, so the walk cannot get stuck in
// degenerate positions; it ends at the target's faces, at a boundary, or where it strays. Where it
// strays (the plane meets another sheet first, the points are on a fold) the shortest path along
// mesh edges takes its place (Dijkstra 1959).
#include "meshing/surface_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

namespace fcn {
namespace {

constexpr double kSnapShare = 0.05;  ///< of the face's size
constexpr double kRounding = 1e-9;   ///< barycentric coordinates below this are zero
constexpr double kMaxStray = 3;      ///< a cut longer than this times the distance has strayed
constexpr int kMaxSteps = 100000;

SimplexPoint vertex_point(VertexHandle vertex) {
    SimplexPoint point;
    point.kind = SimplexPoint::Kind::Vertex;
    point.index = vertex.idx();
    return point;
}

SimplexPoint edge_point(EdgeHandle edge, double t) {
    SimplexPoint point;
    point.kind = SimplexPoint::Kind::Edge;
    point.index = edge.idx();
    point.t = t;
    return point;
}

bool contains(const std::vector<int>& sorted, int value) {
    return std::binary_search(sorted.begin(), sorted.end(), value);
}

/// One walk along the cut of a plane.
class PlaneWalk {
public:
    PlaneWalk(const Mesh& mesh, const Vec3& from, const Vec3& to, const Vec3& plane_normal,
              const std::vector<int>& target_faces)
        : mesh_(mesh),
          from_(from),
          normal_(plane_normal),
          target_faces_(target_faces),
          max_length_(kMaxStray * (to - from).norm()) {}

    bool is_crossed(HalfedgeHandle halfedge) const {
        return is_positive(mesh_.from_vertex_handle(halfedge)) !=
               is_positive(mesh_.to_vertex_handle(halfedge));
    }

    SimplexPoint crossing(HalfedgeHandle halfedge) const {
        const EdgeHandle edge = mesh_.edge_handle(halfedge);
        const HalfedgeHandle first = mesh_.halfedge_handle(edge, 0);
        const double a = height(mesh_.from_vertex_handle(first));
        const double b = height(mesh_.to_vertex_handle(first));
        return edge_point(edge, std::clamp(a / (a - b), 0.0, 1.0));
    }

    /// Leaves a face through `exit` and follows the cut; empty if it does not arrive.
    std::vector<SimplexPoint> follow(HalfedgeHandle exit, double& length) const {
        std::vector<SimplexPoint> path;
        Vec3 last = from_;
        length = 0;
        for (int step = 0; step < kMaxSteps; ++step) {
            path.push_back(crossing(exit));
            const Vec3 here = position(mesh_, path.back());
            length += (here - last).norm();
            last = here;
            const HalfedgeHandle entry = mesh_.opposite_halfedge_handle(exit);
            if (length > max_length_ || mesh_.is_boundary(entry)) return {};
            if (contains(target_faces_, mesh_.face_handle(entry).idx())) return path;
            const HalfedgeHandle next = mesh_.next_halfedge_handle(entry);
            exit = is_crossed(next) ? next : mesh_.next_halfedge_handle(next);
        }
        return {};
    }

private:
    double height(VertexHandle vertex) const { return normal_.dot(mesh_.point(vertex) - from_); }
    bool is_positive(VertexHandle vertex) const { return height(vertex) >= 0; }

    const Mesh& mesh_;
    Vec3 from_;
    Vec3 normal_;
    const std::vector<int>& target_faces_;
    double max_length_;
};

/// Whether the edge lies on the boundary of the point's star, seen from a face of the star.
bool touches(const Mesh& mesh, HalfedgeHandle halfedge, const SimplexPoint& point) {
    switch (point.kind) {
        case SimplexPoint::Kind::Vertex:
            return mesh.from_vertex_handle(halfedge).idx() == point.index ||
                   mesh.to_vertex_handle(halfedge).idx() == point.index;
        case SimplexPoint::Kind::Edge:
            return mesh.edge_handle(halfedge).idx() == point.index;
        case SimplexPoint::Kind::Face:
            return false;
    }
    return false;
}

Vec3 mean_normal(const Mesh& mesh, const std::vector<int>& faces) {
    Vec3 sum = Vec3::Zero();
    for (const int face : faces) sum += face_normal(mesh, FaceHandle(face));
    return sum;
}

std::vector<SimplexPoint> cut_path(const Mesh& mesh, const SimplexPoint& from,
                                   const SimplexPoint& to) {
    const Vec3 start = position(mesh, from), end = position(mesh, to);
    const std::vector<int> start_faces = incident_faces(mesh, from);
    const std::vector<int> target_faces = incident_faces(mesh, to);
    const Vec3 up = mean_normal(mesh, start_faces) + mean_normal(mesh, target_faces);
    const Vec3 plane_normal = (end - start).cross(up);
    if (!(plane_normal.norm() > 1e-6 * (end - start).norm())) return {};

    const PlaneWalk walk(mesh, start, end, plane_normal.normalized(), target_faces);
    std::vector<SimplexPoint> best;
    double best_length = std::numeric_limits<double>::infinity();
    for (const int face : start_faces) {
        for (const HalfedgeHandle exit : mesh.fh_range(FaceHandle(face))) {
            if (touches(mesh, exit, from) || !walk.is_crossed(exit)) continue;
            double length = 0;
            std::vector<SimplexPoint> path = walk.follow(exit, length);
            if (path.empty()) continue;
            length += (end - position(mesh, path.back())).norm();
            if (length < best_length) {
                best_length = length;
                best = std::move(path);
            }
        }
    }
    return best;
}

std::vector<VertexHandle> star_vertices(const Mesh& mesh, const SimplexPoint& point) {
    if (point.kind == SimplexPoint::Kind::Vertex) return {VertexHandle(point.index)};
    std::vector<VertexHandle> vertices;
    for (const int face : incident_faces(mesh, point))
        for (const VertexHandle vertex : face_vertices(mesh, FaceHandle(face)))
            if (std::find(vertices.begin(), vertices.end(), vertex) == vertices.end())
                vertices.push_back(vertex);
    return vertices;
}

struct Visit {
    double distance = std::numeric_limits<double>::infinity();
    VertexHandle parent;
};

/// Shortest path along edges; visits only as much of the mesh as it must.
std::optional<std::vector<SimplexPoint>> edge_path(const Mesh& mesh, const SimplexPoint& from,
                                                   const SimplexPoint& to) {
    const Vec3 start = position(mesh, from), end = position(mesh, to);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::map<int, Visit> visits;
    for (const VertexHandle vertex : star_vertices(mesh, from)) {
        const double distance = (mesh.point(vertex) - start).norm();
        visits[vertex.idx()] = {distance, VertexHandle()};
        queue.emplace(distance, vertex.idx());
    }
    std::map<int, double> targets;
    for (const VertexHandle vertex : star_vertices(mesh, to))
        targets[vertex.idx()] = (mesh.point(vertex) - end).norm();

    int best_target = -1;
    double best = std::numeric_limits<double>::infinity();
    while (!queue.empty() && queue.top().first < best) {
        const auto [distance, index] = queue.top();
        queue.pop();
        if (distance > visits[index].distance) continue;
        const auto target = targets.find(index);
        if (target != targets.end() && distance + target->second < best) {
            best = distance + target->second;
            best_target = index;
        }
        const VertexHandle here(index);
        for (const VertexHandle next : mesh.vv_range(here)) {
            const double through = distance + (mesh.point(next) - mesh.point(here)).norm();
            Visit& visit = visits[next.idx()];
            if (!(through < visit.distance)) continue;
            visit = {through, here};
            queue.emplace(through, next.idx());
        }
    }
    if (best_target < 0) return std::nullopt;
    std::vector<SimplexPoint> path;
    for (VertexHandle vertex(best_target); vertex.is_valid(); vertex = visits[vertex.idx()].parent)
        path.push_back(vertex_point(vertex));
    std::reverse(path.begin(), path.end());
    const auto is_end = [](const SimplexPoint& a, const SimplexPoint& b) {
        return a.kind == SimplexPoint::Kind::Vertex && b.kind == a.kind && a.index == b.index;
    };
    if (!path.empty() && is_end(path.front(), from)) path.erase(path.begin());
    if (!path.empty() && is_end(path.back(), to)) path.pop_back();
    return path;
}

}  // namespace

Vec3 position(const Mesh& mesh, const SimplexPoint& point) {
    if (point.kind == SimplexPoint::Kind::Vertex) return mesh.point(VertexHandle(point.index));
    if (point.kind == SimplexPoint::Kind::Edge) {
        const HalfedgeHandle halfedge = mesh.halfedge_handle(EdgeHandle(point.index), 0);
        return (1 - point.t) * mesh.point(mesh.from_vertex_handle(halfedge)) +
               point.t * mesh.point(mesh.to_vertex_handle(halfedge));
    }
    return position(mesh, SurfacePoint{point.index, point.barycentric});
}

std::vector<int> incident_faces(const Mesh& mesh, const SimplexPoint& point) {
    std::vector<int> faces;
    if (point.kind == SimplexPoint::Kind::Face) return {point.index};
    if (point.kind == SimplexPoint::Kind::Edge) {
        for (unsigned side = 0; side < 2; ++side) {
            const auto halfedge = mesh.halfedge_handle(EdgeHandle(point.index), side);
            if (!mesh.is_boundary(halfedge)) faces.push_back(mesh.face_handle(halfedge).idx());
        }
    } else {
        for (const FaceHandle face : mesh.vf_range(VertexHandle(point.index)))
            faces.push_back(face.idx());
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

bool share_face(const Mesh& mesh, const SimplexPoint& a, const SimplexPoint& b) {
    const std::vector<int> faces = incident_faces(mesh, a);
    for (const int face : incident_faces(mesh, b))
        if (contains(faces, face)) return true;
    return false;
}

SimplexPoint snap_to_simplex(const Mesh& mesh, const SurfacePoint& point, double tolerance) {
    const FaceHandle face(point.face);
    const auto vertices = face_vertices(mesh, face);
    const Vec3 here = position(mesh, point);
    std::array<double, 3> side{};  // opposite to each corner
    for (std::size_t i = 0; i < 3; ++i)
        side[i] = (mesh.point(vertices[(i + 2) % 3]) - mesh.point(vertices[(i + 1) % 3])).norm();
    const double size = std::min({side[0], side[1], side[2]});

    for (std::size_t i = 0; i < 3; ++i) {
        const double distance = (here - mesh.point(vertices[i])).norm();
        if (distance <= std::min(tolerance, kSnapShare * size) ||
            point.barycentric[static_cast<int>(i)] >= 1 - kRounding)
            return vertex_point(vertices[i]);
    }
    const double twice_area = 2 * face_area(mesh, face);
    std::size_t nearest = 3;
    double nearest_distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const double altitude = twice_area / side[i];
        const double weight = point.barycentric[static_cast<int>(i)];
        const double distance = weight * altitude;
        const bool is_near = distance <= std::min(tolerance, kSnapShare * altitude);
        if ((is_near || weight <= kRounding) && distance < nearest_distance) {
            nearest = i;
            nearest_distance = distance;
        }
    }
    if (nearest == 3) {
        SimplexPoint inside;
        inside.kind = SimplexPoint::Kind::Face;
        inside.index = point.face;
        inside.barycentric = point.barycentric;
        return inside;
    }
    const VertexHandle a = vertices[(nearest + 1) % 3], b = vertices[(nearest + 2) % 3];
    const EdgeHandle edge = mesh.edge_handle(mesh.find_halfedge(a, b));
    const HalfedgeHandle first = mesh.halfedge_handle(edge, 0);
    const Vec3 origin = mesh.point(mesh.from_vertex_handle(first));
    const Vec3 along = mesh.point(mesh.to_vertex_handle(first)) - origin;
    const double t = (here - origin).dot(along) / along.squaredNorm();
    if (t <= 1e-12) return vertex_point(mesh.from_vertex_handle(first));
    if (t >= 1 - 1e-12) return vertex_point(mesh.to_vertex_handle(first));
    return edge_point(edge, t);
}

std::optional<std::vector<SimplexPoint>> trace_path(const Mesh& mesh, const SimplexPoint& from,
                                                    const SimplexPoint& to) {
    if (share_face(mesh, from, to)) return std::vector<SimplexPoint>{};
    std::vector<SimplexPoint> path = cut_path(mesh, from, to);
    if (!path.empty()) return path;
    return edge_path(mesh, from, to);
}

}  // namespace fcn
