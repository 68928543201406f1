#include "adaptation/box_grid.h"

#include <algorithm>
#include <cmath>

namespace fcn {

namespace {

bool meet(const BoxGrid::Box& a, const BoxGrid::Box& b) {
    return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

}  // namespace

BoxGrid::Box BoxGrid::around(const Vec3& a, const Vec3& b, double margin) {
    const Vec3 pad = Vec3::Constant(margin);
    return {a.cwiseMin(b) - pad, a.cwiseMax(b) + pad};
}

BoxGrid::Cell BoxGrid::cell_of(const Vec3& point) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = static_cast<std::int64_t>(std::floor(point[axis] / cell_size_));
    }
    return cell;
}

std::uint64_t BoxGrid::key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    // Distinct cells may share a key; find() tests the boxes themselves, so that costs time only.
    return static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ull ^
           static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Full ^
           static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ull;
}

BoxGrid::BoxGrid(const std::vector<Box>& boxes, double cell_size)
    : boxes_(boxes), cell_size_(cell_size) {
    std::vector<std::pair<std::uint64_t, int>> keyed;
    keyed.reserve(boxes.size() * 2);
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
        const Cell low = cell_of(boxes[i].min);
        const Cell high = cell_of(boxes[i].max);
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
            for (std::int64_t y = low[1]; y <= high[1]; ++y) {
                for (std::int64_t z = low[2]; z <= high[2]; ++z) {
                    keyed.emplace_back(key_of(x, y, z), i);
                }
            }
        }
    }
    std::sort(keyed.begin(), keyed.end());
    entries_.reserve(keyed.size());
    ranges_.reserve(keyed.size());
    for (std::size_t k = 0; k < keyed.size(); ++k) {
        if (k == 0 || keyed[k].first != keyed[k - 1].first) {
            ranges_[keyed[k].first] = {static_cast<std::uint32_t>(k),
                                       static_cast<std::uint32_t>(k)};
        }
        entries_.push_back(keyed[k].second);
        ranges_[keyed[k].first].second = static_cast<std::uint32_t>(k + 1);
    }
}

void BoxGrid::find(const Box& query, std::vector<int>& result) const {
    result.clear();
    const Cell low = cell_of(query.min);
    const Cell high = cell_of(query.max);
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        for (std::int64_t y = low[1]; y <= high[1]; ++y) {
            for (std::int64_t z = low[2]; z <= high[2]; ++z) {
                const auto range = ranges_.find(key_of(x, y, z));
                if (range == ranges_.end()) continue;
                for (std::uint32_t k = range->second.first; k < range->second.second; ++k) {
                    if (meet(boxes_[entries_[k]], query)) result.push_back(entries_[k]);
                }
            }
        }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
}

}  // namespace fcn
