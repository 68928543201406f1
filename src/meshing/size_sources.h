#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// Places that ask for shorter edges than elsewhere: lengths grow from there by a share of the
/// distance. A lookup is one cell of a hash grid.
class SizeSources {
public:
    /// Sources of lengths below `length` come.
    explicit SizeSources(double length) : length_(length) {}
    SizeSources() = default;

    struct Source {
        Vec3 position;
        double size;
    };

    bool is_empty() const { return sources_.empty(); }
    const std::vector<Source>& sources() const { return sources_; }
    void add(const Vec3& position, double size);
    /// What the sources allow at a point; infinity far from all.
    double limit(const Vec3& position) const;
    /// Whether a vertex lies where a source is felt, or two edges farther.
    bool is_near(const Vec3& position) const { return limit(position) < kNear * length_; }
    /// The same, and an edge farther, so that changes near sources change nothing that is not
    /// around.
    bool is_around(const Vec3& position) const { return limit(position) < kFarthest * length_; }

    static constexpr double kGrowth = 0.4;                 ///< of the length with distance
    static constexpr double kNear = 1.8, kFarthest = 2.5;  ///< in lengths: larger is not known

private:
    using Cell = std::array<int, 3>;
    struct CellHash {
        std::size_t operator()(const Cell& cell) const;
    };
    Cell cell_of(const Vec3& position) const;

    double length_ = 0;
    std::vector<Source> sources_;
    std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

/// What one round of looking for faults asks for: of requests that lie within half an edge of each
/// other the first counts, since one fault shows on several faces.
class SizeRequests {
public:
    /// `now`: the edge length there so far.
    void ask(const Vec3& position, double now, double size);
    /// Makes them sources and forgets them.
    void grant(SizeSources& sources);

private:
    std::vector<SizeSources::Source> requests_;
};

}  // namespace fcn
