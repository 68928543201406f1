#include "report/viewer_block.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "geometry/file_content.h"

namespace fcn {
namespace {

constexpr double kSteps = 262143;

/// Seven bits a byte, least first; the high bit says that more follow.
void append_number(std::string& bytes, std::uint32_t number) {
    for (; number > 127; number >>= 7) bytes += static_cast<char>((number & 127) | 128);
    bytes += static_cast<char>(number);
}

/// 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
std::uint32_t unsigned_of(std::int64_t difference) {
    return static_cast<std::uint32_t>(difference < 0 ? -2 * difference - 1 : 2 * difference);
}

}  // namespace

PointGrid::PointGrid(const BoundingBox& box) : min_(box.min) {
    const Vec3 size = box.max - box.min;
    const double longest = size.maxCoeff();
    if (longest > 0 && std::isfinite(longest)) step_ = longest / kSteps;
    for (int axis = 0; axis < 3; ++axis)
        last_[static_cast<std::size_t>(axis)] =
            static_cast<std::uint32_t>(std::clamp(std::ceil(size[axis] / step_), 0.0, kSteps + 1));
}

std::array<std::uint32_t, 3> PointGrid::operator()(const Vec3& point) const {
    std::array<std::uint32_t, 3> steps{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double at = std::round((point[axis] - min_[axis]) / step_);
        steps[a] = at > 0 ? static_cast<std::uint32_t>(std::min(at, double(last_[a]))) : 0;
    }
    return steps;
}

nlohmann::json PointGrid::to_json() const {
    return {{"min", {min_[0], min_[1], min_[2]}}, {"step", step_}};
}

nlohmann::json BlockWriter::add_numbers(const std::vector<std::uint32_t>& numbers) {
    const std::size_t offset = bytes_.size();
    for (const std::uint32_t number : numbers) append_number(bytes_, number);
    return {offset, numbers.size()};
}

nlohmann::json BlockWriter::add_points(const std::vector<Vec3>& points, const PointGrid& grid) {
    const std::size_t offset = bytes_.size();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::int64_t before = 0;
        for (const Vec3& point : points) {
            const std::int64_t now = grid(point)[axis];
            append_number(bytes_, unsigned_of(now - before));
            before = now;
        }
    }
    return {offset, points.size()};
}

std::string BlockWriter::finish(const nlohmann::json& header) const {
    const std::string text = header.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    std::string block = "FCNV";
    for (int shift = 0; shift < 32; shift += 8)
        block += static_cast<char>(text.size() >> shift & 255);
    return compress(block + text + bytes_);
}

nlohmann::json short_number(double value) {
    if (!std::isfinite(value)) return nullptr;
    char text[32];
    std::snprintf(text, sizeof text, "%.5g", value);
    return std::strtod(text, nullptr);
}

}  // namespace fcn
