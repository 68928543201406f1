#include "features/combine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "features/crest.h"
#include "features/feature_meshes.h"
#include "features/features.h"
#include "geometry/errors.h"
#include "geometry/models.h"
#include "geometry/surface_queries.h"

namespace fcn {
namespace {

using testing::distance_to;
using testing::height_field;
using testing::problems_of;

LoadedMesh plane() {
    return height_field(20, 20, [](double, double) { return 0.0; });
}

/// Polylines over a mesh as a network: equal end points are one node.
FeatureCurveNetwork lines_on(const LoadedMesh& mesh, const std::vector<std::vector<Vec3>>& lines,
                             double spacing, const std::string& source) {
    const SurfaceQueries queries(mesh.mesh);
    FeatureCurveNetwork network;
    std::map<std::array<double, 3>, int> nodes;
    for (const std::vector<Vec3>& line : lines) {
        NetworkArc arc;
        arc.source = source;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const int steps =
                std::max(1, static_cast<int>(std::ceil((line[i + 1] - line[i]).norm() / spacing)));
            for (int k = 0; k <= steps; ++k) {
                if (k == 0 && i > 0) continue;
                const double t = static_cast<double>(k) / steps;
                const ClosestPoint p = queries.closest((1 - t) * line[i] + t * line[i + 1]);
                arc.samples.push_back({p.position, p.surface});
            }
        }
        for (int side = 0; side < 2; ++side) {
            const ArcSample& end = side == 0 ? arc.samples.front() : arc.samples.back();
            const auto [found, is_new] =
                nodes.try_emplace({end.position.x(), end.position.y(), end.position.z()},
                                  static_cast<int>(network.nodes.size()));
            if (is_new) network.nodes.push_back({end.position, end.surface});
            arc.nodes[side] = found->second;
        }
        network.arcs.push_back(std::move(arc));
    }
    return network;
}

/// The farthest that a sample of `network` or a middle between two lies from `other`.
double farthest(const FeatureCurveNetwork& network, const FeatureCurveNetwork& other) {
    double result = 0;
    for (const NetworkArc& arc : network.arcs) {
        for (std::size_t i = 0; i + 1 < arc.samples.size(); ++i) {
            const Vec3 &a = arc.samples[i].position, &b = arc.samples[i + 1].position;
            for (double t : {0.0, 0.5})
                result = std::max(result, distance_to(other, (1 - t) * a + t * b));
        }
    }
    return result;
}

FeatureCurveNetwork shuffled(const FeatureCurveNetwork& network, std::mt19937_64& random) {
    FeatureCurveNetwork result = network;
    result.curves.clear();
    for (NetworkArc& arc : result.arcs) {
        arc.curve = -1;
        if (random() % 2 == 0) continue;
        std::swap(arc.nodes[0], arc.nodes[1]);
        std::swap(arc.patches[0], arc.patches[1]);
        std::ranges::reverse(arc.samples);
    }
    std::ranges::shuffle(result.arcs, random);
    return result;
}

std::vector<double> sorted_lengths(const FeatureCurveNetwork& network) {
    std::vector<double> lengths;
    for (const NetworkArc& arc : network.arcs) lengths.push_back(arc.length());
    std::ranges::sort(lengths);
    return lengths;
}

FeatureCurveNetwork vsa(const LoadedMesh& mesh, int patches, bool is_straightening = true) {
    VsaOptions options;
    options.patch_count = patches;
    options.is_straightening = is_straightening;
    return detect_vsa(mesh, options);
}

std::map<int, int> valence_counts(const FeatureCurveNetwork& network) {
    std::map<int, int> counts;
    for (int valence : network.valences()) ++counts[valence];
    return counts;
}

TEST(Combine, NetworkWithItselfGivesItself) {
    for (const char* name : {"box", "gear", "ribs", "superellipse-torus"}) {
        const LoadedMesh mesh = make_model(name);
        for (const FeatureCurveNetwork& network :
             {detect_sharp(mesh), vsa(mesh, 40), vsa(mesh, 40, false)}) {
            const FeatureCurveNetwork result = combine_networks({network, network}, mesh);
            ASSERT_EQ(result.arcs.size(), network.arcs.size()) << name;
            ASSERT_EQ(result.nodes.size(), network.nodes.size()) << name;
            for (std::size_t a = 0; a < network.arcs.size(); ++a) {
                ASSERT_EQ(result.arcs[a].samples.size(), network.arcs[a].samples.size()) << name;
                for (std::size_t i = 0; i < network.arcs[a].samples.size(); ++i)
                    EXPECT_EQ(result.arcs[a].samples[i].position,
                              network.arcs[a].samples[i].position);
            }
        }
    }
}

TEST(Combine, BoxHasTwelveEdges) {
    const LoadedMesh mesh = make_model("box");
    const FeatureCurveNetwork result = combine_networks({detect_sharp(mesh), vsa(mesh, 6)}, mesh);
    EXPECT_EQ(result.arcs.size(), 12u);
    EXPECT_EQ(result.nodes.size(), 8u);
    for (const NetworkArc& arc : result.arcs) EXPECT_EQ(arc.source, "sharp");
    EXPECT_EQ(problems_of(result, mesh.mesh), "");
}

TEST(Combine, NothingIsLostBeyondTheTolerance) {
    for (const char* name : {"box", "gear", "ribs", "octaflower", "steps"}) {
        const LoadedMesh mesh = make_model(name);
        const double tolerance = default_combine_tolerance(mesh);
        const FeatureCurveNetwork sharp = detect_sharp(mesh), patches = vsa(mesh, 60);
        for (const auto& inputs : {std::vector{sharp, patches}, std::vector{patches, sharp},
                                   std::vector{vsa(mesh, 25), sharp, patches}}) {
            const FeatureCurveNetwork result = combine_networks(inputs, mesh);
            EXPECT_EQ(problems_of(result, mesh.mesh), "") << name;
            for (const FeatureCurveNetwork& input : inputs)
                EXPECT_LE(farthest(input, result), tolerance * (1 + 1e-9)) << name;
            // And nothing is made up: junctions move by the tolerance at most.
            FeatureCurveNetwork all;
            for (const FeatureCurveNetwork& input : inputs)
                all.arcs.insert(all.arcs.end(), input.arcs.begin(), input.arcs.end());
            EXPECT_LE(farthest(result, all), tolerance * (1 + 1e-9)) << name;
        }
    }
}

TEST(Combine, CrestLinesAcrossFacesAreMergedToo) {
    const LoadedMesh mesh = make_model("superellipse-torus");
    const FeatureCurveNetwork crests = detect_crest(mesh), patches = vsa(mesh, 60);
    ASSERT_GT(crests.arcs.size(), 0u);
    const double tolerance = default_combine_tolerance(mesh);
    for (const auto& inputs : {std::vector{crests, patches}, std::vector{patches, crests}}) {
        const FeatureCurveNetwork result = combine_networks(inputs, mesh);
        EXPECT_EQ(problems_of(result, mesh.mesh), "");
        for (const FeatureCurveNetwork& input : inputs)
            EXPECT_LE(farthest(input, result), tolerance * (1 + 1e-9));
        EXPECT_EQ(combine_networks({result, result}, mesh).arcs.size(), result.arcs.size());
    }
}

TEST(Combine, DuplicatesAreFused) {
    for (const char* name : {"gear", "ribs", "steps"}) {
        const LoadedMesh mesh = make_model(name);
        const FeatureCurveNetwork sharp = detect_sharp(mesh), patches = vsa(mesh, 60);
        const FeatureCurveNetwork result = combine_networks({sharp, patches}, mesh);
        double doubled = 0;
        for (const NetworkArc& arc : result.arcs) {
            if (arc.source != "vsa") continue;
            for (std::size_t i = 0; i + 1 < arc.samples.size(); ++i) {
                const Vec3 &a = arc.samples[i].position, &b = arc.samples[i + 1].position;
                if (std::max(distance_to(sharp, a), distance_to(sharp, b)) < 1e-9)
                    doubled += (b - a).norm();
            }
        }
        EXPECT_LE(doubled, 1e-9) << name;
        EXPECT_LT(result.total_length(), sharp.total_length() + patches.total_length());
    }
}

TEST(Combine, OrderOfArcsDoesNotMatter) {
    const std::uint64_t seed = 7;
    std::mt19937_64 random(seed);
    for (const char* name : {"gear", "octaflower"}) {
        const LoadedMesh mesh = make_model(name);
        const FeatureCurveNetwork sharp = detect_sharp(mesh), patches = vsa(mesh, 50);
        const FeatureCurveNetwork expected = combine_networks({sharp, patches}, mesh);
        for (int trial = 0; trial < 3; ++trial) {
            const FeatureCurveNetwork result =
                combine_networks({shuffled(sharp, random), shuffled(patches, random)}, mesh);
            ASSERT_EQ(result.arcs.size(), expected.arcs.size()) << name << ", seed " << seed;
            EXPECT_EQ(valence_counts(result), valence_counts(expected)) << name;
            const auto lengths = sorted_lengths(result), others = sorted_lengths(expected);
            for (std::size_t a = 0; a < lengths.size(); ++a)
                EXPECT_NEAR(lengths[a], others[a], 1e-9) << name << ", seed " << seed;
            EXPECT_LT(std::max(farthest(result, expected), farthest(expected, result)), 1e-9);
        }
    }
}

TEST(Combine, CrossingArcsGetAJunction) {
    const LoadedMesh mesh = height_field(
        20, 20, [](double x, double y) { return 0.02 * (x - 10) * (x - 10) + 0.1 * std::sin(y); });
    const auto one = lines_on(mesh, {{{2, 9.3, 0}, {18, 11.1, 0}}}, 0.7, "one");
    const auto other = lines_on(mesh, {{{9.1, 1, 0}, {10.7, 17, 0}}}, 0.45, "other");
    const FeatureCurveNetwork result = combine_networks({one, other}, mesh, {0.5});
    EXPECT_EQ(problems_of(result, mesh.mesh), "");
    EXPECT_EQ(valence_counts(result), (std::map<int, int>{{1, 4}, {4, 1}}));
    std::map<std::string, int> sources;
    for (const NetworkArc& arc : result.arcs) ++sources[arc.source];
    EXPECT_EQ(sources, (std::map<std::string, int>{{"one", 2}, {"other", 2}}));
}

TEST(Combine, EndsCloseToAnArcJoinIt) {
    const LoadedMesh mesh = plane();
    const auto one = lines_on(mesh, {{{2, 10.2, 0}, {18, 10.2, 0}}}, 1, "one");
    // Ends before, on and beyond the line, and one too far away.
    const auto other = lines_on(mesh,
                                {{{4, 3, 0}, {4, 10.1, 0}},
                                 {{7, 3, 0}, {7, 10.2, 0}},
                                 {{11, 3, 0}, {11, 10.3, 0}},
                                 {{15, 3, 0}, {15, 9, 0}}},
                                1, "other");
    const FeatureCurveNetwork result = combine_networks({one, other}, mesh, {0.5});
    EXPECT_EQ(problems_of(result, mesh.mesh), "");
    EXPECT_EQ(valence_counts(result), (std::map<int, int>{{1, 7}, {3, 3}}));
}

TEST(Combine, LooseEndOfAnEarlierArcJoinsALaterOne) {
    const LoadedMesh mesh = plane();
    const auto one = lines_on(mesh, {{{10.3, 2, 0}, {10.3, 9.4, 0}}}, 1, "one");
    const auto other = lines_on(mesh, {{{2, 9.5, 0}, {18, 9.5, 0}}}, 1, "other");
    const FeatureCurveNetwork result = combine_networks({one, other}, mesh, {0.6});
    EXPECT_EQ(problems_of(result, mesh.mesh), "");
    EXPECT_EQ(valence_counts(result), (std::map<int, int>{{1, 3}, {3, 1}}));
}

TEST(Combine, StretchAlongAnArcIsFused) {
    const LoadedMesh mesh = plane();
    const auto one = lines_on(mesh, {{{2, 10, 0}, {18, 10, 0}}}, 0.9, "one");
    const auto other =
        lines_on(mesh, {{{5, 3, 0}, {5.5, 10.1, 0}, {12, 9.9, 0}, {13, 16, 0}}}, 0.4, "other");
    const FeatureCurveNetwork result = combine_networks({one, other}, mesh, {0.6});
    EXPECT_EQ(problems_of(result, mesh.mesh), "");
    EXPECT_EQ(valence_counts(result), (std::map<int, int>{{1, 4}, {3, 2}}));
    EXPECT_EQ(result.arcs.size(), 5u);
}

TEST(Combine, RingsMeetAtWhatIsThere) {
    const LoadedMesh mesh = plane();
    std::vector<Vec3> circle;
    for (int k = 0; k < 48; ++k)
        circle.emplace_back(10 + 5 * std::cos(k * 7.5 * testing::kDegree),
                            10 + 5 * std::sin(k * 7.5 * testing::kDegree), 0);
    circle.push_back(circle.front());
    const auto ring = lines_on(mesh, {circle}, 1, "ring");
    const auto line = lines_on(mesh, {{{1, 11.3, 0}, {19, 11.3, 0}}}, 0.8, "line");
    const FeatureCurveNetwork after = combine_networks({line, ring}, mesh, {0.4});
    EXPECT_EQ(problems_of(after, mesh.mesh), "");
    EXPECT_EQ(valence_counts(after), (std::map<int, int>{{1, 2}, {4, 2}}));
    const FeatureCurveNetwork before = combine_networks({ring, line}, mesh, {0.4});
    EXPECT_EQ(valence_counts(before), (std::map<int, int>{{1, 2}, {2, 1}, {4, 2}}));
    const FeatureCurveNetwork itself = combine_networks({ring, ring}, mesh, {0.4});
    EXPECT_EQ(itself.arcs.size(), 1u);
    EXPECT_EQ(combine_networks({{}, ring}, mesh, {0.4}).arcs.size(), 1u);
}

TEST(Combine, BothSidesOfAThinWallStay) {
    ModelOptions options;
    options.spacing = 0.01;
    const LoadedMesh mesh = make_model("thin-wall", options);
    const FeatureCurveNetwork sharp = detect_sharp(mesh);
    const FeatureCurveNetwork vsa_network = vsa(mesh, 20);
    const double tolerance = 0.05;
    const FeatureCurveNetwork result = combine_networks({sharp, vsa_network}, mesh, {tolerance});
    EXPECT_EQ(problems_of(result, mesh.mesh), "");
    EXPECT_LE(farthest(vsa_network, result), tolerance);
}

TEST(Combine, PinsOfFusedStretchesStay) {
    const LoadedMesh mesh = plane();
    const auto one = lines_on(mesh, {{{2, 10, 0}, {18, 10, 0}}}, 0.9, "one");
    auto other = lines_on(mesh, {{{5, 10, 0}, {11, 10, 0}, {11, 17, 0}}}, 0.4, "other");
    other.arcs[0].pin = Pin::Keep;
    const FeatureCurveNetwork result = combine_networks({one, other}, mesh, {0.6});
    EXPECT_EQ(problems_of(result, mesh.mesh), "");
    double pinned = 0;
    for (const NetworkArc& arc : result.arcs)
        pinned += arc.source == "one" && arc.pin == Pin::Keep ? arc.length() : 0;
    EXPECT_NEAR(pinned, 6, 0.61);
}

TEST(Combine, PatchesOfDetectorsStayApart) {
    const LoadedMesh mesh = make_model("superellipse-torus");
    const FeatureCurveNetwork a = vsa(mesh, 8);
    FeatureCurveNetwork b = vsa(mesh, 13);
    int end = 0;
    for (const NetworkArc& arc : a.arcs) end = std::max({end, arc.patches[0], arc.patches[1]});
    for (NetworkArc& arc : b.arcs) arc.source = "second";
    const FeatureCurveNetwork result = combine_networks({a, b}, mesh);
    EXPECT_EQ(problems_of(result, mesh.mesh), "");
    int later = 0;
    for (const NetworkArc& arc : result.arcs) {
        const bool is_later = arc.source == "second";
        later += is_later;
        EXPECT_EQ(std::min(arc.patches[0], arc.patches[1]) > end, is_later);
    }
    EXPECT_GT(later, 0);
}

/// Random lines on a plane against their crossings by brute force.
TEST(Combine, RandomLinesCrossInJunctions) {
    const LoadedMesh mesh = plane();
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> place(1, 19);
        const auto draw = [&](const char* source, double spacing) {
            std::vector<std::vector<Vec3>> lines;
            for (int k = 0; k < 4; ++k)
                lines.push_back(
                    {{place(random), place(random), 0}, {place(random), place(random), 0}});
            return lines_on(mesh, lines, spacing, source);
        };
        const FeatureCurveNetwork one = draw("one", 0.8), other = draw("other", 0.55);
        const double tolerance = 0.3;
        const FeatureCurveNetwork result = combine_networks({one, other}, mesh, {tolerance});
        EXPECT_EQ(problems_of(result, mesh.mesh), "") << "seed " << seed;
        EXPECT_LE(farthest(one, result), 1e-9) << "seed " << seed;
        EXPECT_LE(farthest(other, result), tolerance) << "seed " << seed;
        // No arc of one and arc of the other crosses away from their ends.
        for (const NetworkArc& a : result.arcs) {
            for (const NetworkArc& b : result.arcs) {
                if (a.source == b.source) continue;
                for (std::size_t i = 0; i + 1 < a.samples.size(); ++i) {
                    for (std::size_t k = 0; k + 1 < b.samples.size(); ++k) {
                        const Vec3& p = a.samples[i].position;
                        const Vec3& q = b.samples[k].position;
                        const Vec3 u = a.samples[i + 1].position - p;
                        const Vec3 v = b.samples[k + 1].position - q;
                        const double d = u.cross(v).z();
                        if (std::abs(d) < 1e-12) continue;
                        const double s = (q - p).cross(v).z() / d, t = (q - p).cross(u).z() / d;
                        EXPECT_FALSE(std::min(s, t) > 1e-6 && std::max(s, t) < 1 - 1e-6)
                            << "seed " << seed << ": a crossing without a junction";
                    }
                }
            }
        }
    }
}

TEST(Combine, EmptyNetworksAndBadTolerances) {
    const LoadedMesh mesh = make_model("box");
    const FeatureCurveNetwork sharp = detect_sharp(mesh);
    EXPECT_TRUE(combine_networks({}, mesh).arcs.empty());
    EXPECT_EQ(combine_networks({sharp, {}}, mesh).arcs.size(), 12u);
    EXPECT_EQ(combine_networks({{}, sharp}, mesh).arcs.size(), 12u);
    EXPECT_THROW(combine_networks({sharp}, mesh, {-1}), InputError);
    EXPECT_THROW(combine_networks({sharp}, mesh, {std::nan("")}), InputError);
}

}  // namespace
}  // namespace fcn
