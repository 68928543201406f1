// Medit .mesh (text): Vertices, Triangles and Quadrilaterals with their reference numbers, which
// are labels unless all are the same. Other sections are walked over token by token until the next
// keyword, so that sections we do not know are no obstacle.

#include <algorithm>
#include <functional>

#include "geometry/mesh_curves.h"
#include "geometry/mesh_formats.h"
#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"

namespace fcn {

namespace {

void read_vertices(TextCursor& in, PolygonSoup& soup) {
    const std::size_t count = in.count("the number of vertices", 8);
    soup.points.reserve(soup.points.size() + count);
    for (std::size_t i = 0; i < count; ++i) {
        soup.points.push_back(in.point("a vertex coordinate"));
        in.number("a vertex reference");
    }
}

void read_polygons(TextCursor& in, PolygonSoup& soup, int corner_count) {
    const std::size_t count = in.count("the number of faces", 8);
    for (std::size_t i = 0; i < count; ++i) {
        for (int corner = 0; corner < corner_count; ++corner) {
            const std::int64_t index = in.integer("a vertex index");
            if (index < 1 || static_cast<std::size_t>(index) > soup.points.size()) {
                in.fail("vertex index " + std::to_string(index) + " is out of range, " +
                        std::to_string(soup.points.size()) + " vertices so far");
            }
            soup.corners.push_back(static_cast<int>(index - 1));
        }
        soup.close_polygon();
        const std::int64_t label = in.integer("a face reference");
        if (label != static_cast<int>(label)) in.fail("a face reference is out of range");
        soup.labels.push_back(static_cast<int>(label));
    }
}

/// Edges with the number of their curve, from 1, and those inside the surface as ridges. Not as
/// RequiredEdges: a remesher that reads them keeps the curves, but may move along them, and readers
/// that do not know the word give up.
void write_curves(TextWriter& out, const LoadedMesh& loaded) {
    std::vector<int> ridges;
    int count = 0;
    out << "Edges\n" << curve_edge_count(loaded) << '\n';
    for_each_curve_edge(loaded, [&](std::size_t curve, int from, int to) {
        out << from + 1 << ' ' << to + 1 << ' ' << curve + 1 << '\n';
        ++count;
        const HalfedgeHandle halfedge =
            loaded.mesh.find_halfedge(VertexHandle(from), VertexHandle(to));
        if (halfedge.is_valid() && !loaded.mesh.is_boundary(loaded.mesh.edge_handle(halfedge)))
            ridges.push_back(count);
    });
    if (!ridges.empty()) out << "Ridges\n" << ridges.size() << '\n';
    for (const int ridge : ridges) out << ridge << '\n';
    const std::vector<int> corners = curve_corners(loaded);
    if (!corners.empty()) out << "Corners\n" << corners.size() << '\n';
    for (const int corner : corners) out << corner + 1 << '\n';
}

}  // namespace

PolygonSoup read_medit(std::string_view content, const std::string& source) {
    TextCursor in(content, source, '#');
    PolygonSoup soup;
    in.expect("MeshVersionFormatted");
    in.integer("the format version");
    for (std::string_view word = in.token(); !word.empty() && word != "End"; word = in.token()) {
        if (word == "Dimension") {
            const std::int64_t dimension = in.integer("the dimension");
            if (dimension != 3) {
                in.fail("the dimension is " + std::to_string(dimension) + ", only 3 is read");
            }
        } else if (word == "Vertices") {
            read_vertices(in, soup);
        } else if (word == "Triangles") {
            read_polygons(in, soup, 3);
        } else if (word == "Quadrilaterals") {
            read_polygons(in, soup, 4);
        } else if (is_word(word)) {
            while (!in.peek().empty() && !is_word(in.peek())) in.token();
        } else {
            in.fail("expected a keyword, found " + shown(word));
        }
    }
    const bool is_uniform = std::adjacent_find(soup.labels.begin(), soup.labels.end(),
                                               std::not_equal_to<>()) == soup.labels.end();
    if (is_uniform) soup.labels.clear();
    return soup;
}

std::string write_medit(const LoadedMesh& loaded) {
    const Mesh& mesh = loaded.mesh;
    TextWriter out;
    out << "MeshVersionFormatted 2\nDimension 3\n";
    if (!loaded.units.empty()) out << "# units: " << loaded.units << '\n';
    out << "Vertices\n" << mesh.n_vertices() << '\n';
    for (const auto vertex : mesh.vertices()) out << mesh.point(vertex) << " 0\n";
    out << "Triangles\n" << mesh.n_faces() << '\n';
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        out << a.idx() + 1 << ' ' << b.idx() + 1 << ' ' << c.idx() + 1 << ' '
            << label_of(loaded, face.idx()) << '\n';
    }
    if (!loaded.curves.empty()) write_curves(out, loaded);
    out << "End\n";
    return out.take();
}

}  // namespace fcn
