#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace experiment {

/// A number, or a pair of numbers for statistics of pairs.
struct Sample {
    double value = 0;
    double other = 0;
};

/// One that belongs to a group of numbers that are not independent of each other.
struct Grouped {
    std::string group;
    double value = 0;
    double other = 0;
};

/// An estimate and its 95% interval.
struct Interval {
    double estimate = 0;  ///< of all numbers; NaN of none
    double low = 0, high = 0;
    bool is_known = false;  ///< false: fewer than two groups, so low and high mean nothing
};

using Statistic = std::function<double(const std::vector<Sample>&)>;

/// Percentile bootstrap over groups: as many groups as there are, drawn with replacement, each with
/// all its numbers; `statistic` of these, `resamplings` times. Resamples on which the statistic is
/// not finite are left out. Deterministic for a seed, on any machine; the order of `numbers` does
/// not matter to which groups are drawn.
Interval bootstrap(const std::vector<Grouped>& numbers, const Statistic& statistic, int resamplings,
                   std::uint64_t seed = 1);

/// The two statistics that are used most: of `value`.
double mean_of(const std::vector<Sample>& samples);
double geometric_mean_of(const std::vector<Sample>& samples);

}  // namespace experiment
