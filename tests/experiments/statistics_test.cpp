// Statistics against closed forms.
#include "experiment/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "experiment/bootstrap.h"
#include "experiment/primal_integral.h"
#include "labeling/random.h"

namespace experiment {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Statistics, Means) {
    EXPECT_DOUBLE_EQ(median({3, 1, 2}), 2);
    EXPECT_DOUBLE_EQ(median({4, 1, 2, 3}), 2.5);
    EXPECT_EQ(median({1, kInfinity, kInfinity}), kInfinity);
    EXPECT_EQ(median({1, kInfinity, kInfinity, kInfinity}), kInfinity);
    EXPECT_TRUE(std::isnan(median({})));
    EXPECT_TRUE(std::isnan(mean({})));
    EXPECT_DOUBLE_EQ(geometric_mean({1, 100}), 10);
    // sqrt((0 + 1) * (8 + 1)) - 1
    EXPECT_DOUBLE_EQ(shifted_geometric_mean({0, 8}, 1), 2);
    EXPECT_TRUE(std::isnan(shifted_geometric_mean({}, 1)));
}

TEST(Statistics, ShiftedGeometricMeanLiesBetweenItsNeighbours) {
    const std::uint64_t seed = 11;
    SCOPED_TRACE("seed " + std::to_string(seed));
    labeling::Random random(seed);
    for (int round = 0; round < 200; ++round) {
        std::vector<double> values;
        for (int k = 0; k < 12; ++k) values.push_back(100 * random.unit());
        const double shifted = shifted_geometric_mean(values, 1);
        EXPECT_GE(shifted, geometric_mean(values) - 1e-9);
        EXPECT_LE(shifted, mean(values) + 1e-9);
        // A large shift makes it the arithmetic mean.
        EXPECT_NEAR(shifted_geometric_mean(values, 1e7), mean(values), 1e-3);
    }
}

TEST(Statistics, PerformanceProfileStepsAtEachRatio) {
    const Points points = performance_profile({2, 1, kInfinity, 2}, 4);
    EXPECT_EQ(points, (Points{{1, 0.25}, {2, 0.75}}));
    EXPECT_TRUE(performance_profile({kInfinity}, 1).empty());
}

TEST(Statistics, CactusCountsSolvedProblems) {
    EXPECT_EQ(cactus({5, 1, 3}), (Points{{1, 1}, {2, 3}, {3, 5}}));
}

TEST(Statistics, PowerLawIsFoundAgain) {
    Points points;
    for (const double x : {10.0, 30.0, 100.0, 500.0}) points.emplace_back(x, 3 * std::pow(x, 1.7));
    const auto law = fit_power_law(points);
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->exponent, 1.7, 1e-9);
    EXPECT_NEAR(law->factor, 3, 1e-9);
    EXPECT_NEAR(law->r_squared, 1, 1e-9);
    EXPECT_FALSE(fit_power_law({{1, 1}, {2, 2}}));
    EXPECT_FALSE(fit_power_law({{5, 1}, {5, 2}, {5, 3}}));
}

TEST(Statistics, PowerLawIsTheLeastSquaresOne) {
    const std::uint64_t seed = 5;
    SCOPED_TRACE("seed " + std::to_string(seed));
    labeling::Random random(seed);
    Points points;
    for (int k = 1; k < 20; ++k) points.emplace_back(k, std::exp(4 * random.unit()));
    const auto law = fit_power_law(points);
    ASSERT_TRUE(law);
    const auto squares = [&](double exponent, double log_factor) {
        double sum = 0;
        for (const auto& [x, y] : points) {
            const double rest = std::log(y) - exponent * std::log(x) - log_factor;
            sum += rest * rest;
        }
        return sum;
    };
    const double least = squares(law->exponent, std::log(law->factor));
    for (const double d : {-1e-3, 1e-3}) {
        EXPECT_LT(least, squares(law->exponent + d, std::log(law->factor)));
        EXPECT_LT(least, squares(law->exponent, std::log(law->factor) + d));
    }
}

TEST(Statistics, RankCorrelation) {
    EXPECT_DOUBLE_EQ(*rank_correlation({{1, 10}, {2, 100}, {3, 1000}}), 1);
    EXPECT_DOUBLE_EQ(*rank_correlation({{1, 3}, {2, 2}, {3, 1}}), -1);
    EXPECT_FALSE(rank_correlation({{1, 3}, {2, 3}, {3, 3}}));
    // Ties share a rank: x has ranks 1.5, 1.5, 3.
    EXPECT_NEAR(*rank_correlation({{1, 1}, {1, 2}, {2, 3}}), std::sqrt(0.75), 1e-12);
}

TEST(Bootstrap, IntervalHoldsTheEstimateAndIsDeterministic) {
    std::vector<Grouped> numbers;
    for (int g = 0; g < 9; ++g) {
        for (int k = 0; k < 5; ++k) numbers.push_back({"group" + std::to_string(g), g + 0.1 * k});
    }
    const Interval once = bootstrap(numbers, mean_of, 500, 3);
    const Interval twice = bootstrap(numbers, mean_of, 500, 3);
    EXPECT_TRUE(once.is_known);
    EXPECT_NEAR(once.estimate, 4.2, 1e-12);
    EXPECT_LT(once.low, once.estimate);
    EXPECT_GT(once.high, once.estimate);
    EXPECT_EQ(once.low, twice.low);
    EXPECT_EQ(once.high, twice.high);
    EXPECT_NE(bootstrap(numbers, mean_of, 500, 4).low, once.low);
}

TEST(Bootstrap, DrawsGroupsAndNotNumbers) {
    // Copies within a group say nothing new, so they must not narrow the interval.
    std::vector<Grouped> few, many;
    for (int g = 0; g < 8; ++g) {
        for (int k = 0; k < 50; ++k) {
            const Grouped number{"group" + std::to_string(g), static_cast<double>(g)};
            if (k == 0) few.push_back(number);
            many.push_back(number);
        }
    }
    const Interval narrow = bootstrap(few, mean_of, 400), wide = bootstrap(many, mean_of, 400);
    EXPECT_NEAR(narrow.low, wide.low, 1e-12);
    EXPECT_NEAR(narrow.high, wide.high, 1e-12);
    EXPECT_GT(wide.high - wide.low, 2);
}

TEST(Bootstrap, CoversTheTrueMeanAboutAsOftenAsItSays) {
    const std::uint64_t seed = 2;
    SCOPED_TRACE("seed " + std::to_string(seed));
    labeling::Random random(seed);
    int covered = 0;
    constexpr int kRounds = 300;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<Grouped> numbers;
        for (int g = 0; g < 30; ++g) numbers.push_back({std::to_string(g), random.unit()});
        const Interval interval = bootstrap(numbers, mean_of, 200, round + 1);
        covered += interval.low <= 0.5 && 0.5 <= interval.high;
    }
    EXPECT_GT(covered, kRounds * 87 / 100);
    EXPECT_LT(covered, kRounds);
}

TEST(Bootstrap, NothingIsKnownOfOneGroup) {
    EXPECT_FALSE(bootstrap({{"a", 1}, {"a", 2}}, mean_of, 100).is_known);
    EXPECT_TRUE(std::isnan(bootstrap({}, mean_of, 100).estimate));
}

TEST(PrimalIntegral, GapsAndArea) {
    // 100% for 1 s, 50% for 3 s, 0% from then to 10 s.
    const std::vector<TracePoint> trace{{1, 0, 50, {}}, {4, 0, 100, {}}};
    const auto steps = gap_steps(trace, 100, 5, 100, 10);
    EXPECT_DOUBLE_EQ(primal_integral(steps, 10), 1 + 0.5 * 3);
    EXPECT_DOUBLE_EQ(*time_to_gap(steps, 0.5), 1);
    EXPECT_DOUBLE_EQ(*time_to_gap(steps, 0), 4);
    EXPECT_FALSE(time_to_gap(gap_steps(trace, 100, 5, 200, 10), 0));
}

TEST(PrimalIntegral, NoSolutionIsTheWholeTime) {
    EXPECT_DOUBLE_EQ(primal_integral(gap_steps({{1, 0, 5, {}}}, {}, 5, 10, 8), 8), 8);
    EXPECT_DOUBLE_EQ(primal_gap({}, 100), 1);
}

TEST(PrimalIntegral, TheTraceIsNotBelievedBeyondTheCheckedValue) {
    const auto steps = gap_steps({{1, 0, 100, {}}}, 80, 5, 100, 10);
    EXPECT_DOUBLE_EQ(steps.back().gap, 0.2);
    // Without a trace the value is there at the end.
    const auto silent = gap_steps({}, 100, 5, 100, 10);
    EXPECT_DOUBLE_EQ(primal_integral(silent, 10), 5);
}

TEST(PrimalIntegral, WhatComesAfterTheLimitIsNotThere) {
    const auto steps = gap_steps({{2, 0, 50, {}}, {30, 0, 100, {}}}, 50, 12, 100, 10);
    EXPECT_DOUBLE_EQ(primal_integral(steps, 10), 2 + 0.5 * 8);
    EXPECT_DOUBLE_EQ(primal_gap(-10, -5), 1);
    EXPECT_DOUBLE_EQ(primal_gap(7, 5), 0);
}

}  // namespace
}  // namespace experiment
