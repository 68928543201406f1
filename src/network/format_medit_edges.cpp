// Medit .mesh: Edges with the arc's number, from 1, as reference; Ridges are all edges but those
// of boundaries, RequiredEdges those that are segments (one edge each in the mesh to be made),
// Corners the nodes with other than two arc ends. Read: Vertices and Edges; references are arc
// numbers. Other sections are walked over token by token until the next keyword.

#include <limits>

#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"
#include "network/network_formats.h"

namespace fcn {
namespace {

void read_vertices(TextCursor& in, EdgeSoup& soup) {
    const std::size_t count = in.count("the number of vertices", 8);
    soup.points.reserve(soup.points.size() + count);
    for (std::size_t k = 0; k < count; ++k) {
        soup.points.push_back(in.point("a vertex coordinate"));
        in.number("a vertex reference");
    }
}

int read_index(TextCursor& in, std::size_t point_count) {
    const std::int64_t index = in.integer("a vertex index");
    if (index < 1 || static_cast<std::uint64_t>(index) > point_count)
        in.fail("vertex index " + std::to_string(index) + " is out of range, " +
                std::to_string(point_count) + " vertices so far");
    return static_cast<int>(index - 1);
}

void read_edges(TextCursor& in, EdgeSoup& soup) {
    const std::size_t count = in.count("the number of edges", 6);
    soup.edges.reserve(soup.edges.size() + count);
    for (std::size_t k = 0; k < count; ++k) {
        EdgeSoup::Edge edge;
        edge.from = read_index(in, soup.points.size());
        edge.to = read_index(in, soup.points.size());
        const std::int64_t reference = in.integer("an edge reference");
        if (reference < 0 || reference > std::numeric_limits<int>::max())
            in.fail("edge reference " + std::to_string(reference) + " is out of range");
        edge.arc = static_cast<int>(reference);
        soup.edges.push_back(edge);
    }
}

}  // namespace

EdgeSoup read_medit_edges(std::string_view content, const std::string& source) {
    TextCursor in(content, source, '#');
    EdgeSoup soup;
    bool has_edges = false;
    in.expect("MeshVersionFormatted");
    in.integer("the format version");
    for (std::string_view word = in.token(); !word.empty() && word != "End"; word = in.token()) {
        if (word == "Dimension") {
            const std::int64_t dimension = in.integer("the dimension");
            if (dimension != 3)
                in.fail("the dimension is " + std::to_string(dimension) + ", only 3 is read");
        } else if (word == "Vertices") {
            read_vertices(in, soup);
        } else if (word == "Edges") {
            read_edges(in, soup);
            has_edges = true;
        } else if (is_word(word)) {
            while (!in.peek().empty() && !is_word(in.peek())) in.token();
        } else {
            in.fail("expected a keyword, found " + shown(word));
        }
    }
    if (!has_edges) in.fail("no Edges section: no curves in it");
    return soup;
}

std::string write_medit_edges(const WrittenNetwork& network) {
    std::vector<int> corners, ridges;
    for (std::size_t p = 0; p < network.points.size(); ++p)
        if (network.valences[p] != 0 && network.valences[p] != 2)
            corners.push_back(static_cast<int>(p));
    TextWriter out;
    out << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << network.points.size() << '\n';
    for (const Vec3& point : network.points) out << point << " 0\n";
    out << "Edges\n" << network.edge_count() << '\n';
    int edge = 0;
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        const WrittenNetwork::Arc& arc = network.arcs[a];
        for (std::size_t k = 1; k < arc.points.size(); ++k) {
            out << arc.points[k - 1] + 1 << ' ' << arc.points[k] + 1 << ' ' << a + 1 << '\n';
            ++edge;
            if (arc.kind != ArcKind::Boundary) ridges.push_back(edge);
        }
    }
    const auto section = [&](const char* name, std::size_t count) {
        if (count > 0) out << name << '\n' << count << '\n';
    };
    section("Ridges", ridges.size());
    for (int ridge : ridges) out << ridge << '\n';
    if (network.has_segments) {
        section("RequiredEdges", network.edge_count());
        for (int k = 1; k <= edge; ++k) out << k << '\n';
    }
    section("Corners", corners.size());
    for (int corner : corners) out << corner + 1 << '\n';
    out << "End\n";
    return out.take();
}

}  // namespace fcn
