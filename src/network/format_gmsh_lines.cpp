// Gmsh .msh, text. Written: version 2.2, one two-node line element per edge, its elementary entity
// the arc's number from 1. Read: 2.2 and 4.1, line elements of any order (the nodes inside a
// higher-order line lie on the curve and are taken in), the elementary entity is the arc. Node
// numbers may have gaps.

#include <limits>
#include <unordered_map>

#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"
#include "network/network_formats.h"

namespace fcn {
namespace {

/// Nodes of a line element type (2 ends, then the inner ones in order); 0 for other elements.
int line_node_count(std::int64_t element_type) {
    switch (element_type) {
        case 1:
            return 2;
        case 8:
            return 3;
        case 26:
            return 4;
        case 27:
            return 5;
        case 28:
            return 6;
        default:
            return 0;
    }
}

class GmshLines {
public:
    GmshLines(std::string_view content, const std::string& source) : in_(content, source) {}

    EdgeSoup run() {
        if (in_.peek() != "$MeshFormat") in_.fail("the file does not begin with $MeshFormat");
        for (std::string_view word = in_.token(); !word.empty(); word = in_.token()) {
            if (word == "$MeshFormat") {
                read_format();
            } else if (word == "$Nodes") {
                is_version_4_ ? read_nodes_4() : read_nodes_2();
            } else if (word == "$Elements") {
                is_version_4_ ? read_elements_4() : read_elements_2();
            } else if (!word.starts_with("$")) {
                in_.fail("expected a section such as $Nodes, found " + shown(word));
            }
            skip_section();
        }
        if (soup_.edges.empty() && !soup_.points.empty())
            in_.fail("no line elements among " + std::to_string(soup_.points.size()) +
                     " nodes: no curves in it");
        return std::move(soup_);
    }

private:
    /// To the next section; what is left of the current one is of no interest.
    void skip_section() {
        while (!in_.peek().empty() && !in_.peek().starts_with("$")) in_.skip_line();
        if (in_.peek().starts_with("$End")) in_.token();
    }

    void read_format() {
        const std::string version(in_.token());
        if (version != "2.2" && version != "2" && version != "2.1" && version != "4.1")
            in_.fail("gmsh version " + shown(version) + " is not supported, save as 2.2 or 4.1");
        is_version_4_ = version == "4.1";
        if (in_.integer("the file type") != 0)
            in_.fail("binary gmsh is not supported, save as text");
    }

    void add_node(std::int64_t tag) {
        if (!index_of_.emplace(tag, static_cast<int>(soup_.points.size())).second)
            in_.fail("node " + std::to_string(tag) + " is there twice");
    }

    void read_position() { soup_.points.push_back(in_.point("a node coordinate")); }

    void read_nodes_2() {
        const std::size_t count = in_.count("the number of nodes", 8);
        for (std::size_t k = 0; k < count; ++k) {
            add_node(in_.integer("a node number"));
            read_position();
        }
    }

    void read_nodes_4() {
        const std::size_t block_count = in_.count("the number of node blocks", 8);
        in_.count("the number of nodes", 1);
        in_.skip_line();
        for (std::size_t b = 0; b < block_count; ++b) {
            in_.integer("an entity dimension");
            in_.integer("an entity tag");
            const bool is_parametric = in_.integer("the parametric flag") != 0;
            const std::size_t count = in_.count("the number of nodes in a block", 4);
            std::vector<std::int64_t> tags;
            for (std::size_t k = 0; k < count; ++k) tags.push_back(in_.integer("a node number"));
            for (std::int64_t tag : tags) {
                add_node(tag);
                read_position();
                if (is_parametric) in_.skip_line();
            }
        }
    }

    void read_elements_2() {
        const std::size_t count = in_.count("the number of elements", 4);
        for (std::size_t k = 0; k < count; ++k) {
            in_.integer("an element number");
            const int node_count = line_node_count(in_.integer_on_line("an element type"));
            if (node_count > 0) {
                const std::int64_t tag_count = in_.integer_on_line("the number of tags");
                if (tag_count < 0) in_.fail("the number of tags is negative");
                std::int64_t entity = 0;
                for (std::int64_t t = 0; t < tag_count; ++t) {
                    const std::int64_t tag = in_.integer_on_line("a tag");
                    if (t == 1) entity = tag;
                }
                read_line(node_count, entity);
            }
            in_.skip_line();
        }
    }

    void read_elements_4() {
        const std::size_t block_count = in_.count("the number of element blocks", 8);
        in_.count("the number of elements", 1);
        in_.skip_line();
        for (std::size_t b = 0; b < block_count; ++b) {
            in_.integer("an entity dimension");
            const std::int64_t entity = in_.integer("an entity tag");
            const int node_count = line_node_count(in_.integer("an element type"));
            const std::size_t count = in_.count("the number of elements in a block", 4);
            for (std::size_t k = 0; k < count; ++k) {
                in_.integer("an element number");
                if (node_count > 0) read_line(node_count, entity);
                in_.skip_line();
            }
        }
    }

    void read_line(int node_count, std::int64_t entity) {
        std::vector<int> nodes;
        for (int k = 0; k < node_count; ++k) {
            const std::int64_t tag = in_.integer_on_line("a node of a line element");
            const auto found = index_of_.find(tag);
            if (found == index_of_.end())
                in_.fail("a line element has node " + std::to_string(tag) +
                         ", which does not exist");
            nodes.push_back(found->second);
        }
        // Ends come first, then the inner nodes from the first end on.
        const int end = nodes[1];
        nodes.erase(nodes.begin() + 1);
        nodes.push_back(end);
        constexpr std::int64_t kLargest = std::numeric_limits<int>::max();
        if (entity > kLargest || entity < -kLargest)
            in_.fail("entity tag " + std::to_string(entity) + " is out of range");
        // A negative tag is the same curve in the other direction.
        soup_.add_polyline(nodes, static_cast<int>(entity < 0 ? -entity : entity));
    }

    TextCursor in_;
    EdgeSoup soup_;
    std::unordered_map<std::int64_t, int> index_of_;
    bool is_version_4_ = false;
};

}  // namespace

EdgeSoup read_gmsh_lines(std::string_view content, const std::string& source) {
    return GmshLines(content, source).run();
}

std::string write_gmsh_lines(const WrittenNetwork& network) {
    TextWriter out;
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << network.points.size() << '\n';
    for (std::size_t p = 0; p < network.points.size(); ++p)
        out << p + 1 << ' ' << network.points[p] << '\n';
    out << "$EndNodes\n$Elements\n" << network.edge_count() << '\n';
    std::size_t element = 0;
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        const std::vector<int>& points = network.arcs[a].points;
        for (std::size_t k = 1; k < points.size(); ++k)
            out << ++element << " 1 2 0 " << a + 1 << ' ' << points[k - 1] + 1 << ' '
                << points[k] + 1 << '\n';
    }
    out << "$EndElements\n";
    return out.take();
}

}  // namespace fcn
