// The conformity checker: every condition by hand on both sides of its limit, thin walls on meshes
// whose surface distances are known, and the neighbour search against all pairs.

#include "adaptation/conformity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <tuple>

#include "geometry/errors.h"
#include "networks.h"

namespace fcn {
namespace {

using test::segment_network;

constexpr double kPi = std::numbers::pi;
constexpr double kInside = 0.5e-6;  ///< within the tolerance
constexpr double kOutside = 2e-6;   ///< beyond it
constexpr std::array<double, 4> kRatios{1.05, 1.14, 1.35, 1.5};

ConformityOptions options_at(double ratio = 1.5, double rmin = 1.0) {
    ConformityOptions options;
    options.rmin = rmin;
    options.ratio = ratio;
    return options;
}

double flattest_height(double ratio) { return std::sqrt(1 - ratio * ratio / 4); }

std::size_t count(const ConformityReport& report, ViolationKind kind) {
    return std::count_if(report.violations.begin(), report.violations.end(),
                         [&](const Violation& v) { return v.kind == kind; });
}

/// A straight chain with the given segment lengths, one arc.
FeatureCurveNetwork straight_chain(const std::vector<double>& lengths) {
    std::vector<Vec3> points{Vec3::Zero()};
    std::vector<std::pair<int, int>> segments;
    for (const double length : lengths) {
        points.push_back(points.back() + Vec3(length, 0, 0));
        segments.emplace_back(points.size() - 2, points.size() - 1);
    }
    return segment_network(points, segments, std::vector<int>(lengths.size(), 0));
}

TEST(ConformityLength, LowerLimit) {
    EXPECT_TRUE(check_conformity(straight_chain({1 - kInside, 1.2}), options_at()).is_conforming());
    const auto report = check_conformity(straight_chain({1.2, 1 - kOutside}), options_at());
    ASSERT_EQ(count(report, ViolationKind::ShortSegment), 1u);
    const Violation& shorter = report.violations.front();
    EXPECT_EQ(shorter.first, 1);
    EXPECT_EQ(shorter.second, -1);
    EXPECT_NEAR(shorter.measured, 1 - kOutside, 1e-12);
    EXPECT_DOUBLE_EQ(shorter.required, 1.0);
    EXPECT_EQ(count(report, ViolationKind::CloseNodes), 1u) << "its ends are also too close";
    EXPECT_EQ(report.counted, 2u);
}

TEST(ConformityLength, UpperLimitAndOneLongSegmentAnArc) {
    auto report = check_conformity(straight_chain({1.5 * (1 + kInside), 1.0}), options_at());
    EXPECT_TRUE(report.is_conforming());
    EXPECT_EQ(report.long_segments, 0u);
    report = check_conformity(straight_chain({1.5 * (1 + kOutside), 1.0}), options_at());
    EXPECT_TRUE(report.is_conforming());
    EXPECT_EQ(report.long_segments, 1u);

    report = check_conformity(straight_chain({1.6, 1.0, 2.06 * (1 + kInside)}), options_at());
    ASSERT_EQ(report.counted, 1u) << "two long ones on one arc";
    EXPECT_EQ(report.violations[0].kind, ViolationKind::LongSegment);
    EXPECT_EQ(report.violations[0].first, 2);
    EXPECT_DOUBLE_EQ(report.violations[0].required, 1.5);
    EXPECT_EQ(report.long_segments, 1u);

    auto two_arcs = straight_chain({1.6, 1.0, 1.7});
    two_arcs.segments[2].arc = 1;
    two_arcs.arcs.resize(2);
    report = check_conformity(two_arcs, options_at());
    EXPECT_TRUE(report.is_conforming()) << "one each";
    EXPECT_EQ(report.long_segments, 2u);
}

TEST(ConformityLength, LongestLimit) {
    for (const double rmin : {0.01, 1.0, 300.0}) {
        const auto chain = [&](double factor) {
            return straight_chain({1.2 * rmin, 2.06 * rmin * factor});
        };
        const ConformityOptions options = options_at(1.35, rmin);
        EXPECT_TRUE(check_conformity(chain(1 + kInside), options).is_conforming());
        const auto report = check_conformity(chain(1 + kOutside), options);
        ASSERT_EQ(report.counted, 1u);
        EXPECT_EQ(report.violations[0].kind, ViolationKind::LongSegment);
        EXPECT_DOUBLE_EQ(report.violations[0].required, 2.06 * rmin);
        EXPECT_EQ(report.long_segments, 0u);
    }
}

TEST(ConformityLength, ZeroLengthIsShortAndHasNoAngle) {
    const auto network =
        segment_network({{0, 0, 0}, {0, 0, 0}, {1.2, 0, 0}}, {{0, 1}, {1, 2}}, {0, 0});
    const auto report = check_conformity(network, options_at());
    EXPECT_EQ(count(report, ViolationKind::ShortSegment), 1u);
    EXPECT_EQ(count(report, ViolationKind::Angle), 0u);
    // A loop of one segment: its two ends are one node.
    const auto loop = segment_network({{0, 0, 0}}, {{0, 0}});
    EXPECT_EQ(count(check_conformity(loop, options_at()), ViolationKind::ShortSegment), 1u);
}

TEST(ConformityNodes, DistanceLimit) {
    const auto gap = [](double width) {
        return segment_network({{0, 0, 0}, {1.2, 0, 0}, {1.2 + width, 0, 0}, {2.4 + width, 0, 0}},
                               {{0, 1}, {2, 3}});
    };
    EXPECT_TRUE(check_conformity(gap(1 - kInside), options_at()).is_conforming());
    auto report = check_conformity(gap(1 - kOutside), options_at());
    ASSERT_EQ(report.counted, 1u);
    EXPECT_EQ(report.violations[0].kind, ViolationKind::CloseNodes);
    EXPECT_EQ(report.violations[0].first, 1);
    EXPECT_EQ(report.violations[0].second, 2);
    EXPECT_NEAR(report.violations[0].measured, 1 - kOutside, 1e-12);
    EXPECT_DOUBLE_EQ(report.violations[0].required, 1.0);
    EXPECT_NEAR((report.violations[0].witness_first - Vec3(1.2, 0, 0)).norm(), 0, 1e-15);
    report = check_conformity(gap(flattest_height(1.5) - 1e-5), options_at());
    EXPECT_EQ(count(report, ViolationKind::CloseNodes), 1u);
    EXPECT_EQ(count(report, ViolationKind::CloseSegments), 1u);
}

// One segment along x, the other crossing above its middle: every node is farther than rmin from
// the others, so that only the distance of the segments counts.
TEST(ConformitySegments, CrossingAtHeight) {
    for (const double ratio : kRatios) {
        const double h = flattest_height(ratio);
        const double half = ratio / 2;
        const auto crossing = [&](double z) {
            return segment_network({{-half, 0, 0}, {half, 0, 0}, {0, -half, z}, {0, half, z}},
                                   {{0, 1}, {2, 3}});
        };
        EXPECT_TRUE(
            check_conformity(crossing(h * (1 - kInside)), options_at(ratio)).is_conforming());
        const auto report = check_conformity(crossing(h * (1 - kOutside)), options_at(ratio));
        ASSERT_EQ(count(report, ViolationKind::CloseSegments), 1u) << ratio;
        const Violation& close = report.violations.back();
        EXPECT_NEAR(close.required, h, 1e-12);
        EXPECT_NEAR(close.measured, h * (1 - kOutside), 1e-12);
        EXPECT_NEAR(close.witness_first.norm(), 0, 1e-12);
        EXPECT_NEAR((close.witness_second - Vec3(0, 0, h)).norm(), 0, 1e-5);
    }
    EXPECT_EQ(
        count(check_conformity(segment_network({{-.7, 0, 0}, {.7, 0, 0}, {0, -.7, 0}, {0, .7, 0}},
                                               {{0, 1}, {2, 3}}),
                               options_at()),
              ViolationKind::CloseSegments),
        1u)
        << "a true crossing";
}

// The apex of the flattest triangle over a longest segment: at rmin from both ends and at h from
// the segment, both limits at once.
TEST(ConformitySegments, FlattestTriangle) {
    for (const double ratio : kRatios) {
        const double h = flattest_height(ratio);
        const auto stem = [&](double y) {
            return segment_network(
                {{-ratio / 2, 0, 0}, {ratio / 2, 0, 0}, {0, y, 0}, {0, y + 1.02, 0}},
                {{0, 1}, {2, 3}});
        };
        EXPECT_TRUE(check_conformity(stem(h), options_at(ratio)).is_conforming());
        const auto report = check_conformity(stem(h * (1 - 1e-5)), options_at(ratio));
        EXPECT_EQ(count(report, ViolationKind::CloseNodes), 2u);
        EXPECT_EQ(count(report, ViolationKind::CloseSegments), 1u);
    }
}

TEST(ConformitySegments, SharedNodesAreLeftToTheAngles) {
    const auto corner = segment_network({{1.2, 0, 0}, {0, 0, 0}, {0, 1.2, 0}}, {{0, 1}, {1, 2}});
    EXPECT_TRUE(check_conformity(corner, options_at()).is_conforming());
    const auto parallel = segment_network({{0, 0, 0}, {1.2, 0, 0}}, {{0, 1}, {0, 1}});
    const auto report = check_conformity(parallel, options_at());
    EXPECT_EQ(count(report, ViolationKind::CloseSegments), 0u);
    ASSERT_EQ(count(report, ViolationKind::Angle), 2u) << "angle 0 at both nodes";
    EXPECT_EQ(report.counted, 2u);
    EXPECT_NE(report.violations[0].witness_first, report.violations[1].witness_first);
    const auto opposite = segment_network({{0, 0, 0}, {1.2, 0, 0}}, {{0, 1}, {1, 0}});
    EXPECT_EQ(check_conformity(opposite, options_at()).counted, 2u);
}

ConformityReport at_angle(double angle, const ConformityOptions& options) {
    // In a tilted plane: the angle is three-dimensional.
    const Vec3 u = Vec3(1, 2, 2).normalized();
    const Vec3 v = Vec3(2, 1, -2).normalized();
    const double length = options.rmin * (1 + options.ratio) / 2;
    return check_conformity(segment_network({length * u, Vec3::Zero(),
                                             length * (std::cos(angle) * u + std::sin(angle) * v)},
                                            {{0, 1}, {1, 2}}),
                            options);
}

TEST(ConformityAngles, EveryIntervalLimit) {
    for (const bool is_quad : {false, true}) {
        for (const double r : kRatios) {
            ConformityOptions options = options_at(r);
            options.is_quad_target = is_quad;
            const double kite = std::acos((r * r + 1) / (2 * std::sqrt(2) * r));
            const double low = is_quad ? 2 * std::min(std::asin(1 / (std::sqrt(2) * r)), kite)
                                       : std::min(std::acos(r / 2), 2 * std::asin(1 / (2 * r)));
            const double high = is_quad
                                    ? 2 * std::max(std::asin(std::min(1.0, r / std::sqrt(2))), kite)
                                    : std::max(2 * std::asin(r / 2), std::acos(1 / (2 * r)));
            const int multiples = is_quad ? 2 : 3;
            const auto is_feasible = [&](double angle) {
                bool is_in = false;
                for (int k = 1; k <= multiples; ++k) is_in |= angle >= k * low && angle <= k * high;
                return is_in;
            };
            int gaps = 0;
            for (int k = 1; k <= multiples; ++k) {
                for (const double limit : {k * low, k * high}) {
                    for (const double side : {-1.0, 1.0}) {
                        const double inside = limit * (1 + side * kInside);
                        const double outside = limit * (1 + side * kOutside);
                        if (outside >= kPi) continue;
                        EXPECT_EQ(count(at_angle(inside, options), ViolationKind::Angle), 0u);
                        const auto report = at_angle(outside, options);
                        const bool is_ok = is_feasible(outside);
                        EXPECT_EQ(count(report, ViolationKind::Angle), is_ok ? 0u : 1u)
                            << outside << " ratio " << r << " quad " << is_quad;
                        if (is_ok || count(report, ViolationKind::Angle) == 0) continue;
                        ++gaps;
                        const Violation& v = report.violations.back();
                        EXPECT_NEAR(v.measured, outside, 1e-9);
                        EXPECT_NEAR(v.required, limit, 1e-9);
                        EXPECT_EQ(v.first, 0);
                        EXPECT_EQ(v.second, 1);
                    }
                }
            }
            EXPECT_GE(gaps, r < 1.3 ? 3 : 1) << "separate intervals at small ratios";
        }
    }
    EXPECT_TRUE(at_angle(kPi, options_at(1.01)).is_conforming());
    EXPECT_EQ(count(at_angle(0.1, options_at(1.5)), ViolationKind::Angle), 1u);
}

TEST(ConformityAngles, AllPairsAtANode) {
    // Six spokes at 60 degrees conform at any ratio; pushing one by 3 degrees breaks the pairs that
    // hold it, at ratio 1.01 but not at 1.5.
    for (const double push : {0.0, 3 * kPi / 180}) {
        std::vector<Vec3> points{Vec3::Zero()};
        std::vector<std::pair<int, int>> segments;
        for (int i = 0; i < 6; ++i) {
            const double angle = i * kPi / 3 + (i == 0 ? push : 0);
            points.push_back(1.01 * Vec3(std::cos(angle), std::sin(angle), 0));
            segments.emplace_back(0, i + 1);
        }
        const auto network = segment_network(points, segments);
        const auto narrow = check_conformity(network, options_at(1.01, 1.005));
        EXPECT_EQ(count(narrow, ViolationKind::Angle), push == 0 ? 0u : 5u);
        EXPECT_EQ(count(check_conformity(network, options_at(1.5, 0.9)), ViolationKind::Angle), 0u);
    }
}

TEST(ConformityPins, OnlyPairsOfPinnedCurvesAreForced) {
    auto network = segment_network(
        {{0, 0, 0}, {0.9, 0, 0}, {0, 0.5, 0}, {0.9, 0.5, 0}, {0, -0.5, 0}, {0.9, -0.5, 0}},
        {{0, 1}, {2, 3}, {4, 5}});
    network.arcs[0].pin = Pin::Keep;
    network.arcs[1].pin = Pin::Keep;
    network.arcs[2].pin = Pin::Drop;
    const auto report = check_conformity(network, options_at());
    for (const Violation& v : report.violations) {
        std::vector<int> items{v.first};
        if (v.second >= 0) items.push_back(v.second);
        const bool is_free = std::any_of(items.begin(), items.end(), [&](int item) {
            return v.kind == ViolationKind::CloseNodes ? item >= 4 : item == 2;
        });
        EXPECT_EQ(v.is_input_forced, !is_free) << to_string(v.kind) << " " << v.first;
    }
    // Lengths 3; nodes: ends of each 3, across at 0.5: 4 and no diagonal below 1 (0.9^2 + 0.5^2 >
    // 1); segments 0-1 and 0-2 at 0.5, 1-2 at 1.
    EXPECT_EQ(report.violations.size(), 3u + 3u + 4u + 2u);
    EXPECT_EQ(report.input_forced, 2u + 2u + 2u + 1u);
    EXPECT_EQ(report.counted, 5u);
    EXPECT_FALSE(report.is_conforming());

    network.arcs[2].pin = Pin::Keep;
    EXPECT_TRUE(check_conformity(network, options_at()).is_conforming());
    EXPECT_EQ(check_conformity(network, options_at()).input_forced, 12u);
}

TEST(ConformityPins, ANodeWithOneFreeArcIsNotForced) {
    // Pinned segments end at nodes 0.8 apart; a free one hangs on the first of the nodes.
    auto network = segment_network({{0, 0, 0}, {-1.2, 0, 0}, {0.8, 0, 0}, {2, 0, 0}, {0, 1.2, 0}},
                                   {{0, 1}, {2, 3}, {0, 4}});
    network.arcs[0].pin = network.arcs[1].pin = Pin::Keep;
    const auto report = check_conformity(network, options_at());
    ASSERT_EQ(report.violations.size(), 1u);
    EXPECT_EQ(report.violations[0].kind, ViolationKind::CloseNodes);
    EXPECT_FALSE(report.violations[0].is_input_forced);
    network.arcs[2].pin = Pin::Keep;
    EXPECT_EQ(check_conformity(network, options_at()).input_forced, 1u);
}

TEST(ConformityPins, PinnedAnglesAndLongSegments) {
    auto network = segment_network({{1.2, 0, 0}, {0, 0, 0}, {1.2, 0.2, 0}}, {{0, 1}, {1, 2}});
    network.arcs[0].pin = network.arcs[1].pin = Pin::Keep;
    EXPECT_TRUE(check_conformity(network, options_at()).is_conforming());
    auto chain = straight_chain({1.7, 1.8, 3.0});
    chain.arcs[0].pin = Pin::Keep;
    const auto report = check_conformity(chain, options_at());
    EXPECT_TRUE(report.is_conforming());
    EXPECT_EQ(report.input_forced, 2u);
    EXPECT_EQ(report.long_segments, 1u);
}

TEST(Conformity, SortedByKindThenIndices) {
    const auto network = segment_network(
        {{0, 0, 0}, {0.5, 0, 0}, {0.1, 0.1, 0}, {0, 0.6, 0}, {3, 0, 0}, {5.5, 0, 0}},
        {{0, 1}, {1, 2}, {2, 3}, {4, 5}});
    const auto report = check_conformity(network, options_at());
    EXPECT_TRUE(std::is_sorted(report.violations.begin(), report.violations.end(),
                               [](const Violation& a, const Violation& b) {
                                   return std::tie(a.kind, a.first, a.second) <
                                          std::tie(b.kind, b.first, b.second);
                               }));
    std::set<ViolationKind> kinds;
    for (const Violation& v : report.violations) kinds.insert(v.kind);
    EXPECT_EQ(kinds.size(), 5u) << "one of each";
}

TEST(Conformity, RefusesBadInput) {
    const auto good = straight_chain({1.2});
    EXPECT_THROW(check_conformity(good, options_at(1.5, 0)), InputError);
    EXPECT_THROW(check_conformity(good, options_at(1.5, std::nan(""))), InputError);
    EXPECT_THROW(check_conformity(good, options_at(1.0)), InputError);
    EXPECT_THROW(check_conformity(good, options_at(1.74)), InputError);
    FeatureCurveNetwork initial = good;
    initial.segments.clear();
    EXPECT_THROW(check_conformity(initial, options_at()), InputError) << "no segments";
    EXPECT_THROW(check_conformity(FeatureCurveNetwork{}, options_at()), InputError);
    FeatureCurveNetwork empty;
    empty.scale = 1;
    EXPECT_TRUE(check_conformity(empty, options_at()).is_conforming()) << "everything dropped";
    FeatureCurveNetwork broken = good;
    broken.segments[0].nodes[1] = 7;
    EXPECT_THROW(check_conformity(broken, options_at()), InputError);
    broken = good;
    broken.segments[0].arc = -1;
    EXPECT_THROW(check_conformity(broken, options_at()), InputError);
    broken = good;
    broken.nodes[0].position.x() = std::nan("");
    EXPECT_THROW(check_conformity(broken, options_at()), InputError);
    broken = good;
    broken.arcs.resize(2);
    EXPECT_THROW(check_conformity(broken, options_at()), InputError) << "an arc without segments";
}

// ---- all pairs, by a distance that is minimised numerically ----

double point_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const double square = (b - a).squaredNorm();
    const double t = square > 0 ? std::clamp((p - a).dot(b - a) / square, 0.0, 1.0) : 0.0;
    return (a + t * (b - a) - p).norm();
}

/// The distance to a segment is convex along another one: ternary search.
double numeric_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
    double low = 0, high = 1;
    for (int i = 0; i < 100; ++i) {
        const double left = low + (high - low) / 3;
        const double right = high - (high - low) / 3;
        const bool is_left = point_segment(a0 + left * (a1 - a0), b0, b1) <
                             point_segment(a0 + right * (a1 - a0), b0, b1);
        (is_left ? high : low) = is_left ? right : left;
    }
    return point_segment(a0 + (low + high) / 2 * (a1 - a0), b0, b1);
}

using Found = std::tuple<ViolationKind, int, int>;

std::multiset<Found> brute_force(const FeatureCurveNetwork& n, double ratio) {
    std::multiset<Found> found;
    const double alpha_min = std::min(std::acos(ratio / 2), 2 * std::asin(1 / (2 * ratio)));
    const double alpha_max = 2 * std::asin(ratio / 2);
    const auto at = [&](int node) -> const Vec3& { return n.nodes[node].position; };
    std::vector<bool> is_used(n.nodes.size(), false);
    const int count = static_cast<int>(n.segments.size());
    for (int i = 0; i < count; ++i) {
        const auto& a = n.segments[i].nodes;
        is_used[a[0]] = is_used[a[1]] = true;
        const double length = (at(a[0]) - at(a[1])).norm();
        if (length < 1) found.emplace(ViolationKind::ShortSegment, i, -1);
        if (length > 2.06) found.emplace(ViolationKind::LongSegment, i, -1);
        for (int j = i + 1; j < count; ++j) {
            const auto& b = n.segments[j].nodes;
            bool is_adjacent = false;
            for (const int shared : {a[0], a[1]}) {
                if (shared != b[0] && shared != b[1]) continue;
                is_adjacent = true;
                const Vec3 u = at(a[0] + a[1] - shared) - at(shared);
                const Vec3 v = at(b[0] + b[1] - shared) - at(shared);
                const double angle = std::acos(std::clamp(u.dot(v) / u.norm() / v.norm(), -1., 1.));
                bool is_ok = false;
                for (int k = 1; k <= 3; ++k) {
                    is_ok |= angle >= k * alpha_min && angle <= k * alpha_max;
                }
                if (!is_ok) found.emplace(ViolationKind::Angle, i, j);
            }
            if (!is_adjacent && numeric_distance(at(a[0]), at(a[1]), at(b[0]), at(b[1])) <
                                    std::sqrt(1 - ratio * ratio / 4)) {
                found.emplace(ViolationKind::CloseSegments, i, j);
            }
        }
    }
    for (std::size_t i = 0; i < n.nodes.size(); ++i) {
        for (std::size_t j = i + 1; j < n.nodes.size(); ++j) {
            if (is_used[i] && is_used[j] && (at(i) - at(j)).norm() < 1) {
                found.emplace(ViolationKind::CloseNodes, i, j);
            }
        }
    }
    return found;
}

TEST(Conformity, RandomNetworksAgainstAllPairs) {
    std::mt19937_64 random(20240611);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    for (int round = 0; round < 60; ++round) {
        SCOPED_TRACE("seed 20240611, round " + std::to_string(round));
        const double ratio = kRatios[round % kRatios.size()];
        const double side = 2 + 6 * uniform();
        std::vector<Vec3> points;
        for (int i = 0; i < 60; ++i) {
            points.emplace_back(side * uniform(), side * uniform(),
                                round % 3 == 0 ? 0.0 : side * uniform() / 3);
        }
        std::set<std::pair<int, int>> pairs;
        while (pairs.size() < 70) {
            const int a = static_cast<int>(random() % points.size());
            const int b = static_cast<int>(random() % points.size());
            if (a < b) pairs.emplace(a, b);
        }
        const auto network = segment_network(points, {pairs.begin(), pairs.end()});
        const auto report = check_conformity(network, options_at(ratio));
        std::multiset<Found> found;
        for (const Violation& v : report.violations) found.emplace(v.kind, v.first, v.second);
        EXPECT_EQ(found, brute_force(network, ratio));
        EXPECT_EQ(report.counted, found.size());
    }
}

// ---- with a mesh ----

/// Closed box of the given size on a grid of cells of the given width; normals outwards.
Mesh plate(double width, double depth, double thickness, double cell) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> faces;
    const std::array<double, 3> size{width, depth, thickness};
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {0, 1}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const int columns = std::max(1, static_cast<int>(std::ceil(size[u] / cell)));
            const int rows = std::max(1, static_cast<int>(std::ceil(size[v] / cell)));
            const int base = static_cast<int>(points.size());
            for (int j = 0; j <= rows; ++j) {
                for (int i = 0; i <= columns; ++i) {
                    Vec3 p;
                    p[axis] = side * size[axis];
                    p[u] = size[u] * i / columns;
                    p[v] = size[v] * j / rows;
                    points.push_back(p);
                }
            }
            for (int j = 0; j < rows; ++j) {
                for (int i = 0; i < columns; ++i) {
                    const int a = base + j * (columns + 1) + i;
                    const int b = a + 1, c = a + columns + 2, d = a + columns + 1;
                    if (side == 1) {
                        faces.push_back({a, b, c});
                        faces.push_back({a, c, d});
                    } else {
                        faces.push_back({a, c, b});
                        faces.push_back({a, d, c});
                    }
                }
            }
        }
    }
    // Weld the seams.
    std::vector<int> first(points.size());
    std::vector<Vec3> unique;
    for (std::size_t i = 0; i < points.size(); ++i) {
        first[i] = -1;
        for (std::size_t j = 0; j < unique.size() && first[i] < 0; ++j) {
            if ((unique[j] - points[i]).norm() < 1e-9) first[i] = static_cast<int>(j);
        }
        if (first[i] >= 0) continue;
        first[i] = static_cast<int>(unique.size());
        unique.push_back(points[i]);
    }
    for (auto& face : faces) {
        for (int& vertex : face) vertex = first[vertex];
    }
    return test::make_mesh(unique, faces);
}

/// Segments along y on the top and the bottom of a plate, at distance x from its rim.
FeatureCurveNetwork top_and_bottom(double x, double thickness) {
    return segment_network({{x, 3, 0}, {x, 4.2, 0}, {x, 3, thickness}, {x, 4.2, thickness}},
                           {{0, 1}, {2, 3}});
}

TEST(ConformityThinWall, ExemptFarFromTheRimOnly) {
    const double t = 0.3;
    const Mesh mesh = plate(8, 8, t, 0.47);
    const auto far = check_conformity(top_and_bottom(4, t), options_at(), &mesh);
    EXPECT_TRUE(far.is_conforming());
    EXPECT_EQ(far.exempt, 3u) << "two pairs of nodes and the segments";
    EXPECT_EQ(far.max_distance_ratio, 0.0) << "a wall's two sides are not near each other";

    // The shortest way from one side to the other runs over the rim: 2x + t = 3 rmin.
    const double limit = (3 - t) / 2;
    EXPECT_EQ(check_conformity(top_and_bottom(limit + 1e-5, t), options_at(), &mesh).exempt, 3u);
    const auto near = check_conformity(top_and_bottom(limit - 1e-5, t), options_at(), &mesh);
    EXPECT_EQ(near.exempt, 0u);
    EXPECT_EQ(near.counted, 3u);
    EXPECT_EQ(near.max_distance_ratio, 4.0) << "cut off there; truly " << (2 * limit + t) / t;
    EXPECT_EQ(near.distance_ratio_over_two, 1u);
}

TEST(ConformityThinWall, CountsWithoutMeshOrWhenAsked) {
    const double t = 0.3;
    const Mesh mesh = plate(8, 8, t, 0.9);
    EXPECT_EQ(check_conformity(top_and_bottom(4, t), options_at()).counted, 3u);
    ConformityOptions strict = options_at();
    strict.is_thin_wall_exempt = false;
    EXPECT_EQ(check_conformity(top_and_bottom(4, t), strict, &mesh).counted, 3u);
    auto pinned = top_and_bottom(4, t);
    pinned.arcs[0].pin = pinned.arcs[1].pin = Pin::Keep;
    const auto report = check_conformity(pinned, options_at(), &mesh);
    EXPECT_EQ(report.input_forced, 3u) << "forced comes before exempt, each counts once";
    EXPECT_EQ(report.exempt, 0u);
}

/// Two flat unconnected sheets, `gap` apart; the upper one's normal is turned by `tilt` about x.
Mesh two_sheets(double gap, double tilt, bool is_facing_away) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> faces;
    for (const int sheet : {0, 1}) {
        const int base = static_cast<int>(points.size());
        for (const double y : {-4.0, 4.0}) {
            for (const double x : {-4.0, 4.0}) {
                const double angle = sheet * tilt;
                points.emplace_back(x, y * std::cos(angle), sheet * gap + y * std::sin(angle));
            }
        }
        const bool is_up = sheet == 1 || !is_facing_away;
        if (is_up) {
            faces.push_back({base, base + 1, base + 3});
            faces.push_back({base, base + 3, base + 2});
        } else {
            faces.push_back({base, base + 3, base + 1});
            faces.push_back({base, base + 2, base + 3});
        }
    }
    return test::make_mesh(points, faces);
}

TEST(ConformityThinWall, NormalsDecide) {
    const auto network = segment_network({{-0.6, 0, 0}, {0.6, 0, 0}, {-0.6, 0, 0.5}, {0.6, 0, 0.5}},
                                         {{0, 1}, {2, 3}});
    const auto exempt = [&](const Mesh& mesh) {
        return check_conformity(network, options_at(), &mesh).exempt;
    };
    EXPECT_EQ(exempt(two_sheets(0.5, 0, true)), 3u) << "unconnected: infinitely far";
    EXPECT_EQ(exempt(two_sheets(0.5, 0, false)), 0u) << "a stack, not a wall";
    EXPECT_EQ(exempt(two_sheets(0.5, kPi / 3 - 1e-3, true)), 3u) << "dot just below -0.5";
    EXPECT_EQ(exempt(two_sheets(0.5, kPi / 3 + 1e-3, true)), 0u) << "dot just above -0.5";
}

TEST(ConformityThinWall, TheRimOfAThinPlateIsNoThinWall) {
    // Both segments on creases of the rim: mean normals at right angles, and close on the surface.
    const double t = 0.3;
    const Mesh mesh = plate(8, 8, t, 1.0);
    EXPECT_EQ(check_conformity(top_and_bottom(0, t), options_at(), &mesh).counted, 3u);
}

/// A sheet, flat but for a V-shaped groove of the given depth around x = 0, as wide as 2 half.
Mesh grooved_sheet(double half, double depth) {
    const std::vector<double> x{-4, -2, -half, 0, half, 2, 4};
    return test::sheet(6, 10,
                       [&](int i, int j) { return Vec3(x[i], j - 5.0, i == 3 ? -depth : 0.0); });
}

TEST(ConformityDistanceRatio, Groove) {
    // Curves along both borders of the groove, 0.8 apart: conforming, as h = 0.66.
    const double half = 0.4;
    const auto network = segment_network(
        {{-half, -1.2, 0}, {-half, 0.1, 0}, {half, -0.55, 0}, {half, 0.7, 0}}, {{0, 1}, {2, 3}});
    for (const double depth : {0.0, 0.3, 0.6, 0.69, 0.7, 1.0}) {
        const Mesh mesh = grooved_sheet(half, depth);
        const auto report = check_conformity(network, options_at(1.35, 0.9), &mesh);
        EXPECT_EQ(report.distance_ratio_pairs, 1u);
        const double expected = std::hypot(half, depth) / half;
        EXPECT_NEAR(report.max_distance_ratio, expected, 1e-9) << depth;
        EXPECT_EQ(report.distance_ratio_over_two, expected > 2 ? 1u : 0u) << depth;
    }
    EXPECT_EQ(check_conformity(network, options_at(1.35, 0.9)).distance_ratio_pairs, 0u)
        << "not measured without a mesh";
}

TEST(ConformityDistanceRatio, OnlyCurvesThatAreClose) {
    const Mesh mesh = grooved_sheet(0.4, 0.5);
    const auto far =
        segment_network({{-2, 0, 0}, {-2, 1.2, 0}, {2, 0, 0}, {2, 1.2, 0}}, {{0, 1}, {2, 3}});
    EXPECT_EQ(check_conformity(far, options_at(), &mesh).distance_ratio_pairs, 0u);
    const auto one_arc = segment_network({{-2, 0, 0}, {-2, 1, 0}, {-2, 2, 0}, {-2, 3, 0}},
                                         {{0, 1}, {1, 2}, {2, 3}}, {0, 0, 0});
    EXPECT_EQ(check_conformity(one_arc, options_at(), &mesh).distance_ratio_pairs, 0u);
}

}  // namespace
}  // namespace fcn
