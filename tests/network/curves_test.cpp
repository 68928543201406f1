#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "network/network.h"
#include "network/sample_networks.h"

namespace fcn {
namespace {

using namespace fcn::testing;

constexpr double kPi = std::numbers::pi;

double total(const std::vector<SupportingCurve>& curves) {
    double sum = 0;
    for (const SupportingCurve& curve : curves) sum += curve.length;
    return sum;
}

/// The rule of section 5.3.1 followed arc by arc with sets: quadratic, and without the chains of
/// the implementation.
class Oracle {
public:
    Oracle(const FeatureCurveNetwork& network, double max_turning)
        : network_(network), max_turning_(max_turning) {}

    SupportingCurve extend(int start) const {
        const auto& p = network_.arcs[start].patches;
        std::set<int> patches;
        for (int patch : p)
            if (patch >= 0) patches.insert(patch);
        if (patches.empty()) patches.insert(-1);
        SupportingCurve best;
        for (int patch : patches) {
            const SupportingCurve curve = extend(start, patch);
            if (std::pair(curve.is_loop, curve.length) > std::pair(best.is_loop, best.length))
                best = curve;
        }
        return best;
    }

    /// The end that continues `end`, or -1.
    int continuation(int end, int patch) const {
        double straightest = 10;
        for (int other = 0; other < end_count(); ++other)
            if (other != end && node(other) == node(end))
                straightest = std::min(straightest, turning(end, other));
        if (straightest > 9 || (patch < 0 && !(straightest < max_turning_))) return -1;
        for (int other = 0; other < end_count(); ++other)
            if (other != end && node(other) == node(end) && borders(other / 2, patch) &&
                std::cos(turning(end, other)) >= std::cos(straightest) - 1e-9)
                return other;
        return -1;
    }

    bool borders(int arc, int patch) const {
        const auto& p = network_.arcs[arc].patches;
        return patch < 0 ? p[0] < 0 && p[1] < 0 : p[0] == patch || p[1] == patch;
    }

private:
    int end_count() const { return 2 * static_cast<int>(network_.arcs.size()); }
    int node(int end) const { return network_.arcs[end / 2].nodes[end % 2]; }
    Vec3 tangent(int end) const {
        const auto& s = network_.arcs[end / 2].samples;
        const Vec3 d =
            end % 2 ? s[s.size() - 2].position - s.back().position : s[1].position - s[0].position;
        return d.normalized();
    }
    double turning(int end, int other) const {
        return std::acos(std::clamp(-tangent(end).dot(tangent(other)), -1.0, 1.0));
    }

    /// Arcs reached through one end; is_loop when the walk comes back to the start the same way.
    std::set<int> reach(int start, int first_end, int patch, bool& is_loop) const {
        std::set<int> arcs{start};
        int end = first_end;
        while (true) {
            const int in = continuation(end, patch);
            if (in < 0) return arcs;
            if (!arcs.insert(in / 2).second) {
                is_loop = in == (first_end ^ 1);
                return arcs;
            }
            end = in ^ 1;
        }
    }

    double length(const std::set<int>& arcs) const {
        double sum = 0;
        for (int arc : arcs) sum += network_.arcs[arc].length();
        return sum;
    }

    SupportingCurve extend(int start, int patch) const {
        bool is_forward_loop = false, is_backward_loop = false;
        std::set<int> forward = reach(start, 2 * start + 1, patch, is_forward_loop);
        const std::set<int> backward = reach(start, 2 * start, patch, is_backward_loop);
        if (is_forward_loop || is_backward_loop)
            return {std::max(is_forward_loop ? length(forward) : 0,
                             is_backward_loop ? length(backward) : 0),
                    true};
        forward.insert(backward.begin(), backward.end());
        return {length(forward), network_.arcs[start].is_closed()};
    }

    const FeatureCurveNetwork& network_;
    double max_turning_;
};

void expect_partition(const FeatureCurveNetwork& network, double max_turning) {
    ASSERT_TRUE(validate(network).empty()) << validate(network).front();
    const Oracle oracle(network, max_turning);
    std::size_t listed = 0;
    for (const NetworkCurve& curve : network.curves) {
        listed += curve.arcs.size();
        double length = 0;
        for (int arc : curve.arcs) length += network.arcs[arc].length();
        EXPECT_NEAR(curve.length, length, 1e-12 * length);
        // Some patch (or none) is common to all, and neighbours continue each other mutually.
        bool has_common_patch = false;
        const auto& first = network.arcs[curve.arcs[0]].patches;
        for (int patch : {first[0], first[1]}) {
            bool is_common = true;
            for (int arc : curve.arcs) is_common = is_common && oracle.borders(arc, patch);
            for (std::size_t k = 0; is_common && k < curve.arcs.size(); ++k) {
                if (k + 1 == curve.arcs.size() && (!curve.is_closed || k == 0)) break;
                const std::size_t next = (k + 1) % curve.arcs.size();
                const int out = 2 * curve.arcs[k] + (curve.is_reversed[k] ? 0 : 1);
                const int in = 2 * curve.arcs[next] + (curve.is_reversed[next] ? 1 : 0);
                is_common =
                    oracle.continuation(out, patch) == in && oracle.continuation(in, patch) == out;
            }
            has_common_patch = has_common_patch || is_common;
        }
        EXPECT_TRUE(has_common_patch);
    }
    EXPECT_EQ(listed, network.arcs.size());
}

FeatureCurveNetwork without_patches(FeatureCurveNetwork network) {
    for (NetworkArc& arc : network.arcs) arc.patches = {-1, -1};
    return network;
}

TEST(Curves, YJunctionTurnsTooMuch) {
    FeatureCurveNetwork network = y_junction();
    for (const SupportingCurve& curve : supporting_curves(network)) {
        EXPECT_NEAR(curve.length, 1, 1e-12);
        EXPECT_FALSE(curve.is_loop);
    }
    find_curves(network);
    EXPECT_EQ(network.curves.size(), 3u);
    // 60 degrees of turning are allowed: every arc goes on into another, none mutually by all.
    CurveOptions wide;
    wide.max_turning = kPi / 2;
    for (const SupportingCurve& curve : supporting_curves(network, wide))
        EXPECT_NEAR(curve.length, 2, 1e-12);
}

TEST(Curves, TJunctionWithPatches) {
    FeatureCurveNetwork network = t_junction();
    const auto curves = supporting_curves(network);
    EXPECT_DOUBLE_EQ(curves[0].length, 3);  // the bar borders patch 0 throughout
    EXPECT_DOUBLE_EQ(curves[1].length, 3);
    // Both halves of the bar are equally straight for the stem; each borders one of its patches.
    EXPECT_DOUBLE_EQ(curves[2].length, 6);
    find_curves(network);
    ASSERT_EQ(network.curves.size(), 2u);
    EXPECT_EQ(network.curves[0].arcs, (std::vector<int>{0, 1}));
    EXPECT_EQ(network.curves[1].arcs, (std::vector<int>{2}));
    EXPECT_EQ(network.arcs[1].curve, 0);
}

TEST(Curves, TJunctionWithoutPatches) {
    FeatureCurveNetwork network = without_patches(t_junction());
    const auto curves = supporting_curves(network);
    EXPECT_DOUBLE_EQ(curves[0].length, 3);
    EXPECT_DOUBLE_EQ(curves[2].length, 4);
}

TEST(Curves, PatchesAndNoneDoNotContinueEachOther) {
    FeatureCurveNetwork network = t_junction();
    network.arcs[1].patches = {-1, -1};
    const auto curves = supporting_curves(network);
    EXPECT_DOUBLE_EQ(curves[0].length, 1);
    EXPECT_DOUBLE_EQ(curves[1].length, 2);
}

TEST(Curves, CrossingOfFourPatchesStops) {
    // Straight continuations share no patch at a crossing; without patches they continue.
    FeatureCurveNetwork network = NetworkBuilder()
                                      .arc({{0, 0, 0}, {1, 0, 0}}, {0, 3})
                                      .arc({{0, 0, 0}, {0, 2, 0}}, {1, 0})
                                      .arc({{0, 0, 0}, {-3, 0, 0}}, {2, 1})
                                      .arc({{0, 0, 0}, {0, -4, 0}}, {3, 2})
                                      .build();
    auto curves = supporting_curves(network);
    for (int a = 0; a < 4; ++a) EXPECT_DOUBLE_EQ(curves[a].length, a + 1);
    find_curves(network);
    EXPECT_EQ(network.curves.size(), 4u);
    network = without_patches(network);
    curves = supporting_curves(network);
    EXPECT_DOUBLE_EQ(curves[0].length, 4);
    EXPECT_DOUBLE_EQ(curves[1].length, 6);
    find_curves(network);
    ASSERT_EQ(network.curves.size(), 2u);
    EXPECT_EQ(network.curves[0].arcs, (std::vector<int>{2, 0}));
    EXPECT_TRUE(network.curves[0].is_reversed[0]);
}

TEST(Curves, OnePatchHoldsForTheWholeCurve) {
    // A straight row of arcs with patches 0|1, 0|2, 3|2: neighbours share a patch, all three none.
    FeatureCurveNetwork network = NetworkBuilder()
                                      .arc({{0, 0, 0}, {1, 0, 0}}, {0, 1})
                                      .arc({{1, 0, 0}, {3, 0, 0}}, {0, 2})
                                      .arc({{3, 0, 0}, {7, 0, 0}}, {3, 2})
                                      .build();
    const auto curves = supporting_curves(network);
    EXPECT_DOUBLE_EQ(curves[0].length, 3);
    EXPECT_DOUBLE_EQ(curves[1].length, 6);
    EXPECT_DOUBLE_EQ(curves[2].length, 6);
    find_curves(network);
    ASSERT_EQ(network.curves.size(), 2u);
    EXPECT_EQ(network.curves[1].arcs, (std::vector<int>{1, 2}));
}

TEST(Curves, CubeSidesAreLoops) {
    FeatureCurveNetwork network = cube();
    for (const SupportingCurve& curve : supporting_curves(network)) {
        EXPECT_NEAR(curve.length, 4, 1e-12);
        EXPECT_TRUE(curve.is_loop);
    }
    find_curves(network);
    expect_partition(network, CurveOptions{}.max_turning);
    // Two opposite sides, and the four edges between them.
    EXPECT_EQ(network.curves.size(), 6u);
    EXPECT_EQ(std::count_if(network.curves.begin(), network.curves.end(),
                            [](const NetworkCurve& c) { return c.is_closed; }),
              2);
    network = without_patches(cube());
    EXPECT_NEAR(total(supporting_curves(network)), 12, 1e-12);
}

TEST(Curves, ClosedArcs) {
    FeatureCurveNetwork network = two_loops();
    const auto curves = supporting_curves(network);
    for (int a = 0; a < 2; ++a) {
        EXPECT_TRUE(curves[a].is_loop);
        EXPECT_DOUBLE_EQ(curves[a].length, network.arcs[a].length());
    }
    find_curves(network);
    ASSERT_EQ(network.curves.size(), 2u);
    EXPECT_TRUE(network.curves[0].is_closed && network.curves[1].is_closed);
}

TEST(Curves, FigureEightIsOneLoop) {
    FeatureCurveNetwork network = figure_eight();
    for (const SupportingCurve& curve : supporting_curves(network)) {
        EXPECT_TRUE(curve.is_loop);
        EXPECT_DOUBLE_EQ(curve.length, network.total_length());
    }
    find_curves(network);
    ASSERT_EQ(network.curves.size(), 1u);
    EXPECT_TRUE(network.curves[0].is_closed);
    EXPECT_EQ(network.curves[0].arcs, (std::vector<int>{0, 1}));
}

TEST(Curves, LassoTailIsNoLoop) {
    FeatureCurveNetwork network = lasso();
    const auto curves = supporting_curves(network);
    EXPECT_TRUE(curves[0].is_loop);
    EXPECT_FALSE(curves[1].is_loop);
    EXPECT_NEAR(curves[1].length, network.total_length(), 1e-12);
    find_curves(network);
    expect_partition(network, CurveOptions{}.max_turning);
    EXPECT_EQ(network.curves.size(), 1u);
    EXPECT_FALSE(network.curves[0].is_closed);
}

TEST(Curves, RingOfArcsIsALoopAndItsTailIsNot) {
    // A polygon of 16 arcs; a tail joins it tangentially, so it continues into the ring
    // one-sidedly.
    NetworkBuilder builder;
    const auto corner = [](int k) {
        return Vec3(std::cos(2 * kPi * (k % 16) / 16), std::sin(2 * kPi * (k % 16) / 16), 0);
    };
    for (int k = 0; k < 16; ++k) builder.arc({corner(k), corner(k + 1)});
    const double bend = kPi / 6;  // more than the ring's own turning of pi / 8
    const Vec3 into = (corner(1) - corner(0)).normalized();
    const Vec3 from(std::cos(bend) * into[0] - std::sin(bend) * into[1],
                    std::sin(bend) * into[0] + std::cos(bend) * into[1], 0);
    builder.arc({corner(0) - 2 * from, corner(0)});
    const FeatureCurveNetwork network = builder.build();
    const double ring = network.total_length() - 2;
    const auto curves = supporting_curves(network);
    for (int k = 0; k < 16; ++k) {
        EXPECT_TRUE(curves[k].is_loop);
        EXPECT_NEAR(curves[k].length, ring, 1e-12);
    }
    EXPECT_FALSE(curves[16].is_loop);
    EXPECT_NEAR(curves[16].length, ring + 2, 1e-12);
}

TEST(Curves, TangentLengthLooksPastNoise) {
    // Each arc hooks sideways within 0.01 of the node; over a length of 1 they are straight.
    FeatureCurveNetwork network = NetworkBuilder()
                                      .arc({{0, 0, 0}, {0, 0.01, 0}, {2, 0, 0}})
                                      .arc({{0, 0, 0}, {0, 0.01, 0.001}, {-2, 0, 0}})
                                      .build();
    EXPECT_LT(supporting_curves(network)[0].length, 3);
    CurveOptions options;
    options.tangent_length = 1;
    EXPECT_GT(supporting_curves(network, options)[0].length, 4);
}

TEST(Curves, AgreeWithTheOracleOnRandomNetworks) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        FeatureCurveNetwork network =
            random_network(seed, 3 + static_cast<int>(seed % 12), 20 + static_cast<int>(seed % 9));
        CurveOptions options;
        options.max_turning = seed % 3 == 0 ? kPi / 4 : seed % 3 == 1 ? kPi / 2 : 3;
        const auto curves = supporting_curves(network, options);
        const Oracle oracle(network, options.max_turning);
        for (std::size_t a = 0; a < network.arcs.size(); ++a) {
            const SupportingCurve expected = oracle.extend(static_cast<int>(a));
            EXPECT_EQ(curves[a].is_loop, expected.is_loop) << "arc " << a;
            EXPECT_NEAR(curves[a].length, expected.length, 1e-9) << "arc " << a;
        }
        find_curves(network, options);
        expect_partition(network, options.max_turning);
    }
}

TEST(Curves, DirectionsOfArcsDoNotMatter) {
    for (std::uint64_t seed = 1000; seed < 1100; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const FeatureCurveNetwork network = random_network(seed, 6, 20);
        FeatureCurveNetwork reversed = network;
        for (std::size_t a = seed % 2; a < reversed.arcs.size(); a += 2) {
            NetworkArc& arc = reversed.arcs[a];
            std::reverse(arc.samples.begin(), arc.samples.end());
            std::swap(arc.nodes[0], arc.nodes[1]);
            std::swap(arc.patches[0], arc.patches[1]);
        }
        CurveOptions options;
        options.max_turning = 2;
        const auto a = supporting_curves(network, options);
        const auto b = supporting_curves(reversed, options);
        for (std::size_t k = 0; k < a.size(); ++k) {
            EXPECT_EQ(a[k].is_loop, b[k].is_loop) << "arc " << k;
            EXPECT_NEAR(a[k].length, b[k].length, 1e-9) << "arc " << k;
        }
    }
}

TEST(Curves, LongChainsTakeLinearTime) {
    // Quadratic following of 200,000 arcs would run into the test's time limit.
    FeatureCurveNetwork network;
    const int count = 200000;
    for (int k = 0; k <= count; ++k) network.nodes.push_back({Vec3(k, 0, 0), {}});
    for (int k = 0; k < count; ++k) {
        NetworkArc arc;
        arc.nodes = {k, k + 1};
        arc.samples = {{Vec3(k, 0, 0), {}}, {Vec3(k + 1, 0, 0), {}}};
        network.arcs.push_back(arc);
    }
    for (const SupportingCurve& curve : supporting_curves(network))
        ASSERT_DOUBLE_EQ(curve.length, count);
    find_curves(network);
    EXPECT_EQ(network.curves.size(), 1u);
}

}  // namespace
}  // namespace fcn
