// Quad meshes as files: OBJ, OFF, and VTU (XML, unstructured grid of VTK) with the cells' scaled
// Jacobians and labels, so that they can be coloured by them; lines carry 1 and -1 there.
#include "meshing/quad_files.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "geometry/errors.h"
#include "geometry/mesh_io.h"
#include "geometry/polygon_soup.h"
#include "geometry/text_writer.h"
#include "meshing/quad_shape.h"

namespace fcn {
namespace {

constexpr std::array<const char*, 3> kFormats{"obj", "off", "vtu"};

/// Without .gz, without the dot, lower case.
std::string format_of(std::filesystem::path path) {
    if (path.extension() == ".gz") path = path.stem();
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension.empty() ? extension : extension.substr(1);
}

std::string to_off(const QuadMesh& mesh) {
    TextWriter out;
    out << "OFF\n" << mesh.points.size() << ' ' << mesh.faces.size() << " 0\n";
    for (const Vec3& p : mesh.points) out << p << '\n';
    for (const auto& [a, b, c, d] : mesh.faces)
        out << "4 " << a << ' ' << b << ' ' << c << ' ' << d << '\n';
    return out.take();
}

std::string to_obj(const QuadMesh& mesh) {
    TextWriter out;
    for (const Vec3& p : mesh.points) out << "v " << p << '\n';
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        if (!mesh.face_labels.empty() && (f == 0 || mesh.face_labels[f] != mesh.face_labels[f - 1]))
            out << "g label_" << mesh.face_labels[f] << '\n';
        out << 'f';
        for (const int v : mesh.faces[f]) out << ' ' << v + 1;
        out << '\n';
    }
    for (const QuadFeatureEdge& edge : mesh.feature_edges)
        out << "l " << edge.from + 1 << ' ' << edge.to + 1 << '\n';
    return out.take();
}

/// A DataArray of one value per cell: quads first, then lines.
template <typename OfQuad, typename OfLine>
void write_array(TextWriter& out, const QuadMesh& mesh, const char* type, const char* name,
                 OfQuad of_quad, OfLine of_line) {
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" format=\"ascii\">\n";
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) of_quad(f);
    for (std::size_t e = 0; e < mesh.feature_edges.size(); ++e) of_line(e);
    out << "</DataArray>\n";
}

std::string to_vtu(const QuadMesh& mesh) {
    constexpr int kQuadCell = 9, kLineCell = 3;
    TextWriter out;
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\""
           " byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
           "<Piece NumberOfPoints=\""
        << mesh.points.size() << "\" NumberOfCells=\""
        << mesh.faces.size() + mesh.feature_edges.size() << "\">\n<CellData>\n";
    const auto put = [&out](auto value) { out << value << '\n'; };
    write_array(
        out, mesh, "Float64", "scaled_jacobian",
        [&](std::size_t f) {
            QuadCorners quad;
            for (std::size_t i = 0; i < 4; ++i)
                quad[i] = mesh.points[static_cast<std::size_t>(mesh.faces[f][i])];
            put(scaled_jacobian(quad));
        },
        [&](std::size_t) { put(1); });
    write_array(
        out, mesh, "Int32", "arc", [&](std::size_t) { put(-1); },
        [&](std::size_t e) { put(mesh.feature_edges[e].arc); });
    if (!mesh.face_labels.empty())
        write_array(
            out, mesh, "Int32", "label", [&](std::size_t f) { put(mesh.face_labels[f]); },
            [&](std::size_t) { put(-1); });
    out << "</CellData>\n<Points>\n<DataArray type=\"Float64\" Name=\"Points\""
           " NumberOfComponents=\"3\" format=\"ascii\">\n";
    for (const Vec3& p : mesh.points) out << p << '\n';
    out << "</DataArray>\n</Points>\n<Cells>\n";
    write_array(
        out, mesh, "Int64", "connectivity",
        [&](std::size_t f) {
            const auto& [a, b, c, d] = mesh.faces[f];
            out << a << ' ' << b << ' ' << c << ' ' << d << '\n';
        },
        [&](std::size_t e) {
            out << mesh.feature_edges[e].from << ' ' << mesh.feature_edges[e].to << '\n';
        });
    std::size_t end = 0;
    write_array(
        out, mesh, "Int64", "offsets", [&](std::size_t) { put(end += 4); },
        [&](std::size_t) { put(end += 2); });
    write_array(
        out, mesh, "UInt8", "types", [&](std::size_t) { put(kQuadCell); },
        [&](std::size_t) { put(kLineCell); });
    out << "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    return out.take();
}

void drop_unused_points(QuadMesh& mesh) {
    std::vector<int> number(mesh.points.size(), -1);
    for (const auto& face : mesh.faces)
        for (const int v : face) number[static_cast<std::size_t>(v)] = 0;
    std::size_t count = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] < 0) continue;
        number[v] = static_cast<int>(count);
        mesh.points[count++] = mesh.points[v];
    }
    mesh.points.resize(count);
    for (auto& face : mesh.faces)
        for (int& v : face) v = number[static_cast<std::size_t>(v)];
}

}  // namespace

std::string quads_to_text(const QuadMesh& mesh, const std::string& format) {
    if (format == "obj") return to_obj(mesh);
    if (format == "off") return to_off(mesh);
    if (format == "vtu") return to_vtu(mesh);
    throw InputError("quads: unknown format " + format + "; known are " + quad_extensions());
}

void write_quads(const std::filesystem::path& path, const QuadMesh& mesh) {
    if (!has_quad_extension(path))
        throw InputError(path.string() + ": no format for quads goes by this name; known are " +
                         quad_extensions());
    write_file_atomically(path, quads_to_text(mesh, format_of(path)));
}

bool has_quad_extension(const std::filesystem::path& path) {
    return std::find(kFormats.begin(), kFormats.end(), format_of(path)) != kFormats.end();
}

std::string quad_extensions() { return ".obj .off .vtu"; }

std::optional<QuadMesh> read_quads(const std::filesystem::path& path) {
    const PolygonSoup soup = read_polygons(path);
    QuadMesh mesh;
    mesh.points = soup.points;
    mesh.face_labels = soup.labels;
    for (std::size_t f = 0; f < soup.polygon_count(); ++f) {
        const std::size_t begin = soup.corner_begin[f];
        if (soup.corner_begin[f + 1] - begin != 4) return std::nullopt;
        mesh.faces.push_back({soup.corners[begin], soup.corners[begin + 1], soup.corners[begin + 2],
                              soup.corners[begin + 3]});
    }
    drop_unused_points(mesh);
    return mesh;
}

}  // namespace fcn
