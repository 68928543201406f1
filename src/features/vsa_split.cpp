// Splitting a region of variational shape approximation, by what the split gains rather than by the
// region's error alone (Cohen-Steiner, Alliez, Desbrun 2004, section 3.4, insert at the worst
// item). Two beginnings: the halves of the region's normals along their principal direction,
// improved by two-means on the normals; and the region's proxy against its worst item. Both are
// grown from the items that fit best, the better one is refitted and grown again while that helps.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "features/vsa_frontier.h"
#include "features/vsa_partition.h"

namespace fcn {
namespace {

constexpr double kStaleShare = 0.1;  // of a region's items: its split gain is found anew
constexpr int kTwoMeansIterations = 4;
constexpr int kRefits = 3;  // floods after the first, of the better pair of halves

}  // namespace

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
    if (region.items.size() < 2 || error <= negligible_error_ * region.area) return {};
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

}  // namespace fcn
