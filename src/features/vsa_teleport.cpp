// Merging and teleporting regions of variational shape approximation (Cohen-Steiner, Alliez,
// Desbrun 2004, section 3.4). A teleport is judged by the exact cost of the merge against the exact
// gain of the split. What a split gains grows when its surroundings adjust, so teleports that look
// up to a few times too expensive are tried one by one, with exchange of the items around, and
// undone unless the error fell.

#include <algorithm>
#include <tuple>

#include "features/vsa_partition.h"

namespace fcn {
namespace {

constexpr double kTeleportMargin = 1.02;  // split gain over merge cost
constexpr double kSearchMargin = 0.25;    // the same, where a trial is worth its time
constexpr int kSearchSweeps = 10;

}  // namespace

std::vector<RegionPartition::MergePair> RegionPartition::merge_pairs() const {
    std::vector<std::pair<int, int>> borders;
    for (int i = 0; i < graph_.size(); ++i) {
        const int a = region_of_item_[i];
        for (const int* n = graph_.neighbors.begin(i); n != graph_.neighbors.end(i); ++n) {
            const int b = region_of_item_[*n];
            if (a < b) borders.push_back({a, b});
        }
    }
    std::sort(borders.begin(), borders.end());
    borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
    std::vector<MergePair> pairs;
    pairs.reserve(borders.size());
    for (const auto& [a, b] : borders) {
        const Region& first = regions_[a];
        const Region& second = regions_[b];
        pairs.push_back({error_of(first.normal + second.normal, first.area + second.area) -
                             error_of(first.normal, first.area) -
                             error_of(second.normal, second.area),
                         a, b});
    }
    std::sort(pairs.begin(), pairs.end(), [](const MergePair& a, const MergePair& b) {
        return std::tie(a.cost, a.first, a.second) < std::tie(b.cost, b.first, b.second);
    });
    return pairs;
}

void RegionPartition::merge(int into, int from) {
    while (!regions_[from].items.empty()) move(regions_[from].items.back(), into);
    resum(into);
    regions_[into].split_gain = -1;
}

void RegionPartition::drop_region(int r) {
    const int last = region_count() - 1;
    if (r != last) {
        for (int item : regions_[last].items) region_of_item_[item] = r;
        regions_[r] = std::move(regions_[last]);
    }
    regions_.pop_back();
}

int RegionPartition::teleport(int fixed_region_count) {
    std::vector<std::pair<double, int>> splits;
    for (int r = 0; r < region_count(); ++r) {
        regions_[r].is_changed = false;
        const double gain = split_gain(r);
        if (gain > 0) splits.push_back({-gain, r});
    }
    std::sort(splits.begin(), splits.end());
    int count = 0;
    std::size_t next_split = 0;
    for (const MergePair& pair : merge_pairs()) {
        if (pair.second < fixed_region_count) continue;
        if (regions_[pair.first].is_changed || regions_[pair.second].is_changed) continue;
        const auto is_free = [&](int r) {
            return !regions_[r].is_changed && r != pair.first && r != pair.second;
        };
        while (next_split < splits.size() && regions_[splits[next_split].second].is_changed) {
            ++next_split;
        }
        std::size_t s = next_split;
        while (s < splits.size() && !is_free(splits[s].second)) ++s;
        if (s == splits.size()) break;
        const int worst = splits[s].second;
        if (-splits[s].first <= kTeleportMargin * pair.cost + tolerance_) break;
        const std::vector<int> leaving = second_half(worst);
        if (leaving.empty()) {
            regions_[worst].is_changed = true;
            continue;
        }
        merge(pair.first, pair.second);
        apply_split(worst, leaving, pair.second);
        for (int r : {pair.first, pair.second, worst}) regions_[r].is_changed = true;
        ++count;
    }
    return count;
}

int RegionPartition::best_split(int first_excluded, int second_excluded) {
    int best = -1;
    for (int r = 0; r < region_count(); ++r) {
        if (r == first_excluded || r == second_excluded || regions_[r].is_changed) continue;
        const double gain = split_gain(r);
        if (gain > 0 && (best < 0 || gain > regions_[best].split_gain)) best = r;
    }
    return best;
}

void RegionPartition::undo(const std::vector<double>& split_gains) {
    std::vector<int> touched;
    for (auto entry = journal_.rbegin(); entry != journal_.rend(); ++entry) {
        touched.push_back(region_of_item_[entry->first]);
        touched.push_back(entry->second);
        move(entry->first, entry->second);
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (int r : touched) {
        resum(r);
        regions_[r].split_gain = split_gains[r];
        regions_[r].moved_count = std::max(1, regions_[r].moved_count / 64);
    }
}

bool RegionPartition::try_teleport(const MergePair& pair, int worst) {
    const double before = error();
    const std::vector<int> leaving = second_half(worst);
    if (leaving.empty()) return false;
    std::vector<double> split_gains;
    for (const Region& region : regions_) split_gains.push_back(region.split_gain);
    journal_.clear();
    is_journaling_ = true;
    merge(pair.first, pair.second);
    apply_split(worst, leaving, pair.second);
    std::vector<int> queue;
    for (int r : {pair.first, pair.second, worst}) {
        queue.insert(queue.end(), regions_[r].items.begin(), regions_[r].items.end());
    }
    refine_from(std::move(queue), kSearchSweeps);
    is_journaling_ = false;
    if (error() < before * (1 - 1e-6)) return true;
    undo(split_gains);
    return false;
}

int RegionPartition::search_teleports(int fixed_region_count) {
    for (Region& region : regions_) region.is_changed = false;
    int count = 0, trial_count = 0;
    for (const MergePair& pair : merge_pairs()) {
        if (pair.second < fixed_region_count) continue;
        if (regions_[pair.first].is_changed || regions_[pair.second].is_changed) continue;
        if (++trial_count > 2 * region_count()) break;
        const int worst = best_split(pair.first, pair.second);
        if (worst < 0 || regions_[worst].split_gain < kSearchMargin * pair.cost) break;
        if (!try_teleport(pair, worst)) continue;
        for (const auto& [item, region] : journal_) {
            regions_[region].is_changed = regions_[region_of_item_[item]].is_changed = true;
        }
        ++count;
    }
    return count;
}

int RegionPartition::dissolve(double area, int fixed_region_count) {
    int count = 0;
    while (true) {
        std::vector<int> into(regions_.size(), -1);
        for (const MergePair& pair : merge_pairs()) {
            for (const auto& [from, to] :
                 {std::pair(pair.first, pair.second), std::pair(pair.second, pair.first)}) {
                const bool is_tiny = from >= fixed_region_count && regions_[from].area < area;
                if (is_tiny && into[from] < 0) into[from] = to;
            }
        }
        std::vector<std::pair<double, int>> order;
        for (int r = 0; r < region_count(); ++r) {
            regions_[r].is_changed = false;
            if (into[r] >= 0) order.push_back({regions_[r].area, r});
        }
        if (order.empty()) return count;
        std::sort(order.begin(), order.end());
        for (const auto& [region_area, r] : order) {
            if (regions_[r].is_changed || regions_[into[r]].is_changed) continue;
            merge(into[r], r);
            regions_[r].is_changed = regions_[into[r]].is_changed = true;
            ++count;
        }
        for (int r = region_count() - 1; r >= 0; --r) {
            if (regions_[r].items.empty()) drop_region(r);
        }
    }
}

}  // namespace fcn
