// Decides which format a mesh is in, by what it contains rather than by its name, and hands over to
// that format's reader or writer.

#include "geometry/mesh_io.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "geometry/errors.h"
#include "geometry/file_content.h"
#include "geometry/mesh_formats.h"
#include "geometry/text_cursor.h"

namespace fcn {

namespace fs = std::filesystem;

namespace {

struct Format {
    std::string_view extension;
    PolygonSoup (*read)(std::string_view, const std::string&);
    std::string (*write)(const LoadedMesh&);
};

constexpr std::array kFormats{
    Format{".off", read_off, write_off},
    Format{".obj", read_obj, write_obj},
};

std::string known_extensions() {
    std::string text;
    for (const Format& format : kFormats) {
        text += (text.empty() ? "" : " ") + std::string(format.extension);
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

PolygonSoup read_soup(std::string_view content, const std::string& source,
                      const std::string& extension) {
    const Format* format = format_of_extension(extension);
    if (format == nullptr) {
        throw InputError(source + ": unknown mesh format; known are " + known_extensions());
    }
    return format->read(content, source);
}

}  // namespace

LoadedMesh read_mesh(std::istream& in, const std::string& name, const ReadOptions& options) {
    const std::string content = read_content(in, name);
    const fs::path path(name);
    LoadedMesh result =
        mesh_from_polygons(read_soup(content, name, extension_of(path)), name, options);
    result.name = (path.extension() == ".gz" ? path.stem() : path).stem().string();
    return result;
}

LoadedMesh read_mesh(const fs::path& path, const ReadOptions& options) {
    const std::string name = path == "-" ? "standard input" : path.string();
    const std::string content = read_file(path);
    LoadedMesh result =
        mesh_from_polygons(read_soup(content, name, extension_of(path)), name, options);
    result.name = (path.extension() == ".gz" ? path.stem() : path).stem().string();
    return result;
}

void write_mesh(const fs::path& path, const LoadedMesh& mesh) {
    const Format* format = format_of_extension(extension_of(path));
    if (format == nullptr) {
        throw InputError(path.string() + ": unknown mesh format; known are " + known_extensions());
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
