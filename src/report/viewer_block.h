#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// The grid to which the viewer's points are rounded: 2^18 steps along the longest side of a box.
class PointGrid {
public:
    /// Points outside the box are moved to its border.
    explicit PointGrid(const BoundingBox& box);
    std::array<std::uint32_t, 3> operator()(const Vec3& point) const;
    nlohmann::json to_json() const;  ///< {"min": [x, y, z], "step": s}

private:
    Vec3 min_;
    double step_ = 1;
    std::array<std::uint32_t, 3> last_{};  ///< largest step per axis
};

/// One data block of the viewer: a JSON header and arrays of whole numbers, which the header names
/// by what add_... returns ([offset, count]). viewer/src/block.js reads it.
class BlockWriter {
public:
    nlohmann::json add_numbers(const std::vector<std::uint32_t>& numbers);
    /// Differences of consecutive points on the grid, axis by axis.
    nlohmann::json add_points(const std::vector<Vec3>& points, const PointGrid& grid);
    /// The compressed block. Same content, same bytes.
    std::string finish(const nlohmann::json& header) const;

private:
    std::string bytes_;
};

/// To five digits, so that headers stay short; null where it is no finite number.
nlohmann::json short_number(double value);

}  // namespace fcn
