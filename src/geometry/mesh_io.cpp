// Decides which format a mesh is in, by what it contains rather than by its name, and hands over to
// that format's reader or writer.

#include "geometry/mesh_io.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "geometry/errors.h"
#include "geometry/file_content.h"
#include "geometry/mesh_curves.h"
#include "geometry/mesh_formats.h"
#include "geometry/text_cursor.h"

namespace fcn {

namespace fs = std::filesystem;

namespace {

using Reader = PolygonSoup (*)(std::string_view, const std::string&);

struct Format {
    std::string_view name;
    std::string_view extension;
    Reader read;  ///< null: written only
    std::string (*write)(const LoadedMesh&);
};

constexpr std::array kFormats{
    Format{"OFF", ".off", read_off, write_off},
    Format{"OBJ", ".obj", read_obj, write_obj},
    Format{"PLY", ".ply", read_ply, write_ply},
    Format{"STL", ".stl", read_stl_binary, write_stl},
    Format{"Medit", ".mesh", read_medit, write_medit},
    Format{"gmsh", ".msh", read_gmsh, write_gmsh},
    Format{"VTP", ".vtp", nullptr, write_vtp},
    Format{"sharp", ".sharp", nullptr,
           [](const LoadedMesh& mesh) { return write_sharp_curves(mesh.mesh, mesh.curves); }},
    Format{"fl", ".fl", nullptr,
           [](const LoadedMesh& mesh) { return write_fl_curves(mesh.curves); }},
};

std::string known_extensions(bool is_reading = true) {
    std::string text;
    for (const Format& format : kFormats) {
        if (is_reading && format.read == nullptr) continue;
        if (!text.empty()) text.push_back(' ');
        text.append(format.extension);
    }
    return text;
}

/// Lower-case extension, that under .gz if there is one.
std::string extension_of(fs::path path) {
    if (path.extension() == ".gz") path = path.stem();
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

const Format* format_of_extension(const std::string& extension) {
    const auto found = std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& format) {
        return format.extension == extension;
    });
    return found == kFormats.end() ? nullptr : &*found;
}

bool is_binary_stl(std::string_view content) {
    if (content.size() < 84) return false;
    std::uint64_t count = 0;
    for (int i = 3; i >= 0; --i) {
        count = count << 8 | static_cast<unsigned char>(content[80 + static_cast<std::size_t>(i)]);
    }
    return content.size() == 84 + 50 * count;
}

/// OBJ has no magic word: its first statement must be one of its own.
bool is_obj_statement(std::string_view word) {
    constexpr std::array<std::string_view, 14> kStatements{
        "v", "vn", "vt", "vp", "f", "g", "o", "s", "mtllib", "usemtl", "l", "p", "call", "usemap"};
    return std::find(kStatements.begin(), kStatements.end(), word) != kStatements.end();
}

bool is_off_word(std::string_view word) {
    return word.size() >= 3 && word.size() <= 8 && word.ends_with("OFF") &&
           word.find_first_not_of("STCN4nOF") == std::string_view::npos;
}

/// The reader that the content itself asks for; none if it does not say.
Reader reader_of_content(std::string_view content) {
    // A binary STL may begin with any word, so its exact size is asked first.
    if (is_binary_stl(content)) return read_stl_binary;
    const std::string_view word = TextCursor(content.substr(0, 1 << 16), "", '#').token();
    if (word == "ply") return read_ply;
    if (is_off_word(word)) return read_off;
    if (word == "$MeshFormat") return read_gmsh;
    if (word == "MeshVersionFormatted") return read_medit;
    if (word == "solid" || word == "SOLID") {
        // Binary files that begin with "solid" have no facet in readable text.
        const bool is_text = content.substr(0, 4096).find('\0') == std::string_view::npos;
        return is_text ? read_stl_text : read_stl_binary;
    }
    if (is_obj_statement(word)) return read_obj;
    return nullptr;
}

/// What a file that is no mesh of ours seems to be, for the message.
std::string kind_of_stranger(std::string_view content) {
    struct Magic {
        std::string_view beginning, kind;
    };
    constexpr std::array kStrangers{
        Magic{"ISO-10303-21", "a STEP model: mesh it first"},
        Magic{"DBRep_DrawableShape", "a BREP model: mesh it first"},
        Magic{"PK\3\4", "a ZIP archive (3MF?)"},
        Magic{"glTF", "binary glTF"},
        Magic{"version https://git-lfs", "a Git LFS pointer, not the file itself"},
        Magic{"<", "XML or HTML"},
        Magic{"{", "JSON"},
        Magic{"\x89PNG", "a PNG picture"},
        Magic{"%PDF", "a PDF document"},
        Magic{"\xff\xfe", "UTF-16 text: save as UTF-8"},
        Magic{"\xfe\xff", "UTF-16 text: save as UTF-8"},
        Magic{"# vtk", "a VTK file"},
        Magic{"BZh", "a bzip2 archive"},
        Magic{"\xfd"
              "7zXZ",
              "an xz archive"},
    };
    for (const Magic& magic : kStrangers) {
        if (content.starts_with(magic.beginning)) return std::string(magic.kind);
    }
    return {};
}

/// Length units stated in a comment or an STL header, such as "# units: mm".
std::string stated_units(std::string_view content) {
    std::string head(content.substr(0, 1024));
    std::transform(head.begin(), head.end(), head.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::size_t found = head.find("units");
    if (found == std::string::npos) return {};
    const std::size_t begin = head.find_first_not_of(" \t:=", found + 5);
    if (begin == std::string::npos) return {};
    const std::size_t end = head.find_first_not_of("abcdefghijklmnopqrstuvwxyz", begin);
    const std::string word = head.substr(begin, end == std::string::npos ? end : end - begin);
    constexpr std::array<std::string_view, 12> kUnits{
        "mm", "cm", "dm", "m", "km", "um", "in", "inch", "ft", "millimeters", "meters", "inches"};
    return std::find(kUnits.begin(), kUnits.end(), word) == kUnits.end() ? std::string() : word;
}

PolygonSoup read_soup(std::string_view content, const std::string& source,
                      const std::string& extension) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (content.starts_with(kByteOrderMark)) content.remove_prefix(kByteOrderMark.size());
    if (content.find_first_not_of(" \t\r\n") == std::string_view::npos) {
        throw InputError(source + ": the file is empty");
    }
    Reader read = reader_of_content(content);
    if (read == nullptr) {
        const std::string kind = kind_of_stranger(content);
        if (!kind.empty()) {
            throw InputError(source + ": not a mesh but " + kind + "; readable are " +
                             known_extensions());
        }
        const Format* format = format_of_extension(extension);
        if (format == nullptr || format->read == nullptr) {
            throw InputError(source + ": unknown mesh format, neither content nor extension is " +
                             "known; readable are " + known_extensions());
        }
        try {
            read = format->read;
            return read(content, source);
        } catch (const InputError& error) {
            throw InputError(std::string(error.what()) + " (the content does not look like " +
                             std::string(format->name) + ", tried because of the extension)");
        }
    }
    PolygonSoup soup = read(content, source);
    if (soup.polygon_count() == 0) {
        throw InputError(source + ": no faces (" + std::to_string(soup.points.size()) +
                         " vertices, perhaps a point cloud or a curve file)");
    }
    if (soup.units.empty()) soup.units = stated_units(content);
    return soup;
}

LoadedMesh load(std::string_view content, const std::string& source, const ReadOptions& options) {
    const fs::path path(source);
    LoadedMesh result =
        mesh_from_polygons(read_soup(content, source, extension_of(path)), source, options);
    result.name = (path.extension() == ".gz" ? path.stem() : path).stem().string();
    return result;
}

}  // namespace

LoadedMesh read_mesh(std::istream& in, const std::string& name, const ReadOptions& options) {
    return load(read_content(in, name), name, options);
}

LoadedMesh read_mesh(const fs::path& path, const ReadOptions& options) {
    return load(read_file(path), path == "-" ? "standard input" : path.string(), options);
}

PolygonSoup read_polygons(const fs::path& path) {
    return read_soup(read_file(path), path == "-" ? "standard input" : path.string(),
                     extension_of(path));
}

void write_mesh(const fs::path& path, const LoadedMesh& mesh) {
    const Format* format = format_of_extension(extension_of(path));
    if (format == nullptr) {
        throw InputError(path.string() + ": unknown mesh format; known are " +
                         known_extensions(false));
    }
    write_file_atomically(path, format->write(mesh));
}

std::vector<int> faces_by_label(const LoadedMesh& mesh) {
    std::vector<int> faces(mesh.mesh.n_faces());
    for (std::size_t i = 0; i < faces.size(); ++i) faces[i] = static_cast<int>(i);
    std::stable_sort(faces.begin(), faces.end(),
                     [&](int f, int g) { return label_of(mesh, f) < label_of(mesh, g); });
    return faces;
}

int label_of(const LoadedMesh& mesh, int face) {
    return mesh.face_labels.empty() ? 0 : mesh.face_labels[static_cast<std::size_t>(face)];
}

std::string label_name(const LoadedMesh& mesh, int label) {
    std::string name;
    if (label >= 0 && static_cast<std::size_t>(label) < mesh.label_names.size()) {
        name = mesh.label_names[static_cast<std::size_t>(label)];
    }
    if (name.empty()) name = "label_" + std::to_string(label);
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == '"' || c == '#'; },
        '_');
    return name;
}

}  // namespace fcn
