// Conflict detection against all pairs, against the conformity checker pair by pair, and by hand
// for every configuration of the paper's Figure 4 and of strict conformity.

#include "adaptation/conflicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "adaptation/conformity.h"
#include "networks.h"
#include "oracles.h"

namespace fcn {
namespace {

using test::PlainNetwork;
using Pairs = std::set<std::pair<int, int>>;

constexpr double kPi = std::numbers::pi;
constexpr std::array<double, 4> kRatios{1.05, 1.14, 1.35, 1.5};

SegmentGraph make_graph(const PlainNetwork& network, double rmin = 1) {
    SegmentGraph graph;
    for (const Vec3& point : network.points) {
        graph.nodes.emplace_back();
        graph.nodes.back().position = point;
    }
    for (int e = 0; e < static_cast<int>(network.segments.size()); ++e) {
        GraphSegment segment;
        segment.nodes = network.segments[e];
        segment.is_short = network.length(e) < rmin;
        graph.segments.push_back(segment);
    }
    graph.connect();
    return graph;
}

ConflictResult detect(const PlainNetwork& network, AdaptationMode mode, double ratio = 1.5,
                      ElementType target = ElementType::Triangle) {
    ConflictOptions options;
    options.mode = mode;
    return detect_conflicts(make_graph(network), make_scale(1, ratio, target), options);
}

Pairs pairs_of(const std::vector<Conflict>& conflicts) {
    Pairs pairs;
    for (const Conflict& c : conflicts) pairs.emplace(c.first, c.second);
    return pairs;
}

Pairs pairs_of(const std::vector<VertexConflict>& conflicts) {
    Pairs pairs;
    for (const VertexConflict& c : conflicts) pairs.emplace(c.first, c.second);
    return pairs;
}

void expect_equal_but_doubtful(const Pairs& found, const Pairs& expected, const Pairs& doubtful) {
    Pairs difference;
    std::set_symmetric_difference(found.begin(), found.end(), expected.begin(), expected.end(),
                                  std::inserter(difference, difference.end()));
    for (const auto& pair : difference) {
        EXPECT_TRUE(doubtful.count(pair)) << "pair " << pair.first << ", " << pair.second
                                          << (found.count(pair) ? " found" : " missed");
    }
}

void compare_with_all_pairs(AdaptationMode mode, double low, int first_seed) {
    std::size_t conflicts = 0, vertex_conflicts = 0, pairs = 0, doubts = 0;
    for (int round = 0; round < 160; ++round) {
        SCOPED_TRACE("seed " + std::to_string(first_seed + round));
        test::ConflictQuestion question;
        question.ratio = kRatios[round % kRatios.size()];
        question.is_quad = round % 3 == 2;
        question.is_best_mode = mode == AdaptationMode::Best;
        question.network = test::random_network(first_seed + round, 30, 2.5 + 0.02 * round,
                                                round % 2 == 0, low, question.ratio);
        const auto expected = test::all_conflicts(question);
        const ConflictResult found =
            detect(question.network, mode, question.ratio,
                   question.is_quad ? ElementType::Quad : ElementType::Triangle);
        expect_equal_but_doubtful(pairs_of(found.conflicts), expected.conflicts, expected.doubtful);
        expect_equal_but_doubtful(pairs_of(found.vertex_conflicts), expected.vertex_conflicts,
                                  expected.doubtful_nodes);
        EXPECT_TRUE(found.input_forced.empty());
        EXPECT_TRUE(found.exempt.empty());
        conflicts += expected.conflicts.size();
        vertex_conflicts += expected.vertex_conflicts.size();
        pairs += 30 * 29 / 2;
        doubts += expected.doubtful.size();
    }
    EXPECT_GT(conflicts, pairs / 50);
    EXPECT_LT(conflicts, pairs / 2);
    EXPECT_GT(vertex_conflicts, 100u);
    EXPECT_LT(doubts, pairs / 200);
}

TEST(ConflictsAgainstAllPairs, PaperMode) { compare_with_all_pairs(AdaptationMode::Paper, 1.0, 1); }
TEST(ConflictsAgainstAllPairs, PaperModeWithShortSegments) {
    compare_with_all_pairs(AdaptationMode::Paper, 0.6, 1001);
}
TEST(ConflictsAgainstAllPairs, BestMode) {
    compare_with_all_pairs(AdaptationMode::Best, 1.0, 2001);
}
TEST(ConflictsAgainstAllPairs, BestModeWithShortSegments) {
    compare_with_all_pairs(AdaptationMode::Best, 0.6, 3001);
}

// Best mode promises strict conformity: without short segments a pair conforms on its own exactly
// if neither it nor two extraordinary nodes of it are in conflict.
TEST(ConflictsAgainstAllPairs, BestModeAgreesWithTheChecker) {
    for (int round = 0; round < 40; ++round) {
        SCOPED_TRACE("seed " + std::to_string(4001 + round));
        const double ratio = kRatios[round % kRatios.size()];
        const PlainNetwork network =
            test::random_network(4001 + round, 30, 3, round % 2 == 0, 1.0, ratio);
        const ConflictResult found = detect(network, AdaptationMode::Best, ratio);
        const Pairs conflicts = pairs_of(found.conflicts);
        const Pairs nodes = pairs_of(found.vertex_conflicts);
        ConformityOptions options;
        options.rmin = 1 - 2e-9;  // lengths may round below 1
        options.ratio = ratio;
        for (int e = 0; e < 30; ++e) {
            for (int f = e + 1; f < 30; ++f) {
                const auto& a = network.segments[e];
                const auto& b = network.segments[f];
                const auto pair =
                    test::segment_network(network.points, {{a[0], a[1]}, {b[0], b[1]}});
                bool is_expected = conflicts.count({e, f}) > 0;
                for (const int u : a) {
                    for (const int v : b) is_expected |= nodes.count(std::minmax(u, v)) > 0;
                }
                EXPECT_EQ(!check_conformity(pair, options).is_conforming(), is_expected)
                    << "segments " << e << " and " << f;
            }
        }
    }
}

TEST(Conflicts, SameWithAnyNumberOfThreadsAndSorted) {
    const PlainNetwork network = test::random_network(77, 400, 9, false, 0.7, 1.5);
    ConflictOptions options;
    const auto one = detect_conflicts(make_graph(network), make_scale(1, 1.5), options);
    options.threads = 2;
    const auto two = detect_conflicts(make_graph(network), make_scale(1, 1.5), options);
    ASSERT_EQ(one.conflicts.size(), two.conflicts.size());
    for (std::size_t i = 0; i < one.conflicts.size(); ++i) {
        const Conflict &a = one.conflicts[i], &b = two.conflicts[i];
        EXPECT_TRUE(a.kind == b.kind && a.first == b.first && a.second == b.second &&
                    a.distance == b.distance && a.witness_first == b.witness_first);
        EXPECT_LT(a.first, a.second);
        if (i > 0) {
            EXPECT_LT(std::pair(one.conflicts[i - 1].first, one.conflicts[i - 1].second),
                      std::pair(a.first, a.second));
        }
    }
}

// ---- by hand ----

PlainNetwork two_segments(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
    return {{a0, a1, b0, b1}, {{0, 1}, {2, 3}}};
}

/// Kind of the only conflict, or nothing.
std::vector<ConflictKind> kinds(const PlainNetwork& network, AdaptationMode mode,
                                double ratio = 1.5) {
    std::vector<ConflictKind> result;
    for (const Conflict& c : detect(network, mode, ratio).conflicts) result.push_back(c.kind);
    return result;
}

const std::vector<ConflictKind> kNone;
const std::vector<ConflictKind> kDistance{ConflictKind::Distance};
const std::vector<ConflictKind> kCrossing{ConflictKind::Crossing};
const std::vector<ConflictKind> kAngle{ConflictKind::Angle};

TEST(ConflictsPaper, ParallelSegments) {
    for (const double ratio : kRatios) {
        const auto beside = [](double gap) {
            return two_segments({0, 0, 0}, {1.05, 0, 0}, {0, gap, 0}, {1.05, gap, 0});
        };
        // Side by side the two sides of configuration (c) are the gap; no connector of (d) leaves
        // room on both sides while the gap is below rmin.
        EXPECT_EQ(kinds(beside(0.99), AdaptationMode::Paper, ratio), kDistance) << ratio;
        EXPECT_EQ(kinds(beside(1.01), AdaptationMode::Paper, ratio), kNone) << ratio;
    }
}

TEST(ConflictsPaper, ConfigurationC) {
    for (const double ratio : kRatios) {
        // A stem above the middle of a segment: from its foot to both ends at least rmin, the far
        // end farther. Sides: foot to one end, tip to the other; a diagonal is longer still.
        const double half = ratio / 2;
        const double height = std::sqrt(1 - half * half);
        const auto stem = [&](double y) {
            return two_segments({-half, 0, 0}, {half, 0, 0}, {0, y, 0}, {0, y + 1.02, 0});
        };
        EXPECT_EQ(kinds(stem(height + 1e-4), AdaptationMode::Paper, ratio), kNone) << ratio;
        EXPECT_EQ(kinds(stem(height - 1e-4), AdaptationMode::Paper, ratio), kDistance) << ratio;
    }
}

TEST(ConflictsPaper, ConfigurationCNeedsOneDiagonalOnly) {
    // Opposite directions on two lines 0.9 apart, shifted by 0.5: both sides of the smaller pairing
    // are sqrt(0.81 + 0.25) = 1.03; one diagonal is longer than both.
    const auto shifted = two_segments({0, 0, 0}, {1.1, 0, 0}, {1.6, 0.9, 0}, {0.5, 0.9, 0});
    EXPECT_EQ(kinds(shifted, AdaptationMode::Paper), kNone);
    EXPECT_EQ(kinds(shifted, AdaptationMode::Best), kNone) << "0.9 >= h, nodes >= rmin";
    const auto closer = two_segments({0, 0, 0}, {1.1, 0, 0}, {1.5, 0.9, 0}, {0.4, 0.9, 0});
    EXPECT_EQ(kinds(closer, AdaptationMode::Paper), kDistance) << "sides 0.985";
}

/// Segment along x and a connector of length 1.02 upwards from its first end; the other segment
/// leaves the connector's upper end at angle `beta`, bending back over the first.
PlainNetwork configuration_d(double beta) {
    const Vec3 top(0, 1.02, 0);
    return two_segments({0, 0, 0}, {1.2, 0, 0}, top,
                        top + 1.2 * Vec3(std::sin(beta), -std::cos(beta), 0));
}

TEST(ConflictsPaper, ConfigurationD) {
    // The far ends are closer than rmin, so (c) fails; (d) asks 2 alpha_min of both angles: here 90
    // degrees and beta.
    for (const double ratio : {1.35, 1.5}) {
        const double needed = 2 * std::min(std::acos(ratio / 2), 2 * std::asin(1 / (2 * ratio)));
        ASSERT_LT(needed, kPi / 2);
        EXPECT_EQ(kinds(configuration_d(needed + 1e-3), AdaptationMode::Paper, ratio), kNone);
        EXPECT_EQ(kinds(configuration_d(needed - 1e-3), AdaptationMode::Paper, ratio), kDistance);
    }
    // At small ratios 2 alpha_min is obtuse, and (d) never helps segments closer than rmin.
    for (const double ratio : {1.05, 1.14}) {
        EXPECT_EQ(kinds(configuration_d(86 * kPi / 180), AdaptationMode::Paper, ratio), kDistance);
    }
    // The quad target keeps the triangle's 2 alpha_min here.
    EXPECT_TRUE(
        detect(configuration_d(80 * kPi / 180), AdaptationMode::Paper, 1.5, ElementType::Quad)
            .conflicts.empty());
    EXPECT_EQ(detect(configuration_d(80 * kPi / 180), AdaptationMode::Best).vertex_conflicts.size(),
              1u)
        << "what (d) accepts, strict conformity does not";
}

TEST(ConflictsPaper, Crossing) {
    for (const double ratio : kRatios) {
        const double h = std::sqrt(1 - ratio * ratio / 4);
        const auto crossing = [](double z) {
            return two_segments({-0.72, 0, 0}, {0.72, 0, 0}, {0, -0.72, z}, {0, 0.72, z});
        };
        // All end points are more than rmin apart: (c) holds at any height.
        EXPECT_EQ(kinds(crossing(h - 1e-4), AdaptationMode::Paper, ratio), kCrossing) << ratio;
        EXPECT_EQ(kinds(crossing(h + 1e-4), AdaptationMode::Paper, ratio), kNone) << ratio;
        EXPECT_EQ(kinds(crossing(0), AdaptationMode::Paper, ratio), kCrossing);
        EXPECT_EQ(kinds(crossing(h - 1e-4), AdaptationMode::Best, ratio), kDistance);
        EXPECT_EQ(kinds(crossing(h + 1e-4), AdaptationMode::Best, ratio), kNone);
        const auto result = detect(crossing(0.3), AdaptationMode::Paper, ratio);
        ASSERT_EQ(result.conflicts.size(), 1u);
        EXPECT_NEAR(result.conflicts[0].distance, 0.3, 1e-12);
        EXPECT_NEAR(result.conflicts[0].witness_first.norm(), 0, 1e-12);
        EXPECT_NEAR((result.conflicts[0].witness_second - Vec3(0, 0, 0.3)).norm(), 0, 1e-12);
    }
}

TEST(Conflicts, AnglesAtASharedNode) {
    for (const double ratio : kRatios) {
        const double low = std::min(std::acos(ratio / 2), 2 * std::asin(1 / (2 * ratio)));
        const double high = std::max(2 * std::asin(ratio / 2), std::acos(1 / (2 * ratio)));
        const auto corner = [](double angle) {
            return PlainNetwork{
                {{1.04, 0, 0}, {0, 0, 0}, 1.04 * Vec3(std::cos(angle), 0, std::sin(angle))},
                {{0, 1}, {1, 2}}};
        };
        const auto is_feasible = [&](double angle) {
            bool is_in = false;
            for (int k = 1; k <= 3; ++k) is_in |= angle >= k * low && angle <= k * high;
            return is_in;
        };
        for (const AdaptationMode mode : {AdaptationMode::Paper, AdaptationMode::Best}) {
            for (int k = 1; k <= 3; ++k) {
                for (const double limit : {k * low, k * high}) {
                    for (const double angle : {limit - 1e-4, limit + 1e-4}) {
                        if (angle > kPi) continue;
                        const auto found = kinds(corner(angle), mode, ratio);
                        const bool has_angle =
                            std::count(found.begin(), found.end(), ConflictKind::Angle) > 0;
                        EXPECT_EQ(has_angle, !is_feasible(angle)) << angle << " at ratio " << ratio;
                    }
                }
            }
            EXPECT_EQ(kinds(corner(kPi), mode, ratio), kNone) << "straight on";
            EXPECT_EQ(kinds(corner(0.1), mode, ratio), kAngle);
        }
    }
}

TEST(Conflicts, AngleThroughAShortSegment) {
    // Two segments joined by a short one, nearly parallel: adjacent, so their angle decides, not
    // their distance. The same without the short segment is a matter of distance.
    PlainNetwork joined{{{0, 0, 0}, {1.2, 0.1, 0}, {0, 0.5, 0}, {1.2, 0.6, 0}},
                        {{0, 1}, {2, 3}, {0, 2}}};
    for (const AdaptationMode mode : {AdaptationMode::Paper, AdaptationMode::Best}) {
        const auto result = detect(joined, mode);
        const auto found =
            std::find_if(result.conflicts.begin(), result.conflicts.end(),
                         [](const Conflict& c) { return c.first == 0 && c.second == 1; });
        ASSERT_NE(found, result.conflicts.end());
        EXPECT_EQ(found->kind, ConflictKind::Angle);
        EXPECT_NEAR(found->angle, 0, 1e-9);
    }
    // Opening the angle to 50 degrees makes them feasible, however close they are.
    PlainNetwork open = joined;
    open.points[1] = Vec3(1.2, 0, 0);
    open.points[3] =
        open.points[2] + 1.2 * Vec3(std::cos(50 * kPi / 180), std::sin(50 * kPi / 180), 0);
    for (const AdaptationMode mode : {AdaptationMode::Paper, AdaptationMode::Best}) {
        const Pairs pairs = pairs_of(detect(open, mode).conflicts);
        EXPECT_FALSE(pairs.count({0, 1}));
    }
    open.segments.pop_back();
    EXPECT_EQ(kinds(open, AdaptationMode::Best), kDistance) << "0.5 < h";
}

TEST(ConflictsBest, NodesOfWhichOneIsRegular) {
    // A chain passes an end point at 0.9: closer than rmin, farther than h. The chain's middle node
    // is regular, so no valence rule can take it out of the way: the pairs conflict.
    const PlainNetwork passing{{{-1.2, 0, 0}, {0, 0, 0}, {1.2, 0, 0}, {0, 0.9, 0}, {0, 2.1, 0}},
                               {{0, 1}, {1, 2}, {3, 4}}};
    const auto result = detect(passing, AdaptationMode::Best);
    EXPECT_EQ(pairs_of(result.conflicts), (Pairs{{0, 2}, {1, 2}}));
    for (const Conflict& c : result.conflicts) EXPECT_EQ(c.kind, ConflictKind::Nodes);
    EXPECT_TRUE(result.vertex_conflicts.empty());
    EXPECT_TRUE(detect(passing, AdaptationMode::Paper).conflicts.empty() ||
                detect(passing, AdaptationMode::Paper).conflicts[0].kind == ConflictKind::Distance);
}

TEST(Conflicts, VertexConflictsOfNodesThatNoShortSegmentJoins) {
    // Two end points 0.9 apart on a line: extraordinary both.
    const auto ends = two_segments({0, 0, 0}, {1.2, 0, 0}, {2.1, 0, 0}, {3.3, 0, 0});
    for (const AdaptationMode mode : {AdaptationMode::Paper, AdaptationMode::Best}) {
        const auto result = detect(ends, mode);
        ASSERT_EQ(result.vertex_conflicts.size(), 1u);
        EXPECT_EQ(result.vertex_conflicts[0].first, 1);
        EXPECT_EQ(result.vertex_conflicts[0].second, 2);
        EXPECT_NEAR(result.vertex_conflicts[0].distance, 0.9, 1e-12);
    }
    EXPECT_TRUE(detect(ends, AdaptationMode::Best).conflicts.empty()) << "left to the valences";
    // Joined by a short segment: the same vertex conflict.
    PlainNetwork joined = ends;
    joined.segments.push_back({1, 2});
    EXPECT_TRUE(detect(joined, AdaptationMode::Best).vertex_conflicts.empty())
        << "both regular now";
    joined.points.push_back({1.2, -1.2, 0});
    joined.points.push_back({2.1, 1.2, 0});
    joined.segments.push_back({1, 4});
    joined.segments.push_back({2, 5});
    EXPECT_EQ(pairs_of(detect(joined, AdaptationMode::Best).vertex_conflicts), (Pairs{{1, 2}}));
    // A regular node close to an extraordinary one is no vertex conflict.
    const PlainNetwork regular{{{-1.2, 0, 0}, {0, 0, 0}, {1.2, 0, 0}, {0, 0.8, 0}, {0, 2, 0}},
                               {{0, 1}, {1, 2}, {3, 4}}};
    EXPECT_TRUE(detect(regular, AdaptationMode::Best).vertex_conflicts.empty());
}

TEST(ConflictsBest, ShortSegmentsAgainstOutsiders) {
    // A short segment 0.5 below another segment: in conflict, so that its cluster cannot simply
    // collapse. At 0.7 (above h, below rmin) only the nodes are close, which a short one may be.
    const auto below = [](double gap) {
        return two_segments({0, 0, 0}, {0.8, 0, 0}, {-0.2, gap, 0}, {1, gap, 0});
    };
    EXPECT_EQ(kinds(below(0.5), AdaptationMode::Best), kDistance);
    EXPECT_EQ(kinds(below(0.7), AdaptationMode::Best), kNone);
}

TEST(Conflicts, PinnedPairsAreReportedButNoConstraint) {
    const auto parallel = two_segments({0, 0, 0}, {1.2, 0, 0}, {0, 0.5, 0}, {1.2, 0.5, 0});
    for (const AdaptationMode mode : {AdaptationMode::Paper, AdaptationMode::Best}) {
        for (int pinned = 0; pinned < 4; ++pinned) {
            SegmentGraph graph = make_graph(parallel);
            graph.segments[0].is_pinned = pinned & 1;
            graph.segments[1].is_pinned = pinned & 2;
            graph.connect();
            ConflictOptions options;
            options.mode = mode;
            const auto result = detect_conflicts(graph, make_scale(1, 1.5), options);
            EXPECT_EQ(result.conflicts.size(), pinned == 3 ? 0u : 1u);
            EXPECT_EQ(result.input_forced.size(), pinned == 3 ? 1u : 0u);
        }
    }
}

/// A feature (segment 2) that ends at a pinned node with another pinned node 0.3 away.
TEST(Conflicts, FeaturesYieldAtNodesThatPinsForceTogether) {
    for (const double gap : {0.3, 1.1}) {
        const PlainNetwork network{{{0, 0, 0}, {gap, 0, 0}, {-1.2, 0, 0}, {0, 1.2, 0}},
                                   {{0, 1}, {0, 2}, {0, 3}}};
        SegmentGraph graph = make_graph(network);
        graph.segments[0].is_pinned = graph.segments[1].is_pinned = true;
        graph.connect();
        ConflictOptions options;
        const auto result = detect_conflicts(graph, make_scale(1, 1.5), options);
        std::vector<std::pair<int, int>> with_feature;
        for (const Conflict& c : result.conflicts) {
            if (c.second == 2) with_feature.emplace_back(c.first, c.second);
        }
        if (gap < 1) {
            EXPECT_EQ(with_feature, (std::vector<std::pair<int, int>>{{0, 2}}));
        } else {
            EXPECT_TRUE(with_feature.empty());
        }
        options.mode = AdaptationMode::Paper;
        EXPECT_TRUE(detect_conflicts(graph, make_scale(1, 1.5), options).conflicts.empty());
    }
}

TEST(Conflicts, ThinWallsAreListedNotInConflict) {
    const auto parallel = two_segments({0, 0, 0}, {1.2, 0, 0}, {0, 0, 0.5}, {1.2, 0, 0.5});
    ConflictOptions options;
    options.is_thin_wall = [](const Vec3& a, const Vec3& b) {
        return std::abs(a.z() - b.z()) > 0.4;
    };
    for (const AdaptationMode mode : {AdaptationMode::Paper, AdaptationMode::Best}) {
        options.mode = mode;
        const auto result = detect_conflicts(make_graph(parallel), make_scale(1, 1.5), options);
        EXPECT_TRUE(result.conflicts.empty());
        EXPECT_TRUE(result.vertex_conflicts.empty());
        ASSERT_EQ(result.exempt.size(), 1u);
        EXPECT_EQ(result.exempt[0].first, 0);
        EXPECT_EQ(result.exempt[0].second, 1);
        EXPECT_NEAR(result.exempt[0].distance, 0.5, 1e-12);
    }
    options.is_thin_wall = [](const Vec3&, const Vec3&) { return false; };
    EXPECT_EQ(detect_conflicts(make_graph(parallel), make_scale(1, 1.5), options).conflicts.size(),
              1u);
}

TEST(Conflicts, ParallelSegmentsBetweenTheSameNodes) {
    const PlainNetwork twice{{{0, 0, 0}, {1.2, 0, 0}}, {{0, 1}, {0, 1}}};
    EXPECT_EQ(kinds(twice, AdaptationMode::Best), kAngle);
    EXPECT_EQ(kinds(twice, AdaptationMode::Paper), kAngle);
}

TEST(Conflicts, SegmentDistanceAgainstSearch) {
    std::uint64_t seed = 5;
    for (int round = 0; round < 300; ++round) {
        const PlainNetwork n = test::random_network(seed + round, 2, 2, round % 2, 0.1, 2);
        const auto [a, b] = n.segments[0];
        const auto [c, d] = n.segments[1];
        const auto expected =
            test::numeric_distance(n.points[a], n.points[b], n.points[c], n.points[d]);
        const auto found = segment_distance(n.points[a], n.points[b], n.points[c], n.points[d]);
        EXPECT_NEAR(found.distance, expected.distance, 1e-9) << "seed " << seed + round;
    }
    // Parallel, collinear, and points.
    EXPECT_NEAR(segment_distance({0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {3, 1, 0}).distance,
                std::sqrt(2.0), 1e-15);
    EXPECT_NEAR(segment_distance({0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 0, 0}).distance, 1, 1e-15);
    EXPECT_NEAR(segment_distance({0, 0, 0}, {0, 0, 0}, {3, 4, 0}, {3, 4, 0}).distance, 5, 1e-15);
    EXPECT_NEAR(segment_distance({0, 2, 0}, {0, 2, 0}, {-1, 0, 0}, {1, 0, 0}).distance, 2, 1e-15);
}

}  // namespace
}  // namespace fcn
