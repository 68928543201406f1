// QuadWild's .sharp: a count, then one line "type,face,edge" each, type 0 concave, 1 convex; edge k
// of a face joins its corners k and k + 1. An interior edge is listed once for each of its faces.
// Corners count from the vertex that the face begins with in the mesh file. Some programs put
// blanks for commas; both are read. The format carries no arcs: edges are chained.

#include <algorithm>

#include "geometry/mesh_curves.h"
#include "geometry/text_cursor.h"
#include "network/mesh_edges.h"
#include "network/network_formats.h"

namespace fcn {

EdgeSoup read_sharp(std::string_view content, const std::string& source, const Mesh& mesh) {
    std::string blanks(content);
    std::replace(blanks.begin(), blanks.end(), ',', ' ');
    TextCursor in(blanks, source, '#');
    EdgeSoup soup;
    for (VertexHandle vertex : mesh.vertices()) soup.points.push_back(mesh.point(vertex));
    const auto bounded = [&](const char* what, std::int64_t end) {
        const std::int64_t value = in.integer(what);
        if (value < 0 || value >= end)
            in.fail(std::string(what) + " " + std::to_string(value) + " is out of range, must be " +
                    "below " + std::to_string(end));
        return static_cast<int>(value);
    };
    std::vector<bool> is_taken(mesh.n_edges(), false);
    const std::size_t count = in.count("the number of sharp edges", 6);
    for (std::size_t k = 0; k < count; ++k) {
        bounded("the type", 2);
        const FaceHandle face(bounded("face", static_cast<std::int64_t>(mesh.n_faces())));
        const int edge = bounded("edge", 3);
        const std::array<VertexHandle, 3> corners = face_vertices(mesh, face);
        const VertexHandle from = corners[edge], to = corners[(edge + 1) % 3];
        const int index = mesh.edge_handle(mesh.find_halfedge(from, to)).idx();
        if (is_taken[index]) continue;  // the other face's entry
        is_taken[index] = true;
        soup.edges.push_back({from.idx(), to.idx(), -1});
    }
    if (!in.peek().empty()) in.fail("more follows after the last edge: " + shown(in.peek()));
    return soup;
}

std::string write_sharp(const WrittenNetwork& network, const Mesh& mesh,
                        const std::string& target) {
    return write_sharp_curves(mesh, MeshEdgePaths(mesh, target).all(network));
}

}  // namespace fcn
