// CGAL's .polylines.txt: per polyline "n x y z x y z ...", a closed one repeats its first point.
// Each polyline is an arc, unless none has more than two points: such a file is a heap of single
// edges, which are chained.

#include <algorithm>

#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"
#include "network/network_formats.h"

namespace fcn {

EdgeSoup read_polylines(std::string_view content, const std::string& source) {
    TextCursor in(content, source, '#');
    EdgeSoup soup;
    int count = 0;
    std::size_t longest = 0;
    while (!in.peek().empty()) {
        const std::size_t size = in.count("the number of points", 6);
        if (size < 2) in.fail("a polyline needs two points, has " + std::to_string(size));
        std::vector<int> indices;
        indices.reserve(size);
        for (std::size_t k = 0; k < size; ++k) {
            indices.push_back(static_cast<int>(soup.points.size()));
            soup.points.push_back(in.point("a coordinate"));
        }
        soup.add_polyline(indices, count++);
        longest = std::max(longest, size);
    }
    if (longest == 2)
        for (EdgeSoup::Edge& edge : soup.edges) edge.arc = -1;
    return soup;
}

std::string write_polylines(const WrittenNetwork& network) {
    TextWriter out;
    for (const WrittenNetwork::Arc& arc : network.arcs) {
        out << arc.points.size();
        for (int point : arc.points) out << ' ' << network.points[point];
        out << '\n';
    }
    // A file without content reads as a truncated one; a blank line says "no polylines".
    if (network.arcs.empty()) out << '\n';
    return out.take();
}

}  // namespace fcn
