// Weights and bonuses against networks worked by hand: I, L, Sym, Loop, a_s and a_par,perp (paper
// section 5.3.1; DESIGN 4.6 - 4.8).

#include "adaptation/weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "adaptation/initial_state.h"
#include "networks.h"
#include "oracles.h"

namespace fcn {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;

AdaptationOptions options_of(AdaptationMode mode, double lambda1 = 0) {
    AdaptationOptions options;
    options.rmin = 1;
    options.mode = mode;
    options.lambda0 = 100;
    options.lambda1 = lambda1;
    options.alpha_sym = 2;
    options.alpha_loop = 100;
    return options;
}

TEST(Weights, ProductOfFactorsInPaperMode) {
    const ScaleInterval scale = make_scale(0.5);
    const AdaptationOptions options = options_of(AdaptationMode::Paper);
    SegmentAttributes a;
    a.sharpness = 3;
    a.curve_length = 7;
    a.length = 0.6;
    EXPECT_DOUBLE_EQ(segment_weight(a, scale, options), 21);
    a.is_symmetric = true;
    EXPECT_DOUBLE_EQ(segment_weight(a, scale, options), 42);
    a.is_on_loop = true;
    EXPECT_DOUBLE_EQ(segment_weight(a, scale, options), 4200);
    a.is_symmetric = false;
    EXPECT_DOUBLE_EQ(segment_weight(a, scale, options), 2100);
    a.contrast = 30;
    a.length = 5;
    EXPECT_DOUBLE_EQ(segment_weight(a, scale, options), 2100) << "the paper knows neither";
}

TEST(Weights, BestModeCountsLengthNotSegments) {
    const ScaleInterval scale = make_scale(0.5);
    const AdaptationOptions options = options_of(AdaptationMode::Best);
    SegmentAttributes a;
    a.sharpness = 3;
    a.curve_length = 8;
    a.length = 1;
    const double whole = segment_weight(a, scale, options);
    EXPECT_DOUBLE_EQ(whole, 3 * std::sqrt(8 / 0.5) * 1 / 0.5);
    a.length = 0.5;
    EXPECT_DOUBLE_EQ(2 * segment_weight(a, scale, options), whole) << "cut into two halves";
    a.length = 1;
    a.contrast = 30;
    EXPECT_DOUBLE_EQ(segment_weight(a, scale, options), 30 * whole);
    // The same network in other units.
    const ScaleInterval metres = make_scale(0.0005);
    a.curve_length = 0.008;
    a.length = 0.001;
    EXPECT_NEAR(segment_weight(a, metres, options), 30 * whole, 1e-9 * whole);
}

TEST(Weights, ContrastOfCreases) {
    EXPECT_DOUBLE_EQ(crease_contrast(0), 1);
    EXPECT_DOUBLE_EQ(crease_contrast(20 * kDegree), 1);
    // Rises up to 40 degrees, where a crease starts to outweigh all that is below.
    for (int degrees = 0; degrees < 180; ++degrees) {
        EXPECT_LE(crease_contrast(degrees * kDegree), crease_contrast((degrees + 1) * kDegree));
    }
    EXPECT_LT(crease_contrast(39.9 * kDegree), crease_contrast(40 * kDegree));
    EXPECT_GT(crease_contrast(30 * kDegree), 1);
    EXPECT_DOUBLE_EQ(crease_contrast(40 * kDegree), crease_contrast(kPi));
    EXPECT_DOUBLE_EQ(crease_contrast(-40 * kDegree), crease_contrast(40 * kDegree));
}

TEST(Weights, Smoothness) {
    EXPECT_DOUBLE_EQ(smoothness(0, 2), 1);
    EXPECT_NEAR(smoothness(15 * kDegree, 2), 0.75, 1e-12);
    EXPECT_NEAR(smoothness(22.5 * kDegree, 2), 0.5, 1e-12);
    EXPECT_NEAR(smoothness(22.5 * kDegree, 4), 0.25, 1e-12);
    EXPECT_NEAR(smoothness(45 * kDegree, 2), 0, 1e-12);
    EXPECT_EQ(smoothness(46 * kDegree, 2), 0);
    EXPECT_EQ(smoothness(90 * kDegree, 2), 0) << "cos^2(2 gamma) rises again, a_s does not";
    EXPECT_EQ(smoothness(kPi, 2), 0);
}

TEST(Weights, Orthogonality) {
    for (const double gamma : {0.0, 90 * kDegree, 180 * kDegree}) {
        EXPECT_NEAR(orthogonality(gamma, 2), 1, 1e-12);
    }
    for (const double gamma : {45 * kDegree, 135 * kDegree}) {
        EXPECT_NEAR(orthogonality(gamma, 2), 0, 1e-12);
    }
    EXPECT_NEAR(orthogonality(15 * kDegree, 2), std::pow(0.75, 2), 1e-12) << "cos^4 30";
    EXPECT_NEAR(orthogonality(75 * kDegree, 2), std::pow(0.75, 2), 1e-12) << "cos^4 150";
    EXPECT_NEAR(orthogonality(15 * kDegree, 1), 0.75, 1e-12);
}

SegmentGraph make_graph(const test::PlainNetwork& network) {
    SegmentGraph graph;
    for (const Vec3& point : network.points) {
        graph.nodes.emplace_back();
        graph.nodes.back().position = point;
    }
    for (const auto& ends : network.segments) {
        graph.segments.emplace_back();
        graph.segments.back().nodes = ends;
    }
    graph.connect();
    return graph;
}

using Bonuses = std::map<std::pair<int, int>, double>;

Bonuses bonuses_of(const test::PlainNetwork& network, const AdaptationOptions& options,
                   const std::vector<std::pair<int, int>>& excluded = {},
                   const std::vector<double>& sharpness = {}, double rmin = 1) {
    const SegmentGraph graph = make_graph(network);
    std::vector<SegmentAttributes> attributes(network.segments.size());
    for (std::size_t i = 0; i < attributes.size(); ++i) {
        attributes[i].sharpness = sharpness.empty() ? 1 : sharpness[i];
    }
    Bonuses result;
    std::pair<int, int> last{-1, -1};
    for (const PairBonus& bonus :
         pair_bonuses(graph, attributes, excluded, make_scale(rmin), options)) {
        EXPECT_LT(bonus.first, bonus.second);
        EXPECT_LT(last, std::pair(bonus.first, bonus.second)) << "sorted, once each";
        EXPECT_GT(bonus.value, 0);
        last = {bonus.first, bonus.second};
        result[last] = bonus.value;
    }
    return result;
}

void expect_bonuses(const Bonuses& found, const Bonuses& expected) {
    for (const auto& [pair, value] : expected) {
        ASSERT_TRUE(found.count(pair)) << pair.first << ", " << pair.second;
        EXPECT_NEAR(found.at(pair), value, 1e-9) << pair.first << ", " << pair.second;
    }
    for (const auto& [pair, value] : found) {
        if (!expected.count(pair)) {
            EXPECT_NEAR(value, 0, 1e-9) << "unexpected " << pair.first << ", " << pair.second;
        }
    }
}

TEST(Bonuses, SmoothnessOfAChain) {
    // Straight on, then 15 degrees, then a right angle.
    const Vec3 turned(std::cos(15 * kDegree), std::sin(15 * kDegree), 0);
    const Vec3 square(-turned.y(), turned.x(), 0);
    test::PlainNetwork chain{{{0, 0, 0}, {1.2, 0, 0}, {2.4, 0, 0}},
                             {{0, 1}, {2, 1}, {2, 3}, {3, 4}}};
    chain.points.push_back(chain.points[2] + 1.2 * turned);
    chain.points.push_back(chain.points[3] + 1.2 * square);
    expect_bonuses(bonuses_of(chain, options_of(AdaptationMode::Paper)),
                   {{{0, 1}, 100}, {{1, 2}, 75}});
    AdaptationOptions half = options_of(AdaptationMode::Paper);
    half.lambda0 = 50;
    half.smooth_power = 4;
    expect_bonuses(bonuses_of(chain, half), {{{0, 1}, 50}, {{1, 2}, 50 * 0.75 * 0.75}});
    half.lambda0 = 0;
    EXPECT_TRUE(bonuses_of(chain, half).empty());
}

TEST(Bonuses, SmoothnessOfStars) {
    // Two straight lines through one node: each continues only itself.
    const test::PlainNetwork cross{
        {{0, 0, 0}, {1.2, 0, 0}, {0, 1.2, 0}, {-1.2, 0, 0}, {0, -1.2, 0}},
        {{0, 1}, {0, 2}, {3, 0}, {4, 0}}};
    expect_bonuses(bonuses_of(cross, options_of(AdaptationMode::Paper)),
                   {{{0, 2}, 100}, {{1, 3}, 100}});
    // A fork: the stem continues into both branches at 15 degrees; the branches turn by 150.
    const double c = std::cos(15 * kDegree), s = std::sin(15 * kDegree);
    const test::PlainNetwork fork{{{0, 0, 0}, {-1, 0, 0}, {c, s, 0}, {c, -s, 0}},
                                  {{1, 0}, {0, 2}, {0, 3}}};
    expect_bonuses(bonuses_of(fork, options_of(AdaptationMode::Paper)),
                   {{{0, 1}, 75}, {{0, 2}, 75}});
}

TEST(Bonuses, OrthogonalityWithinTheRadius) {
    // Midpoints (0, 0) and (d, 0): parallel lines, reach 2 rmax = 3.
    const auto parallel = [](double d) {
        return test::PlainNetwork{{{0, -0.6, 0}, {0, 0.6, 0}, {d, 0.6, 0}, {d, -0.6, 0}},
                                  {{0, 1}, {2, 3}}};
    };
    const AdaptationOptions quad = options_of(AdaptationMode::Paper, 10);
    expect_bonuses(bonuses_of(parallel(2.99), quad), {{{0, 1}, 10}});
    EXPECT_TRUE(bonuses_of(parallel(3.01), quad).empty());
    EXPECT_TRUE(bonuses_of(parallel(2), options_of(AdaptationMode::Paper, 0)).empty());
    EXPECT_TRUE(bonuses_of(parallel(2), quad, {{0, 1}}).empty()) << "a conflicting pair";
    AdaptationOptions wide = quad;
    wide.ortho_radius = 4;
    expect_bonuses(bonuses_of(parallel(5.99), wide), {{{0, 1}, 10}});

    const auto turned = [](double angle) {
        const Vec3 half = 0.6 * Vec3(std::cos(angle), 0, std::sin(angle));
        const Vec3 middle(1.5, 0.5, 0);
        return test::PlainNetwork{{{-0.6, 0, 0}, {0.6, 0, 0}, middle - half, middle + half},
                                  {{0, 1}, {2, 3}}};
    };
    expect_bonuses(bonuses_of(turned(90 * kDegree), quad), {{{0, 1}, 10}});
    expect_bonuses(bonuses_of(turned(15 * kDegree), quad), {{{0, 1}, 10 * 0.5625}});
    expect_bonuses(bonuses_of(turned(105 * kDegree), quad), {{{0, 1}, 10 * 0.5625}});
    expect_bonuses(bonuses_of(turned(45 * kDegree), quad), {});
}

TEST(Bonuses, BothTermsAddUp) {
    const test::PlainNetwork chain{{{0, 0, 0}, {1.2, 0, 0}, {2.4, 0, 0}, {3.6, 0, 0}, {4.8, 0, 0}},
                                   {{0, 1}, {1, 2}, {2, 3}, {3, 4}}};
    // Midpoints of 0 and 3 are 3.6 apart: beyond 2 rmax.
    expect_bonuses(bonuses_of(chain, options_of(AdaptationMode::Paper, 10)),
                   {{{0, 1}, 110}, {{1, 2}, 110}, {{2, 3}, 110}, {{0, 2}, 10}, {{1, 3}, 10}});
}

TEST(Bonuses, BestModeScalesWithTheDullerOfThePair) {
    // In best mode lambda0 = 100 is one unit of sharpness a joint.
    const test::PlainNetwork chain{{{0, 0, 0}, {1.2, 0, 0}, {2.4, 0, 0}, {3.6, 0, 0}},
                                   {{0, 1}, {1, 2}, {2, 3}}};
    expect_bonuses(bonuses_of(chain, options_of(AdaptationMode::Best), {}, {2.0, 0.5, 3.0}),
                   {{{0, 1}, 0.5}, {{1, 2}, 0.5}});
    expect_bonuses(bonuses_of(chain, options_of(AdaptationMode::Best, 10), {}, {2.0, 0.5, 3.0}),
                   {{{0, 1}, 0.55}, {{1, 2}, 0.55}, {{0, 2}, 0.2}});
}

// ---- attributes of the initial network ----

/// A cylinder of the given radius around the z axis, open at both ends.
Mesh cylinder(double radius, double height, int sides, int rows) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> faces;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i < sides; ++i) {
            const double angle = 2 * kPi * i / sides;
            points.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                height * j / rows);
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < sides; ++i) {
            const int a = j * sides + i, b = j * sides + (i + 1) % sides;
            faces.push_back({a, b, b + sides});
            faces.push_back({a, b + sides, a + sides});
        }
    }
    return test::make_mesh(points, faces);
}

/// Initial network: each arc a polyline between two nodes (equal for a closed one).
struct PlainArc {
    int from, to;
    std::vector<Vec3> inner;
    std::array<int, 2> patches{-1, -1};
};

FeatureCurveNetwork initial_network(const std::vector<Vec3>& nodes,
                                    const std::vector<PlainArc>& arcs) {
    FeatureCurveNetwork network;
    for (const Vec3& node : nodes) {
        network.nodes.emplace_back();
        network.nodes.back().position = node;
    }
    for (const PlainArc& plain : arcs) {
        NetworkArc arc;
        arc.nodes = {plain.from, plain.to};
        arc.patches = plain.patches;
        arc.samples.push_back({nodes[plain.from], {}});
        for (const Vec3& point : plain.inner) arc.samples.push_back({point, {}});
        arc.samples.push_back({nodes[plain.to], {}});
        network.arcs.push_back(arc);
    }
    return network;
}

InitialState state_of(const Mesh& mesh, const FeatureCurveNetwork& network, AdaptationMode mode,
                      double rmin = 1) {
    LoadedMesh loaded;
    loaded.mesh = mesh;
    const AdaptationSurface surface(loaded.mesh);
    return make_initial_state(loaded, surface, network, make_scale(rmin), options_of(mode));
}

Mesh flat_square() {
    return test::sheet(10, 10, [](int i, int j) { return Vec3(2 * i - 10, 2 * j - 10, 0); });
}

TEST(Attributes, PaperSharpnessIsTheCurvatureAcross) {
    for (const double radius : {1.0, 2.0, 5.0}) {
        const Mesh mesh = cylinder(radius, 6, 80, 20);
        const auto network = initial_network({{radius, 0, 1.5}, {radius, 0, 4.5}}, {{0, 1, {}}});
        const InitialState state = state_of(mesh, network, AdaptationMode::Paper);
        ASSERT_EQ(state.network.arcs.size(), 1u);
        ASSERT_GT(state.network.arcs[0].sharpness.size(), 10u);
        for (const double kappa : state.network.arcs[0].sharpness) {
            EXPECT_NEAR(kappa, 1 / radius, 0.02 / radius);
        }
    }
}

TEST(Attributes, BestSharpnessIsTheTurningWithinTheScale) {
    // A roof whose two slopes meet at a crease of `bend`: the turning is the dihedral angle, on any
    // mesh; the median of a single crease is itself.
    const double bend = 50 * kDegree;
    for (const int rows : {4, 40}) {
        const Mesh mesh = test::sheet(6, rows, [&](int i, int j) {
            const double x = i - 3.0;
            return Vec3(x * std::cos(bend / 2), 20.0 * j / rows - 10,
                        -std::abs(x) * std::sin(bend / 2));
        });
        const auto network = initial_network({{0, -5, 0}, {0, 5, 0}}, {{0, 1, {}}});
        const InitialState state = state_of(mesh, network, AdaptationMode::Best);
        EXPECT_NEAR(state.median_turning, bend, 0.02 * bend) << rows;
        for (const double sharpness : state.network.arcs[0].sharpness) {
            EXPECT_NEAR(sharpness, 1, 0.02) << rows;
        }
        for (const double crease : state.network.arcs[0].crease) {
            EXPECT_NEAR(crease, bend, 1e-6);
        }
    }
    // A cylinder of radius 4 turns by rmin / 4 within its ball, up to the ball's shape (pi / 4).
    const auto network = initial_network({{4, 0, 3}, {4, 0, 9}}, {{0, 1, {}}});
    const InitialState round = state_of(cylinder(4, 12, 200, 80), network, AdaptationMode::Best);
    EXPECT_NEAR(round.median_turning, kPi / 4 * 0.25, 0.02);
}

TEST(Attributes, CurveLengthThroughAStraightNodeOnly) {
    // A bar of 3 + 2 and a stem of 1.5 that ends on it, without patches.
    const auto network = initial_network({{-3, 0, 0}, {0, 0, 0}, {2, 0, 0}, {0, 1.5, 0}},
                                         {{0, 1, {}}, {1, 2, {}}, {3, 1, {}}});
    const InitialState state = state_of(flat_square(), network, AdaptationMode::Best);
    ASSERT_EQ(state.origins.size(), 3u);
    EXPECT_NEAR(state.origins[0].curve_length, 5, 1e-12);
    EXPECT_NEAR(state.origins[1].curve_length, 5, 1e-12);
    EXPECT_NEAR(state.origins[2].curve_length, 1.5, 1e-12);
    for (const OriginAttributes& origin : state.origins) EXPECT_FALSE(origin.is_on_loop);
    EXPECT_EQ(state.origins[0].curve, state.origins[1].curve);
    EXPECT_NE(state.origins[0].curve, state.origins[2].curve);
}

TEST(Attributes, PatchesStopACurveAtATNode) {
    // Arcs 0 and 1 continue each other straight; with patches the extension needs a common one.
    // The stem leans so that arc 0 continues it more straightly than arc 1.
    const std::vector<Vec3> nodes{{-3, 0, 0}, {0, 0, 0}, {2, 0, 0}, {0.3, 1.5, 0}};
    const double stem_length = std::hypot(0.3, 1.5);
    const auto lengths = [&](std::array<int, 2> first, std::array<int, 2> second,
                             std::array<int, 2> stem) {
        const auto network =
            initial_network(nodes, {{0, 1, {}, first}, {1, 2, {}, second}, {3, 1, {}, stem}});
        const InitialState state = state_of(flat_square(), network, AdaptationMode::Best);
        return std::array<double, 3>{state.origins[0].curve_length, state.origins[1].curve_length,
                                     state.origins[2].curve_length};
    };
    // A T-node: patch 0 below the bar, 1 and 2 above it, the stem between those.
    const auto t_node = lengths({1, 0}, {2, 0}, {1, 2});
    EXPECT_NEAR(t_node[0], 5, 1e-12);
    EXPECT_NEAR(t_node[1], 5, 1e-12);
    EXPECT_NEAR(t_node[2], stem_length + 3, 1e-12)
        << "the straightest arc borders patch 1 as the stem does: the rule asks no more";
    const auto inner_stem = lengths({1, 0}, {2, 0}, {3, 4});
    EXPECT_NEAR(inner_stem[0], 5, 1e-12);
    EXPECT_NEAR(inner_stem[2], stem_length, 1e-12);
    // No common patch: everyone ends at the node.
    const auto apart = lengths({1, 4}, {2, 5}, {6, 7});
    EXPECT_NEAR(apart[0], 3, 1e-12);
    EXPECT_NEAR(apart[1], 2, 1e-12);
    EXPECT_NEAR(apart[2], stem_length, 1e-12);
}

TEST(Attributes, LoopsAndSymmetry) {
    // A closed arc; a ring of twelve arcs that turn by 30 degrees; a square of four arcs.
    std::vector<Vec3> nodes;
    std::vector<PlainArc> arcs;
    const auto ring = [&](const Vec3& centre, double radius, int sides) {
        const int first = static_cast<int>(nodes.size());
        for (int i = 0; i < sides; ++i) {
            const double angle = 2 * kPi * i / sides;
            nodes.push_back(centre + radius * Vec3(std::cos(angle), std::sin(angle), 0));
            arcs.push_back({first + i, first + (i + 1) % sides, {}});
        }
    };
    ring({-5, -5, 0}, 3, 12);
    ring({5, 5, 0}, 3, 4);
    const Vec3 centre(5, -5, 0);
    nodes.push_back(centre + Vec3(2, 0, 0));
    PlainArc closed{16, 16, {}};
    for (int i = 1; i < 24; ++i) {
        const double angle = 2 * kPi * i / 24;
        closed.inner.push_back(centre + 2 * Vec3(std::cos(angle), std::sin(angle), 0));
    }
    arcs.push_back(closed);
    FeatureCurveNetwork network = initial_network(nodes, arcs);
    SymmetryOrbit orbit;
    orbit.members.resize(2);
    orbit.members[0].arc = 12;
    orbit.members[1].arc = 14;
    network.orbits.push_back(orbit);
    const InitialState state = state_of(flat_square(), network, AdaptationMode::Best);
    const double side = 2 * 3 * std::sin(kPi / 12);
    for (int a = 0; a < 12; ++a) {
        EXPECT_TRUE(state.origins[a].is_on_loop) << a;
        EXPECT_NEAR(state.origins[a].curve_length, 12 * side, 1e-9);
    }
    for (int a = 12; a < 16; ++a) {
        EXPECT_FALSE(state.origins[a].is_on_loop) << "turns by 90 degrees";
        EXPECT_NEAR(state.origins[a].curve_length, 3 * std::sqrt(2.0), 1e-9);
        EXPECT_EQ(state.origins[a].is_symmetric, a == 12 || a == 14);
    }
    EXPECT_TRUE(state.origins[16].is_on_loop);
    EXPECT_NEAR(state.origins[16].curve_length, 24 * 2 * 2 * std::sin(kPi / 24), 1e-9);
}

}  // namespace
}  // namespace fcn
