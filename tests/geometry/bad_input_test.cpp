#include <gtest/gtest.h>

#include <sstream>

#include "geometry/errors.h"
#include "geometry/file_content.h"
#include "geometry/mesh_io.h"

namespace fcn {
namespace {

struct BadInput {
    const char* label;
    const char* name;
    std::string content;
    /// Both must stand in the message.
    const char* where;
    const char* what;
};

std::string stl_header(int facet_count) {
    std::string bytes(80, 'x');
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(facet_count >> (8 * i) & 0xff);
    return bytes;
}

const std::string kPlyHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kGmshHead = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string kGmshNodes = "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n";
const std::string kMeditHead = "MeshVersionFormatted 2\nDimension 3\n";

std::vector<BadInput> bad_inputs() {
    return {
        {"empty", "a.off", "", "a.off", "empty"},
        {"blank", "a.obj", " \n\n\t", "a.obj", "empty"},
        {"unknown", "a.xyz", "hello", "a.xyz", "unknown mesh format"},
        {"step", "a.stl", "ISO-10303-21;\nHEADER;", "a.stl", "STEP"},
        {"zip", "a.obj", "PK\3\4....", "a.obj", "ZIP"},
        {"html", "a.ply", "<!DOCTYPE html><html>", "a.ply", "HTML"},
        {"lfs pointer", "a.off", "version https://git-lfs.github.com/spec/v1\n", "a.off", "LFS"},
        {"utf-16", "a.off", std::string("\xff\xfeO\0F\0F\0", 8), "a.off", "UTF-16"},
        {"wrong extension", "a.ply", "8 12\n0 0 0\n", "a.ply", "does not look like PLY"},
        {"gzip cut short", "a.off.gz", compress("OFF\n3 1 0\n").substr(0, 15), "a.off.gz",
         "truncated"},
        {"gzip damaged", "a.off.gz", compress("OFF\n3 1 0\n").substr(0, 10) + "xxxxxxxxxxxxxxx",
         "a.off.gz", "gzip"},

        {"off without counts", "a.off", "OFF\n", "a.off:2", "the number of vertices"},
        {"off counts too big", "a.off", "OFF\n4000000000 1 0\n0 0 0\n", "a.off:2", "truncated"},
        {"off negative count", "a.off", "OFF\n-3 1 0\n", "a.off:2", "negative"},
        {"off nan", "a.off", "OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "a.off:4",
         "not finite"},
        {"off inf", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 -inf\n0 1 0\n3 0 1 2\n", "a.off:4",
         "not finite"},
        {"off overflow", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 1e999\n0 1 0\n3 0 1 2\n", "a.off:4",
         "not finite"},
        {"off huge", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 1e99\n0 1 0\n3 0 1 2\n", "a.off",
         "larger than"},
        {"off word", "a.off", "OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n", "a.off:4", "'x'"},
        {"off comma", "a.off", "OFF\n3 1 0\n0 0 0\n1 0,5 0\n0 1 0\n3 0 1 2\n", "a.off:4", "'0,5'"},
        {"off index", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "a.off:6",
         "out of range"},
        {"off negative index", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "a.off:6",
         "out of range"},
        {"off index of 2^32", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 4294967296\n",
         "a.off:6", "out of range"},
        {"off cut short", "a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "a.off:7", "ends"},
        {"off cut in a face", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1", "a.off:6",
         "a vertex index"},
        {"off missing coordinate", "a.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "a.off:4",
         "a vertex coordinate"},
        {"off uneven", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0 7\n0 1 0\n3 0 1 2\n", "a.off:4",
         "4 numbers"},
        {"off binary", "a.off", "OFF BINARY\n", "a.off:1", "binary"},
        {"off of four dimensions", "a.off", "4OFF\n1 1 1\n", "a.off:1", "three-dimensional"},
        {"off without faces", "a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "a.off", "no faces"},
        {"off flat", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n", "a.off", "area"},
        {"off large polygon", "a.off",
         [] {
             std::string text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n30000";
             for (int i = 0; i < 30000; ++i) text += " " + std::to_string(i % 3);
             return text;
         }(),
         "a.off", "30000 corners"},

        {"obj index zero", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "a.obj:4",
         "out of range"},
        {"obj index too large", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "a.obj:4",
         "out of range"},
        {"obj relative index", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n", "a.obj:4",
         "out of range"},
        {"obj face word", "a.obj", "v 0 0 0\nf one two three\n", "a.obj:2", "'one'"},
        {"obj short vertex", "a.obj", "v 0 0\n", "a.obj:1", "a vertex coordinate"},
        {"obj only points", "a.obj", "v 0 0 0\nv 1 0 0\n", "a.obj", "no faces"},
        {"obj nan", "a.obj", "v 0 0 NaN\n", "a.obj:1", "not finite"},

        {"ply without end", "a.ply", "ply\nformat ascii 1.0\n", "a.ply:3", "end_header"},
        {"ply without format", "a.ply", "ply\nend_header\n", "a.ply", "format"},
        {"ply encoding", "a.ply", "ply\nformat utf8 1.0\n", "a.ply:2", "'utf8'"},
        {"ply type", "a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty long x\n",
         "a.ply:4", "'long'"},
        {"ply floating list", "a.ply",
         "ply\nformat ascii 1.0\nelement face 1\nproperty list float int i\n", "a.ply:4",
         "floating"},
        {"ply early property", "a.ply", "ply\nformat ascii 1.0\nproperty float x\n", "a.ply:3",
         "before the first element"},
        {"ply without z", "a.ply",
         "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
         "end_header\n0 0\n",
         "a.ply", "x, y and z"},
        {"ply without corners", "a.ply",
         "ply\nformat ascii 1.0\nelement face 1\nproperty int label\nend_header\n1\n", "a.ply",
         "vertex_indices"},
        {"ply cut short", "a.ply", kPlyHeader + "0 0 0\n1 0 0\n0 1", "a.ply:12", "a coordinate"},
        {"ply index", "a.ply", kPlyHeader + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "a.ply:13",
         "out of range"},
        {"ply list too long", "a.ply", kPlyHeader + "0 0 0\n1 0 0\n0 1 0\n99 0 1 2\n", "a.ply:13",
         "99 list items"},
        {"ply binary cut short", "a.ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
         "property float y\nproperty float z\nend_header\n0123456789",
         "a.ply", "only 10 bytes"},
        {"ply binary nan", "a.ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
         "property float y\nproperty float z\nend_header\n" +
             std::string(12, '\xff'),
         "a.ply", "not finite"},
        {"ply huge count", "a.ply",
         "ply\nformat ascii 1.0\nelement vertex 999999999999\nproperty float x\nproperty float y\n"
         "property float z\nend_header\n0 0 0\n",
         "a.ply", "announced"},

        {"stl too short", "a.stl", "x", "a.stl", "84 bytes"},
        {"stl binary cut short", "a.stl", stl_header(2) + std::string(60, '\0'), "a.stl",
         "2 facets needs 184 bytes"},
        {"stl binary huge count", "a.stl", stl_header(-1), "a.stl", "4294967295 facets"},
        {"stl binary nan", "a.stl", stl_header(1) + std::string(50, '\xff'), "a.stl: facet 0",
         "not finite"},
        {"stl text cut short", "a.stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
         "a.stl:5", "'vertex'"},
        {"stl text without end", "a.stl", "solid s\n", "a.stl:2", "endsolid"},
        {"stl text word", "a.stl", "solid s\nfacet normal 0 0 1\ninner loop\n", "a.stl:3",
         "'inner'"},
        {"stl text without facets", "a.stl", "solid s\nendsolid s\n", "a.stl", "no faces"},

        {"medit of two dimensions", "a.mesh", "MeshVersionFormatted 2\nDimension 2\n", "a.mesh:2",
         "only 3"},
        {"medit index", "a.mesh", kMeditHead + "Vertices 1\n0 0 0 0\nTriangles 1\n1 1 2 0\nEnd\n",
         "a.mesh:6", "out of range"},
        {"medit count", "a.mesh", kMeditHead + "Vertices 1000\n0 0 0 0\n", "a.mesh:3", "truncated"},
        {"medit without keyword", "a.mesh", kMeditHead + "1 2 3\n", "a.mesh:3", "a keyword"},
        {"medit only volume", "a.mesh", kMeditHead + "Vertices 1\n0 0 0 0\nTetrahedra 0\nEnd\n",
         "a.mesh", "no faces"},

        {"gmsh binary", "a.msh", "$MeshFormat\n2.2 1 8\n", "a.msh:2", "binary"},
        {"gmsh version", "a.msh", "$MeshFormat\n3.0 0 8\n$EndMeshFormat\n", "a.msh:2", "'3.0'"},
        {"gmsh section", "a.msh", kGmshHead + "Nodes\n", "a.msh:4", "'Nodes'"},
        {"gmsh section end", "a.msh", kGmshHead + "$Nodes\n0\n$EndElements\n", "a.msh:6",
         "'$EndNodes'"},
        {"gmsh node twice", "a.msh", kGmshHead + "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n",
         "a.msh:7", "twice"},
        {"gmsh unknown node", "a.msh",
         kGmshHead + kGmshNodes + "$Elements\n1\n1 2 2 0 1 1 2 4\n$EndElements\n", "a.msh:12",
         "node number 4"},
        {"gmsh short element", "a.msh",
         kGmshHead + kGmshNodes + "$Elements\n1\n1 2 2 0 1 1 2\n$EndElements\n", "a.msh:12",
         "a node number"},
        {"gmsh without surface", "a.msh",
         kGmshHead + kGmshNodes + "$Elements\n1\n1 1 2 0 1 1 2\n$EndElements\n", "a.msh",
         "no faces"},
    };
}

TEST(BadInput, IsRefusedWithPlaceAndReason) {
    EXPECT_GE(bad_inputs().size(), 40U);
    for (const BadInput& input : bad_inputs()) {
        SCOPED_TRACE(input.label);
        std::istringstream in(input.content);
        try {
            read_mesh(in, input.name);
            ADD_FAILURE() << "was accepted";
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_EQ(message.rfind(input.where, 0), 0U) << message;
            EXPECT_NE(message.find(input.what), std::string::npos) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
}

TEST(BadInput, FilesThatCannotBeOpened) {
    for (const char* path : {"/nonexistent/mesh.off", "/"}) {
        try {
            read_mesh(std::filesystem::path(path));
            ADD_FAILURE() << path << " was accepted";
        } catch (const InputError& error) {
            EXPECT_EQ(std::string(error.what()).rfind(path, 0), 0U) << error.what();
        }
    }
}

TEST(BadInput, EveryCutOfAGoodFileIsReadOrRefused) {
    const std::string whole =
        "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    std::size_t refused = 0;
    for (std::size_t length = 0; length < whole.size(); ++length) {
        std::istringstream in(whole.substr(0, length));
        try {
            read_mesh(in, "a.off");
        } catch (const InputError&) {
            ++refused;
        }
    }
    // Only the last line's end can be missing without harm.
    EXPECT_EQ(refused, whole.size() - 1);
}

TEST(BadInput, UnknownFormatsAreNotWritten) {
    const LoadedMesh mesh = mesh_from_soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    EXPECT_THROW(write_mesh("/tmp/mesh.fbx", mesh), InputError);
    EXPECT_THROW(write_mesh("/nonexistent/mesh.off", mesh), InputError);
}

}  // namespace
}  // namespace fcn
