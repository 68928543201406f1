// Around each vertex counter-clockwise, from a separating edge to the next.
#include "meshing/vertex_sectors.h"

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::size_t corner(const Mesh& mesh, FaceHandle face, VertexHandle vertex) {
    const auto corners = face_vertices(mesh, face);
    return corners[0] == vertex ? 0 : (corners[1] == vertex ? 1 : 2);
}

/// The next halfedge out of the same vertex, counter-clockwise.
HalfedgeHandle next_around(const Mesh& mesh, HalfedgeHandle h) {
    return mesh.opposite_halfedge_handle(mesh.prev_halfedge_handle(h));
}

}  // namespace

VertexSectors vertex_sectors(const Mesh& mesh, const std::vector<bool>& is_separating) {
    VertexSectors result;
    result.of_corner.assign(mesh.n_faces(), {-1, -1, -1});
    const auto separates = [&](HalfedgeHandle h) {
        return is_separating[at(mesh.edge_handle(h).idx())];
    };
    for (const VertexHandle vertex : mesh.vertices()) {
        if (mesh.is_isolated(vertex)) continue;
        HalfedgeHandle start = mesh.halfedge_handle(vertex);
        if (!mesh.is_boundary(vertex)) {
            for (const HalfedgeHandle h : mesh.voh_range(vertex))
                if (separates(h)) start = h;
        } else if (mesh.is_boundary(start)) {
            start = next_around(mesh, start);  // the first face counter-clockwise
        }
        HalfedgeHandle h = start;
        result.vertex.push_back(vertex.idx());
        do {
            if (!mesh.is_boundary(h)) {
                if (h != start && separates(h)) result.vertex.push_back(vertex.idx());
                const FaceHandle face = mesh.face_handle(h);
                result.of_corner[at(face.idx())][corner(mesh, face, vertex)] = result.count() - 1;
            }
            h = next_around(mesh, h);
        } while (h != start);
    }
    return result;
}

}  // namespace fcn
