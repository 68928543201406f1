#include "meshing/quad_extraction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "meshing/grid_map.h"
#include "sample_maps.h"

namespace fcn {
namespace {

using test::mapped_patches;
using test::MappedMesh;
using test::PatchOptions;

QuadExtraction extract(const MappedMesh& mapped) { return extract_quads(mapped.mesh, mapped.map); }

/// Number of vertices of each number of edges that is not 4, boundary ones aside.
std::map<int, int> irregular_valences(const QuadMesh& mesh) {
    std::vector<int> valences(mesh.points.size(), 0);
    std::vector<char> is_boundary(mesh.points.size(), 0);
    const std::vector<int> opposite = opposite_halfedges(mesh);
    for (std::size_t h = 0; h < opposite.size(); ++h) {
        const int v = mesh.faces[h / 4][h % 4], w = mesh.faces[h / 4][(h + 1) % 4];
        ++valences[static_cast<std::size_t>(v)];
        if (opposite[h] >= 0) continue;
        is_boundary[static_cast<std::size_t>(v)] = is_boundary[static_cast<std::size_t>(w)] = 1;
    }
    std::map<int, int> counts;
    for (std::size_t v = 0; v < valences.size(); ++v)
        if (!is_boundary[v] && valences[v] != 4) ++counts[valences[v]];
    return counts;
}

void expect_grid(const QuadMesh& patches, const PatchOptions& options) {
    SCOPED_TRACE("cells " + std::to_string(options.cells) + ", squares " +
                 std::to_string(options.squares) + ", seed " + std::to_string(options.seed) +
                 (options.is_turning ? ", turning" : ""));
    const MappedMesh mapped = mapped_patches(patches, options);
    ASSERT_TRUE(corner_map_faults(mapped.mesh, mapped.map).is_none())
        << corner_map_faults(mapped.mesh, mapped.map).message();
    const QuadExtraction quads = extract(mapped);
    ASSERT_EQ(quads.fault, "");
    const auto expected = test::expected_faces(patches, options.squares);
    EXPECT_EQ(quads.mesh.faces.size(), expected.size());
    // Triangles map to the same places as the patch where that is a parallelogram.
    if (test::are_parallelograms(patches)) {
        EXPECT_TRUE(test::positions_of(quads.mesh) == expected);
    }
    EXPECT_EQ(irregular_valences(quads.mesh), irregular_valences(patches));
    EXPECT_EQ(check_topology(quads.mesh).euler_characteristic,
              check_topology(patches).euler_characteristic);
    ASSERT_EQ(quads.places.size(), quads.mesh.points.size());
    ASSERT_EQ(quads.domain_vertices.size(), quads.mesh.points.size());
    for (std::size_t v = 0; v < quads.places.size(); ++v) {
        EXPECT_EQ(position(mapped.mesh, quads.places[v]), quads.mesh.points[v]);
        const int own = quads.domain_vertices[v];
        if (own < 0) continue;
        EXPECT_LT((mapped.mesh.point(VertexHandle(own)) - quads.mesh.points[v]).norm(), 1e-12);
    }
}

/// Lines of the grid inside faces, along edges, through vertices; whole points in each of these.
void expect_grids(const QuadMesh& patches) {
    unsigned seed = 1;
    for (const int cells : {1, 2, 3, 4, 8}) {
        for (const int squares : {1, 2, 4, 5}) {
            for (const bool is_turning : {false, true})
                expect_grid(patches, {cells, squares, 0, is_turning, seed++});
            expect_grid(patches, {cells, squares, 0.25, true, seed++});
        }
    }
}

TEST(QuadExtraction, CutsAPlaneIntoItsGrid) { expect_grids(test::quad_grid(3, 2)); }

TEST(QuadExtraction, CutsATorusIntoItsGrid) { expect_grids(test::quad_torus(3, 1, 4, 3)); }

TEST(QuadExtraction, CutsACylinderIntoItsGrid) {
    QuadMesh cylinder = test::quad_torus(3, 1, 5, 4);
    // The torus without one ring around its axis; that leaves no vertex behind.
    cylinder.faces.erase(cylinder.faces.begin(), cylinder.faces.begin() + 5);
    EXPECT_EQ(check_topology(cylinder).boundary_loops, 2);
    expect_grids(cylinder);
}

TEST(QuadExtraction, KeepsSingularitiesOfEveryIndex) {
    for (const int valence : {3, 4, 5, 6, 8}) {
        SCOPED_TRACE("valence " + std::to_string(valence));
        expect_grids(test::quad_fan(valence));
    }
}

TEST(QuadExtraction, CutsACubeIntoItsGrid) {
    expect_grids(test::quad_cube());
    const QuadExtraction quads = extract(mapped_patches(test::quad_cube(), {4, 3, 0.2, true, 7}));
    EXPECT_EQ(irregular_valences(quads.mesh), (std::map<int, int>{{3, 8}}));
}

TEST(QuadExtraction, KeepsHandlesAndComponents) {
    std::set<std::array<int, 3>> blocks;
    for (int x = 0; x < 5; ++x)
        for (int y = 0; y < 3; ++y)
            if (y != 1 || x % 2 == 0) blocks.insert({x, y, 0});
    blocks.insert({7, 0, 0});
    const QuadMesh patches = test::quad_blocks(blocks);
    const QuadTopology topology = check_topology(patches);
    ASSERT_EQ(topology.fault, "");
    ASSERT_EQ(topology.components, 2);
    ASSERT_EQ(topology.euler_characteristic, -2 + 2);  // genus 2, and a cube
    for (unsigned seed = 1; seed <= 10; ++seed)
        expect_grid(patches, {1 + static_cast<int>(seed) % 5, 1 + static_cast<int>(seed) % 4, 0.25,
                              true, seed});
}

TEST(QuadExtraction, FollowsLinesAcrossSlivers) {
    // Two long triangles, 40 lines each way through one diagonal, moved by less than a square.
    expect_grid(test::quad_grid(1, 1), {1, 40, 0, true, 3});
    MappedMesh mapped = mapped_patches(test::quad_grid(1, 1), {1, 40, 0, false, 3});
    for (auto& face : mapped.map.uv)
        for (Vec2& p : face) p += 64 * Vec2(p[1], 0);
    const QuadExtraction sheared = extract(mapped);
    EXPECT_NE(sheared.fault.find("boundary edge off the lines"), std::string::npos)
        << sheared.fault;
}

/// A torus with `around` squares along each quarter of its tube and one along a sixth of its axis.
MappedMesh thin_torus(double around) {
    MappedMesh mapped = mapped_patches(test::quad_torus(3, 1, 6, 4), {4, 1, 0.2, false, 2});
    for (std::size_t f = 0; f < mapped.map.uv.size(); ++f) {
        const std::size_t patch = f / 32;
        for (Vec2& p : mapped.map.uv[f])
            p = {p[0] + static_cast<double>(patch % 6),
                 around * (p[1] + static_cast<double>(patch / 6))};
    }
    return mapped;
}

TEST(QuadExtraction, DividesRowsAroundThinTubes) {
    const QuadExtraction wide = extract(thin_torus(1));
    EXPECT_EQ(wide.fault, "");
    EXPECT_EQ(wide.divided_rows, 0);
    EXPECT_EQ(wide.mesh.faces.size(), 24u);
    for (const double around : {0.5, 0.25}) {
        const MappedMesh mapped = thin_torus(around);
        const QuadExtraction thin = extract(mapped);
        ASSERT_EQ(thin.fault, "") << around;
        EXPECT_EQ(thin.divided_rows, 1);
        EXPECT_EQ(thin.mesh.faces.size(), 18u);  // three around, the fewest there can be
        EXPECT_EQ(check_topology(thin.mesh).euler_characteristic, 0);
        EXPECT_TRUE(irregular_valences(thin.mesh).empty());
        for (std::size_t v = 0; v < thin.places.size(); ++v)
            EXPECT_EQ(position(mapped.mesh, thin.places[v]), thin.mesh.points[v]);
    }
}

TEST(QuadExtraction, IsDeterministic) {
    const MappedMesh mapped = mapped_patches(test::quad_cube(), {8, 5, 0.25, true, 5});
    const QuadExtraction first = extract(mapped), second = extract(mapped);
    EXPECT_EQ(first.mesh.faces, second.mesh.faces);
    EXPECT_EQ(first.mesh.points, second.mesh.points);
}

/// The fault after a change of a sound map of a cube; corner 0 is at a whole point.
template <class Change>
std::string fault_after(const Change& change, int squares = 3) {
    MappedMesh mapped = mapped_patches(test::quad_cube(), {4, squares, 0, true, 11});
    change(mapped);
    const QuadExtraction quads = extract(mapped);
    if (!quads.fault.empty()) {
        EXPECT_TRUE(quads.mesh.faces.empty());
        EXPECT_TRUE(quads.places.empty());
        EXPECT_TRUE(quads.domain_vertices.empty());
    }
    return quads.fault;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(QuadExtraction, SaysWhatIsWrongWithAMap) {
    EXPECT_EQ(fault_after([](MappedMesh&) {}), "");
    EXPECT_EQ(fault_after([](MappedMesh& m) { m.map.uv.pop_back(); }),
              "a map of 191 faces for a mesh of 192");
    EXPECT_EQ(fault_after([](MappedMesh& m) { m.map.uv[7][1][0] = std::nan(""); }),
              "face 7: coordinates that are not finite");
    EXPECT_EQ(fault_after([](MappedMesh& m) {
                  m.map.uv[8][1][0] = -std::numeric_limits<double>::infinity();
              }),
              "face 8: coordinates that are not finite");
    EXPECT_EQ(fault_after([](MappedMesh& m) { m.map.uv[9][1][0] += 1e-9; }),
              "edge between faces 8 and 9: not a quarter turn");
    EXPECT_EQ(fault_after([](MappedMesh& m) { m.map.uv[9][1][0] = 1e-18; }),
              "face 9: coordinates that are not truncated");
    EXPECT_EQ(fault_after([](MappedMesh& m) { std::swap(m.map.uv[5][1], m.map.uv[5][2]); }),
              "face 5: turned over");
    EXPECT_EQ(fault_after([](MappedMesh& m) { m.map.uv[5][1] = m.map.uv[5][2]; }),
              "face 5: without area");
    EXPECT_TRUE(contains(fault_after([](MappedMesh& m) {
                             for (Vec2& p : m.map.uv[6]) p += Vec2(0.5, 0);
                         }),
                         "shift is not whole"));
    EXPECT_TRUE(contains(fault_after([](MappedMesh& m) {
                             for (auto& face : m.map.uv)
                                 for (Vec2& p : face) p *= 1e6;
                         }),
                         "more than 50000000 quads"));
}

TEST(QuadExtraction, WantsSingularitiesOnTheGrid) {
    // Three fans of one, whole inside but turned about a point that is not.
    MappedMesh mapped = mapped_patches(test::quad_fan(3), {4, 2, 0, false, 1});
    for (auto& face : mapped.map.uv)
        for (Vec2& p : face) p *= 1.5;
    EXPECT_EQ(extract(mapped).fault, "");
    for (auto& face : mapped.map.uv)
        for (Vec2& p : face) p += Vec2(0.5, 0.5);
    const std::string fault = extract(mapped).fault;
    EXPECT_TRUE(contains(fault, "boundary edge off the lines")) << fault;
    // A cube whose corners are at half points; its transitions are whole all the same.
    MappedMesh cube = mapped_patches(test::quad_cube(), {4, 3, 0, false, 1});
    for (auto& face : cube.map.uv)
        for (Vec2& p : face) p += Vec2(0.5, 0.5);
    EXPECT_TRUE(contains(extract(cube).fault, "valence 3, not on the grid")) << extract(cube).fault;
}

TEST(QuadExtraction, RowsAreDividedWhereQuadsAreFarFromTheSurface) {
    // Half a cylinder of radius 1 and two quads: a chord of a right angle is 1 - cos 45 degrees
    // from its arc, one of half of that 1 - cos 22.5 degrees.
    MappedMesh mapped = mapped_patches(test::quad_grid(1, 1), {32, 2, 0, false, 1});
    for (const VertexHandle v : mapped.mesh.vertices()) {
        const double angle = std::numbers::pi * mapped.mesh.point(v)[0];
        mapped.mesh.set_point(v, {std::cos(angle), mapped.mesh.point(v)[1], -std::sin(angle)});
    }
    const auto quads = [&](double tolerance, std::size_t most) {
        RowOptions options;
        options.tolerance = tolerance;
        options.most_quads = most;
        const QuadExtraction result = extract_quads(mapped.mesh, mapped.map, options);
        EXPECT_EQ(result.fault, "");
        return result.mesh.faces.size();
    };
    EXPECT_EQ(quads(0, 100), 4u);
    EXPECT_EQ(quads(1 - std::cos(std::numbers::pi / 4) + 1e-9, 100), 4u);
    EXPECT_EQ(quads(0.1, 100), 8u);
    EXPECT_EQ(quads(0.1, 7), 6u);
    EXPECT_EQ(quads(1 - std::cos(std::numbers::pi / 8) + 1e-9, 100), 8u);
    EXPECT_EQ(quads(0.05, 100), 12u);
}

TEST(QuadExtraction, RefusesWhatIsNoMeshOfQuads) {
    // A cylinder of one quad around: its faces have the same corner twice.
    QuadMesh ring = test::quad_torus(3, 1, 4, 4);
    MappedMesh mapped = mapped_patches(ring, {2, 4, 0, false, 1});
    for (auto& face : mapped.map.uv)
        for (Vec2& p : face) p /= 16;
    const std::string fault = extract(mapped).fault;
    EXPECT_FALSE(fault.empty());
}

TEST(GridMap, TurnsAndOrders) {
    const GridPoint p{3, -7};
    for (int k = 0; k < 4; ++k) {
        EXPECT_EQ(turned(turned(p, k), 4 - k), p);
        EXPECT_EQ(orientation(direction_vector(k), direction_vector((k + 1) & 3)), 1);
        EXPECT_EQ(orientation(direction_vector(k), direction_vector((k + 2) & 3)), 0);
    }
    const GridPoint a{std::int64_t{1} << 60, 1}, b{(std::int64_t{1} << 60) - 1, 1};
    EXPECT_EQ(orientation(a, b), 1);
    EXPECT_EQ(orientation(b, a), -1);
}

}  // namespace
}  // namespace fcn
