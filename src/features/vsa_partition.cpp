// A partition into regions, flooding and the exchange of border items.
//
// The moves are those of variational shape approximation (Cohen-Steiner, Alliez, Desbrun 2004,
// sections 3.2 to 3.4). Departure: the L2,1 error of a set about its best proxy is
// 2 (area - |integral of the normal|), so what a move changes is known exactly from two sums:
// border items move one by one while the *fitted* error falls (the k-means exchange of Hartigan and
// Wong 1979), which is cheaper than flooding everything anew and does not stop where Lloyd's
// iteration does. An item leaves only where its region stays connected, decided by a short search
// around it.

#include "features/vsa_partition.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "features/vsa_frontier.h"

namespace fcn {
namespace {

constexpr int kConnectivityLimit = 32;  // items looked at to see that a region stays connected

}  // namespace

RegionPartition::RegionPartition(const ItemGraph& graph, const std::vector<int>& locked_items,
                                 double negligible_error)
    : graph_(graph),
      region_of_item_(graph.size(), -1),
      slot_(graph.size(), -1),
      is_locked_(graph.size(), false),
      mark_(graph.size(), 0),
      is_queued_(graph.size(), false),
      negligible_error_(negligible_error) {
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

}  // namespace fcn
