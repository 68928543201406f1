// The models with axis-parallel faces: each is a set of cells between the planes of its creases.

#include <algorithm>
#include <cmath>

#include "geometry/model_shapes.h"

namespace fcn {

namespace {

/// Alternating widths from `begin`: planes at begin, begin + a, begin + a + b, ...
std::vector<double> alternating(double begin, double a, double b, int count) {
    std::vector<double> planes{begin};
    for (int i = 0; i < count; ++i) planes.push_back(planes.back() + (i % 2 == 0 ? a : b));
    return planes;
}

/// Index of the interval that holds a value; planes ascend.
int interval(const std::vector<double>& planes, double value) {
    return static_cast<int>(std::upper_bound(planes.begin(), planes.end(), value) -
                            planes.begin()) -
           1;
}

}  // namespace

ModelSurface make_box(const ModelOptions& options) {
    return boundary_of_cells({{{0, 1}, {0, 0.8}, {0, 0.6}}}, options.resolution,
                             [](const Vec3&) { return true; });
}

ModelSurface make_skyscraper(const ModelOptions& options) {
    // Set-backs, in units of the spacing, from the ground up; they repeat.
    constexpr double kDepths[] = {1, 0.25, 2, 0.5, 4};
    const int tier_count = options.count;
    std::vector<double> inset{0};
    for (int tier = 1; tier < tier_count; ++tier) {
        inset.push_back(inset.back() + options.spacing * kDepths[(tier - 1) % 5]);
    }
    const double top_width = std::max(2 * options.spacing, 1 - 2 * inset.back());
    const double base_width = top_width + 2 * inset.back();
    const double tier_height = std::max(options.spacing, 1.4 / tier_count);
    std::vector<double> across;
    std::vector<double> up{0};
    for (double depth : inset) {
        across.push_back(depth);
        across.push_back(base_width - depth);
        up.push_back(up.back() + tier_height);
    }
    return boundary_of_cells({across, across, up}, options.resolution, [&](const Vec3& p) {
        const double depth = inset[static_cast<std::size_t>(interval(up, p.z()))];
        return std::min(p.x(), p.y()) > depth && std::max(p.x(), p.y()) < base_width - depth;
    });
}

ModelSurface make_ribs(const ModelOptions& options) {
    // Ribs half a spacing wide and a spacing high, on a plate that sticks out by a spacing.
    const double spacing = options.spacing;
    std::vector<double> x =
        alternating(spacing, 0.5 * spacing, 0.5 * spacing, 2 * options.count - 1);
    x.insert(x.begin(), 0.0);
    x.push_back(x.back() + spacing);
    const std::vector<double> y{0, spacing, spacing + 0.5, 2 * spacing + 0.5};
    const std::vector<double> z{0, 2 * spacing, 3 * spacing};
    return boundary_of_cells({x, y, z}, options.resolution, [&](const Vec3& p) {
        if (interval(z, p.z()) == 0) return true;
        return interval(y, p.y()) == 1 && interval(x, p.x()) % 2 == 1;
    });
}

ModelSurface make_holes(const ModelOptions& options) {
    // Rows of square holes, a spacing wide and apart; the last row may have fewer.
    const double spacing = options.spacing;
    const int columns = static_cast<int>(std::ceil(std::sqrt(options.count)));
    const int rows = (options.count + columns - 1) / columns;
    const std::vector<double> x = alternating(0, spacing, spacing, 2 * columns + 1);
    const std::vector<double> y = alternating(0, spacing, spacing, 2 * rows + 1);
    return boundary_of_cells({x, y, {0, spacing}}, options.resolution, [&](const Vec3& p) {
        const int i = interval(x, p.x()), j = interval(y, p.y());
        return i % 2 == 0 || j % 2 == 0 || j / 2 * columns + i / 2 >= options.count;
    });
}

ModelSurface make_step(const ModelOptions& options) {
    return boundary_of_cells({{{0, 0.5, 1}, {0, 0.5}, {0, 0.4, 0.4 + options.spacing}}},
                             options.resolution,
                             [](const Vec3& p) { return p.z() < 0.4 || p.x() > 0.5; });
}

ModelSurface make_steps(const ModelOptions& options) {
    const double spacing = options.spacing;
    const std::vector<double> along = alternating(0, spacing, spacing, options.count);
    return boundary_of_cells({along, {0, 0.5}, along}, options.resolution, [&](const Vec3& p) {
        return interval(along, p.z()) <= interval(along, p.x());
    });
}

ModelSurface make_thin_wall(const ModelOptions& options) {
    // A standing plate a tenth of the spacing thick. Strips lie on both sides, those behind
    // shifted by half a pitch, so that creases run back to back across the wall.
    const double spacing = options.spacing;
    const double thickness = 0.1 * spacing;
    const double relief = 0.25 * spacing;
    const std::vector<double> x =
        alternating(0, 0.5 * spacing, 0.5 * spacing, 4 * options.count + 1);
    const std::vector<double> y{0, relief, relief + thickness, 2 * relief + thickness};
    const std::vector<double> z{0, 0.1, 0.5, 0.6};
    return boundary_of_cells({x, y, z}, options.resolution, [&](const Vec3& p) {
        const int layer = interval(y, p.y());
        if (layer == 1) return true;
        const int column = interval(x, p.x());
        const bool is_last = column == 4 * options.count;
        return interval(z, p.z()) == 1 && !is_last && column % 4 == (layer == 0 ? 1 : 2);
    });
}

}  // namespace fcn
