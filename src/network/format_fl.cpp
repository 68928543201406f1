// .fl feature lines: the number of polylines; per polyline its size and its vertices, from 0, that
// follow each other along mesh edges; a closed one repeats its first vertex. The numbers mean the
// vertices of the mesh that lies beside the file. Each polyline is an arc, unless none has more
// than two vertices: then the edges are chained.

#include <algorithm>

#include "geometry/mesh_curves.h"
#include "geometry/text_cursor.h"
#include "network/mesh_edges.h"
#include "network/network_formats.h"

namespace fcn {

EdgeSoup read_fl(std::string_view content, const std::string& source, const Mesh& mesh) {
    TextCursor in(content, source, '#');
    EdgeSoup soup;
    for (VertexHandle vertex : mesh.vertices()) soup.points.push_back(mesh.point(vertex));
    const std::int64_t point_count = static_cast<std::int64_t>(soup.points.size());
    const std::size_t count = in.count("the number of polylines", 4);
    std::size_t longest = 0;
    for (std::size_t line = 0; line < count; ++line) {
        const std::size_t size = in.count("the size of a polyline", 2);
        if (size < 2) in.fail("a polyline needs two vertices, has " + std::to_string(size));
        std::vector<int> indices;
        for (std::size_t k = 0; k < size; ++k) {
            const std::int64_t index = in.integer("a vertex index");
            if (index < 0 || index >= point_count)
                in.fail("vertex index " + std::to_string(index) +
                        " is out of range, the mesh has " + std::to_string(point_count) +
                        " vertices");
            const int vertex = static_cast<int>(index);
            if (!indices.empty() &&
                !mesh.find_halfedge(VertexHandle(indices.back()), VertexHandle(vertex)).is_valid())
                in.fail("vertices " + std::to_string(indices.back()) + " and " +
                        std::to_string(vertex) + " are not joined by a mesh edge (wrong mesh?)");
            indices.push_back(vertex);
        }
        soup.add_polyline(indices, static_cast<int>(line));
        longest = std::max(longest, size);
    }
    if (!in.peek().empty()) in.fail("more follows after the last polyline: " + shown(in.peek()));
    if (longest == 2)
        for (EdgeSoup::Edge& edge : soup.edges) edge.arc = -1;
    return soup;
}

std::string write_fl(const WrittenNetwork& network, const Mesh& mesh, const std::string& target) {
    return write_fl_curves(MeshEdgePaths(mesh, target).all(network));
}

}  // namespace fcn
