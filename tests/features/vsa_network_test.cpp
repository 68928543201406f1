#include <gtest/gtest.h>

#include "features/border_cut.h"
#include "features/edge_chains.h"
#include "features/feature_meshes.h"
#include "features/features.h"
#include "features/straighten.h"
#include "geometry/models.h"
#include "support/shared_data.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

using testing::kDegree;
using testing::problems_of;

std::vector<bool> borders(const MeshArrays& arrays, const std::vector<int>& patch) {
    std::vector<bool> is_border(arrays.edge_count(), false);
    for (int e = 0; e < arrays.edge_count(); ++e) {
        const auto [f, g] = arrays.edge_faces[e];
        is_border[e] = f >= 0 && g >= 0 && patch[f] != patch[g];
    }
    return is_border;
}

std::vector<int> patches_by(const MeshArrays& arrays,
                            const std::function<int(const Vec3&)>& patch_at) {
    std::vector<int> patch(arrays.face_count());
    for (int f = 0; f < arrays.face_count(); ++f) patch[f] = patch_at(arrays.centroid(f));
    return patch;
}

TEST(Straighten, ZigzagOfAStraightLineBecomesStraight) {
    for (double slope : {0.0, 0.13, 0.35, 0.5, 0.77, 1.3, -0.4, -1.0}) {
        const LoadedMesh mesh = testing::height_field(60, 60, [](double, double) { return 0.0; });
        const MeshArrays arrays = mesh_arrays(mesh.mesh);
        const auto patch = patches_by(
            arrays, [&](const Vec3& c) { return c.y() - 30.1 < slope * (c.x() - 30.2) ? 0 : 1; });
        const EdgeNetwork edges = trace_edges(arrays, borders(arrays, patch), patch, "test");
        ASSERT_EQ(edges.network.arcs.size(), 1u) << slope;
        const auto network =
            straighten(arrays, edges, std::vector<bool>(arrays.edge_count(), false));
        const NetworkArc& arc = network.arcs[0];
        const double chord = (arc.samples.back().position - arc.samples[0].position).norm();
        EXPECT_LT(arc.length(), 1.02 * chord) << "slope " << slope;
        EXPECT_EQ(problems_of(network, mesh.mesh), "");
    }
}

TEST(Straighten, CircleKeepsItsSize) {
    const LoadedMesh mesh = testing::height_field(60, 60, [](double, double) { return 0.0; });
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    for (double radius : {1.2, 3.0, 8.0, 20.0}) {
        const auto patch = patches_by(arrays, [&](const Vec3& c) {
            return (c - Vec3(30.1, 29.8, 0)).norm() < radius ? 0 : 1;
        });
        const EdgeNetwork edges = trace_edges(arrays, borders(arrays, patch), patch, "test");
        ASSERT_EQ(edges.network.arcs.size(), 1u);
        const auto network =
            straighten(arrays, edges, std::vector<bool>(arrays.edge_count(), false));
        const NetworkArc& arc = network.arcs[0];
        EXPECT_TRUE(arc.is_closed());
        EXPECT_EQ(arc.patches, edges.network.arcs[0].patches);
        double area = 0;
        for (std::size_t i = 0; i + 1 < arc.samples.size(); ++i) {
            area += 0.5 * arc.samples[i].position.cross(arc.samples[i + 1].position).z();
        }
        double face_total = 0;
        for (int f = 0; f < arrays.face_count(); ++f) face_total += patch[f] == 0 ? 0.5 : 0;
        EXPECT_NEAR(std::abs(area), face_total, 0.2 * face_total) << "radius " << radius;
        if (radius >= 8) {
            EXPECT_LT(arc.length(), 1.03 * 2 * std::numbers::pi * radius);
            EXPECT_GT(arc.length(), 0.95 * 2 * std::numbers::pi * radius);
        }
        EXPECT_EQ(problems_of(network, mesh.mesh), "");
    }
}

TEST(Straighten, KeepsNodesArcsPatchesAndTheBoundary) {
    const LoadedMesh mesh = testing::height_field(
        40, 40, [](double x, double y) { return 0.02 * (x - 20) * (y - 15); });
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    const auto patch = patches_by(arrays, [](const Vec3& c) {
        const double x = c.x() - 20, y = c.y() - 20;
        return y > 0.6 * x + 1 ? (x < 2 ? 0 : 1) : (x + y < -3 ? 2 : 3);
    });
    const EdgeNetwork edges = trace_edges(arrays, borders(arrays, patch), patch, "test");
    const auto network = straighten(arrays, edges, std::vector<bool>(arrays.edge_count(), false));
    ASSERT_EQ(network.arcs.size(), edges.network.arcs.size());
    ASSERT_EQ(network.nodes.size(), edges.network.nodes.size());
    for (std::size_t n = 0; n < network.nodes.size(); ++n) {
        EXPECT_EQ(network.nodes[n].position, edges.network.nodes[n].position);
    }
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        const NetworkArc& before = edges.network.arcs[a];
        const NetworkArc& after = network.arcs[a];
        EXPECT_EQ(after.nodes, before.nodes);
        EXPECT_EQ(after.patches, before.patches);
        EXPECT_LE(after.length(), before.length() + 1e-9);
        EXPECT_GT(after.length(), 0.5 * before.length());
        for (const ArcSample& sample : after.samples) {
            double nearest = 1e300;
            for (const ArcSample& old : before.samples) {
                nearest = std::min(nearest, (old.position - sample.position).norm());
            }
            EXPECT_LT(nearest, 2.0);
        }
    }
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
}

TEST(Straighten, CreaseSamplesStay) {
    const LoadedMesh mesh = testing::folded_strip(20, 30, 10, [](double) { return 1.0; });
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    const auto patch = patches_by(arrays, [](const Vec3& c) { return c.x() < 10 ? 0 : 1; });
    const EdgeNetwork edges = trace_edges(arrays, borders(arrays, patch), patch, "test");
    const auto network = straighten(arrays, edges, borders(arrays, patch));
    ASSERT_EQ(network.arcs.size(), 1u);
    ASSERT_EQ(network.arcs[0].samples.size(), edges.network.arcs[0].samples.size());
    for (std::size_t i = 0; i < network.arcs[0].samples.size(); ++i) {
        EXPECT_EQ(network.arcs[0].samples[i].position, edges.network.arcs[0].samples[i].position);
    }
}

TEST(BorderCut, MovesABorderOntoTheCreaseBesideIt) {
    const LoadedMesh mesh = testing::folded_strip(20, 30, 10, [](double) { return 35 * kDegree; });
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    // The border runs one or two faces beside the crease, in steps.
    const auto patch = patches_by(arrays, [](const Vec3& c) {
        return c.x() < 10 + (static_cast<int>(c.y() / 4) % 2 == 0 ? 1 : -1) ? 0 : 1;
    });
    const std::vector<Vec3> proxies{Vec3::UnitZ(),
                                    Vec3(std::sin(35 * kDegree), 0, std::cos(35 * kDegree))};
    const auto moved = move_borders(arrays, arrays.dihedrals, {}, patch, proxies);
    for (int f = 0; f < arrays.face_count(); ++f) {
        EXPECT_EQ(moved[f], arrays.centroid(f).x() < 10 ? 0 : 1);
    }
}

TEST(BorderCut, SnapsToABorderOfLabels) {
    const LoadedMesh mesh = testing::height_field(
        20, 30, [](double, double) { return 0.0; }, [](int x, int) { return x < 9 ? 4 : 5; });
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    const auto patch = patches_by(arrays, [](const Vec3& c) { return c.x() < 11 ? 0 : 1; });
    const std::vector<Vec3> proxies(2, Vec3::UnitZ());
    const auto moved = move_borders(arrays, arrays.dihedrals, mesh.face_labels, patch, proxies);
    for (int f = 0; f < arrays.face_count(); ++f) {
        EXPECT_EQ(moved[f], arrays.centroid(f).x() < 9 ? 0 : 1);
    }
}

TEST(BorderCut, EveryPatchSurvivesInOnePiece) {
    const LoadedMesh mesh = make_model("octaflower");
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    VsaOptions options;
    options.patch_count = 150;
    const VsaResult vsa = segment_vsa(mesh.mesh, options);
    const auto moved =
        move_borders(arrays, arrays.dihedrals, {}, vsa.patch_of_face, vsa.proxy_normals);
    std::vector<int> parts(vsa.proxy_normals.size(), 0);
    std::vector<bool> is_seen(arrays.face_count(), false);
    for (int start = 0; start < arrays.face_count(); ++start) {
        if (is_seen[start]) continue;
        ++parts[moved[start]];
        std::vector<int> stack{start};
        is_seen[start] = true;
        while (!stack.empty()) {
            const int f = stack.back();
            stack.pop_back();
            for (int g : arrays.face_neighbors[f]) {
                if (g < 0 || is_seen[g] || moved[g] != moved[f]) continue;
                is_seen[g] = true;
                stack.push_back(g);
            }
        }
    }
    for (int count : parts) EXPECT_EQ(count, 1);
}

TEST(VsaNetwork, BoxGivesItsTwelveCreases) {
    const LoadedMesh mesh = make_model("box");
    const auto network = detect_vsa(mesh);
    EXPECT_EQ(network.arcs.size(), 12u);
    EXPECT_EQ(network.nodes.size(), 8u);
    for (const NetworkArc& arc : network.arcs) {
        EXPECT_NE(arc.patches[0], arc.patches[1]);
        EXPECT_GE(std::min(arc.patches[0], arc.patches[1]), 0);
        EXPECT_EQ(arc.source, "vsa");
    }
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
}

TEST(VsaNetwork, CreaseThatEndsInsideAPatchIsThere) {
    // A fold that fades out: few patches do not border on it all along.
    const auto angle = [](double y) { return std::max(0.0, 70 - 4 * y) * kDegree; };
    const LoadedMesh mesh = testing::folded_strip(30, 30, 15, angle);
    VsaOptions options;
    options.patch_count = 1;
    const auto network = detect_vsa(mesh, options);
    ASSERT_EQ(network.arcs.size(), 1u);
    EXPECT_GE(network.arcs[0].length(), 7);  // 40 degrees at y = 7.5
    EXPECT_EQ(network.arcs[0].patches[0], network.arcs[0].patches[1]);
    options.crease_angle = 0;
    EXPECT_EQ(detect_vsa(mesh, options).arcs.size(), 0u);
}

TEST(VsaNetwork, SameOnOneThreadAndTwo) {
    const LoadedMesh mesh = make_model("octaflower");
    VsaOptions options;
    const auto one = detect_vsa(mesh, options);
    options.threads = 2;
    const auto two = detect_vsa(mesh, options);
    ASSERT_EQ(one.arcs.size(), two.arcs.size());
    for (std::size_t a = 0; a < one.arcs.size(); ++a) {
        ASSERT_EQ(one.arcs[a].samples.size(), two.arcs[a].samples.size());
        EXPECT_EQ(one.arcs[a].nodes, two.arcs[a].nodes);
        for (std::size_t i = 0; i < one.arcs[a].samples.size(); ++i) {
            EXPECT_EQ(one.arcs[a].samples[i].position, two.arcs[a].samples[i].position);
        }
    }
}

class VsaOnMesh : public ::testing::TestWithParam<std::string> {};

TEST_P(VsaOnMesh, ValidAndNoSharpCreaseIsMissing) {
    const auto folder = testing::shared_data();
    if (!folder) GTEST_SKIP() << "no shared data";
    const LoadedMesh mesh = read_mesh(*folder / "meshes" / (GetParam() + ".off"));
    const auto network = detect_vsa(mesh);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    const MeshArrays arrays = mesh_arrays(mesh.mesh);
    double total = 0, covered = 0;
    for (int e = 0; e < arrays.edge_count(); ++e) {
        if (std::abs(arrays.dihedrals[e]) < 40 * kDegree) continue;
        const Vec3 middle = 0.5 * (arrays.points[arrays.edge_vertices[e][0]] +
                                   arrays.points[arrays.edge_vertices[e][1]]);
        total += arrays.edge_length(e);
        if (testing::distance_to(network, middle) <= 0.5 * arrays.mean_edge_length) {
            covered += arrays.edge_length(e);
        }
    }
    EXPECT_GT(total, 0);
    EXPECT_GE(covered, 0.98 * total);
}

INSTANTIATE_TEST_SUITE_P(Cad, VsaOnMesh,
                         ::testing::Values("fandisk", "anchor_dense", "CrankArm", "frame"));

}  // namespace
}  // namespace fcn
