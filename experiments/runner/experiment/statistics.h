#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace experiment {

/// Median; the mean of the two in the middle when their count is even. NaN of nothing.
double median(std::vector<double> values);
/// NaN of nothing.
double mean(const std::vector<double>& values);
/// exp(mean(log)) of positive values. NaN of nothing.
double geometric_mean(const std::vector<double>& values);
/// exp(mean(log(value + shift))) - shift, values >= 0, shift > 0. NaN of nothing.
double shifted_geometric_mean(const std::vector<double>& values, double shift);

/// What an unsolved run counts in PAR10: ten times its limit.
constexpr double kPenalty = 10;

using Points = std::vector<std::pair<double, double>>;

/// Share of `count` problems (y, in 0..1) whose ratio to the best is at most x: a step function,
/// one point for each distinct finite ratio. Infinite ratios are problems not solved.
Points performance_profile(std::vector<double> ratios, std::size_t count);

/// How many problems (x) are solved when each may take y seconds: solved times in rising order.
Points cactus(std::vector<double> solved_seconds);

/// y = factor * x^exponent.
struct PowerLaw {
    double exponent = 0, factor = 1;
    double r_squared = 0;  ///< of the logarithms; 1 when all y are equal
    std::size_t points = 0;
};

/// Least squares of log y against log x, all positive. Nothing when fewer than three points or two
/// different x.
std::optional<PowerLaw> fit_power_law(const Points& points);

/// Rank correlation of Spearman, ties at their mean rank; nothing when one side is constant or
/// there are fewer than three points.
std::optional<double> rank_correlation(const Points& points);

}  // namespace experiment
