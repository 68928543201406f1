// Graded lengths (after Persson 2006, "Mesh size functions for implicit geometry and PDE-based mesh
// generation"): the length at a point is the least of size + growth * distance over the sources.
// Every source is listed in all cells that it reaches, so that a point asks one cell.
#include "meshing/size_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fcn {
namespace {

constexpr double kCell = 3;  ///< in lengths

}  // namespace

std::size_t SizeSources::CellHash::operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const int i : cell) hash = hash * 0x9E3779B97F4A7C15ULL + static_cast<std::uint32_t>(i);
    return static_cast<std::size_t>(hash ^ (hash >> 29));
}

SizeSources::Cell SizeSources::cell_of(const Vec3& position) const {
    Cell cell;
    for (int i = 0; i < 3; ++i)
        cell[static_cast<std::size_t>(i)] =
            static_cast<int>(std::clamp(std::floor(position[i] / (kCell * length_)), -1e9, 1e9));
    return cell;
}

void SizeSources::add(const Vec3& position, double size) {
    const int index = static_cast<int>(sources_.size());
    sources_.push_back({position, size});
    const double reach = std::max(0.0, kFarthest * length_ - size) / kGrowth;
    const Cell low = cell_of(position - Vec3::Constant(reach));
    const Cell high = cell_of(position + Vec3::Constant(reach));
    for (int x = low[0]; x <= high[0]; ++x)
        for (int y = low[1]; y <= high[1]; ++y)
            for (int z = low[2]; z <= high[2]; ++z) cells_[{x, y, z}].push_back(index);
}

double SizeSources::limit(const Vec3& position) const {
    double least = std::numeric_limits<double>::infinity();
    if (sources_.empty()) return least;
    const auto cell = cells_.find(cell_of(position));
    if (cell == cells_.end()) return least;
    for (const int i : cell->second) {
        const Source& source = sources_[static_cast<std::size_t>(i)];
        least = std::min(least, source.size + kGrowth * (position - source.position).norm());
    }
    return least;
}

void SizeRequests::ask(const Vec3& position, double now, double size) {
    const bool is_asked =
        std::any_of(requests_.begin(), requests_.end(), [&](const SizeSources::Source& other) {
            return (position - other.position).norm() < 0.5 * now;
        });
    if (!is_asked) requests_.push_back({position, size});
}

void SizeRequests::grant(SizeSources& sources) {
    for (const SizeSources::Source& request : requests_)
        sources.add(request.position, request.size);
    requests_.clear();
}

}  // namespace fcn
