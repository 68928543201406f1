// Polylines that run along mesh edges. A surface point is on a vertex or an edge if the barycentric
// coordinates of the other corners are nothing but rounding.

#include "network/mesh_edges.h"

#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr double kRounding = 1e-7;
constexpr double kOnSurface = 1e-6;  ///< in diagonals

std::string shown(const Vec3& p) {
    return "(" + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ", " + std::to_string(p[2]) +
           ")";
}

bool lies_on(const Mesh& mesh, const MeshPlace& place, EdgeHandle edge) {
    if (place.edge.is_valid()) return place.edge == edge;
    if (!place.vertex.is_valid()) return false;
    const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
    return place.vertex == mesh.from_vertex_handle(halfedge) ||
           place.vertex == mesh.to_vertex_handle(halfedge);
}

}  // namespace

MeshPlace place_of(const Mesh& mesh, const SurfacePoint& point) {
    MeshPlace place;
    if (point.face < 0 || point.face >= static_cast<int>(mesh.n_faces())) return place;
    const std::array<VertexHandle, 3> corners = face_vertices(mesh, FaceHandle(point.face));
    std::vector<VertexHandle> present;
    for (int k = 0; k < 3; ++k)
        if (point.barycentric[k] > kRounding) present.push_back(corners[k]);
    if (present.size() == 1) place.vertex = present[0];
    if (present.size() == 2)
        place.edge = mesh.edge_handle(mesh.find_halfedge(present[0], present[1]));
    return place;
}

EdgeHandle common_edge(const Mesh& mesh, const MeshPlace& a, const MeshPlace& b) {
    if (a.edge.is_valid()) return lies_on(mesh, b, a.edge) ? a.edge : EdgeHandle();
    if (b.edge.is_valid()) return lies_on(mesh, a, b.edge) ? b.edge : EdgeHandle();
    if (!a.vertex.is_valid() || !b.vertex.is_valid()) return EdgeHandle();
    const HalfedgeHandle halfedge = mesh.find_halfedge(a.vertex, b.vertex);
    return halfedge.is_valid() ? mesh.edge_handle(halfedge) : EdgeHandle();
}

MeshEdgePaths::MeshEdgePaths(const Mesh& mesh, std::string target)
    : mesh_(mesh),
      target_(std::move(target)),
      tolerance_(kOnSurface * bounding_box(mesh).diagonal()) {}

MeshPlace MeshEdgePaths::locate(const WrittenNetwork& network, int point) {
    const SurfacePoint& surface = network.surfaces[point];
    const Vec3& where = network.points[point];
    if (surface.face >= 0 && surface.face < static_cast<int>(mesh_.n_faces()) &&
        (position(mesh_, surface) - where).norm() <= tolerance_)
        return place_of(mesh_, surface);
    if (!queries_) queries_ = std::make_unique<SurfaceQueries>(mesh_);
    const ClosestPoint closest = queries_->closest(where);
    if (!(closest.distance <= tolerance_)) return MeshPlace();
    return place_of(mesh_, closest.surface);
}

std::vector<VertexHandle> MeshEdgePaths::vertices_along(const WrittenNetwork& network,
                                                        std::size_t arc) {
    const std::vector<int>& points = network.arcs[arc].points;
    const auto fail = [&](int point, const std::string& what) {
        throw InputError(target_ + ": arc " + std::to_string(arc) + " " + what + " near " +
                         shown(network.points[point]) +
                         "; this format holds curves along mesh edges only");
    };
    std::vector<VertexHandle> path;
    MeshPlace before;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const MeshPlace place = locate(network, points[k]);
        if (k == 0 && !place.vertex.is_valid()) fail(points[k], "does not start at a mesh vertex");
        if (k > 0 && !common_edge(mesh_, before, place).is_valid())
            fail(points[k], "leaves the mesh edges");
        before = place;
        if (!place.vertex.is_valid()) continue;
        // Back at the vertex it came from, by way of points inside an edge: not an edge.
        if (!path.empty() && path.back() == place.vertex) fail(points[k], "turns back in an edge");
        path.push_back(place.vertex);
    }
    if (!before.vertex.is_valid()) fail(points.back(), "does not end at a mesh vertex");
    return path;
}

std::vector<std::vector<int>> MeshEdgePaths::all(const WrittenNetwork& network) {
    std::vector<std::vector<int>> paths;
    for (std::size_t arc = 0; arc < network.arcs.size(); ++arc) {
        paths.emplace_back();
        for (const VertexHandle vertex : vertices_along(network, arc))
            paths.back().push_back(vertex.idx());
    }
    return paths;
}

}  // namespace fcn
