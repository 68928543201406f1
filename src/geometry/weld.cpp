// Welding by hashing. Equal positions go into one open-addressing table keyed by the coordinates'
// bits. Within a distance, points are put into a grid of that cell size and each looks for an
// earlier representative in the 27 cells around it; taking the lowest index first makes the result
// independent of everything but the order of the points.

#include <bit>
#include <cmath>
#include <limits>

#include "geometry/polygon_soup.h"

namespace fcn {

namespace {

std::uint64_t mix(std::uint64_t value) {
    value ^= value >> 32;
    value *= 0xd6e8feb86659fd93ULL;
    value ^= value >> 32;
    value *= 0xd6e8feb86659fd93ULL;
    return value ^ (value >> 32);
}

template <typename Key>
std::uint64_t hash_key(const std::array<Key, 3>& key) {
    std::uint64_t hash = 0;
    for (Key part : key) hash = mix(hash ^ std::bit_cast<std::uint64_t>(part)) + 0x9e3779b97f4a7c15;
    return hash;
}

/// Open addressing from a key to the head of a list of points.
template <typename Key>
class PointTable {
public:
    explicit PointTable(std::size_t point_count)
        : mask_(std::bit_ceil(2 * point_count + 2) - 1), keys_(mask_ + 1), heads_(mask_ + 1, -1) {}

    int& head(const std::array<Key, 3>& key) {
        std::size_t slot = hash_key(key) & mask_;
        while (heads_[slot] >= 0 && keys_[slot] != key) slot = (slot + 1) & mask_;
        keys_[slot] = key;
        return heads_[slot];
    }
    int find(const std::array<Key, 3>& key) const {
        std::size_t slot = hash_key(key) & mask_;
        while (heads_[slot] >= 0 && keys_[slot] != key) slot = (slot + 1) & mask_;
        return heads_[slot];
    }

private:
    std::size_t mask_;
    std::vector<std::array<Key, 3>> keys_;
    std::vector<int> heads_;
};

std::vector<int> weld_equal(const std::vector<Vec3>& points) {
    PointTable<double> table(points.size());
    std::vector<int> representative(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        // Adding zero turns -0 into +0.
        int& head = table.head({points[i].x() + 0.0, points[i].y() + 0.0, points[i].z() + 0.0});
        if (head < 0) head = static_cast<int>(i);
        representative[i] = head;
    }
    return representative;
}

std::array<std::int64_t, 3> cell_of(const Vec3& point, const Vec3& origin, double size) {
    std::array<std::int64_t, 3> cell;
    for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = static_cast<std::int64_t>(std::floor((point[axis] - origin[axis]) / size));
    }
    return cell;
}

std::vector<int> weld_within(const std::vector<Vec3>& points, double distance, const Vec3& origin) {
    PointTable<std::int64_t> table(points.size());
    std::vector<int> representative(points.size());
    std::vector<int> next(points.size(), -1);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto cell = cell_of(points[i], origin, distance);
        int best = -1;
        for (int neighbour = 0; neighbour < 27; ++neighbour) {
            const std::array<std::int64_t, 3> key{cell[0] + neighbour % 3 - 1,
                                                  cell[1] + neighbour / 3 % 3 - 1,
                                                  cell[2] + neighbour / 9 - 1};
            for (int j = table.find(key); j >= 0; j = next[j]) {
                const bool is_close = (points[j] - points[i]).norm() <= distance;
                if (is_close && (best < 0 || j < best)) best = j;
            }
        }
        if (best < 0) {
            int& head = table.head(cell);
            next[i] = head;
            head = static_cast<int>(i);
            best = static_cast<int>(i);
        }
        representative[i] = best;
    }
    return representative;
}

}  // namespace

std::vector<int> weld_map(const std::vector<Vec3>& points, double distance) {
    if (points.empty()) return {};
    if (distance <= 0) return weld_equal(points);
    Vec3 low = points.front();
    Vec3 high = points.front();
    for (const Vec3& point : points) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    // Cells must be countable in 64 bits.
    const double smallest = (high - low).maxCoeff() * 0x1p-52;
    return weld_within(points, std::max(distance, smallest), low);
}

}  // namespace fcn
