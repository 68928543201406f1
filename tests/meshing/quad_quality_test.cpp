#include "meshing/quad_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "geometry/errors.h"
#include "geometry/mesh_io.h"
#include "meshing/quad_files.h"
#include "meshing/quad_shape.h"
#include "sample_quads.h"

namespace fcn {
namespace {

TEST(ScaledJacobian, OfKnownQuads) {
    EXPECT_DOUBLE_EQ(scaled_jacobian({{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}}), 1);
    const double s = std::sin(std::numbers::pi / 3), c = std::cos(std::numbers::pi / 3);
    EXPECT_NEAR(scaled_jacobian({{{0, 0, 0}, {1, 0, 0}, {1 + c, s, 0}, {c, s, 0}}}), s, 1e-12);
    // An arrowhead has one corner that is turned over, and a bow tie of no area has nothing.
    EXPECT_LT(scaled_jacobian({{{0, 0, 0}, {2, 0, 0}, {0.2, 0.2, 0}, {0, 2, 0}}}), 0);
    EXPECT_EQ(scaled_jacobian({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}), 0);
    // Bent along a diagonal by a right angle: each wing is seen at 45 degrees.
    const double bent =
        scaled_jacobian({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 0.5, std::sqrt(0.5)}}});
    EXPECT_GT(bent, 0);
    EXPECT_LT(bent, 0.9);
}

TEST(MeasureQuads, CountsWhatIsIrregular) {
    const QuadQuality torus = measure_quads(test::quad_torus(3, 1, 24, 12));
    EXPECT_EQ(torus.share_irregular, 0);
    EXPECT_EQ(torus.inner_vertices, 288u);
    EXPECT_GT(torus.min_scaled_jacobian, 0.9);
    const QuadQuality cube = measure_quads(test::quad_cube(), 1.001);
    EXPECT_EQ(cube.share_irregular, 1);
    EXPECT_EQ(cube.close_singularities, 12u);
    EXPECT_EQ(measure_quads(test::quad_cube(), 1.5).close_singularities, 24u);
    EXPECT_EQ(measure_quads(test::quad_cube(), 2).close_singularities, 28u);
    EXPECT_DOUBLE_EQ(cube.mean_scaled_jacobian, 1);
    EXPECT_DOUBLE_EQ(cube.mean_edge, 1);
    const QuadQuality grid = measure_quads(test::quad_grid(4, 3));
    EXPECT_EQ(grid.inner_vertices, 6u);
    EXPECT_EQ(grid.share_irregular, 0);
}

TEST(MeasureQuads, NamesWhatIsIrregular) {
    EXPECT_TRUE(irregular_vertices(test::quad_torus(3, 1, 24, 12)).empty());
    EXPECT_TRUE(irregular_vertices(test::quad_grid(4, 3)).empty());  // the boundary does not count
    const std::vector<IrregularVertex> corners = irregular_vertices(test::quad_cube());
    ASSERT_EQ(corners.size(), 8u);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        EXPECT_EQ(corners[i].vertex, static_cast<int>(i));
        EXPECT_EQ(corners[i].valence, 3);
    }
}

TEST(MeasureQuads, CountsInvertedCorners) {
    QuadMesh mesh = test::quad_grid(2, 2);
    mesh.points[4] = {-0.2, -0.2, 0};
    EXPECT_GT(measure_quads(mesh).inverted_corners, 0u);
    EXPECT_LT(measure_quads(mesh).min_scaled_jacobian, 0);
}

FeatureCurveNetwork line(const Vec3& from, const Vec3& to) {
    FeatureCurveNetwork network;
    network.nodes = {{from, {}}, {to, {}}};
    network.arcs.resize(1);
    network.arcs[0].nodes = {0, 1};
    network.arcs[0].samples = {{from, {}}, {to, {}}};
    network.segments.push_back({{0, 1}, 0, 0, 1, 0, false});
    return network;
}

TEST(MeasureAlignment, IsTheAngleToTheNearerDirection) {
    const QuadMesh grid = test::quad_grid(10, 10);
    for (const double degrees : {0.0, 7.0, 30.0, 45.0, 60.0, 88.0}) {
        const double radians = degrees * std::numbers::pi / 180;
        const Vec3 from(2, 2, 0), to = from + 5 * Vec3(std::cos(radians), std::sin(radians), 0);
        const double expected = std::min(degrees, 90 - degrees);
        FeatureCurveNetwork network = line(from, to);
        const QuadAlignment along = measure_alignment(grid, network, 0.1);
        EXPECT_NEAR(along.mean_degrees, expected, 1e-6);
        EXPECT_NEAR(along.max_degrees, expected, 1e-6);
        EXPECT_EQ(along.share_over_10, expected > 10 ? 1 : 0);
        network.segments.clear();
        EXPECT_NEAR(measure_alignment(grid, network, 0.1).mean_degrees, expected, 1e-6);
    }
    EXPECT_THROW(measure_alignment(grid, line({0, 0, 0}, {1, 0, 0}), 0), InputError);
    EXPECT_THROW(measure_alignment({}, line({0, 0, 0}, {1, 0, 0}), 1), InputError);
}

class QuadFiles : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("quad_files_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path folder_;
};

TEST_F(QuadFiles, ReadBackWhatWasWritten) {
    QuadMesh mesh = test::quad_torus(3, 1, 9, 7);
    mesh.feature_edges = {{0, 1, 4, 2}};
    for (const char* name : {"a.obj", "a.off", "a.obj.gz"}) {
        write_quads(folder_ / name, mesh);
        const auto read = read_quads(folder_ / name);
        ASSERT_TRUE(read) << name;
        EXPECT_EQ(read->points, mesh.points);
        EXPECT_EQ(read->faces, mesh.faces);
    }
    // As triangles it is an ordinary mesh, cut in two each.
    EXPECT_EQ(read_mesh(folder_ / "a.off").mesh.n_faces(), 2 * mesh.faces.size());
}

TEST_F(QuadFiles, LabelsComeBack) {
    QuadMesh mesh = test::quad_grid(2, 1);
    mesh.face_labels = {3, 5};
    write_quads(folder_ / "a.obj", mesh);
    const auto read = read_quads(folder_ / "a.obj");
    ASSERT_TRUE(read);
    ASSERT_EQ(read->face_labels.size(), 2u);
    EXPECT_NE(read->face_labels[0], read->face_labels[1]);
}

TEST_F(QuadFiles, OtherFacesAreNoQuads) {
    write_file_atomically(folder_ / "a.off",
                          "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
    EXPECT_FALSE(read_quads(folder_ / "a.off"));
    write_file_atomically(folder_ / "b.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 7\n");
    EXPECT_THROW(read_quads(folder_ / "b.off"), InputError);
    EXPECT_THROW(write_quads(folder_ / "a.stl", test::quad_cube()), InputError);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.stl"));
}

TEST_F(QuadFiles, VtuHasACellForEachQuadAndFeature) {
    QuadMesh mesh = test::quad_cube();
    mesh.feature_edges = {{0, 1, 0, -1}, {0, 2, 1, -1}};
    const std::string text = quads_to_text(mesh, "vtu");
    EXPECT_NE(text.find("NumberOfPoints=\"8\" NumberOfCells=\"8\""), std::string::npos);
    EXPECT_NE(text.find("\n24\n26\n28\n</DataArray>"), std::string::npos);
    EXPECT_NE(text.find("\n9\n9\n3\n3\n</DataArray>"), std::string::npos);
}

}  // namespace
}  // namespace fcn
