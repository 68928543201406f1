// OFF, with the prefixes for texture, colour and normals (ST, C, N), whose extra numbers are
// skipped: coordinates come first on a vertex's line and corners first on a face's.

#include "geometry/mesh_formats.h"
#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"

namespace fcn {

namespace {

void read_header(TextCursor& in) {
    const std::string_view word = in.token();
    std::string_view kind = word;
    if (kind.starts_with("ST")) kind.remove_prefix(2);
    if (kind.starts_with("C")) kind.remove_prefix(1);
    if (kind.starts_with("N")) kind.remove_prefix(1);
    if (kind != "OFF") {
        in.fail("expected the word OFF, found " + shown(word) +
                (word.ends_with("OFF") ? " (only three-dimensional OFF is read)" : ""));
    }
    if (in.peek() == "BINARY") in.fail("binary OFF is not supported, save as text");
}

std::size_t skip_extras(TextCursor& in) {
    std::size_t count = 0;
    while (!in.token_on_line().empty()) ++count;
    return count;
}

void read_face(TextCursor& in, PolygonSoup& soup) {
    const std::size_t corner_count = in.count("the number of corners", 2);
    for (std::size_t i = 0; i < corner_count; ++i) {
        const std::int64_t index = in.integer("a vertex index");
        if (index < 0 || static_cast<std::size_t>(index) >= soup.points.size()) {
            in.fail("vertex index " + std::to_string(index) + " is out of range, there are " +
                    std::to_string(soup.points.size()) + " vertices");
        }
        soup.corners.push_back(static_cast<int>(index));
    }
    soup.close_polygon();
    in.skip_line();
}

}  // namespace

PolygonSoup read_off(std::string_view content, const std::string& source) {
    TextCursor in(content, source, '#');
    read_header(in);
    const std::size_t vertex_count = in.count("the number of vertices", 6);
    const std::size_t face_count = in.count("the number of faces", 2);
    in.skip_line();  // the number of edges, which some writers leave out
    PolygonSoup soup;
    soup.points.reserve(vertex_count);
    std::size_t extra_count = 0;
    for (std::size_t i = 0; i < vertex_count; ++i) {
        const double x = in.number("a vertex coordinate");
        const double y = in.number_on_line("a vertex coordinate");
        const double z = in.number_on_line("a vertex coordinate");
        soup.points.emplace_back(x, y, z);
        const std::size_t count = skip_extras(in);
        if (i == 0) extra_count = count;
        if (count != extra_count) {
            in.fail("this vertex has " + std::to_string(3 + count) + " numbers, those before " +
                    std::to_string(3 + extra_count));
        }
    }
    soup.corner_begin.reserve(face_count + 1);
    soup.corners.reserve(3 * face_count);
    for (std::size_t i = 0; i < face_count; ++i) read_face(in, soup);
    return soup;
}

std::string write_off(const LoadedMesh& loaded) {
    const Mesh& mesh = loaded.mesh;
    TextWriter out;
    out << "OFF\n";
    if (!loaded.units.empty()) out << "# units: " << loaded.units << '\n';
    out << mesh.n_vertices() << ' ' << mesh.n_faces() << " 0\n";
    for (const auto vertex : mesh.vertices()) out << mesh.point(vertex) << '\n';
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        out << "3 " << a.idx() << ' ' << b.idx() << ' ' << c.idx() << '\n';
    }
    return out.take();
}

}  // namespace fcn
