// Resampling against the enumeration of all chains, and by hand where the answer is plain.

#include "adaptation/resampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "oracles.h"

namespace fcn {
namespace {

using test::ChainAnswer;
using test::ChainQuestion;
using test::LongSegment;

constexpr std::array<double, 5> kRatios{1.05, 1.14, 1.35, 1.5, 1.7};

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    int below(int count) { return static_cast<int>(engine_() % count); }

private:
    std::mt19937_64 engine_;
};

/// A curve whose direction wanders: more or less straight, in space.
std::vector<Vec3> wandering_arc(Random& random, int sample_count, double step, double turn) {
    std::vector<Vec3> points{Vec3::Zero()};
    Vec3 direction = Vec3::UnitX();
    while (static_cast<int>(points.size()) < sample_count) {
        points.push_back(points.back() + step * random.uniform(0.5, 1.5) * direction);
        direction +=
            turn * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        direction.normalize();
    }
    return points;
}

std::vector<Vec3> straight_arc(double length, double spacing) {
    const int count = static_cast<int>(std::ceil(length / spacing));
    std::vector<Vec3> points;
    for (int i = 0; i <= count; ++i) points.emplace_back(length * i / count, 0, 0);
    return points;
}

/// Closed: the last repeats the first.
std::vector<Vec3> closed_arc(Random& random, int distinct, double radius, double wobble) {
    std::vector<Vec3> points;
    for (int i = 0; i < distinct; ++i) {
        const double angle = 2 * std::numbers::pi * (i + random.uniform(-0.3, 0.3)) / distinct;
        const double r = radius * (1 + wobble * random.uniform(-1, 1));
        points.emplace_back(r * std::cos(angle), r * std::sin(angle),
                            wobble * radius * random.uniform(-1, 1));
    }
    points.push_back(points.front());
    return points;
}

ChainQuestion question(const std::vector<Vec3>& points, double ratio, LongSegment long_segment,
                       int min_segments = 1) {
    ChainQuestion q;
    q.points = points;
    q.rmax = ratio;
    q.evenness = ResamplingOptions{}.evenness;
    q.min_segments = min_segments;
    q.long_segment = long_segment;
    return q;
}

/// The rule: all lengths in S; else one long segment at an end; else nothing.
ChainAnswer expected_chain(const std::vector<Vec3>& points, double ratio, int min_segments) {
    ChainAnswer answer =
        test::best_chain(question(points, ratio, LongSegment::Nowhere, min_segments));
    if (!answer.exists) {
        answer = test::best_chain(question(points, ratio, LongSegment::AtAnEnd, min_segments));
    }
    return answer;
}

/// The chain starts and ends where it should, ascends, and is made of admissible segments, of
/// which the one longer than rmax is named.
void expect_valid(const Resampling& result, const std::vector<Vec3>& points, double ratio) {
    ASSERT_GE(result.chain.size(), 2u);
    EXPECT_EQ(result.chain.front(), 0);
    EXPECT_EQ(result.chain.back() + 1u, points.size());
    EXPECT_TRUE(std::is_sorted(result.chain.begin(), result.chain.end(), std::less_equal<>()));
    for (std::size_t k = 0; k + 1 < result.chain.size(); ++k) {
        const double length = (points[result.chain[k + 1]] - points[result.chain[k]]).norm();
        EXPECT_GE(length, 1 - 1e-6);
        if (static_cast<int>(k) == result.long_segment) {
            EXPECT_GT(length, ratio);
            EXPECT_LE(length, 2.06 + 1e-5);
            EXPECT_TRUE(k == 0 || k + 2 == result.chain.size()) << "at an end";
        } else {
            EXPECT_LE(length, ratio * (1 + 1e-6));
        }
    }
}

TEST(ResamplingOracle, CountsWhatItEnumerates) {
    // Unit-spaced samples, lengths 1 or 2 (rmax 1.7 < 2 <= 2.06: a 2 is long): one chain in S.
    const auto points = straight_arc(5, 1);
    EXPECT_EQ(test::best_chain(question(points, 1.7, LongSegment::Nowhere)).tried, 1);
    EXPECT_EQ(test::best_chain(question(points, 1.7, LongSegment::AtAnEnd)).tried, 2);
    EXPECT_EQ(test::best_chain(question(points, 1.7, LongSegment::Anywhere)).tried, 4);
}

TEST(Resampling, OpenArcsAgainstAllChains) {
    int regular = 0, with_long = 0, none = 0;
    for (int round = 0; round < 1500; ++round) {
        SCOPED_TRACE("seed " + std::to_string(round));
        Random random(round);
        const double ratio = kRatios[round % kRatios.size()];
        const auto points = wandering_arc(random, 2 + random.below(15), random.uniform(0.2, 0.6),
                                          random.uniform(0, 1.2));
        const ChainAnswer expected = expected_chain(points, ratio, 1);
        const Resampling result = resample_arc(points, false, make_scale(1, ratio));
        EXPECT_FALSE(result.is_unrepresentable);
        ASSERT_EQ(result.is_short, !expected.exists);
        const int last = static_cast<int>(points.size()) - 1;
        if (!expected.exists) {
            ++none;
            EXPECT_EQ(result.chain, (std::vector<int>{0, last}));
            continue;
        }
        expect_valid(result, points, ratio);
        EXPECT_NEAR(result.cost, expected.cost, 1e-9);
        EXPECT_NEAR(test::chain_cost(question(points, ratio, LongSegment::Nowhere), result.chain),
                    expected.cost, 1e-9);
        const bool is_regular =
            test::best_chain(question(points, ratio, LongSegment::Nowhere)).exists;
        EXPECT_EQ(result.long_segment < 0, is_regular);
        ++(is_regular ? regular : with_long);
    }
    EXPECT_GT(regular, 100);
    EXPECT_GT(with_long, 30);
    EXPECT_GT(none, 100);
}

TEST(Resampling, ScalesAndDirectionsDoNotMatter) {
    for (int round = 0; round < 100; ++round) {
        SCOPED_TRACE("seed " + std::to_string(round));
        Random random(1000 + round);
        auto points = wandering_arc(random, 14, 0.4, 0.8);
        const Resampling unit = resample_arc(points, false, make_scale(1, 1.35));
        std::vector<Vec3> small;
        for (const Vec3& p : points) small.push_back(0.003 * p + Vec3(5, -2, 1));
        const Resampling scaled = resample_arc(small, false, make_scale(0.003, 1.35));
        EXPECT_EQ(unit.is_short, scaled.is_short);
        EXPECT_NEAR(unit.cost, scaled.cost, 1e-6);
        std::reverse(points.begin(), points.end());
        const Resampling backward = resample_arc(points, false, make_scale(1, 1.35));
        EXPECT_EQ(unit.is_short, backward.is_short);
        EXPECT_NEAR(unit.cost, backward.cost, 1e-9);
    }
}

TEST(Resampling, ClosedArcsFromAFixedStartAgainstAllChains) {
    ResamplingOptions options;
    options.is_start_fixed = true;
    int regular = 0, with_long = 0, none = 0;
    for (int round = 0; round < 800; ++round) {
        SCOPED_TRACE("seed " + std::to_string(round));
        Random random(5000 + round);
        const double ratio = kRatios[round % kRatios.size()];
        const auto points = closed_arc(random, 6 + random.below(9), random.uniform(0.4, 1.1),
                                       random.uniform(0, 0.2));
        const ChainAnswer expected = expected_chain(points, ratio, 3);
        const Resampling result = resample_arc(points, true, make_scale(1, ratio), options);
        EXPECT_FALSE(result.is_short);
        ASSERT_EQ(result.is_unrepresentable, !expected.exists);
        if (!expected.exists) {
            EXPECT_TRUE(result.chain.empty());
            ++none;
            continue;
        }
        EXPECT_EQ(result.start, 0);
        EXPECT_GE(result.chain.size(), 4u) << "three segments";
        expect_valid(result, points, ratio);
        EXPECT_NEAR(result.cost, expected.cost, 1e-9);
        ++(result.long_segment < 0 ? regular : with_long);
    }
    EXPECT_GT(regular, 50);
    EXPECT_GT(with_long, 20);
    EXPECT_GT(none, 50);
}

std::vector<Vec3> rotated(const std::vector<Vec3>& closed, int start) {
    std::vector<Vec3> points;
    const int distinct = static_cast<int>(closed.size()) - 1;
    for (int k = 0; k <= distinct; ++k) points.push_back(closed[(start + k) % distinct]);
    return points;
}

TEST(Resampling, FreeClosedArcsAgainstAllChainsFromAllStarts) {
    ResamplingOptions every_start;
    every_start.start_count = 64;
    for (int round = 0; round < 150; ++round) {
        SCOPED_TRACE("seed " + std::to_string(round));
        Random random(9000 + round);
        const double ratio = kRatios[round % kRatios.size()];
        const auto points = closed_arc(random, 8 + random.below(6), random.uniform(0.5, 1.0), 0.15);
        const int distinct = static_cast<int>(points.size()) - 1;
        const Resampling result = resample_arc(points, true, make_scale(1, ratio), every_start);
        ChainAnswer best;
        for (int start = 0; start < distinct; ++start) {
            const ChainAnswer answer =
                test::best_chain(question(rotated(points, start), ratio, LongSegment::Nowhere, 3));
            if (answer.exists && (!best.exists || answer.cost < best.cost)) best = answer;
        }
        if (best.exists) {
            // Every chain has a node within the first rmax or so of the arc.
            ASSERT_FALSE(result.is_unrepresentable);
            EXPECT_EQ(result.long_segment, -1);
            EXPECT_GE(result.cost, best.cost - 1e-9);
        }
        if (result.is_unrepresentable) continue;
        EXPECT_GE(result.chain.size(), 4u);
        EXPECT_EQ(result.chain.front(), result.start);
        EXPECT_EQ(result.chain.back(), result.start + distinct);
        const auto turned = rotated(points, result.start);
        std::vector<int> chain = result.chain;
        for (int& sample : chain) sample -= result.start;
        EXPECT_NEAR(test::chain_cost(question(turned, ratio, LongSegment::Nowhere), chain),
                    result.cost, 1e-9);
        // The best from its own start, and no worse than from the first sample.
        EXPECT_NEAR(expected_chain(turned, ratio, 3).cost, result.cost, 1e-9);
        const ChainAnswer first =
            test::best_chain(question(points, ratio, LongSegment::Nowhere, 3));
        if (first.exists) {
            EXPECT_LE(result.cost, first.cost + 1e-9);
        }
    }
}

TEST(Resampling, FreeStartsFindTheCornersOfASquare) {
    // A closed square of side 1.2, sampled from the middle of a side: only chains through the four
    // corners cost nothing but the evenness.
    std::vector<Vec3> points;
    const std::array<Vec3, 4> corners{Vec3(0, 0, 0), Vec3(1.2, 0, 0), Vec3(1.2, 1.2, 0),
                                      Vec3(0, 1.2, 0)};
    for (int side = 0; side < 4; ++side) {
        for (int i = 0; i < 12; ++i) {
            points.push_back(corners[side] + (corners[(side + 1) % 4] - corners[side]) * i / 12.0);
        }
    }
    std::rotate(points.begin(), points.begin() + 6, points.end());
    points.push_back(points.front());
    ResamplingOptions options;
    options.start_count = 48;
    const Resampling free = resample_arc(points, true, make_scale(1, 1.5), options);
    EXPECT_EQ(free.chain.size(), 5u);
    EXPECT_LT(free.cost, 1e-5);
    options.is_start_fixed = true;
    EXPECT_GT(resample_arc(points, true, make_scale(1, 1.5), options).cost, 0.01);
}

TEST(Resampling, StraightArcsByHand) {
    struct Case {
        double length, ratio;
        int segments;  ///< 0 = short
        bool has_long;
    };
    // In S if k <= length <= k ratio for some k; one long segment of at most 2.06 otherwise.
    for (const Case c :
         {Case{0.99, 1.5, 0, false}, Case{1.0, 1.5, 1, false}, Case{1.5, 1.5, 1, false},
          Case{1.52, 1.5, 1, true}, Case{1.98, 1.5, 1, true}, Case{2.0, 1.5, 2, false},
          Case{1.2, 1.14, 1, true}, Case{2.2, 1.14, 2, false}, Case{2.4, 1.14, 2, true},
          Case{2.98, 1.14, 2, true}, Case{3.0, 1.14, 3, false}, Case{3.6, 1.05, 3, true},
          Case{1.9, 1.05, 1, true}}) {
        SCOPED_TRACE(std::to_string(c.length) + " at ratio " + std::to_string(c.ratio));
        const auto points = straight_arc(c.length, 0.02);
        const Resampling result = resample_arc(points, false, make_scale(1, c.ratio));
        ASSERT_EQ(result.is_short, c.segments == 0);
        if (result.is_short) continue;
        EXPECT_EQ(result.chain.size(), c.segments + 1u);
        EXPECT_EQ(result.long_segment >= 0, c.has_long);
        expect_valid(result, points, c.ratio);
    }
}

TEST(Resampling, TiesBreakTowardEvenLengths) {
    for (const double length : {2.3, 3.7, 5.0, 7.77, 12.4}) {
        const auto points = straight_arc(length, 0.02);
        const Resampling result = resample_arc(points, false, make_scale(1, 1.5));
        ASSERT_FALSE(result.is_short);
        double shortest = 1e9, longest = 0;
        for (std::size_t k = 0; k + 1 < result.chain.size(); ++k) {
            const double l = (points[result.chain[k + 1]] - points[result.chain[k]]).norm();
            shortest = std::min(shortest, l);
            longest = std::max(longest, l);
        }
        EXPECT_LE(longest - shortest, 0.02 + 1e-9) << "one sample, at length " << length;
    }
}

TEST(Resampling, ShortByChordThoughTheArcIsLong) {
    // A hairpin whose ends are 0.3 apart and whose samples stay within rmin of one of them.
    std::vector<Vec3> points;
    for (int i = 0; i <= 8; ++i) points.emplace_back(0.9 * i / 8, 0, 0);
    for (int i = 8; i >= 0; --i) points.emplace_back(0.9 * i / 8, 0.3, 0);
    EXPECT_TRUE(resample_arc(points, false, make_scale(1, 1.5)).is_short);
    EXPECT_FALSE(test::best_chain(question(points, 1.5, LongSegment::Anywhere)).exists);
}

TEST(Resampling, ClosedArcsNeedThreeSegments) {
    const auto circle = [](double radius) {
        std::vector<Vec3> points;
        for (int i = 0; i < 240; ++i) {
            const double angle = 2 * std::numbers::pi * i / 240;
            points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
        }
        points.push_back(points.front());
        return points;
    };
    // Three chords of a circle: the equilateral triangle has sides sqrt(3) r.
    const double limit = 1 / std::sqrt(3.0);
    const Resampling small = resample_arc(circle(limit * 0.99), true, make_scale(1, 1.5));
    EXPECT_TRUE(small.is_unrepresentable);
    EXPECT_TRUE(small.chain.empty());
    const Resampling large = resample_arc(circle(limit * 1.01), true, make_scale(1, 1.5));
    EXPECT_FALSE(large.is_unrepresentable);
    EXPECT_EQ(large.chain.size(), 4u);
}

TEST(Resampling, DeviationIsTheIntegralDistance) {
    // A half circle over its diameter: the distance is r sin(a), the integral over the arc 2 r^2.
    std::vector<Vec3> points;
    constexpr int kSamples = 2000;
    for (int i = 0; i <= kSamples; ++i) {
        const double angle = std::numbers::pi * i / kSamples;
        points.emplace_back(0.7 * std::cos(angle), 0.7 * std::sin(angle), 3);
    }
    EXPECT_NEAR(chord_deviation(points, 0, kSamples), 2 * 0.49, 1e-5);
    Random random(3);
    const auto arc = wandering_arc(random, 30, 0.3, 0.9);
    for (int first = 0; first < 29; ++first) {
        for (int last = first + 1; last < 30; ++last) {
            EXPECT_NEAR(chord_deviation(arc, first, last), test::deviation(arc, first, last),
                        1e-12);
        }
    }
}

}  // namespace
}  // namespace fcn
