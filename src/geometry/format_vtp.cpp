// VTK .vtp (XML PolyData, text), written only: curves are line cells, faces are polygon cells. Cell
// data: curve (from 0; -1 of a face) and, where the mesh has labels, label (-1 of a line).

#include "geometry/mesh_curves.h"
#include "geometry/mesh_formats.h"
#include "geometry/text_writer.h"

namespace fcn {
namespace {

template <typename Write>
void write_array(TextWriter& out, const char* type, const char* name, Write write) {
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" format=\"ascii\">\n";
    write();
    out << "</DataArray>\n";
}

void write_cell_data(TextWriter& out, const LoadedMesh& loaded) {
    const std::size_t faces = loaded.mesh.n_faces();
    out << "<CellData>\n";
    write_array(out, "Int32", "curve", [&] {
        for (std::size_t curve = 0; curve < loaded.curves.size(); ++curve) out << curve << '\n';
        for (std::size_t face = 0; face < faces; ++face) out << "-1\n";
    });
    if (!loaded.face_labels.empty())
        write_array(out, "Int32", "label", [&] {
            for (std::size_t curve = 0; curve < loaded.curves.size(); ++curve) out << "-1\n";
            for (std::size_t face = 0; face < faces; ++face)
                out << label_of(loaded, static_cast<int>(face)) << '\n';
        });
    out << "</CellData>\n";
}

void write_lines(TextWriter& out, const LoadedMesh& loaded) {
    out << "<Lines>\n";
    write_array(out, "Int64", "connectivity", [&] {
        for (const std::vector<int>& curve : loaded.curves)
            for (const int vertex : curve) out << vertex << '\n';
    });
    write_array(out, "Int64", "offsets", [&] {
        std::size_t end = 0;
        for (const std::vector<int>& curve : loaded.curves) out << (end += curve.size()) << '\n';
    });
    out << "</Lines>\n";
}

void write_polygons(TextWriter& out, const Mesh& mesh) {
    out << "<Polys>\n";
    write_array(out, "Int64", "connectivity", [&] {
        for (const auto face : mesh.faces()) {
            const auto [a, b, c] = face_vertices(mesh, face);
            out << a.idx() << ' ' << b.idx() << ' ' << c.idx() << '\n';
        }
    });
    write_array(out, "Int64", "offsets", [&] {
        for (std::size_t face = 1; face <= mesh.n_faces(); ++face) out << 3 * face << '\n';
    });
    out << "</Polys>\n";
}

}  // namespace

std::string write_vtp(const LoadedMesh& loaded) {
    TextWriter out;
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\""
           " byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
           "<Piece NumberOfPoints=\""
        << loaded.mesh.n_vertices() << "\" NumberOfVerts=\"0\" NumberOfLines=\""
        << loaded.curves.size() << "\" NumberOfStrips=\"0\" NumberOfPolys=\""
        << loaded.mesh.n_faces() << "\">\n";
    write_cell_data(out, loaded);
    out << "<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\""
           " format=\"ascii\">\n";
    for (const auto vertex : loaded.mesh.vertices()) out << loaded.mesh.point(vertex) << '\n';
    out << "</DataArray>\n</Points>\n";
    write_lines(out, loaded);
    write_polygons(out, loaded.mesh);
    out << "</Piece>\n</PolyData>\n</VTKFile>\n";
    return out.take();
}

}  // namespace fcn
