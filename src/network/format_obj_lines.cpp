// Wavefront OBJ line elements. Written: one "l a b" per edge, since some programs keep only the
// first edge of a longer line. Read: "l" of any length, corners "7", "7/2" or "-1". OBJ carries no
// arcs: they are chained again.

#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"
#include "network/network_formats.h"

namespace fcn {
namespace {

class ObjLines {
public:
    ObjLines(std::string_view content, const std::string& source) : in_(content, source, '#') {}

    EdgeSoup run() {
        bool has_lines = false;
        for (std::string_view word = in_.token(); !word.empty(); word = in_.token()) {
            if (word == "v") {
                soup_.points.push_back(in_.point_on_line("a vertex coordinate"));
            } else if (word == "l") {
                read_line();
                has_lines = true;
            }
            in_.skip_line();
        }
        if (!has_lines && !soup_.points.empty())
            in_.fail("no line elements ('l') among " + std::to_string(soup_.points.size()) +
                     " vertices: no curves in it");
        return std::move(soup_);
    }

private:
    void read_line() {
        std::vector<int> indices;
        for (std::string_view word = in_.token_on_line(); !word.empty(); word = in_.token_on_line())
            indices.push_back(corner(word));
        if (indices.size() < 2)
            in_.fail("a line element needs two vertices, has " + std::to_string(indices.size()));
        soup_.add_polyline(indices, -1);
    }

    int corner(std::string_view word) const {
        const std::string_view digits = word.substr(0, word.find('/'));
        const std::int64_t count = static_cast<std::int64_t>(soup_.points.size());
        std::int64_t index = in_.parse_integer(digits, "a vertex index");
        if (index < 0 && index >= -count) index += count + 1;
        if (index < 1 || index > count)
            in_.fail("vertex index " + std::string(digits) + " is out of range, " +
                     std::to_string(count) + " vertices so far");
        return static_cast<int>(index - 1);
    }

    TextCursor in_;
    EdgeSoup soup_;
};

}  // namespace

EdgeSoup read_obj_lines(std::string_view content, const std::string& source) {
    return ObjLines(content, source).run();
}

std::string write_obj_lines(const WrittenNetwork& network) {
    TextWriter out;
    out << "# feature curve network: " << network.arcs.size() << " arcs\n";
    for (const Vec3& point : network.points) out << "v " << point << '\n';
    for (const WrittenNetwork::Arc& arc : network.arcs)
        for (std::size_t k = 1; k < arc.points.size(); ++k)
            out << "l " << arc.points[k - 1] + 1 << ' ' << arc.points[k] + 1 << '\n';
    return out.take();
}

}  // namespace fcn
