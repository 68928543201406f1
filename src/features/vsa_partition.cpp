// The moves of variational shape approximation (Cohen-Steiner, Alliez, Desbrun 2004, sections 3.2
// to 3.4: partition by flooding, proxy fitting, insertion, deletion, teleport) on a graph of items.
//
// Departures. (1) The L2,1 error of a set about its best proxy is 2 (area - |integral of the
// normal|), so what a move changes is known exactly from two sums: border items move one by one
// while the *fitted* error falls (the k-means exchange of Hartigan and Wong 1979), which is cheaper
// than flooding everything anew and does not stop where Lloyd's iteration does. (2) A region is
// split by what the split gains, with two-means inside the region (floods from the best fitted
// items, starting from the halves along the normals' principal direction and from the furthest
// item), not by its error alone. (3) A teleport compares the exact split gain with the exact
// merge cost.

#include "features/vsa_partition.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <tuple>

namespace fcn {
namespace {

constexpr double kNegligibleError = 1e-6;  // per area: normals agree within about 0.06 degrees
constexpr double kTeleportMargin = 1.02;   // split gain over merge cost
constexpr double kSearchMargin = 0.25;     // the same, where a trial is worth its time
constexpr double kStaleShare = 0.1;        // of a region's items: its split gain is found anew
constexpr int kSearchSweeps = 10;
constexpr int kTwoMeansIterations = 4;
constexpr int kRefits = 3;              // floods after the first, of the better pair of halves
constexpr int kConnectivityLimit = 32;  // items looked at to see that a region stays connected

struct Candidate {
    double error;
    int region;
    int item;
    bool operator>(const Candidate& other) const {
        return std::tie(error, region, item) > std::tie(other.error, other.region, other.item);
    }
};
using Frontier = std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>>;

}  // namespace

RegionPartition::RegionPartition(const ItemGraph& graph, const std::vector<int>& locked_items)
    : graph_(graph),
      region_of_item_(graph.size(), -1),
      slot_(graph.size(), -1),
      is_locked_(graph.size(), false),
      mark_(graph.size(), 0),
      is_queued_(graph.size(), false) {
    for (int item : locked_items) is_locked_[item] = true;
    tolerance_ = 1e-13 * std::accumulate(graph.areas.begin(), graph.areas.end(), 0.0);
}

double RegionPartition::error_of(const Vec3& normal, double area) {
    return 2 * std::max(0.0, area - normal.norm());
}

double RegionPartition::item_error(int item, const Vec3& proxy) const {
    const double area = graph_.areas[item];
    return area > 0 ? 2 * std::max(0.0, 1 - graph_.normals[item].dot(proxy) / area) : 0;
}

Vec3 RegionPartition::proxy(int region) const {
    const Vec3& normal = regions_[region].normal;
    const double norm = normal.norm();
    return norm > 0 ? Vec3(normal / norm) : Vec3(Vec3::Zero());
}

double RegionPartition::error() const {
    double total = 0;
    for (const Region& region : regions_) total += error_of(region.normal, region.area);
    return total;
}

void RegionPartition::resum(int r) {
    Region& region = regions_[r];
    region.normal.setZero();
    region.area = 0;
    for (int item : region.items) {
        region.normal += graph_.normals[item];
        region.area += graph_.areas[item];
    }
}

void RegionPartition::assign(const std::vector<int>& region_of_item, int region_count) {
    regions_.assign(region_count, {});
    region_of_item_ = region_of_item;
    for (int i = 0; i < graph_.size(); ++i) {
        std::vector<int>& items = regions_[region_of_item_[i]].items;
        slot_[i] = static_cast<int>(items.size());
        items.push_back(i);
    }
    for (int r = 0; r < region_count; ++r) resum(r);
}

void RegionPartition::move(int item, int to) {
    Region& source = regions_[region_of_item_[item]];
    Region& target = regions_[to];
    const int last = source.items.back();
    source.items[slot_[item]] = last;
    slot_[last] = slot_[item];
    source.items.pop_back();
    slot_[item] = static_cast<int>(target.items.size());
    target.items.push_back(item);
    source.normal -= graph_.normals[item];
    source.area -= graph_.areas[item];
    target.normal += graph_.normals[item];
    target.area += graph_.areas[item];
    ++source.moved_count;
    ++target.moved_count;
    if (is_journaling_) journal_.push_back({item, region_of_item_[item]});
    region_of_item_[item] = to;
}

void RegionPartition::flood(const std::vector<int>& seeds) {
    std::vector<Vec3> proxies;
    std::vector<int> region(graph_.size(), -1);
    Frontier frontier;
    for (std::size_t s = 0; s < seeds.size(); ++s) {
        const bool has_proxy =
            s < regions_.size() && region_of_item_[seeds[s]] == static_cast<int>(s);
        const Vec3 own = graph_.normals[seeds[s]];
        proxies.push_back(has_proxy ? proxy(static_cast<int>(s)) : Vec3(own.normalized()));
        frontier.push({-1, static_cast<int>(s), seeds[s]});
    }
    int next = 0;
    while (true) {
        while (!frontier.empty()) {
            const Candidate top = frontier.top();
            frontier.pop();
            if (region[top.item] >= 0) continue;
            region[top.item] = top.region;
            for (const int* n = graph_.neighbors.begin(top.item);
                 n != graph_.neighbors.end(top.item); ++n) {
                if (region[*n] >= 0) continue;
                frontier.push({item_error(*n, proxies[top.region]), top.region, *n});
            }
        }
        while (next < graph_.size() && region[next] >= 0) ++next;
        if (next == graph_.size()) break;
        proxies.push_back(graph_.normals[next].normalized());
        frontier.push({-1, static_cast<int>(proxies.size()) - 1, next});
    }
    assign(region, static_cast<int>(proxies.size()));
}

std::vector<int> RegionPartition::best_items() const {
    std::vector<int> best(regions_.size(), -1);
    for (int r = 0; r < region_count(); ++r) {
        const Vec3 normal = proxy(r);
        double best_error = std::numeric_limits<double>::infinity();
        for (int item : regions_[r].items) {
            const double error = item_error(item, normal) - (is_locked_[item] ? 8 : 0);
            if (error < best_error || (error == best_error && item < best[r])) {
                best_error = error;
                best[r] = item;
            }
        }
    }
    return best;
}

bool RegionPartition::is_removable(int item) {
    const int region = region_of_item_[item];
    if (is_locked_[item] || regions_[region].items.size() < 2) return false;
    std::vector<int> targets;
    for (const int* n = graph_.neighbors.begin(item); n != graph_.neighbors.end(item); ++n) {
        if (region_of_item_[*n] == region) targets.push_back(*n);
    }
    if (targets.size() < 2) return true;
    ++stamp_;
    mark_[item] = stamp_;
    mark_[targets[0]] = stamp_;
    std::vector<int> reached{targets[0]};
    std::size_t missing = targets.size() - 1;
    for (std::size_t i = 0; i < reached.size() && reached.size() < kConnectivityLimit; ++i) {
        for (const int* n = graph_.neighbors.begin(reached[i]);
             n != graph_.neighbors.end(reached[i]); ++n) {
            if (region_of_item_[*n] != region || mark_[*n] == stamp_) continue;
            mark_[*n] = stamp_;
            reached.push_back(*n);
            if (std::find(targets.begin() + 1, targets.end(), *n) != targets.end() &&
                --missing == 0) {
                return true;
            }
        }
    }
    return false;
}

/// The neighbouring region whose error, with the item, makes the sum of errors smallest; -1 where
/// the item is best left alone.
int RegionPartition::best_target(int item) const {
    const int own = region_of_item_[item];
    const Region& source = regions_[own];
    const Vec3& normal = graph_.normals[item];
    const double area = graph_.areas[item];
    double left_gain = 0;
    bool has_gain = false;
    int best = -1;
    double best_change = -tolerance_;
    for (const int* n = graph_.neighbors.begin(item); n != graph_.neighbors.end(item); ++n) {
        const int r = region_of_item_[*n];
        if (r == own || r == best) continue;
        if (!has_gain) {
            left_gain = error_of(source.normal, source.area) -
                        error_of(source.normal - normal, source.area - area);
            has_gain = true;
        }
        const Region& target = regions_[r];
        const double change = error_of(target.normal + normal, target.area + area) -
                              error_of(target.normal, target.area) - left_gain;
        if (change < best_change || (change == best_change && best >= 0 && r < best)) {
            best_change = change;
            best = r;
        }
    }
    return best;
}

std::int64_t RegionPartition::refine_from(std::vector<int> queue, int max_sweeps) {
    std::int64_t move_count = 0;
    std::vector<int> next;
    for (int item : queue) is_queued_[item] = true;
    for (int sweep = 0; sweep < max_sweeps && !queue.empty(); ++sweep) {
        next.clear();
        for (int item : queue) {
            is_queued_[item] = false;
            const int target = best_target(item);
            if (target < 0 || !is_removable(item)) continue;
            move(item, target);
            ++move_count;
            for (const int* n = graph_.neighbors.begin(item); n != graph_.neighbors.end(item);
                 ++n) {
                if (is_queued_[*n]) continue;
                is_queued_[*n] = true;
                next.push_back(*n);
            }
        }
        std::swap(queue, next);
    }
    for (int item : queue) is_queued_[item] = false;
    return move_count;
}

std::int64_t RegionPartition::refine(int max_sweeps) {
    std::vector<int> queue(graph_.size());
    std::iota(queue.begin(), queue.end(), 0);
    const std::int64_t move_count = refine_from(std::move(queue), max_sweeps);
    for (int r = 0; r < region_count(); ++r) {
        resum(r);
    }
    return move_count;
}

/// Two-means of a region's normals alone, starting from two proxies: classification, no adjacency.
std::array<Vec3, 2> RegionPartition::two_means(int r, std::array<Vec3, 2> proxies) const {
    for (int iteration = 0; iteration < kTwoMeansIterations; ++iteration) {
        std::array<Vec3, 2> sums{Vec3::Zero(), Vec3::Zero()};
        const Vec3 difference = proxies[1] - proxies[0];
        for (int item : regions_[r].items) {
            const Vec3& normal = graph_.normals[item];
            sums[normal.dot(difference) > 0 ? 1 : 0] += normal;
        }
        if (!(sums[0].norm() > 0) || !(sums[1].norm() > 0)) break;
        proxies = {sums[0].normalized(), sums[1].normalized()};
    }
    return proxies;
}

/// Two halves of a region grown from the items that fit two proxies best.
RegionPartition::Halves RegionPartition::grow_halves(int r, std::array<Vec3, 2>& proxies) {
    const Region& region = regions_[r];
    std::array<int, 2> seeds{-1, -1};
    for (int side = 0; side < 2; ++side) {
        double best_error = std::numeric_limits<double>::infinity();
        for (int item : region.items) {
            if (side == 1 && item == seeds[0]) continue;
            const double error = item_error(item, proxies[side]);
            if (error < best_error || (error == best_error && item < seeds[side])) {
                best_error = error;
                seeds[side] = item;
            }
        }
    }
    const int base = stamp_;
    stamp_ += 2;  // base + 1: first half, base + 2: second half
    Frontier frontier;
    for (int side = 0; side < 2; ++side) frontier.push({-1, side, seeds[side]});
    std::array<Vec3, 2> normals{Vec3::Zero(), Vec3::Zero()};
    std::array<double, 2> areas{0, 0};
    Halves halves;
    while (!frontier.empty()) {
        const Candidate top = frontier.top();
        frontier.pop();
        if (mark_[top.item] > base) continue;
        mark_[top.item] = base + 1 + top.region;
        normals[top.region] += graph_.normals[top.item];
        areas[top.region] += graph_.areas[top.item];
        if (top.region == 1) halves.second.push_back(top.item);
        for (const int* n = graph_.neighbors.begin(top.item); n != graph_.neighbors.end(top.item);
             ++n) {
            if (region_of_item_[*n] != r || mark_[*n] > base) continue;
            frontier.push({item_error(*n, proxies[top.region]), top.region, *n});
        }
    }
    halves.gain = error_of(region.normal, region.area) - error_of(normals[0], areas[0]) -
                  error_of(normals[1], areas[1]);
    for (int side = 0; side < 2; ++side) {
        if (normals[side].norm() > 0) proxies[side] = normals[side].normalized();
    }
    return halves;
}

/// A locked item stays: the part that holds it keeps the region's number.
void RegionPartition::keep_locked(int r, Halves& halves) {
    if (std::none_of(halves.second.begin(), halves.second.end(),
                     [&](int i) { return is_locked_[i]; })) {
        return;
    }
    ++stamp_;
    for (int item : halves.second) mark_[item] = stamp_;
    std::vector<int> first;
    for (int item : regions_[r].items) {
        if (mark_[item] != stamp_) first.push_back(item);
    }
    halves.second = std::move(first);
}

RegionPartition::Halves RegionPartition::split(int r) {
    const Region& region = regions_[r];
    const double error = error_of(region.normal, region.area);
    if (region.items.size() < 2 || error <= kNegligibleError * region.area) return {};
    const Vec3 mean = region.normal / region.area, own = proxy(r);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    int furthest = region.items.front();
    double furthest_error = -1;
    for (int item : region.items) {
        if (!(graph_.areas[item] > 0)) continue;
        const Vec3 offset = graph_.normals[item] / graph_.areas[item] - mean;
        spread += graph_.areas[item] * offset * offset.transpose();
        const double e = item_error(item, own);
        if (e > furthest_error || (e == furthest_error && item < furthest)) {
            furthest_error = e;
            furthest = item;
        }
    }
    const Vec3 axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
    std::array<Vec3, 2> across = two_means(r, {mean - 0.5 * axis, mean + 0.5 * axis});
    std::array<Vec3, 2> out{own, graph_.normals[furthest].normalized()};
    Halves best = grow_halves(r, across);
    Halves other = grow_halves(r, out);
    const bool is_other = other.gain > best.gain * (1 + 1e-9);
    if (is_other) std::swap(best, other);
    for (int refit = 0; refit < kRefits; ++refit) {
        Halves refitted = grow_halves(r, is_other ? out : across);
        if (refitted.gain <= best.gain * (1 + 1e-3)) break;
        best = std::move(refitted);
    }
    keep_locked(r, best);
    return best;
}

double RegionPartition::split_gain(int r) {
    Region& region = regions_[r];
    const auto item_count = static_cast<double>(region.items.size());
    if (region.split_gain < 0 || region.moved_count > kStaleShare * item_count) second_half(r);
    return region.split_gain;
}

std::vector<int> RegionPartition::second_half(int r) {
    Region& region = regions_[r];
    if (region.split_gain < 0 || region.moved_count > 0) {
        Halves halves = split(r);
        region.split_gain = halves.gain;
        region.second_half = std::move(halves.second);
        region.moved_count = 0;
    }
    return region.second_half;
}

void RegionPartition::apply_split(int r, const std::vector<int>& leaving, int new_region) {
    for (int item : leaving) move(item, new_region);
    for (int part : {r, new_region}) {
        resum(part);
        regions_[part].split_gain = -1;
    }
}

int RegionPartition::split_best(int count) {
    std::vector<std::pair<double, int>> order;
    for (int r = 0; r < region_count(); ++r) {
        const double gain = split_gain(r);
        if (gain > 0) order.push_back({-gain, r});
    }
    std::sort(order.begin(), order.end());
    int split_count = 0;
    for (const auto& [negative_gain, r] : order) {
        if (split_count == count) break;
        const std::vector<int> leaving = second_half(r);
        if (leaving.empty()) continue;
        regions_.emplace_back();
        apply_split(r, leaving, region_count() - 1);
        ++split_count;
    }
    return split_count;
}

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
