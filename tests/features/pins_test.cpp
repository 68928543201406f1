#include "features/pins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "features/feature_meshes.h"
#include "features/features.h"
#include "geometry/errors.h"
#include "geometry/models.h"
#include "geometry/vertex_values.h"

namespace fcn {
namespace {

using testing::problems_of;

PinRule numbered(PinRule::Target target, int index, Pin pin = Pin::Keep) {
    PinRule rule;
    rule.target = target;
    rule.pin = pin;
    rule.index = index;
    rule.name = "--keep number:" + std::to_string(index);
    return rule;
}

PinRule box(const Vec3& a, const Vec3& b, Pin pin = Pin::Keep) {
    PinRule rule;
    rule.target = PinRule::Target::Box;
    rule.pin = pin;
    rule.box = Eigen::AlignedBox3d(a);
    rule.box.extend(b);
    rule.name = "--keep-box";
    return rule;
}

double length_of(const FeatureCurveNetwork& network, Pin pin) {
    double length = 0;
    for (const NetworkArc& arc : network.arcs) length += arc.pin == pin ? arc.length() : 0;
    return length;
}

/// Length of the polylines for which `is_in` holds, by fine sampling.
template <class Test>
double measured(const FeatureCurveNetwork& network, Test is_in) {
    constexpr int kSteps = 2000;
    double length = 0;
    for (const NetworkArc& arc : network.arcs) {
        for (std::size_t i = 0; i + 1 < arc.samples.size(); ++i) {
            const Vec3 &a = arc.samples[i].position, &b = arc.samples[i + 1].position;
            int count = 0;
            for (int k = 0; k < kSteps; ++k) count += is_in(a + (k + 0.5) / kSteps * (b - a));
            length += (b - a).norm() * count / kSteps;
        }
    }
    return length;
}

TEST(Pins, NumbersPinWholeArcsAndCurves) {
    const LoadedMesh mesh = make_model("ribs");
    FeatureCurveNetwork network = detect_sharp(mesh);
    find_curves(network);
    int curve = 0;
    for (int c = 0; c < static_cast<int>(network.curves.size()); ++c)
        if (network.curves[c].arcs.size() > network.curves[curve].arcs.size()) curve = c;
    const FeatureCurveNetwork result = apply_pins(
        network, mesh,
        {numbered(PinRule::Target::Curve, curve), numbered(PinRule::Target::Arc, 3, Pin::Drop)});
    EXPECT_EQ(problems_of(result, mesh.mesh), "");
    const std::vector<int>& kept = network.curves[curve].arcs;
    ASSERT_EQ(std::ranges::find(kept, 3), kept.end());
    for (int a = 0; a < static_cast<int>(network.arcs.size()); ++a) {
        const bool is_kept = std::ranges::find(kept, a) != kept.end();
        EXPECT_EQ(result.arcs[a].pin, is_kept ? Pin::Keep : a == 3 ? Pin::Drop : Pin::None) << a;
    }
    EXPECT_EQ(result.curves.size(), network.curves.size());
}

TEST(Pins, BoxesCutArcsWhereTheyEnd) {
    const LoadedMesh mesh = make_model("gear");
    const FeatureCurveNetwork network = detect_sharp(mesh);
    const std::uint64_t seed = 11;
    std::mt19937_64 random(seed);
    const BoundingBox bounds = bounding_box(mesh.mesh);
    for (int trial = 0; trial < 10; ++trial) {
        std::uniform_real_distribution<double> share(0, 1);
        const auto draw = [&] {
            const Vec3 t(share(random), share(random), share(random));
            return Vec3(bounds.min + t.cwiseProduct(bounds.max - bounds.min));
        };
        PinRule rule = box(draw(), draw());
        rule.box.extend(Vec3((bounds.min + bounds.max) / 2 + Vec3(0, 0, bounds.diagonal())));
        rule.box.extend(Vec3((bounds.min + bounds.max) / 2 - Vec3(0, 0, bounds.diagonal())));
        const FeatureCurveNetwork result = apply_pins(network, mesh, {rule});
        EXPECT_EQ(problems_of(result, mesh.mesh), "") << "seed " << seed;
        EXPECT_NEAR(result.total_length(), network.total_length(), 1e-9);
        const double inside =
            measured(network, [&](const Vec3& p) { return rule.box.contains(p); });
        EXPECT_NEAR(length_of(result, Pin::Keep), inside, 2e-3 * network.total_length())
            << "seed " << seed;
    }
}

TEST(Pins, ShortStretchesFollowTheirNeighbours) {
    const LoadedMesh mesh = make_model("box");
    const FeatureCurveNetwork network = detect_sharp(mesh);
    const BoundingBox bounds = bounding_box(mesh.mesh);
    const double size = (bounds.max - bounds.min).minCoeff();
    Vec3 inner = bounds.min;
    inner.array() += 0.1 * size;
    const PinRule rule = box(bounds.min - Vec3(1, 1, 1), inner);
    EXPECT_NEAR(length_of(apply_pins(network, mesh, {rule}), Pin::Keep), 0.3 * size, 1e-9);
    const FeatureCurveNetwork result = apply_pins(network, mesh, {rule}, {}, {0.15 * size});
    EXPECT_EQ(length_of(result, Pin::Keep), 0);
    EXPECT_EQ(result.arcs.size(), network.arcs.size());
    EXPECT_EQ(result.notes.size(), network.notes.size() + 1);
}

TEST(Pins, ImportanceIsLinearBetweenVertices) {
    const LoadedMesh mesh = make_model("box");
    const FeatureCurveNetwork network = detect_sharp(mesh);
    PaintedImportance paint;
    paint.name = "paint";
    const auto importance = [](const Vec3& p) { return 3 * p.x() - 2 * p.y() - 0.3; };
    for (const VertexHandle v : mesh.mesh.vertices())
        paint.of_vertex.push_back(importance(mesh.mesh.point(v)));
    const FeatureCurveNetwork result = apply_pins(network, mesh, {}, paint);
    EXPECT_EQ(problems_of(result, mesh.mesh), "");
    const double high = measured(network, [&](const Vec3& p) { return importance(p) >= 0.5; });
    const double low = measured(network, [&](const Vec3& p) { return importance(p) <= -0.5; });
    ASSERT_GT(high, 0);
    ASSERT_GT(low, 0);
    EXPECT_NEAR(length_of(result, Pin::Keep), high, 1e-3);
    EXPECT_NEAR(length_of(result, Pin::Drop), low, 1e-3);
    EXPECT_NEAR(result.total_length(), network.total_length(), 1e-9);
}

TEST(Pins, NumbersGoBeforeBoxesAndBoxesBeforeImportance) {
    const LoadedMesh mesh = make_model("box");
    const FeatureCurveNetwork network = detect_sharp(mesh);
    PaintedImportance paint;
    paint.of_vertex.assign(mesh.mesh.n_vertices(), 1.0);
    const Vec3 far(100, 100, 100);
    const FeatureCurveNetwork result = apply_pins(
        network, mesh, {numbered(PinRule::Target::Arc, 0), box(-far, far, Pin::Drop)}, paint);
    EXPECT_EQ(result.arcs[0].pin, Pin::Keep);
    for (std::size_t a = 1; a < result.arcs.size(); ++a) EXPECT_EQ(result.arcs[a].pin, Pin::Drop);
}

TEST(Pins, BordersAreNotPlaces) {
    const LoadedMesh mesh = testing::folded_strip(10, 10, 5, [](double) { return 1.0; });
    const FeatureCurveNetwork network =
        add_boundaries(detect_sharp(mesh), mesh, BoundaryPolicy::Keep);
    const Vec3 far(100, 100, 100);
    const FeatureCurveNetwork result = apply_pins(network, mesh, {box(-far, far, Pin::Drop)});
    for (const NetworkArc& arc : result.arcs)
        EXPECT_EQ(arc.pin, arc.kind == ArcKind::Feature ? Pin::Drop : Pin::Keep);
}

TEST(Pins, NonsenseIsRefused) {
    const LoadedMesh mesh = make_model("box");
    const FeatureCurveNetwork network = detect_sharp(mesh);
    const auto refused = [&](const std::vector<PinRule>& rules, const std::string& part,
                             const PaintedImportance& paint = {}) {
        try {
            apply_pins(network, mesh, rules, paint);
            ADD_FAILURE() << "accepted: " << part;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    };
    refused({numbered(PinRule::Target::Arc, 12)}, "arc 12 does not exist");
    refused({numbered(PinRule::Target::Curve, 500)}, "curve 500 does not exist");
    refused({numbered(PinRule::Target::Arc, 2), numbered(PinRule::Target::Arc, 2, Pin::Drop)},
            "arc 2 is to be kept and to be dropped");
    const Vec3 far(100, 100, 100);
    refused({box(-far, far), box(-far, far, Pin::Drop)}, "overlap");
    refused({box(far, 2 * far)}, "no feature passes");
    PaintedImportance paint;
    paint.name = "paint.txt";
    paint.of_vertex = {1, 2, 3};
    refused({}, "paint.txt: 3 values", paint);
    paint.of_vertex.assign(mesh.mesh.n_vertices(), std::nan(""));
    refused({}, "not finite", paint);
}

TEST(VertexValues, ArePropertiesOfPlyVertices) {
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property uchar red\nproperty float z\nproperty double importance\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const VertexValues values =
        read_ply_values(header + "0 1 255 2 -0.5\n3 4 0 5 1e-3\n", "a.ply", "importance");
    EXPECT_EQ(values.points, (std::vector<Vec3>{{0, 1, 2}, {3, 4, 5}}));
    EXPECT_EQ(values.values, (std::vector<double>{-0.5, 1e-3}));
    for (const auto& [body, property] : {std::pair("0 1 255 2 -0.5\n3 4 0 5 1\n", "paint"),
                                         std::pair("0 1 255 2 nan\n3 4 0 5 1\n", "importance"),
                                         std::pair("0 1 255 2 0.5\n3 4 0\n", "importance")})
        EXPECT_THROW(read_ply_values(header + body, "a.ply", property), InputError) << body;
}

}  // namespace
}  // namespace fcn
