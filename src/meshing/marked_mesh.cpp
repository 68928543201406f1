#include "meshing/marked_mesh.h"

namespace fcn {

void request_status(Mesh& mesh) {
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_halfedge_status();
    mesh.request_face_status();
}

MarkedMesh compacted(const MarkedMesh& marked) {
    const Mesh& mesh = marked.mesh;
    MarkedMesh result;
    std::vector<int> renumbered(mesh.n_vertices(), -1);
    for (const VertexHandle vertex : mesh.vertices()) {  // skips deleted ones
        const auto i = static_cast<std::size_t>(vertex.idx());
        renumbered[i] = result.mesh.add_vertex(mesh.point(vertex)).idx();
        result.is_fixed_vertex.push_back(marked.is_fixed_vertex[i]);
    }
    const auto vertex_of = [&](VertexHandle old) {
        return VertexHandle(renumbered[static_cast<std::size_t>(old.idx())]);
    };
    for (const FaceHandle face : mesh.faces()) {
        const auto v = face_vertices(mesh, face);
        result.mesh.add_face(vertex_of(v[0]), vertex_of(v[1]), vertex_of(v[2]));
        result.face_label.push_back(marked.face_label[static_cast<std::size_t>(face.idx())]);
    }
    result.edge_role.assign(result.mesh.n_edges(), EdgeRole::Free);
    for (const EdgeHandle edge : mesh.edges()) {
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const HalfedgeHandle there = result.mesh.find_halfedge(
            vertex_of(mesh.from_vertex_handle(h)), vertex_of(mesh.to_vertex_handle(h)));
        const auto i = static_cast<std::size_t>(result.mesh.edge_handle(there).idx());
        result.edge_role[i] = marked.edge_role[static_cast<std::size_t>(edge.idx())];
    }
    for (const int vertex : marked.station_vertex)
        result.station_vertex.push_back(vertex < 0 ? -1
                                                   : renumbered[static_cast<std::size_t>(vertex)]);
    return result;
}

}  // namespace fcn
