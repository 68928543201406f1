#include <gtest/gtest.h>

#include "features/feature_meshes.h"
#include "features/features.h"
#include "geometry/models.h"
#include "support/shared_data.h"
#include "support/small_meshes.h"

namespace fcn {
namespace {

using testing::kDegree;
using testing::length_of_kind;
using testing::problems_of;

double boundary_length(const Mesh& mesh) {
    double length = 0;
    for (const auto e : mesh.edges()) {
        if (mesh.is_boundary(e)) length += mesh.calc_edge_length(e);
    }
    return length;
}

LoadedMesh flat(int nx, int ny, const std::function<int(int, int)>& label = {}) {
    return testing::height_field(
        nx, ny, [](double, double) { return 0.0; }, label);
}

TEST(Boundaries, SquareHasFourPinnedSides) {
    const LoadedMesh mesh = flat(12, 8);
    const auto network = add_boundaries({}, mesh, BoundaryPolicy::Keep);
    EXPECT_EQ(network.nodes.size(), 4u);
    ASSERT_EQ(network.arcs.size(), 4u);
    for (const NetworkArc& arc : network.arcs) {
        EXPECT_EQ(arc.kind, ArcKind::Boundary);
        EXPECT_EQ(arc.pin, Pin::Keep);
    }
    EXPECT_DOUBLE_EQ(network.total_length(), 40);
    EXPECT_GT(network.diagonal, 0);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
}

TEST(Boundaries, PolicyDecidesThePin) {
    const LoadedMesh mesh = flat(12, 8);
    const auto adapted = add_boundaries({}, mesh, BoundaryPolicy::Adapt);
    EXPECT_EQ(adapted.arcs.size(), 4u);
    for (const NetworkArc& arc : adapted.arcs) EXPECT_EQ(arc.pin, Pin::None);
    EXPECT_TRUE(add_boundaries({}, mesh, BoundaryPolicy::Ignore).arcs.empty());
}

TEST(Boundaries, ClosedMeshWithoutLabelsChangesNothing) {
    const LoadedMesh mesh = make_model("box");
    const auto before = detect_sharp(mesh);
    const auto after = add_boundaries(before, mesh, BoundaryPolicy::Keep);
    EXPECT_EQ(after.arcs.size(), before.arcs.size());
    EXPECT_NEAR(after.total_length(), before.total_length(), 1e-12);
}

TEST(Boundaries, CornerAngleDecidesTheNodes) {
    const LoadedMesh mesh = flat(12, 8);
    const auto network = add_boundaries({}, mesh, BoundaryPolicy::Keep, 100 * kDegree);
    ASSERT_EQ(network.arcs.size(), 1u);
    EXPECT_TRUE(network.arcs[0].is_closed());
}

TEST(Boundaries, FeatureEndsInNodesOfTheBoundary) {
    const LoadedMesh mesh = testing::folded_strip(10, 14, 4, [](double) { return 60 * kDegree; });
    const auto features = detect_sharp(mesh);
    ASSERT_EQ(features.arcs.size(), 1u);
    const auto network = add_boundaries(features, mesh, BoundaryPolicy::Keep);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    EXPECT_NEAR(length_of_kind(network, ArcKind::Boundary), boundary_length(mesh.mesh), 1e-9);
    const std::vector<int> valences = network.valences();
    int feature_count = 0;
    for (const NetworkArc& arc : network.arcs) {
        if (arc.kind != ArcKind::Feature) continue;
        ++feature_count;
        EXPECT_EQ(arc.pin, Pin::None);
        for (int node : arc.nodes) EXPECT_EQ(valences[node], 3);
    }
    EXPECT_EQ(feature_count, 1);
}

TEST(Boundaries, FeatureAlongABoundaryIsReplaced) {
    const LoadedMesh mesh = flat(12, 8);
    std::vector<bool> is_marked(mesh.mesh.n_edges(), false);
    for (const auto e : mesh.mesh.edges()) {
        const auto h = mesh.mesh.halfedge_handle(e, 0);
        const Vec3& p = mesh.mesh.point(mesh.mesh.from_vertex_handle(h));
        const Vec3& q = mesh.mesh.point(mesh.mesh.to_vertex_handle(h));
        // Along y = 0 from x = 2 to 9, then up x = 9 to the middle.
        const bool along =
            p.y() == 0 && q.y() == 0 && std::min(p.x(), q.x()) >= 2 && std::max(p.x(), q.x()) <= 9;
        const bool up = p.x() == 9 && q.x() == 9 && std::max(p.y(), q.y()) <= 4;
        is_marked[e.idx()] = along || up;
    }
    const auto features = network_from_edges(mesh.mesh, is_marked, {}, "test");
    ASSERT_EQ(features.arcs.size(), 1u);
    const auto network = add_boundaries(features, mesh, BoundaryPolicy::Keep);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    EXPECT_NEAR(length_of_kind(network, ArcKind::Feature), 4, 1e-12);
    EXPECT_NEAR(length_of_kind(network, ArcKind::Boundary), 40, 1e-12);
    EXPECT_EQ(network.nodes.size(), 6u);  // corners, where the feature leaves, its free end
    EXPECT_EQ(network.arcs.size(), 6u);
}

TEST(Boundaries, LabelBordersArePinnedArcs) {
    const LoadedMesh mesh = flat(12, 9, [](int x, int y) { return x < 5 ? 1 : y < 3 ? 2 : 3; });
    const auto network = add_boundaries({}, mesh, BoundaryPolicy::Keep);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    EXPECT_NEAR(length_of_kind(network, ArcKind::LabelBorder), 9 + 7, 1e-12);
    EXPECT_NEAR(length_of_kind(network, ArcKind::Boundary), 42, 1e-12);
    int label_arcs = 0;
    for (const NetworkArc& arc : network.arcs) {
        EXPECT_EQ(arc.pin, Pin::Keep);
        label_arcs += arc.kind == ArcKind::LabelBorder;
    }
    EXPECT_EQ(label_arcs, 3);
}

TEST(Boundaries, FeatureAcrossFacesGetsANodeWhereItCrossesALabelBorder) {
    const LoadedMesh mesh = flat(12, 9, [](int x, int) { return x < 6 ? 1 : 2; });
    FeatureCurveNetwork features;
    // A line through face interiors at y = 4.3 from x = 2.1 to 9.6, in steps of 0.3.
    NetworkArc arc;
    const auto sample_at = [&](double x, double y) {
        ArcSample sample;
        for (const auto f : mesh.mesh.faces()) {
            const auto [a, b, c] = face_vertices(mesh.mesh, f);
            const Vec3 p(x, y, 0);
            const Vec3 A = mesh.mesh.point(a), B = mesh.mesh.point(b), C = mesh.mesh.point(c);
            const double area = (B - A).cross(C - A).z();
            const Vec3 w((C - B).cross(p - B).z() / area, (A - C).cross(p - C).z() / area,
                         (B - A).cross(p - A).z() / area);
            if (w.minCoeff() < 0) continue;
            sample = {p, {f.idx(), w}};
        }
        return sample;
    };
    for (int i = 0; i <= 25; ++i) arc.samples.push_back(sample_at(2.05 + 0.3 * i, 4.3));
    arc.nodes = {0, 1};
    features.nodes.push_back({arc.samples.front().position, arc.samples.front().surface});
    features.nodes.push_back({arc.samples.back().position, arc.samples.back().surface});
    features.arcs.push_back(arc);
    const auto network = add_boundaries(features, mesh, BoundaryPolicy::Keep);
    EXPECT_EQ(problems_of(network, mesh.mesh), "");
    const std::vector<int> valences = network.valences();
    int crossing = -1;
    for (std::size_t n = 0; n < network.nodes.size(); ++n) {
        if (valences[n] == 4) crossing = static_cast<int>(n);
    }
    ASSERT_GE(crossing, 0);
    EXPECT_NEAR((network.nodes[crossing].position - Vec3(6, 4.3, 0)).norm(), 0, 1e-9);
    EXPECT_NEAR(length_of_kind(network, ArcKind::Feature), 7.5, 1e-9);
    EXPECT_NEAR(length_of_kind(network, ArcKind::LabelBorder), 9, 1e-9);
}

class BoundariesOnMesh : public ::testing::TestWithParam<std::string> {};

TEST_P(BoundariesOnMesh, EveryLoopIsThereAndPinned) {
    const auto folder = testing::shared_data();
    if (!folder) GTEST_SKIP() << "no shared data";
    const LoadedMesh mesh = read_mesh(*folder / "meshes" / (GetParam() + ".off"));
    ASSERT_GT(boundary_length(mesh.mesh), 0);
    VsaOptions options;
    options.patch_count = 60;
    for (const auto& features : {detect_sharp(mesh), detect_vsa(mesh, options)}) {
        const auto network = add_boundaries(features, mesh, BoundaryPolicy::Keep);
        EXPECT_EQ(problems_of(network, mesh.mesh), "");
        EXPECT_NEAR(length_of_kind(network, ArcKind::Boundary), boundary_length(mesh.mesh),
                    1e-9 * boundary_length(mesh.mesh));
        for (const NetworkArc& arc : network.arcs) {
            EXPECT_EQ(arc.pin, arc.kind == ArcKind::Feature ? Pin::None : Pin::Keep);
        }
        // A feature that reaches the boundary shares a node with it.
        std::vector<bool> is_boundary_node(network.nodes.size(), false);
        for (const NetworkArc& arc : network.arcs) {
            if (arc.kind != ArcKind::Boundary) continue;
            for (int node : arc.nodes) is_boundary_node[node] = true;
        }
        for (const NetworkArc& arc : network.arcs) {
            if (arc.kind != ArcKind::Feature) continue;
            for (std::size_t i = 0; i < arc.samples.size(); ++i) {
                const bool is_end = i == 0 || i + 1 == arc.samples.size();
                const SurfacePoint& at = arc.samples[i].surface;
                for (int k = 0; k < 3; ++k) {
                    if (at.barycentric[k] != 1) continue;
                    const auto v = face_vertices(mesh.mesh, FaceHandle(at.face))[k];
                    if (!mesh.mesh.is_boundary(v)) continue;
                    ASSERT_TRUE(is_end);
                    EXPECT_TRUE(is_boundary_node[arc.nodes[i == 0 ? 0 : 1]]);
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Open, BoundariesOnMesh,
                         ::testing::Values("mech-holes-shark", "ChineseDragon-10kv"),
                         [](const auto& which) {
                             std::string name = which.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace fcn
