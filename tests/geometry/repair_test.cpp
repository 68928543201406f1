#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/manifold_check.h"
#include "geometry/mesh_io.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

using namespace fcn::testing;

/// Every repaired mesh must be clean when it is read again, and refused when repair is off.
LoadedMesh expect_repaired(const Soup& soup) {
    LoadedMesh result = soup.load();
    expect_manifold(result);
    EXPECT_FALSE(result.repairs.is_clean());
    ReadOptions strict;
    strict.is_repairing = false;
    EXPECT_THROW(soup.load(strict), InputError);
    return result;
}

TEST(Repair, CleanInputComesOutAsItWentIn) {
    const Soup soup = cube_soup();
    ReadOptions strict;
    strict.is_repairing = false;
    const LoadedMesh cube = soup.load(strict);
    expect_manifold(cube);
    EXPECT_TRUE(cube.repairs.is_clean());
    EXPECT_TRUE(cube.repairs.messages().empty());
    EXPECT_EQ(cube.face_labels, soup.labels);
    for (const auto vertex : cube.mesh.vertices()) {
        EXPECT_EQ(cube.mesh.point(vertex), soup.points[vertex.idx()]);
    }
    for (const auto face : cube.mesh.faces()) {
        const auto corners = face_vertices(cube.mesh, face);
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(corners[i].idx(), soup.triangles[face.idx()][i]);
        }
    }
    EXPECT_NEAR(volume(cube.mesh), 1.0, 1e-14);
}

TEST(Repair, WeldsEqualPositions) {
    Soup loose;
    const Soup cube = cube_soup();
    for (const auto& corners : cube.triangles) {
        for (int corner : corners) {
            Vec3 point = cube.points[corner];
            // Negative zero is equal to zero.
            if (point.x() == 0) point.x() = -0.0;
            loose.points.push_back(loose.points.size() % 2 == 0 ? point : cube.points[corner]);
        }
        const int last = static_cast<int>(loose.points.size());
        loose.triangles.push_back({last - 3, last - 2, last - 1});
    }
    const LoadedMesh mesh = expect_repaired(loose);
    EXPECT_EQ(mesh.mesh.n_vertices(), 8U);
    EXPECT_EQ(mesh.repairs.welded_vertex_count, 28U);
    EXPECT_EQ(euler_characteristic(mesh.mesh), 2);
}

TEST(Repair, WeldsWithinATolerance) {
    Soup square = joined(square_soup(4), square_soup(4));
    for (std::size_t i = 25; i < 50; ++i) square.points[i] += Vec3(1 + 1e-7, 1e-7, 0);
    EXPECT_EQ(boundary_edge_count(square.load().mesh), 32U);
    ReadOptions options;
    options.weld_tolerance = 1e-6;
    const LoadedMesh welded = square.load(options);
    expect_manifold(welded);
    EXPECT_EQ(welded.repairs.welded_vertex_count, 5U);
    EXPECT_EQ(boundary_edge_count(welded.mesh), 24U);
    options.weld_tolerance = -1;
    EXPECT_THROW(square.load(options), InputError);
}

TEST(Repair, DropsRepeatedCornersAndFacesAndLooseVertices) {
    Soup soup = cube_soup();
    soup.triangles.push_back({3, 3, 5});
    soup.triangles.push_back({0, 3, 2});  // the first face turned over
    soup.triangles.push_back(soup.triangles[4]);
    soup.labels.insert(soup.labels.end(), 3, 9);
    soup.points.emplace_back(7, 7, 7);
    const LoadedMesh mesh = expect_repaired(soup);
    EXPECT_EQ(mesh.mesh.n_faces(), 12U);
    EXPECT_EQ(mesh.mesh.n_vertices(), 8U);
    EXPECT_EQ(mesh.repairs.degenerate_face_count, 1U);
    EXPECT_EQ(mesh.repairs.unreferenced_vertex_count, 1U);
    EXPECT_EQ(mesh.repairs.duplicate_face_count, 2U);
    EXPECT_EQ(euler_characteristic(mesh.mesh), 2);
    EXPECT_EQ(mesh.repairs.messages().size(), 3U);
}

TEST(Repair, OrientsTheMinorityOfAComponent) {
    Soup soup = joined(cube_soup(), cube_soup({3, 0, 0}));
    for (int face : {0, 3, 7}) std::swap(soup.triangles[face][1], soup.triangles[face][2]);
    for (int face = 12; face < 24; ++face) {
        // The second cube is inside out but for one face: its majority decides.
        if (face != 15) std::swap(soup.triangles[face][1], soup.triangles[face][2]);
    }
    const LoadedMesh mesh = expect_repaired(soup);
    EXPECT_EQ(mesh.repairs.reoriented_face_count, 4U);
    EXPECT_NEAR(volume(mesh.mesh), 0.0, 1e-12);
    EXPECT_EQ(mesh.face_labels, soup.labels);
}

TEST(Repair, CutsAMoebiusBand) {
    Soup band;
    constexpr int kCount = 12;
    for (int i = 0; i < kCount; ++i) {
        const double turn = 2 * M_PI * i / kCount;
        for (double side : {-0.3, 0.3}) {
            const double radius = 1 + side * std::cos(turn / 2);
            band.points.emplace_back(radius * std::cos(turn), radius * std::sin(turn),
                                     side * std::sin(turn / 2));
        }
    }
    for (int i = 0; i < kCount; ++i) {
        const bool is_last = i + 1 == kCount;
        const int a = 2 * i;
        const int c = is_last ? 1 : a + 2;
        const int d = is_last ? 0 : a + 3;
        band.triangles.push_back({a, a + 1, c});
        band.triangles.push_back({a + 1, d, c});
    }
    const LoadedMesh mesh = expect_repaired(band);
    EXPECT_GT(mesh.repairs.split_edge_count, 0U);
    EXPECT_EQ(mesh.mesh.n_faces(), band.triangles.size());
    // A strip: one boundary loop around a disc.
    EXPECT_EQ(euler_characteristic(mesh.mesh), 1);
}

TEST(Repair, TakesApartSolidsThatTouchAlongAnEdge) {
    const LoadedMesh mesh = expect_repaired(joined(cube_soup(), cube_soup({1, 1, 0})));
    EXPECT_EQ(mesh.mesh.n_vertices(), 16U);
    EXPECT_EQ(boundary_edge_count(mesh.mesh), 0U);
    EXPECT_EQ(euler_characteristic(mesh.mesh), 4);
    EXPECT_NEAR(volume(mesh.mesh), 2.0, 1e-12);
    EXPECT_EQ(mesh.repairs.split_edge_count, 1U);
    EXPECT_EQ(mesh.repairs.split_vertex_count, 2U);
}

TEST(Repair, TakesApartSolidsThatTouchInAVertex) {
    const LoadedMesh mesh = expect_repaired(joined(cube_soup(), cube_soup({1, 1, 1})));
    EXPECT_EQ(mesh.mesh.n_vertices(), 16U);
    EXPECT_EQ(mesh.repairs.split_vertex_count, 1U);
    EXPECT_EQ(mesh.repairs.split_edge_count, 0U);
    EXPECT_EQ(euler_characteristic(mesh.mesh), 4);
}

TEST(Repair, TakesAFinOffItsWall) {
    Soup soup = square_soup(4);
    // A fin on the edges from the middle to the right border.
    const int low[] = {12, 13, 14};
    for (int i = 0; i < 3; ++i) {
        soup.points.emplace_back(soup.points[low[i]] + Vec3(0, 0, 0.3));
    }
    for (int i = 0; i < 2; ++i) {
        soup.triangles.push_back({low[i], low[i + 1], 26 + i});
        soup.triangles.push_back({low[i], 26 + i, 25 + i});
    }
    const LoadedMesh mesh = expect_repaired(soup);
    EXPECT_EQ(mesh.repairs.split_edge_count, 2U);
    // The wall stays whole: its boundary is the square's, and the fin has its own.
    EXPECT_EQ(boundary_edge_count(mesh.mesh), 16U + 6U);
    EXPECT_EQ(euler_characteristic(mesh.mesh), 2);
}

TEST(Repair, SplitsEdgesWithTheSameEnds) {
    // Two tetrahedra share the edge 0-1. One is inside out, so that the faces that continue each
    // other straight across the edge agree and are joined; then both end points stay whole and two
    // edges run between them.
    Soup soup;
    soup.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {0, 1, 0.5}, {0, -1, 0.5}, {-1, 0, 0.5}};
    soup.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2},
                      {0, 1, 4}, {0, 4, 5}, {0, 5, 1}, {1, 5, 4}};
    const LoadedMesh mesh = expect_repaired(soup);
    EXPECT_EQ(mesh.repairs.split_edge_count, 2U);
    EXPECT_EQ(mesh.repairs.split_vertex_count, 0U);
    EXPECT_EQ(mesh.mesh.n_vertices(), 7U);
    EXPECT_EQ(mesh.mesh.n_faces(), 10U);
    EXPECT_EQ(boundary_edge_count(mesh.mesh), 0U);
    EXPECT_EQ(euler_characteristic(mesh.mesh), 2);
}

TEST(Repair, FlipsFacesWithoutArea) {
    // The corner 4 lies on the edge 0-1, where only the lower face knows of it.
    Soup soup;
    soup.points = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}, {0.7, 0, 0}};
    soup.triangles = {{0, 1, 2}, {0, 4, 1}, {0, 3, 4}, {3, 1, 4}};
    soup.labels = {5, 6, 7, 7};
    const LoadedMesh mesh = expect_repaired(soup);
    EXPECT_EQ(mesh.repairs.degenerate_face_count, 1U);
    EXPECT_EQ(mesh.mesh.n_faces(), 4U);
    EXPECT_EQ(boundary_edge_count(mesh.mesh), 4U);
    EXPECT_NEAR(total_area(mesh.mesh), 2.0, 1e-14);
    EXPECT_EQ(mesh.face_labels, (std::vector<int>{5, 5, 7, 7}));
}

TEST(Repair, UnwindsAStripOfFacesWithoutArea) {
    // A fan of collinear faces stitches the long edge of the upper face to seven short ones.
    Soup soup;
    constexpr int kCount = 8;
    soup.points = {{0, 0, 0}, {kCount, 0, 0}, {4, 3, 0}, {4, -3, 0}};
    int previous = 0;
    for (int i = 1; i < kCount; ++i) {
        const int middle = static_cast<int>(soup.points.size());
        soup.points.emplace_back(i, 0, 0);
        soup.triangles.push_back({previous, middle, 1});
        soup.triangles.push_back({3, middle, previous});
        previous = middle;
    }
    soup.triangles.push_back({3, 1, previous});
    soup.triangles.push_back({0, 1, 2});
    const LoadedMesh mesh = expect_repaired(soup);
    EXPECT_EQ(mesh.repairs.degenerate_face_count, 7U);
    EXPECT_EQ(boundary_edge_count(mesh.mesh), 4U);
    EXPECT_NEAR(total_area(mesh.mesh), 24.0, 1e-12);
}

TEST(Repair, DropsFacesWithoutAreaAtABoundary) {
    Soup soup = square_soup(2);
    soup.triangles.push_back({0, 2, 1});  // along the lower border
    const LoadedMesh mesh = expect_repaired(soup);
    EXPECT_EQ(mesh.mesh.n_faces(), 8U);
    EXPECT_EQ(mesh.repairs.degenerate_face_count, 1U);
}

TEST(Repair, RefusesSoupsWithoutAnyArea) {
    Soup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    soup.triangles = {{0, 1, 2}, {1, 2, 3}, {0, 0, 1}};
    EXPECT_THROW(soup.load(), InputError);
    soup.triangles.clear();
    EXPECT_THROW(soup.load(), InputError);
}

TEST(Repair, RefusesWhatDoesNotFitTogether) {
    Soup soup = cube_soup();
    soup.labels.pop_back();
    EXPECT_THROW(soup.load(), InputError);
    soup = cube_soup();
    soup.triangles[3][1] = 8;
    EXPECT_THROW(soup.load(), InputError);
    soup = cube_soup();
    soup.points[2].y() = std::nan("");
    EXPECT_THROW(soup.load(), InputError);
    soup = cube_soup();
    soup.points[2].y() = 1e300;
    EXPECT_THROW(soup.load(), InputError);
}

TEST(Repair, MakesAManifoldOfAnySoup) {
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Randomness random(seed);
        Soup soup;
        const int point_count = 4 + random.index(12);
        for (int i = 0; i < point_count; ++i) {
            // A small lattice: many collinear triples and equal points.
            soup.points.emplace_back(random.index(3), random.index(3), random.index(2));
        }
        const int face_count = 1 + random.index(40);
        for (int i = 0; i < face_count; ++i) {
            soup.triangles.push_back({random.index(soup.points.size()),
                                      random.index(soup.points.size()),
                                      random.index(soup.points.size())});
            soup.labels.push_back(i);
        }
        LoadedMesh mesh;
        try {
            mesh = soup.load();
        } catch (const InputError& error) {
            // Only a soup without any area may be refused.
            ASSERT_NE(std::string(error.what()).find("area"), std::string::npos) << error.what();
            continue;
        }
        expect_manifold(mesh);
        EXPECT_EQ(mesh.hash, soup.load().hash);
        if (HasFailure()) break;
    }
}

}  // namespace
}  // namespace fcn
