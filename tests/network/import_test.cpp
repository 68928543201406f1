#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "network/network_io.h"
#include "network/sample_networks.h"

namespace fcn {
namespace {

using namespace fcn::testing;

std::vector<Vec3> arc_of(const FeatureCurveNetwork& network, std::size_t a) {
    return polylines(network).at(a);
}

const std::vector<Vec3> kPath{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}};

TEST(Import, ObjLinesAndFaces) {
    const auto network = network_from_content(
        "# a mesh with curves\r\nv 0 0 0\r\nv 1 0 0\r\nv 2 0 0 1.0\r\nv 2 1 0\r\nvn 0 0 1\r\n"
        "f 1 2 4\r\nl 1/1 2/2 \\\r\n 3\r\nl -1 -2\r\ng other\r\nv 9 9 9\r\n",
        "n.obj");
    ASSERT_EQ(network.arcs.size(), 1u);
    EXPECT_EQ(arc_of(network, 0), kPath);
    EXPECT_EQ(network.arcs[0].source, "import");
}

TEST(Import, EdgesAreChainedThroughEqualPoints) {
    // Four single edges in disorder, with a point of its own at every end and a negative zero.
    const auto network = network_from_content(
        "2 1 0 0 2 0 0\n2 -0.0 0 0 1 0 0\n2 2 1 0 2 0 0\n2 2 1 0 2 1 0\n2 1 0 0 0 0 0\n",
        "n.polylines.txt");
    ASSERT_EQ(network.arcs.size(), 1u);
    EXPECT_EQ(arc_of(network, 0), kPath);
    ASSERT_EQ(network.notes.size(), 2u);
    EXPECT_NE(network.notes[0].find("1 edges without length"), std::string::npos);
    EXPECT_NE(network.notes[1].find("1 repeated edges"), std::string::npos);
}

TEST(Import, ClosedChainBeginsWithItsFirstEdge) {
    const auto network =
        network_from_content("v 0 0 0\nv 1 0 0\nv 1 1 0\nl 2 3\nl 3 1\nl 1 2\n", "n.obj");
    ASSERT_EQ(network.arcs.size(), 1u);
    EXPECT_TRUE(network.arcs[0].is_closed());
    EXPECT_EQ(arc_of(network, 0), (std::vector<Vec3>{{1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 0, 0}}));
}

TEST(Import, PlyTextWithFaces) {
    const auto network = network_from_content(
        "ply\nformat ascii 1.0\ncomment x\nobj_info y\nelement face 1\n"
        "property list uchar int vertex_indices\nproperty float quality\n"
        "element vertex 4\nproperty uchar red\nproperty float x\nproperty float y\n"
        "property float z\nelement edge 3\nproperty int vertex2\nproperty int vertex1\n"
        "end_header\n3 0 1 2 nan\n7 0 0 0\n7 1 0 0\n7 2 0 0\n7 2 1 0\n1 0\n2 1\n3 2\n",
        "n.ply");
    ASSERT_EQ(network.arcs.size(), 1u);
    EXPECT_EQ(arc_of(network, 0), kPath);
}

template <typename Value>
void append(std::string& out, Value value, bool is_big) {
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    out += is_big ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

TEST(Import, PlyBinaryOfBothByteOrders) {
    for (bool is_big : {false, true}) {
        std::string content = std::string("ply\nformat binary_") + (is_big ? "big" : "little") +
                              "_endian 1.0\nelement vertex 4\nproperty float x\n"
                              "property double y\nproperty float z\nelement face 1\n"
                              "property list uchar short vertex_indices\nelement edge 3\n"
                              "property uint vertex1\nproperty ushort vertex2\n"
                              "property uchar kept\nend_header\n";
        for (const Vec3& p : kPath) {
            append(content, static_cast<float>(p[0]), is_big);
            append(content, p[1], is_big);
            append(content, static_cast<float>(p[2]), is_big);
        }
        content += '\3';
        for (std::int16_t corner : {0, 1, 3}) append(content, corner, is_big);
        for (std::uint32_t edge : {0, 1, 2}) {
            append(content, edge, is_big);
            append(content, static_cast<std::uint16_t>(edge + 1), is_big);
            content += edge == 2 ? '\0' : '\1';
        }
        const auto network = network_from_content(content, "n.ply");
        ASSERT_EQ(network.arcs.size(), 1u);
        EXPECT_EQ(arc_of(network, 0), (std::vector<Vec3>(kPath.begin(), kPath.begin() + 3)));
        ASSERT_EQ(network.dropped.size(), 1u);
        EXPECT_EQ(network.dropped[0].polyline, (std::vector<Vec3>(kPath.begin() + 2, kPath.end())));
        for (std::size_t length = 0; length < content.size(); ++length)
            EXPECT_THROW(network_from_content(content.substr(0, length), "n.ply"), InputError);
    }
}

TEST(Import, GmshBothVersions) {
    const std::string version_2 =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 5 \"x\"\n$EndPhysicalNames\n"
        "$Nodes\n4\n10 0 0 0\n20 1 0 0\n30 2 0 0\n40 2 1 0\n$EndNodes\n$Elements\n4\n"
        "1 15 2 0 1 10\n2 2 2 0 1 10 20 40\n3 1 2 0 7 40 30\n4 8 2 0 3 10 30 20\n$EndElements\n";
    const std::string version_4 =
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 1 0 0\n1 0 0 0 0\n"
        "3 0 0 0 2 0 0 0 0\n$EndEntities\n$Nodes\n2 4 10 40\n0 1 0 1\n10\n0 0 0\n1 3 1 3\n20\n30\n"
        "40\n1 0 0 0.5\n2 0 0 1\n2 1 0 1\n$EndNodes\n$Elements\n3 4 1 4\n0 1 15 1\n1 10\n"
        "1 7 1 1\n2 40 30\n1 3 8 1\n3 10 30 20\n$EndElements\n";
    for (const std::string& content : {version_2, version_4}) {
        const auto network = network_from_content(content, "n.msh");
        ASSERT_EQ(network.arcs.size(), 2u);  // entity 3 before entity 7
        EXPECT_EQ(arc_of(network, 0), (std::vector<Vec3>(kPath.begin(), kPath.begin() + 3)));
        EXPECT_EQ(arc_of(network, 1), (std::vector<Vec3>{kPath[3], kPath[2]}));
    }
}

TEST(Import, MeditSections) {
    const auto network = network_from_content(
        "MeshVersionFormatted 1\n\nDimension\n3\nVertices 4\n0 0 0 1\n1 0 0 1\n2 0 0 1\n2 1 0 1\n"
        "Triangles 1\n1 2 4 0\nEdges 3\n1 2 4\n2 3 4\n3 4 2\nCorners 1\n1\n"
        "UnknownSection 2\n1 2 3\n4 5 6\nEnd\n",
        "n.mesh");
    ASSERT_EQ(network.arcs.size(), 2u);
    EXPECT_EQ(arc_of(network, 0), (std::vector<Vec3>{kPath[2], kPath[3]}));
    EXPECT_EQ(arc_of(network, 1), (std::vector<Vec3>(kPath.begin(), kPath.begin() + 3)));
}

TEST(Import, VtpOfOtherPrograms) {
    const std::string content =
        "<?xml version='1.0'?><!-- made by hand -->\n<VTKFile type=\"PolyData\" version=\"0.1\">\n"
        "<PolyData><FieldData><DataArray Name='t' format='ascii'>1</DataArray></FieldData>\n"
        "<Piece NumberOfPoints='4' NumberOfVerts='1' NumberOfLines='2' NumberOfPolys='1'>\n"
        "<PointData><DataArray Name='arc' format='ascii'>5 5 5 5</DataArray></PointData>\n"
        "<Points><DataArray type='Float32' NumberOfComponents='3' format='ascii'>\n"
        "0 0 0 1 0 0 <InformationKey name='x'>8 8</InformationKey> 2 0 0 2 1 0"
        "</DataArray></Points>\n"
        "<Verts><DataArray Name='connectivity' format='ascii'>0</DataArray>"
        "<DataArray Name='offsets' format='ascii'>1</DataArray></Verts>\n"
        "<Lines><DataArray Name='connectivity' format='ascii'>0 1 2 2 3</DataArray>"
        "<DataArray Name='offsets' format='ascii'>3 5</DataArray></Lines>\n"
        "<Polys><DataArray Name='connectivity' format='ascii'>0 1 3</DataArray>"
        "<DataArray Name='offsets' format='ascii'>3</DataArray></Polys>\nCELLS"
        "</Piece></PolyData></VTKFile>\n";
    const auto plain = network_from_content(content, "n.vtp");
    ASSERT_EQ(plain.arcs.size(), 1u);
    EXPECT_EQ(arc_of(plain, 0), kPath);
    // Cell data come in the order vertices, lines, polygons.
    std::string with_arcs = content;
    with_arcs.replace(with_arcs.find("CELLS"), 5,
                      "<CellData><DataArray Name='arc' format='ascii'>9 2 1 9</DataArray>"
                      "</CellData>");
    const auto parted = network_from_content(with_arcs, "n.vtp");
    ASSERT_EQ(parted.arcs.size(), 2u);
    EXPECT_EQ(arc_of(parted, 0), (std::vector<Vec3>{kPath[2], kPath[3]}));
}

TEST(Import, SharpWithBlanksAndEachEdgeOnce) {
    const LoadedMesh mesh = cube_mesh(1);
    const auto corners = face_vertices(mesh.mesh, FaceHandle(3));
    const auto network = network_from_content("1\n1 3 2\n", "n.sharp", &mesh.mesh);
    ASSERT_EQ(network.arcs.size(), 1u);
    EXPECT_EQ(arc_of(network, 0),
              (std::vector<Vec3>{mesh.mesh.point(corners[2]), mesh.mesh.point(corners[0])}));
}

TEST(Import, ContentDecidesBeforeTheName) {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n"
        "end_header\n0 0 0\n1 0 0\n0 1\n";
    EXPECT_EQ(network_from_content(ply, "misnamed.obj").arcs.size(), 1u);
    EXPECT_EQ(network_from_content(ply, "-").arcs.size(), 1u);
    EXPECT_EQ(network_from_content(network_to_json(cube()), "cube.txt").arcs.size(), 12u);
}

struct BadFile {
    std::string name;
    std::string content;
    std::vector<std::string> words;
};

TEST(Import, BadFilesAreRefusedWithTheirPlace) {
    const LoadedMesh mesh = cube_mesh(1);
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
        "property float y\nproperty float z\n";
    const std::string edge =
        "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
        "end_header\n";
    const std::string medit = "MeshVersionFormatted 2\nDimension 3\nVertices 2\n0 0 0 0\n1 0 0 0\n";
    const std::string msh =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n2 1 0 0\n"
        "$EndNodes\n";
    const std::string vtp =
        "<VTKFile type='PolyData'>\n<PolyData><Piece>\n<Points>"
        "<DataArray format='ascii'>0 0 0 1 0 0</DataArray></Points>\n";
    const auto lines = [](const std::string& corners, const std::string& offsets) {
        return "<Lines>\n<DataArray Name='connectivity' format='ascii'>" + corners +
               "</DataArray>\n<DataArray Name='offsets' format='ascii'>" + offsets +
               "</DataArray></Lines>";
    };
    const std::string tail = "</Piece></PolyData></VTKFile>";
    const std::vector<BadFile> cases{
        {"n.obj", "", {"empty"}},
        {"n.obj", "v 0 0 0\nv 1 0 0\nf 1 2 2\n", {"no curves"}},
        {"n.obj", "v 0 0 0\nv 1 0 0\nl 1 3\n", {":3:", "index 3"}},
        {"n.obj", "v 0 0 0\nv 1 0 0\nl 0 1\n", {":3:", "index 0"}},
        {"n.obj", "v 0 0 0\nv 1 0 0\nl -3 1\n", {":3:", "index -3"}},
        {"n.obj", "v 0 0 0\nv 1 0 0\nl 1\n", {":3:", "two vertices"}},
        {"n.obj", "v 0 0 0\nv 1 0 x\nl 1 2\n", {":2:", "'x'"}},
        {"n.obj", "v 0 0 0\nv 1 0 nan\nl 1 2\n", {":2:", "nan"}},
        {"n.obj", "v 0 0 0\nv 1 0\nl 1 2\n", {":2:"}},
        {"n.obj", "v 0 0 0\nv 1 0 1e999\nl 1 2\n", {":2:", "1e999"}},
        {"n.ply", "ply\n", {"end_header"}},
        {"n.ply", "ply\nformat ascii 1.0\nend_header\n", {"no curves"}},
        {"n.ply", "ply\nend_header\n", {"format"}},
        {"n.ply", "ply\nformat utf8 1.0\nend_header\n", {":2:", "utf8"}},
        {"n.ply", "ply\nformat ascii 1.0\nelement vertex -4\n", {":3:", "negative"}},
        {"n.ply", "ply\nformat ascii 1.0\nproperty int x\n", {":3:"}},
        {"n.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n", {":4:", "quad"}},
        {"n.ply", ply + edge + "0 0 0\n1 0 0\n0 2\n", {"vertex 2"}},
        {"n.ply", ply + edge + "0 0 0\n1 0 0\n0 -1\n", {":13:", "vertex2 -1 "}},
        {"n.ply", ply + edge + "0 0 0\n1 0 0\n0 0.5\n", {":13:", "vertex2 0.5 "}},
        {"n.ply", ply + edge + "0 0 0\n1 0 0\n", {"before vertex1"}},
        {"n.ply", ply + edge + "0 0 0\n1 0 inf\n0 1\n", {":12:", "inf"}},
        {"n.ply",
         ply + "element edge 1\nproperty int vertex1\nend_header\n0 0 0\n1 0 0\n0\n",
         {"vertex2"}},
        {"n.ply",
         "ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty float x\n" + edge + "0\n",
         {"99999999999999"}},
        {"n.mesh", "Dimension 3\n", {":1:", "MeshVersionFormatted"}},
        {"n.mesh", medit + "End\n", {"no curves"}},
        {"n.mesh", medit + "Edges 1\n1 3 0\nEnd\n", {":7:", "index 3"}},
        {"n.mesh", medit + "Edges 1\n1 2 -1\nEnd\n", {":7:", "-1"}},
        {"n.mesh", medit + "Edges 2\n1 2 1\n", {"expected a vertex index|breaks off|ends"}},
        {"n.mesh", medit + "Edges 4000000000\n1 2 1\n", {":6:", "4000000000"}},
        {"n.mesh", medit + "12\n", {":6:", "12"}},
        {"n.mesh", "MeshVersionFormatted 2\nDimension 2\n", {":2:", "dimension"}},
        {"n.msh", "$MeshFormat\n3 0 8\n", {":2:", "'3'"}},
        {"n.msh", "$MeshFormat\n2.2 1 8\n", {":2:", "binary"}},
        {"n.msh", "hello\n", {":1:", "$MeshFormat"}},
        {"n.msh", msh, {"no curves"}},
        {"n.msh", msh + "$Elements\n1\n1 1 2 0 1 1 5\n", {":11:", "node 5"}},
        {"n.msh", msh + "$Elements\n1\n1 1 2 0 1 1\n", {":11:"}},
        {"n.msh", msh + "$Elements\n2\n1 1 2 0 1 1 2\n", {"ends|breaks off|expected"}},
        {"n.msh",
         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n1 0 0 0\n",
         {":7:", "node 1", "twice"}},
        {"n.vtp", "hello", {"no <VTKFile>"}},
        {"n.vtp", "<VTKFile type='ImageData'></VTKFile>", {":1:", "PolyData"}},
        {"n.vtp", "<VTKFile type='PolyData'", {":1:", "does not end"}},
        {"n.vtp", vtp, {"does not end"}},
        {"n.vtp", vtp + tail, {"no curves"}},
        {"n.vtp", vtp + lines("0 1", "3") + tail, {":6:", "offset 0 is 3,"}},
        {"n.vtp", vtp + lines("0 2", "2") + tail, {":5:", "corner 1 is 2,"}},
        {"n.vtp", vtp + lines("0 x", "2") + tail, {":5:", "'x'"}},
        {"n.vtp",
         vtp + lines("0 1", "2") +
             "<CellData><DataArray Name='arc' format='ascii'></DataArray></CellData>" + tail,
         {"'arc'", "0 values for 1"}},
        {"n.vtp",
         "<VTKFile type='PolyData'><AppendedData>_xx</AppendedData></VTKFile>",
         {"appended"}},
        {"n.vtp",
         "<VTKFile type='PolyData'><Piece><Points><DataArray format='binary'>AA"
         "</DataArray></Points></Piece></VTKFile>",
         {"ascii"}},
        {"n.polylines.txt", "2 0 0 0 1 0\n", {"coordinate"}},
        {"n.polylines.txt", "1 0 0 0\n", {":1:", "two points"}},
        {"n.polylines.txt", "2 0 0 0 1 0 0\n3000000000 0 0 0\n", {":2:", "3000000000"}},
        {"n.polylines.txt", "2 0 0 0 1 0 zero\n", {":1:", "'zero'"}},
        {"n.polylines.txt", "-2 0 0 0 1 0 0\n", {":1:", "-2"}},
        {"n.sharp", "1\n2,0,0\n", {":2:", "type 2|the type 2"}},
        {"n.sharp", "1\n1,12,0\n", {":2:", "face 12", "12"}},
        {"n.sharp", "1\n1,0,3\n", {":2:", "edge 3"}},
        {"n.sharp", "2\n1,0,0\n", {"ends|breaks off"}},
        {"n.sharp", "1\n1,0,0\n1,0,1\n", {":3:", "more follows"}},
        {"n.fl", "1\n2 0 8\n", {":2:", "index 8", "8 vertices"}},
        {"n.fl", "1\n1 0\n", {":2:", "two vertices"}},
        {"n.fl", "1\n2 0 0\n", {":2:", "not joined"}},
        {"n.fl", "1\n2 0 1\n2 1 2\n", {"more follows"}},
        {"n.fl", "x\n", {":1:", "'x'"}},
    };
    for (const BadFile& bad : cases) {
        SCOPED_TRACE(bad.name + ": " + bad.content);
        try {
            network_from_content(bad.content, bad.name, &mesh.mesh);
            ADD_FAILURE() << "accepted";
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(bad.name), std::string::npos) << message;
            for (const std::string& words : bad.words) {
                bool is_found = false;
                for (std::size_t begin = 0; begin <= words.size();) {
                    const std::size_t end = std::min(words.find('|', begin), words.size());
                    is_found = is_found ||
                               message.find(words.substr(begin, end - begin)) != std::string::npos;
                    begin = end + 1;
                }
                EXPECT_TRUE(is_found) << message << "\nlacks " << words;
            }
        }
    }
    EXPECT_THROW(network_from_content("1\n1,0,0\n", "n.sharp"), InputError);  // no mesh
}

}  // namespace
}  // namespace fcn
