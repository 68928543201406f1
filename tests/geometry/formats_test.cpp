#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <sstream>

#include "geometry/errors.h"
#include "geometry/file_content.h"
#include "geometry/manifold_check.h"
#include "geometry/mesh_io.h"
#include "geometry/models.h"
#include "support/shared_data.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

using namespace fcn::testing;
namespace fs = std::filesystem;

class Folder {
public:
    Folder() {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        std::string name = std::string(test->test_suite_name()) + "." + test->name();
        std::replace(name.begin(), name.end(), '/', '_');
        path_ = fs::path(::testing::TempDir()) / ("scalefcn_" + name);
        fs::remove_all(path_);
        fs::create_directories(path_);
    }
    ~Folder() { fs::remove_all(path_); }
    fs::path operator/(const std::string& name) const { return path_ / name; }
    std::size_t entry_count() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(path_), {}));
    }

private:
    fs::path path_;
};

LoadedMesh read_text(const std::string& content, const std::string& name) {
    std::istringstream in(content);
    return read_mesh(in, name);
}

/// Labelled, with names, at positions that need all their digits.
LoadedMesh odd_mesh() {
    Soup soup = cube_soup({0.1, 1e-17, -1.0 / 3});
    for (int& label : soup.labels) label += 1;
    LoadedMesh mesh = soup.load();
    mesh.label_names = {"", "left side", "right", "top", "bottom", "front", "back"};
    mesh.units = "mm";
    mesh.name = "odd";
    return mesh;
}

class RoundTrip : public ::testing::TestWithParam<const char*> {};

TEST_P(RoundTrip, KeepsPositionsFacesAndLabels) {
    const Folder folder;
    const std::string extension = GetParam();
    const LoadedMesh before = odd_mesh();
    write_mesh(folder / ("odd" + extension), before);
    EXPECT_EQ(folder.entry_count(), 1U) << "a temporary file was left";
    const LoadedMesh after = read_mesh(folder / ("odd" + extension));
    expect_manifold(after);
    EXPECT_TRUE(after.repairs.is_clean());
    EXPECT_EQ(after.name, "odd");
    // STL has no vertices, so their order follows the facets.
    const bool is_stl = extension.starts_with(".stl");
    if (!is_stl) {
        EXPECT_EQ(after.hash, before.hash);
        for (const auto vertex : before.mesh.vertices()) {
            EXPECT_EQ(after.mesh.point(vertex), before.mesh.point(vertex));
        }
    }
    EXPECT_EQ(volume(after.mesh), volume(before.mesh));
    if (extension.starts_with(".off")) {
        EXPECT_TRUE(after.face_labels.empty());
    } else {
        ASSERT_EQ(after.face_labels.size(), before.face_labels.size());
        for (std::size_t face = 0; face < before.face_labels.size(); ++face) {
            for (std::size_t other = 0; other < face; ++other) {
                EXPECT_EQ(before.face_labels[face] == before.face_labels[other],
                          after.face_labels[face] == after.face_labels[other]);
            }
        }
    }
    const bool has_names = extension.starts_with(".obj") || is_stl || extension == ".msh";
    if (has_names) {
        for (std::size_t face = 0; face < before.face_labels.size(); ++face) {
            EXPECT_EQ(after.label_names.at(static_cast<std::size_t>(after.face_labels[face])),
                      before.label_names[static_cast<std::size_t>(before.face_labels[face])]);
        }
    }
    // What was read writes the same bytes again.
    write_mesh(folder / ("again" + extension), after);
    if (!is_stl) {
        EXPECT_EQ(read_file(folder / ("again" + extension)),
                  read_file(folder / ("odd" + extension)));
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, RoundTrip,
                         ::testing::Values(".off", ".obj", ".ply", ".stl", ".mesh", ".msh",
                                           ".off.gz", ".obj.gz", ".ply.gz", ".stl.gz", ".mesh.gz",
                                           ".msh.gz"));

TEST(Formats, UnitsAreFoundInComments) {
    const Folder folder;
    for (const char* extension : {".off", ".obj", ".ply", ".mesh"}) {
        write_mesh(folder / ("odd" + std::string(extension)), odd_mesh());
        EXPECT_EQ(read_mesh(folder / ("odd" + std::string(extension))).units, "mm") << extension;
    }
}

TEST(Formats, ContentDecidesBeforeTheName) {
    const Folder folder;
    write_mesh(folder / "odd.ply", odd_mesh());
    fs::rename(folder / "odd.ply", folder / "odd.off");
    EXPECT_EQ(read_mesh(folder / "odd.off").hash, odd_mesh().hash);
    write_file_atomically(folder / "plain.gz", read_file(folder / "odd.off"));
    fs::rename(folder / "plain.gz", folder / "plain.stl");
    EXPECT_EQ(read_mesh(folder / "plain.stl").hash, odd_mesh().hash);
}

TEST(Formats, OffVariants) {
    const char* faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    const auto reference = read_text("OFF\n4 4 6\n" + points + faces, "a.off");
    expect_manifold(reference);
    EXPECT_TRUE(reference.repairs.is_clean());
    const std::string variants[] = {
        "OFF 4 4 6\n" + points + faces,
        "# comment\r\nOFF # more\r\n\r\n4 4 0\r\n" + points + faces,
        "OFF\n4 4\n" + points + faces,
        "COFF\n4 4 6\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n0 1 0 255 0 0 255\n"
        "+0 0e5 1.0 255 0 0 255\n3 0 2 1 0.5 0.5 0.5\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
        "NOFF\n4 4 6\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n0 0 1 0 0 1\n" + std::string(faces),
        "\xef\xbb\xbfOFF\r4 4 6\r0 0 0\r1 0 0\r0 1 0\r0 0 1\r3 0 2 1\r3 0 1 3\r3 1 2 3\r3 0 3 2",
        "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 1e-999\n0 0 1\n" + std::string(faces),
    };
    for (const std::string& text : variants) {
        EXPECT_EQ(read_text(text, "a.off").hash, reference.hash) << text;
    }
}

TEST(Formats, PolygonsAreCutWithoutFoldingOver) {
    // A concave quad, a concave hexagon, and a bow of eight corners, each of known area.
    const auto quad = read_text("OFF 4 1 0\n0 0 0\n2 0 0\n0.5 0.5 0\n0 2 0\n4 0 1 2 3\n", "q.off");
    EXPECT_EQ(quad.repairs.triangulated_polygon_count, 1U);
    EXPECT_NEAR(total_area(quad.mesh), 1.0, 1e-14);
    const auto ell =
        read_text("OFF 6 1 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n6 0 1 2 3 4 5\n", "l.off");
    EXPECT_EQ(ell.mesh.n_faces(), 4U);
    EXPECT_NEAR(total_area(ell.mesh), 3.0, 1e-14);
    for (const auto face : ell.mesh.faces()) EXPECT_GT(face_normal(ell.mesh, face).z(), 0.99);
    std::string star = "OFF 12 1 0\n";
    double area = 0;
    for (int i = 0; i < 12; ++i) {
        const double radius = i % 2 == 0 ? 2.0 : 0.7;
        star += std::to_string(radius * std::cos(M_PI * i / 6)) + " " +
                std::to_string(radius * std::sin(M_PI * i / 6)) + " 0\n";
        area += 0.5 * 2.0 * 0.7 * std::sin(M_PI / 6);
    }
    star += "12 0 1 2 3 4 5 6 7 8 9 10 11\n";
    EXPECT_NEAR(total_area(read_text(star, "s.off").mesh), area, 1e-5);
}

TEST(Formats, ObjIndicesGroupsAndContinuations) {
    const auto mesh = read_text(
        "# made by hand\nmtllib none.mtl\no thing\nv 0 0 0 1\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
        "vn 0 0 1\nvt 0 0\ng base\nusemtl red\nf 1/1/1 3//1 \\\n 2/1\nusemtl blue\nf 1 2 4\n"
        "f -3 -2 -1\ng base\nusemtl red\nf 1 4 3\ns off\nl 1 2\n",
        "a.obj");
    expect_manifold(mesh);
    EXPECT_EQ(mesh.face_labels, (std::vector<int>{0, 1, 1, 0}));
    EXPECT_EQ(mesh.label_names, (std::vector<std::string>{"thing/base/red", "thing/base/blue"}));
    const auto plain = read_text("g all\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj");
    EXPECT_TRUE(plain.face_labels.empty());
}

std::string bytes_of(double value, bool is_double, bool is_big) {
    std::string bytes = is_double ? std::string(reinterpret_cast<const char*>(&value), 8) : [&] {
        const auto single = static_cast<float>(value);
        return std::string(reinterpret_cast<const char*>(&single), 4);
    }();
    if (is_big) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

std::string bytes_of(int value, bool is_big) {
    std::string bytes(reinterpret_cast<const char*>(&value), 4);
    if (is_big) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

TEST(Formats, PlyEncodingsAgree) {
    const Soup cube = cube_soup();
    const std::string header =
        "comment units = mm\nelement vertex 8\nproperty uchar red\nproperty float x\n"
        "property float y\nproperty float z\nelement edge 1\nproperty int vertex1\n"
        "property list uchar short spare\nelement face 12\nproperty list uchar int vertex_index\n"
        "property short region\nproperty float quality\nend_header\n";
    std::string text = "ply\nformat ascii 1.0\n" + header;
    for (const Vec3& p : cube.points) {
        text += "7 " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
                std::to_string(p.z()) + "\n";
    }
    text += "3 2 5 6\n";
    for (std::size_t i = 0; i < 12; ++i) {
        const auto [a, b, c] = cube.triangles[i];
        text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + " " +
                std::to_string(cube.labels[i]) + " 0.5\n";
    }
    const LoadedMesh reference = read_text(text, "a.ply");
    expect_manifold(reference);
    EXPECT_EQ(reference.face_labels, cube.labels);
    EXPECT_EQ(reference.units, "mm");
    for (const bool is_big : {false, true}) {
        std::string binary = is_big ? "ply\nformat binary_big_endian 1.0\n"
                                    : "ply\nformat binary_little_endian 1.0\n";
        binary += header;
        const auto half = [&](int value) {
            const std::string whole = bytes_of(value, is_big);
            return is_big ? whole.substr(2) : whole.substr(0, 2);
        };
        for (const Vec3& p : cube.points) {
            binary += '\7';
            for (double x : p) binary += bytes_of(x, false, is_big);
        }
        binary += bytes_of(3, is_big) + '\2' + half(5) + half(6);
        for (std::size_t i = 0; i < 12; ++i) {
            binary += '\3';
            for (int corner : cube.triangles[i]) binary += bytes_of(corner, is_big);
            binary += half(cube.labels[i]) + bytes_of(0.5, false, is_big);
        }
        const LoadedMesh mesh = read_text(binary, "a.ply");
        EXPECT_EQ(mesh.hash, reference.hash);
        EXPECT_EQ(mesh.face_labels, reference.face_labels);
    }
}

TEST(Formats, PlyTriangleStrips) {
    const LoadedMesh mesh = read_text(
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
        "property double z\nelement tristrips 1\nproperty list int int vertex_indices\n"
        "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n"
        "10 0 1 2 3 -1 3 5 2 4 -1\n",
        "a.ply");
    expect_manifold(mesh);
    EXPECT_EQ(mesh.mesh.n_faces(), 4U);
    EXPECT_EQ(mesh.repairs.reoriented_face_count, 0U);
    EXPECT_NEAR(total_area(mesh.mesh), 2.0, 1e-14);
}

std::string binary_stl(const Soup& soup, std::string header) {
    header.resize(80, ' ');
    std::string bytes = header + bytes_of(static_cast<int>(soup.triangles.size()), false);
    for (const auto& corners : soup.triangles) {
        bytes += std::string(12, '\0');
        for (int corner : corners) {
            for (double x : soup.points[corner]) bytes += bytes_of(x, false, false);
        }
        bytes += std::string(2, '\0');
    }
    return bytes;
}

TEST(Formats, BinaryStlEvenIfItSaysSolid) {
    for (const char* header : {"made here", "solid but binary", "OFF", "units: mm"}) {
        const LoadedMesh mesh = read_text(binary_stl(cube_soup(), header), "a.stl");
        expect_manifold(mesh);
        EXPECT_EQ(mesh.mesh.n_vertices(), 8U);
        EXPECT_TRUE(mesh.repairs.is_clean());
        EXPECT_NEAR(volume(mesh.mesh), 1.0, 1e-14);
    }
}

TEST(Formats, BinaryStlFarFromTheOriginKeepsItsFaces) {
    // The allowance for single precision must not eat faces of sensible size.
    Soup soup = square_soup(3);
    for (Vec3& p : soup.points) p += Vec3(1000, 1000, 0);
    const LoadedMesh mesh = read_text(binary_stl(soup, ""), "a.stl");
    expect_manifold(mesh);
    EXPECT_EQ(mesh.mesh.n_faces(), 18U);
    EXPECT_NEAR(total_area(mesh.mesh), 1.0, 1e-3);
}

TEST(Formats, TextStlWithSeveralSolids) {
    const char* text =
        "solid lower part\n facet normal nan nan nan\n  outer loop\n vertex 0 0 0\n vertex 1 0 0\n"
        "vertex 0 1 0\n endloop\n endfacet\nendsolid lower part\n"
        "SOLID upper\n FACET NORMAL 0 0 1\n OUTER LOOP\n VERTEX 1 0 0\n VERTEX 1 1 0\n"
        "VERTEX 0 1 0\n ENDLOOP\n ENDFACET\nENDSOLID\n";
    const LoadedMesh mesh = read_text(text, "a.stl");
    expect_manifold(mesh);
    EXPECT_EQ(mesh.face_labels, (std::vector<int>{0, 1}));
    EXPECT_EQ(mesh.label_names, (std::vector<std::string>{"lower part", "upper"}));
    EXPECT_EQ(mesh.mesh.n_vertices(), 4U);
}

TEST(Formats, MeditWithOtherSections) {
    const LoadedMesh mesh = read_text(
        "MeshVersionFormatted 2\nDimension\n3\n\nVertices\n5\n0 0 0 1\n1 0 0 1\n1 1 0 1\n"
        "0 1 0 1\n2 0 0 1\nEdges\n1\n1 2 7\nCorners 1 1\nTriangles\n1\n2 5 3 4\n"
        "Quadrilaterals\n1\n1 2 3 4 8\nNormals\n1\n0 0 1.5e0\nEnd\n",
        "a.mesh");
    expect_manifold(mesh);
    EXPECT_EQ(mesh.face_labels, (std::vector<int>{4, 8, 8}));
    EXPECT_EQ(boundary_edge_count(mesh.mesh), 5U);
}

constexpr const char* kGmsh2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 9 \"rim\"\n2 5 \"left wall\"\n"
    "2 6 \"right\"\n$EndPhysicalNames\n$Nodes\n4\n10 0 0 0\n20 1 0 0\n30 1 1 0\n40 0 1 0\n"
    "$EndNodes\n$Elements\n4\n1 15 2 0 1 10\n2 1 2 9 1 10 20\n3 2 2 5 1 10 20 30\n"
    "4 2 2 -6 2 10 30 40\n$EndElements\n";
constexpr const char* kGmsh4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 5 \"left wall\"\n2 6 \"right\"\n"
    "$EndPhysicalNames\n$Entities\n1 1 2 0\n1 0 0 0 0\n1 0 0 0 1 0 0 1 9 2 1 -1\n"
    "1 0 0 0 1 1 0 1 5 1 1\n2 0 0 0 1 1 0 1 6 0\n$EndEntities\n$Nodes\n2 4 10 40\n2 1 0 3\n10\n"
    "20\n30\n0 0 0\n1 0 0\n1 1 0\n2 2 1 1\n40\n0 1 0 0.5 0.5\n$EndNodes\n$Elements\n3 3 1 3\n"
    "1 1 1 1\n1 10 20\n2 1 2 1\n2 10 20 30\n2 2 2 1\n3 10 30 40\n$EndElements\n";

TEST(Formats, GmshVersionsAgree) {
    const LoadedMesh two = read_text(kGmsh2, "a.msh");
    const LoadedMesh four = read_text(kGmsh4, "b.msh");
    expect_manifold(two);
    EXPECT_EQ(two.hash, four.hash);
    for (const LoadedMesh* mesh : {&two, &four}) {
        EXPECT_EQ(mesh->face_labels, (std::vector<int>{5, 6}));
        ASSERT_EQ(mesh->label_names.size(), 7U);
        EXPECT_EQ(mesh->label_names[5], "left wall");
        EXPECT_EQ(mesh->label_names[6], "right");
    }
}

TEST(Formats, WritingReplacesWholeFilesOnly) {
    const Folder folder;
    write_file_atomically(folder / "a.txt", "first");
    write_file_atomically(folder / "a.txt", "second, longer");
    EXPECT_EQ(read_file(folder / "a.txt"), "second, longer");
    fs::create_symlink(folder / "a.txt", folder / "link.txt");
    write_file_atomically(folder / "link.txt", "third");
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(read_file(folder / "a.txt"), "third");
    EXPECT_EQ(folder.entry_count(), 2U);
    EXPECT_THROW(write_file_atomically(folder / "missing/a.txt", "x"), InputError);
    EXPECT_THROW(write_file_atomically(folder / "", "x"), InputError);
    EXPECT_EQ(folder.entry_count(), 2U);
}

TEST(Formats, GzipCarriesNoTimeAndMayHaveMembers) {
    const std::string text(100000, 'x');
    EXPECT_EQ(compress(text), compress(text));
    EXPECT_EQ(decompress(compress(text), "t"), text);
    EXPECT_EQ(decompress(compress("one ") + compress("two"), "t"), "one two");
    EXPECT_EQ(decompress(compress("") + compress("two"), "t"), "two");
    const std::string whole = compress(text);
    for (std::size_t length = 2; length < whole.size(); length += 7) {
        EXPECT_THROW(decompress(whole.substr(0, length), "t"), InputError);
    }
}

TEST(Formats, MeshesOfTheCorpusAreManifold) {
    const auto data = shared_data();
    if (!data) GTEST_SKIP() << "no folder of shared meshes, see SCALEFCN_SHARED";
    int mesh_count = 0;
    for (const char* name : {"fandisk.off", "wingnut.obj", "elephant.off", "mech-holes-shark.off",
                             "rotor_small.off", "nefertiti-lowres.obj"}) {
        if (!fs::exists(*data / "meshes" / name)) continue;
        const LoadedMesh mesh = read_mesh(*data / "meshes" / name);
        SCOPED_TRACE(name);
        expect_manifold(mesh);
        ++mesh_count;
    }
    EXPECT_GT(mesh_count, 0);
}

}  // namespace
}  // namespace fcn
