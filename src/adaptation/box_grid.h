#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// Uniform hash grid over axis-aligned boxes; finds the boxes that meet a query box. Near-linear
/// to build when boxes span few cells.
class BoxGrid {
public:
    struct Box {
        Vec3 min = Vec3::Zero();
        Vec3 max = Vec3::Zero();
    };
    static Box around(const Vec3& a, const Vec3& b, double margin);

    BoxGrid(const std::vector<Box>& boxes, double cell_size);

    /// Indices of all boxes that meet `query`, ascending, into `result` (cleared first).
    void find(const Box& query, std::vector<int>& result) const;

private:
    using Cell = std::array<std::int64_t, 3>;
    Cell cell_of(const Vec3& point) const;
    static std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z);

    std::vector<Box> boxes_;
    double cell_size_ = 1;
    std::vector<int> entries_;  ///< box indices, grouped by key
    std::unordered_map<std::uint64_t, std::pair<std::uint32_t, std::uint32_t>> ranges_;
};

}  // namespace fcn
