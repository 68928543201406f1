#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "features/feature_meshes.h"
#include "features/features.h"
#include "features/mesh_arrays.h"
#include "features/sharp_edges.h"
#include "geometry/errors.h"
#include "geometry/models.h"
#include "support/shared_data.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

using testing::kDegree;
using testing::problems_of;

LoadedMesh model(const std::string& name, double noise = 0, std::uint64_t seed = 1) {
    ModelOptions options;
    options.noise = noise;
    options.seed = seed;
    return make_model(name, options);
}

TEST(Sharp, NoisyPlaneHasNone) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        for (double noise : {0.05, 0.1, 0.2}) {
            const auto network = detect_sharp(model("noisy-plane", noise, seed));
            EXPECT_EQ(network.arcs.size(), 0u) << "seed " << seed << " noise " << noise;
        }
    }
}

TEST(Sharp, NoisySphereHasNone) {
    for (double noise : {0.0, 0.05, 0.1, 0.2}) {
        EXPECT_EQ(detect_sharp(model("sphere", noise)).arcs.size(), 0u) << "noise " << noise;
    }
}

TEST(Sharp, BoxHasTwelveCreasesAndEightCorners) {
    const LoadedMesh mesh = model("box");
    const auto network = detect_sharp(mesh);
    EXPECT_EQ(network.arcs.size(), 12u);
    EXPECT_EQ(network.nodes.size(), 8u);
    for (const NetworkArc& arc : network.arcs) EXPECT_NEAR(arc.dihedral, 90 * kDegree, 1e-6);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    EXPECT_EQ(network.mesh_hash, mesh.hash);
}

TEST(Sharp, TwelveTrianglesOfACubeAreEnough) {
    const auto network = detect_sharp(testing::cube_soup().load());
    EXPECT_EQ(network.arcs.size(), 12u);
    EXPECT_EQ(network.nodes.size(), 8u);
}

// No face agrees with any neighbour, which is what noise looks like, too.
TEST(Sharp, SpikesOnACubeAreAllCreases) {
    std::vector<Vec3> points;
    for (int k = 0; k < 8; ++k) points.emplace_back(k & 1, k >> 1 & 1, k >> 2 & 1);
    std::vector<std::array<int, 3>> triangles;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
        for (int side = 0; side < 2; ++side) {
            Vec3 tip = Vec3::Constant(0.5);
            tip[axis] = side == 0 ? -1.5 : 2.5;
            points.push_back(tip);
            const int top = static_cast<int>(points.size()) - 1, base = side << axis;
            const std::array<int, 4> ring{base, base + u, base + u + v, base + v};
            for (int i = 0; i < 4; ++i) {
                const int a = ring[i], b = ring[(i + 1) % 4];
                triangles.push_back(side == 1 ? std::array{a, b, top} : std::array{b, a, top});
            }
        }
    }
    const auto network = detect_sharp(mesh_from_soup(points, triangles));
    EXPECT_EQ(network.arcs.size(), 36u);
    EXPECT_EQ(network.nodes.size(), 14u);
}

TEST(Sharp, CylinderHasTwoClosedRims) {
    const LoadedMesh mesh = model("cylinder");
    const auto network = detect_sharp(mesh);
    ASSERT_EQ(network.arcs.size(), 2u);
    for (const NetworkArc& arc : network.arcs) EXPECT_TRUE(arc.is_closed());
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
}

TEST(Sharp, GearKeepsEveryCrease) {
    const LoadedMesh mesh = model("gear");
    const auto network = detect_sharp(mesh);
    double creases = 0;
    for (const auto e : mesh.mesh.edges()) {
        if (std::abs(dihedral_angle(mesh.mesh, e)) > 40 * kDegree) {
            creases += mesh.mesh.calc_edge_length(e);
        }
    }
    EXPECT_GT(creases, 0);
    EXPECT_NEAR(network.total_length(), creases, 1e-9 * creases);
}

TEST(Sharp, WeakEdgesContinueAChainButDoNotStartOne) {
    // 50 degrees in the middle, 25 towards both ends.
    const auto angle = [](double y) {
        return (25 + 25 * std::exp(-(y - 24) * (y - 24) / 64)) * kDegree;
    };
    const LoadedMesh mesh = testing::folded_strip(5, 48, 4, angle);
    const auto chain = detect_sharp(mesh);
    ASSERT_EQ(chain.arcs.size(), 1u);
    EXPECT_NEAR(chain.arcs[0].length(), 48, 1e-9);
    const LoadedMesh weak = testing::folded_strip(5, 48, 4, [](double) { return 25 * kDegree; });
    EXPECT_EQ(detect_sharp(weak).arcs.size(), 0u);
    SharpOptions strict;
    strict.low_angle = strict.high_angle;
    const auto core = detect_sharp(mesh, strict);
    ASSERT_EQ(core.arcs.size(), 1u);
    EXPECT_LT(core.arcs[0].length(), 14);  // 40 degrees are exceeded over 11.4
    EXPECT_GT(core.arcs[0].length(), 8);
}

TEST(Sharp, SignSelectsConvexOrConcave) {
    SharpOptions convex, concave;
    convex.sign = SharpSign::Convex;
    concave.sign = SharpSign::Concave;
    for (double sign : {1.0, -1.0}) {
        const LoadedMesh mesh =
            testing::folded_strip(6, 8, 3, [&](double) { return sign * 60 * kDegree; });
        EXPECT_EQ(detect_sharp(mesh, convex).arcs.size(), sign > 0 ? 1u : 0u);
        EXPECT_EQ(detect_sharp(mesh, concave).arcs.size(), sign > 0 ? 0u : 1u);
        EXPECT_EQ(detect_sharp(mesh).arcs.size(), 1u);
    }
}

TEST(Sharp, MinLengthCountsConnectedChains) {
    const LoadedMesh mesh = testing::folded_strip(6, 8, 3, [](double) { return 60 * kDegree; });
    SharpOptions options;
    options.min_length = 7.9;
    EXPECT_EQ(detect_sharp(mesh, options).arcs.size(), 1u);
    options.min_length = 8.1;
    EXPECT_EQ(detect_sharp(mesh, options).arcs.size(), 0u);
}

TEST(Sharp, OptionsOutOfRangeAreRefused) {
    const LoadedMesh mesh = testing::cube_soup().load();
    SharpOptions options;
    options.high_angle = 0;
    EXPECT_THROW(detect_sharp(mesh, options), InputError);
    options = {};
    options.low_angle = 2 * options.high_angle;
    EXPECT_THROW(detect_sharp(mesh, options), InputError);
    options = {};
    options.min_length = std::nan("");
    EXPECT_THROW(detect_sharp(mesh, options), InputError);
}

/// Edges on curves of the CAD model, as pairs of vertices of the file.
std::set<std::pair<int, int>> cad_edges(const std::filesystem::path& path) {
    std::ifstream in(path);
    std::vector<std::pair<int, int>> edges;
    for (std::string line; std::getline(in, line);) {
        int a = 0, b = 0;
        if (line[0] != '#' && std::istringstream(line) >> a >> b) edges.push_back({a, b});
    }
    return testing::edge_set(edges);
}

struct CadCase {
    std::string name;
    double high_degrees;
    double low_degrees;
};

class SharpOnCad : public ::testing::TestWithParam<CadCase> {};

TEST_P(SharpOnCad, FindsTheModelsCurvesAndLittleElse) {
    const auto folder = testing::shared_data();
    if (!folder) GTEST_SKIP() << "no shared data";
    const auto& [name, high, low] = GetParam();
    const LoadedMesh mesh = read_mesh(*folder / "meshes" / (name + ".off"));
    ASSERT_TRUE(mesh.repairs.is_clean());  // so that vertex ids are those of the file
    const auto truth = cad_edges(*folder / "meshes" / (name + ".cadedges.txt"));
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    SharpOptions options;
    options.high_angle = high * kDegree;
    options.low_angle = low * kDegree;
    const auto is_sharp = sharp_edges(arrays, robust_dihedrals(arrays, options.low_angle), options);
    int found = 0, missed = 0, wrong = 0;
    for (int e = 0; e < arrays.edge_count(); ++e) {
        const auto [a, b] = arrays.edge_vertices[e];
        const bool is_true = truth.count(std::minmax(a, b)) > 0;
        const bool is_strong = std::abs(arrays.dihedrals[e]) >= options.high_angle;
        if (is_sharp[e]) {
            ++(is_true ? found : wrong);
        } else if (is_true && is_strong) {
            ++missed;
        }
    }
    EXPECT_GE(found, 0.98 * (found + missed)) << "missed " << missed;
    EXPECT_GE(found, 0.95 * (found + wrong)) << "wrong " << wrong;
}

INSTANTIATE_TEST_SUITE_P(Cad, SharpOnCad,
                         ::testing::Values(CadCase{"CrankArm", 40, 18}, CadCase{"frame", 60, 48}),
                         [](const auto& which) { return which.param.name; });

TEST(Threshold, MarksWhatTheAnglesSay) {
    for (const char* name : {"gear", "octaflower", "thin-wall", "noisy-plane"}) {
        const Mesh mesh = make_model(name, {}).mesh;
        for (double degrees : {1.0, 18.0, 40.0, 89.0, 91.0, 150.0}) {
            const double angle = degrees * std::numbers::pi / 180;
            const std::vector<bool> marks = edges_above(mesh, angle);
            ASSERT_EQ(marks.size(), mesh.n_edges());
            for (const auto edge : mesh.edges()) {
                const double found = std::abs(dihedral_angle(mesh, edge));
                if (std::abs(found - angle) < 1e-9) continue;
                ASSERT_EQ(marks[edge.idx()], found > angle) << name << " edge " << edge.idx();
            }
        }
    }
    const Mesh mesh = make_model("box", {}).mesh;
    EXPECT_THROW(edges_above(mesh, 0), InputError);
    EXPECT_THROW(edges_above(mesh, std::nan("")), InputError);
}

TEST(Threshold, PlainNetworkIsTheMarkedEdges) {
    const LoadedMesh mesh = model("noisy-plane");
    SharpOptions options;
    options.is_plain = true;
    double length = 0;
    const std::vector<bool> marks = edges_above(mesh.mesh, options.high_angle);
    for (const auto edge : mesh.mesh.edges())
        if (marks[edge.idx()]) length += mesh.mesh.calc_edge_length(edge);
    EXPECT_GT(length, 0);
    EXPECT_NEAR(detect_sharp(mesh, options).total_length(), length, 1e-9 * length);
}

TEST(Threshold, PatchesLieBetweenMarkedEdges) {
    const Mesh mesh = make_model("gear", {}).mesh;
    const std::vector<bool> marks = edges_above(mesh, 0.7);
    const std::vector<int> patches = patches_between(mesh, marks);
    // Top, bottom, bore, and three faces and a gap of each of eight teeth.
    EXPECT_EQ(*std::max_element(patches.begin(), patches.end()) + 1, 3 + 4 * 8);
    EXPECT_EQ(patches.front(), 0);
    for (const auto edge : mesh.edges()) {
        const auto h = mesh.halfedge_handle(edge, 0);
        const int left = patches[mesh.face_handle(h).idx()];
        const int right = patches[mesh.face_handle(mesh.opposite_halfedge_handle(h)).idx()];
        EXPECT_EQ(left != right, static_cast<bool>(marks[edge.idx()]));
    }
}

}  // namespace
}  // namespace fcn
