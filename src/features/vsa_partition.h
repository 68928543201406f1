#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "features/vsa_items.h"

namespace fcn {

/// A partition of an item graph into connected regions, with the moves of variational shape
/// approximation. Every move keeps regions connected and none empty. A region's error is that of
/// its own best proxy, 2 (area - |normal|). Sequential and deterministic.
class RegionPartition {
public:
    /// `locked_items` never leave the region they are in; regions of at most `negligible_error` per
    /// area are not split.
    explicit RegionPartition(const ItemGraph& graph, const std::vector<int>& locked_items = {},
                             double negligible_error = 1e-6);

    int region_count() const { return static_cast<int>(regions_.size()); }
    const std::vector<int>& region_of_item() const { return region_of_item_; }
    double error() const;
    double region_area(int region) const { return regions_[region].area; }

    void assign(const std::vector<int>& region_of_item, int region_count);

    /// Grows regions from one seed item each, in the order of (error, region, item); components
    /// without a seed become regions of their own.
    void flood(const std::vector<int>& seeds);

    /// The item of each region that fits its proxy best.
    std::vector<int> best_items() const;

    /// Splits the regions that gain most, up to `count` of them, each at most once; regions whose
    /// error is negligible are not split. Returns how many were.
    int split_best(int count);

    /// Moves single border items to a neighbouring region while that lowers the error.
    /// Returns the number of moves.
    std::int64_t refine(int max_sweeps);

    /// Merges the cheapest adjacent pairs and splits the best regions instead, while the split
    /// gains more than the merge costs, each region at most once; regions below
    /// `fixed_region_count` are not merged. Returns the number of teleports.
    int teleport(int fixed_region_count);

    /// Tries single teleports that look up to a few times too expensive, with exchange of the
    /// items around, and keeps those that lower the error. Returns their number.
    int search_teleports(int fixed_region_count);

    /// Merges regions smaller than `area` into the neighbour with the least error increase,
    /// smallest first. Returns how many.
    int dissolve(double area, int fixed_region_count);

private:
    struct Region {
        Vec3 normal = Vec3::Zero();  ///< integral over the region
        double area = 0;
        std::vector<int> items;
        double split_gain = -1;        ///< cached; -1 unknown
        std::vector<int> second_half;  ///< of that split; valid while moved_count is 0
        int moved_count = 0;           ///< items that came or went since the gain was found
        bool is_changed = false;       ///< within one teleport round
    };
    struct Halves {
        double gain = 0;
        std::vector<int> second;  ///< items that leave the region
    };
    struct MergePair {
        double cost = 0;
        int first = -1;
        int second = -1;
    };

    static double error_of(const Vec3& normal, double area);
    double item_error(int item, const Vec3& proxy) const;
    Vec3 proxy(int region) const;
    void move(int item, int to);
    void resum(int region);
    bool is_removable(int item);
    int best_target(int item) const;
    std::vector<MergePair> merge_pairs() const;
    void merge(int into, int from);
    void drop_region(int region);
    Halves split(int region);
    std::array<Vec3, 2> two_means(int region, std::array<Vec3, 2> proxies) const;
    Halves grow_halves(int region, std::array<Vec3, 2>& proxies);
    void keep_locked(int region, Halves& halves);
    double split_gain(int region);
    std::int64_t refine_from(std::vector<int> queue, int max_sweeps);
    int best_split(int first_excluded, int second_excluded);
    bool try_teleport(const MergePair& pair, int worst);
    void undo(const std::vector<double>& split_gains);
    std::vector<int> second_half(int region);
    void apply_split(int region, const std::vector<int>& leaving, int new_region);

    const ItemGraph& graph_;
    std::vector<Region> regions_;
    std::vector<int> region_of_item_;
    std::vector<int> slot_;  ///< of an item in its region's list
    std::vector<bool> is_locked_;
    std::vector<int> mark_;        ///< scratch: stamps
    std::vector<bool> is_queued_;  ///< scratch of refine_from(); all false between calls
    std::vector<std::pair<int, int>> journal_;  ///< item and where it was, while journaling
    bool is_journaling_ = false;
    int stamp_ = 0;
    double tolerance_ = 0;
    double negligible_error_;
};

}  // namespace fcn
