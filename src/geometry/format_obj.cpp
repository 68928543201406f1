// Wavefront OBJ: v and f (with negative, relative indices); g, o and usemtl together name the label
// of the faces that follow. A file with a single combination of them has no labels. Other
// statements (normals, texture, lines, curves) are skipped.

#include <map>

#include "geometry/mesh_curves.h"
#include "geometry/mesh_formats.h"
#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"

namespace fcn {

namespace {

class ObjReader {
public:
    ObjReader(std::string_view content, const std::string& source) : in_(content, source, '#') {}

    PolygonSoup run() {
        for (std::string_view word = in_.token(); !word.empty(); word = in_.token()) {
            if (word == "v") {
                soup_.points.push_back(in_.point_on_line("a vertex coordinate"));
            } else if (word == "f") {
                read_face();
            } else if (word == "g") {
                set_name(group_);
            } else if (word == "o") {
                set_name(object_);
            } else if (word == "usemtl") {
                set_name(material_);
            }
            in_.skip_line();
        }
        if (labels_.size() < 2) {
            soup_.labels.clear();
            soup_.label_names.clear();
        }
        return std::move(soup_);
    }

private:
    void set_name(std::string& name) {
        name = in_.rest_of_line();
        label_ = -1;
    }

    int label() {
        if (label_ >= 0) return label_;
        std::string name = object_;
        for (const std::string& part : {group_, material_}) {
            if (!name.empty() && !part.empty()) name += '/';
            name += part;
        }
        // Keyed by the name, so that what is written reads back the same.
        const auto [entry, is_new] = labels_.try_emplace(name, static_cast<int>(labels_.size()));
        if (is_new) soup_.label_names.push_back(name);
        return label_ = entry->second;
    }

    void read_face() {
        for (std::string_view corner = in_.token_on_line(); !corner.empty();
             corner = in_.token_on_line()) {
            const std::int64_t index =
                in_.parse_integer(corner.substr(0, corner.find('/')), "a vertex index");
            const auto count = static_cast<std::int64_t>(soup_.points.size());
            const std::int64_t zero_based = index > 0 ? index - 1 : count + index;
            if (index == 0 || zero_based < 0 || zero_based >= count) {
                in_.fail("vertex index " + std::to_string(index) + " is out of range, " +
                         std::to_string(count) + " vertices so far");
            }
            soup_.corners.push_back(static_cast<int>(zero_based));
        }
        soup_.close_polygon();
        soup_.labels.push_back(label());
    }

    TextCursor in_;
    PolygonSoup soup_;
    std::string object_, group_, material_;
    std::map<std::string, int> labels_;
    int label_ = -1;
};

}  // namespace

PolygonSoup read_obj(std::string_view content, const std::string& source) {
    return ObjReader(content, source).run();
}

std::string write_obj(const LoadedMesh& loaded) {
    const Mesh& mesh = loaded.mesh;
    TextWriter out;
    if (!loaded.units.empty()) out << "# units: " << loaded.units << '\n';
    for (const auto vertex : mesh.vertices()) out << "v " << mesh.point(vertex) << '\n';
    bool is_first = true;
    int current = 0;
    for (const auto face : mesh.faces()) {
        // Groups may be entered again, so the faces can keep their order.
        const int label = label_of(loaded, face.idx());
        if (!loaded.face_labels.empty() && (is_first || label != current)) {
            out << "g " << label_name(loaded, label) << '\n';
            current = label;
            is_first = false;
        }
        const auto [a, b, c] = face_vertices(mesh, face);
        out << "f " << a.idx() + 1 << ' ' << b.idx() + 1 << ' ' << c.idx() + 1 << '\n';
    }
    for_each_curve_edge(loaded, [&](std::size_t, int from, int to) {
        out << "l " << from + 1 << ' ' << to + 1 << '\n';
    });
    return out.take();
}

}  // namespace fcn
