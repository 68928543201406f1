// Gmsh .msh, text, versions 2.2 and 4.1: triangles and quads (of higher order: their corners). The
// physical group of an element is its label; without any group there are no labels, since the
// elementary entities of a CAD model also part smooth seams. Node numbers may have gaps.

#include <algorithm>
#include <cstdlib>
#include <map>
#include <unordered_map>

#include "geometry/mesh_curves.h"
#include "geometry/mesh_formats.h"
#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"

namespace fcn {

namespace {

/// Corners of a two-dimensional element type, 0 for other elements.
int corner_count_of(std::int64_t element_type) {
    switch (element_type) {
        case 2:   // 3-node triangle
        case 9:   // 6-node
        case 20:  // 9-node
        case 21:  // 10-node
            return 3;
        case 3:   // 4-node quadrangle
        case 10:  // 9-node
        case 16:  // 8-node
            return 4;
        default:
            return 0;
    }
}

class GmshReader {
public:
    GmshReader(std::string_view content, const std::string& source) : in_(content, source) {}

    PolygonSoup run() {
        bool has_format = false;
        for (std::string_view word = in_.token(); !word.empty(); word = in_.token()) {
            const std::string section(word);
            if (section == "$MeshFormat") {
                read_format();
                has_format = true;
            } else if (section == "$PhysicalNames") {
                read_physical_names();
            } else if (section == "$Entities" && is_version_4_) {
                read_entities();
            } else if (section == "$Nodes") {
                is_version_4_ ? read_nodes_4() : read_nodes_2();
            } else if (section == "$Elements") {
                is_version_4_ ? read_elements_4() : read_elements_2();
            } else if (section.starts_with("$") && !section.starts_with("$End")) {
                skip_section();
            } else {
                in_.fail("expected a section such as $Nodes, found " + shown(section));
            }
            finish_section(section);
            if (!has_format) in_.fail("the file does not begin with $MeshFormat");
        }
        set_names();
        return std::move(soup_);
    }

private:
    void read_format() {
        const std::string version(in_.token());
        const std::int64_t is_binary = in_.integer("the file type");
        in_.integer("the data size");
        if (version != "2.2" && version != "2" && version != "2.1" && version != "4.1") {
            in_.fail("gmsh version " + shown(version) + " is not supported, save as 2.2 or 4.1");
        }
        is_version_4_ = version == "4.1";
        if (is_binary != 0) in_.fail("binary gmsh is not supported, save as text");
    }

    void skip_section() {
        while (!in_.peek().empty() && !in_.peek().starts_with("$End")) in_.skip_line();
    }

    void finish_section(const std::string& section) {
        const std::string end = "$End" + section.substr(1);
        in_.expect(end);
    }

    void read_physical_names() {
        const std::size_t count = in_.count("the number of physical names", 5);
        for (std::size_t i = 0; i < count; ++i) {
            const std::int64_t dimension = in_.integer("a dimension");
            const std::int64_t tag = in_.integer_on_line("a physical group");
            std::string name(in_.rest_of_line());
            if (name.size() >= 2 && name.front() == '"' && name.back() == '"') {
                name = name.substr(1, name.size() - 2);
            }
            if (dimension == 2) names_[tag] = name;
        }
    }

    void add_node(std::int64_t tag, const Vec3& point) {
        if (!index_of_node_.emplace(tag, static_cast<int>(soup_.points.size())).second) {
            in_.fail("node " + std::to_string(tag) + " is given twice");
        }
        soup_.points.push_back(point);
    }

    Vec3 read_point() { return in_.point("a node coordinate"); }

    void read_nodes_2() {
        const std::size_t count = in_.count("the number of nodes", 8);
        for (std::size_t i = 0; i < count; ++i) {
            const std::int64_t tag = in_.integer("a node number");
            add_node(tag, read_point());
        }
    }

    void read_nodes_4() {
        const std::size_t block_count = in_.count("the number of node blocks", 8);
        const std::size_t node_count = in_.count("the number of nodes", 8);
        in_.integer("the smallest node number");
        in_.integer("the largest node number");
        std::vector<std::int64_t> tags;
        for (std::size_t block = 0; block < block_count; ++block) {
            const std::int64_t dimension = in_.integer("an entity's dimension");
            in_.integer("an entity's number");
            const bool is_parametric = in_.integer("the parametric flag") != 0;
            tags.resize(in_.count("the number of nodes in a block", 8));
            for (std::int64_t& tag : tags) tag = in_.integer("a node number");
            for (std::int64_t tag : tags) {
                add_node(tag, read_point());
                for (std::int64_t i = 0; is_parametric && i < std::min<std::int64_t>(dimension, 3);
                     ++i) {
                    in_.number("a node parameter");
                }
            }
        }
        if (soup_.points.size() != node_count) {
            in_.fail(std::to_string(node_count) + " nodes are announced, " +
                     std::to_string(soup_.points.size()) + " are given");
        }
    }

    void skip_numbers(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) in_.number("an entity's bounding box");
    }

    /// Of the geometry only the physical groups of surfaces matter.
    void read_entities() {
        std::size_t counts[4];
        for (std::size_t& count : counts) count = in_.count("the number of entities", 2);
        for (int dimension = 0; dimension < 4; ++dimension) {
            for (std::size_t i = 0; i < counts[dimension]; ++i) {
                const std::int64_t tag = in_.integer("an entity's number");
                skip_numbers(dimension == 0 ? 3 : 6);
                const std::size_t group_count = in_.count("the number of physical groups", 2);
                for (std::size_t g = 0; g < group_count; ++g) {
                    const std::int64_t group = in_.integer("a physical group");
                    if (dimension == 2 && g == 0) group_of_surface_[tag] = group;
                }
                if (dimension == 0) continue;
                const std::size_t boundary_count = in_.count("the number of boundary entities", 2);
                for (std::size_t b = 0; b < boundary_count; ++b) in_.integer("an entity's number");
            }
        }
    }

    void read_corners(int corner_count) {
        for (int corner = 0; corner < corner_count; ++corner) {
            const std::int64_t tag = in_.integer_on_line("a node number");
            const auto found = index_of_node_.find(tag);
            if (found == index_of_node_.end()) {
                in_.fail("node number " + std::to_string(tag) + " is not among the nodes");
            }
            soup_.corners.push_back(found->second);
        }
        soup_.close_polygon();
    }

    /// A negative group number means a reversed surface; the label is the group.
    void add_label(std::int64_t group) {
        const std::int64_t label = std::llabs(group);
        if (label != static_cast<int>(label)) in_.fail("a physical group is out of range");
        soup_.labels.push_back(static_cast<int>(label));
        has_group_ = has_group_ || label != 0;
    }

    void read_elements_2() {
        const std::size_t count = in_.count("the number of elements", 6);
        for (std::size_t i = 0; i < count; ++i) {
            in_.integer("an element number");
            const int corner_count = corner_count_of(in_.integer_on_line("an element type"));
            if (corner_count > 0) {
                const std::size_t tag_count = in_.count("the number of tags", 2);
                std::int64_t group = 0;
                for (std::size_t tag = 0; tag < tag_count; ++tag) {
                    const std::int64_t value = in_.integer_on_line("an element tag");
                    if (tag == 0) group = value;
                }
                read_corners(corner_count);
                add_label(group);
            }
            in_.skip_line();
        }
    }

    void read_elements_4() {
        const std::size_t block_count = in_.count("the number of element blocks", 8);
        const std::size_t element_count = in_.count("the number of elements", 4);
        in_.integer("the smallest element number");
        in_.integer("the largest element number");
        std::size_t seen = 0;
        for (std::size_t block = 0; block < block_count; ++block) {
            in_.integer("an entity's dimension");
            const std::int64_t entity = in_.integer("an entity's number");
            const int corner_count = corner_count_of(in_.integer("an element type"));
            const std::size_t count = in_.count("the number of elements in a block", 4);
            in_.skip_line();
            const auto group = group_of_surface_.find(entity);
            for (std::size_t i = 0; i < count; ++i) {
                in_.integer("an element number");
                if (corner_count > 0) {
                    read_corners(corner_count);
                    add_label(group == group_of_surface_.end() ? 0 : group->second);
                }
                in_.skip_line();
            }
            seen += count;
        }
        if (seen != element_count) {
            in_.fail(std::to_string(element_count) + " elements are announced, " +
                     std::to_string(seen) + " are given");
        }
    }

    void set_names() {
        if (!has_group_) {
            soup_.labels.clear();
            return;
        }
        // Names are listed by label; a huge group number must not make a huge list.
        constexpr std::int64_t kLargestNamed = 65535;
        for (const auto& [tag, name] : names_) {
            if (tag < 0 || tag > kLargestNamed) continue;
            soup_.label_names.resize(static_cast<std::size_t>(tag) + 1);
            soup_.label_names.back() = name;
        }
    }

    TextCursor in_;
    PolygonSoup soup_;
    bool is_version_4_ = false;
    bool has_group_ = false;
    std::unordered_map<std::int64_t, int> index_of_node_;
    std::map<std::int64_t, std::int64_t> group_of_surface_;
    std::map<std::int64_t, std::string> names_;
};

}  // namespace

PolygonSoup read_gmsh(std::string_view content, const std::string& source) {
    return GmshReader(content, source).run();
}

std::string write_gmsh(const LoadedMesh& loaded) {
    const Mesh& mesh = loaded.mesh;
    TextWriter out;
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    std::map<int, std::string> names;
    for (int label : loaded.face_labels) {
        const bool is_named = label > 0 &&
                              static_cast<std::size_t>(label) < loaded.label_names.size() &&
                              !loaded.label_names[static_cast<std::size_t>(label)].empty();
        if (is_named) names.try_emplace(label, label_name(loaded, label));
    }
    if (!names.empty()) {
        out << "$PhysicalNames\n" << names.size() << '\n';
        for (const auto& [label, name] : names) out << "2 " << label << " \"" << name << "\"\n";
        out << "$EndPhysicalNames\n";
    }
    out << "$Nodes\n" << mesh.n_vertices() << '\n';
    for (const auto vertex : mesh.vertices()) {
        out << vertex.idx() + 1 << ' ' << mesh.point(vertex) << '\n';
    }
    out << "$EndNodes\n$Elements\n" << mesh.n_faces() + curve_edge_count(loaded) << '\n';
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        const int label = label_of(loaded, face.idx());
        out << face.idx() + 1 << " 2 2 " << label << ' ' << (label > 0 ? label : 1) << ' '
            << a.idx() + 1 << ' ' << b.idx() + 1 << ' ' << c.idx() + 1 << '\n';
    }
    std::size_t element = mesh.n_faces();
    for_each_curve_edge(loaded, [&](std::size_t curve, int from, int to) {
        out << ++element << " 1 2 0 " << curve + 1 << ' ' << from + 1 << ' ' << to + 1 << '\n';
    });
    out << "$EndElements\n";
    return out.take();
}

}  // namespace fcn
