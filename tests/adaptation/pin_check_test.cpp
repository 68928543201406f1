#include "adaptation/pin_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "adaptation/networks.h"

namespace fcn {
namespace {

constexpr double kRmin = 0.1;

/// Curves drawn on the unit square.
struct Drawing {
    LoadedMesh mesh;
    FeatureCurveNetwork network;

    Drawing() {
        mesh.mesh = test::sheet(10, 10, [](int i, int j) { return Vec3(i / 10.0, j / 10.0, 0); });
        mesh.name = "sheet";
    }
    NetworkArc& add(const std::vector<Vec3>& points, Pin pin = Pin::Keep) {
        NetworkArc arc;
        arc.pin = pin;
        for (const Vec3& point : points) arc.samples.push_back({point, {}});
        for (int side = 0; side < 2; ++side)
            arc.nodes[side] = node(side == 0 ? points.front() : points.back());
        network.arcs.push_back(arc);
        return network.arcs.back();
    }
    int node(const Vec3& point) {
        for (std::size_t n = 0; n < network.nodes.size(); ++n)
            if (network.nodes[n].position == point) return static_cast<int>(n);
        network.nodes.push_back({point, {}});
        return static_cast<int>(network.nodes.size()) - 1;
    }
};

AdaptationOptions options_at(double rmin) {
    AdaptationOptions options;
    options.rmin = rmin;
    return options;
}

/// Whether the pins of a drawing hold at a scale.
bool holds(const Drawing& drawing, double rmin) {
    return check_pins(drawing.mesh, drawing.network, options_at(rmin)).conflicts.empty();
}

TEST(PinCheck, PinsThatFitAreFine) {
    Drawing drawing;
    drawing.add({{0.1, 0.3, 0}, {0.9, 0.3, 0}});
    drawing.add({{0.1, 0.7, 0}, {0.9, 0.7, 0}});
    drawing.add({{0.1, 0.32, 0}, {0.9, 0.32, 0}}, Pin::None);
    drawing.add({{0.1, 0.68, 0}, {0.9, 0.68, 0}}, Pin::Drop);
    EXPECT_TRUE(holds(drawing, kRmin));
}

TEST(PinCheck, NamesThePairItsDistanceAndAScaleThatFits) {
    for (double distance : {0.03, 0.05, 0.011}) {
        Drawing drawing;
        drawing.add({{0.1, 0.8, 0}, {0.9, 0.8, 0}});
        drawing.add({{0.1, 0.5, 0}, {0.9, 0.5, 0}});
        drawing.add({{0.1, 0.5 + distance, 0}, {0.9, 0.5 + distance, 0}});
        const PinCheck check = check_pins(drawing.mesh, drawing.network, options_at(kRmin));
        ASSERT_EQ(check.conflicts.size(), 1u) << distance;
        const PinConflict& conflict = check.conflicts[0];
        EXPECT_EQ(conflict.first, 1);
        EXPECT_EQ(conflict.second, 2);
        EXPECT_NEAR(conflict.distance, distance, 0.2 * distance);
        // It fits there, not at all where lines are closer than the flattest triangle is high, and
        // certainly where they are farther than rmin apart.
        EXPECT_TRUE(holds(drawing, conflict.largest_scale)) << distance;
        const double height = std::sqrt(1 - 1.5 * 1.5 / 4);
        EXPECT_LE(conflict.largest_scale, distance / height * (1 + 1e-6)) << distance;
        EXPECT_GE(conflict.largest_scale, distance / 2) << distance;
        const std::string message = conflict.message(kRmin);
        EXPECT_NE(message.find("arcs 1 and 2 are pinned 0."), std::string::npos) << message;
        EXPECT_NE(message.find("; both fit up to scale 0.0"), std::string::npos) << message;
    }
}

TEST(PinCheck, ShortArcsFitWhereTheyAreLongEnough) {
    Drawing drawing;
    drawing.add({{0.4, 0.5, 0}, {0.46, 0.5, 0}});
    const PinCheck check = check_pins(drawing.mesh, drawing.network, options_at(kRmin));
    ASSERT_EQ(check.conflicts.size(), 1u);
    EXPECT_EQ(check.conflicts[0].kind, PinConflict::Kind::Length);
    EXPECT_NEAR(check.conflicts[0].distance, 0.06, 1e-12);
    EXPECT_NEAR(check.conflicts[0].largest_scale, 0.06, 0.001);
    EXPECT_LE(check.conflicts[0].largest_scale, 0.06 * (1 + 1e-6));
    EXPECT_TRUE(holds(drawing, check.conflicts[0].largest_scale));
}

TEST(PinCheck, NoScaleMakesASharpAngleFit) {
    Drawing drawing;
    const double angle = 12 * std::numbers::pi / 180;
    drawing.add({{0.2, 0.2, 0}, {0.8, 0.2, 0}});
    drawing.add({{0.2, 0.2, 0}, {0.2 + 0.6 * std::cos(angle), 0.2 + 0.6 * std::sin(angle), 0}});
    const PinCheck check = check_pins(drawing.mesh, drawing.network, options_at(0.05));
    ASSERT_FALSE(check.conflicts.empty());
    EXPECT_EQ(check.conflicts[0].largest_scale, 0);
    const std::string message = check.conflicts[0].message(0.05);
    EXPECT_NE(message.find("no scale was found"), std::string::npos) << message;
}

TEST(PinCheck, BordersAreHeldAgainstFeaturesButNotEachOther) {
    Drawing borders;
    borders.add({{0.1, 0.5, 0}, {0.9, 0.5, 0}}).kind = ArcKind::Boundary;
    borders.add({{0.1, 0.52, 0}, {0.9, 0.52, 0}}).kind = ArcKind::LabelBorder;
    EXPECT_TRUE(holds(borders, kRmin));
    borders.add({{0.1, 0.54, 0}, {0.9, 0.54, 0}});
    const PinCheck check = check_pins(borders.mesh, borders.network, options_at(kRmin));
    ASSERT_EQ(check.conflicts.size(), 2u);
    for (const PinConflict& conflict : check.conflicts) EXPECT_EQ(conflict.second, 2);
}

TEST(PinCheck, ArcsThatContinueEachOtherAreOneChain) {
    // Neither part carries a segment of the scale alone; joined they do.
    Drawing drawing;
    drawing.add({{0.3, 0.5, 0}, {0.37, 0.5, 0}});
    drawing.add({{0.37, 0.5, 0}, {0.42, 0.5, 0}});
    EXPECT_TRUE(holds(drawing, kRmin));
}

}  // namespace
}  // namespace fcn
