// Cluster bootstrap (Davison & Hinkley, Bootstrap Methods, 1997, section 3.8): the scales,
// iterations, renamings and seeds of one mesh resemble each other, so whole meshes are drawn; an
// interval from drawn runs would be far too narrow.
#include "experiment/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "labeling/random.h"

namespace experiment {

Interval bootstrap(const std::vector<Grouped>& numbers, const Statistic& statistic, int resamplings,
                   std::uint64_t seed) {
    Interval interval;
    std::vector<Sample> all;
    std::map<std::string, std::vector<Sample>> by_group;
    for (const Grouped& number : numbers) {
        all.push_back({number.value, number.other});
        by_group[number.group].push_back(all.back());
    }
    interval.estimate = all.empty() ? std::numeric_limits<double>::quiet_NaN() : statistic(all);
    interval.low = interval.high = interval.estimate;
    if (by_group.size() < 2) return interval;
    std::vector<const std::vector<Sample>*> groups;
    for (const auto& [name, members] : by_group) groups.push_back(&members);

    labeling::Random random(seed);
    std::vector<double> estimates;
    std::vector<Sample> drawn;
    for (int k = 0; k < resamplings; ++k) {
        drawn.clear();
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const auto& group = *groups[random.below(static_cast<std::uint32_t>(groups.size()))];
            drawn.insert(drawn.end(), group.begin(), group.end());
        }
        const double estimate = statistic(drawn);
        if (std::isfinite(estimate)) estimates.push_back(estimate);
    }
    if (estimates.empty()) return interval;
    std::sort(estimates.begin(), estimates.end());
    const auto at = [&](double share) {
        const auto last = static_cast<double>(estimates.size() - 1);
        return estimates[static_cast<std::size_t>(std::lround(share * last))];
    };
    interval.low = at(0.025);
    interval.high = at(0.975);
    interval.is_known = true;
    return interval;
}

double mean_of(const std::vector<Sample>& samples) {
    double sum = 0;
    for (const Sample& sample : samples) sum += sample.value;
    return sum / static_cast<double>(samples.size());
}

double geometric_mean_of(const std::vector<Sample>& samples) {
    double sum = 0;
    for (const Sample& sample : samples) sum += std::log(sample.value);
    return std::exp(sum / static_cast<double>(samples.size()));
}

}  // namespace experiment
