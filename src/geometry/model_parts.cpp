#include "geometry/model_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/errors.h"

namespace fcn {

int ModelSurface::add(const Vec3& point) {
    points.push_back(point);
    return static_cast<int>(points.size()) - 1;
}

void ModelSurface::zip(const std::vector<int>& lower, const std::vector<int>& upper) {
    std::size_t i = 0;
    std::size_t j = 0;
    const auto distance = [&](int a, int b) { return (points[a] - points[b]).squaredNorm(); };
    while (i + 1 < lower.size() || j + 1 < upper.size()) {
        bool is_lower_next = j + 1 == upper.size();
        if (!is_lower_next && i + 1 < lower.size()) {
            // Rounded, so that equal diagonals are equal on every machine.
            const double along_lower = distance(lower[i + 1], upper[j]);
            const double along_upper = distance(lower[i], upper[j + 1]);
            is_lower_next = along_lower <= along_upper * (1 + 1e-9);
        }
        if (is_lower_next) {
            add_triangle(lower[i], lower[i + 1], upper[j]);
            ++i;
        } else {
            add_triangle(lower[i], upper[j + 1], upper[j]);
            ++j;
        }
    }
}

void ModelSurface::zip_rings(const std::vector<int>& lower, const std::vector<int>& upper) {
    std::size_t nearest = 0;
    for (std::size_t j = 1; j < upper.size(); ++j) {
        const auto distance = [&](std::size_t k) {
            return (points[upper[k]] - points[lower[0]]).squaredNorm();
        };
        if (distance(j) < distance(nearest) * (1 - 1e-9)) nearest = j;
    }
    std::vector<int> closed_lower = lower;
    closed_lower.push_back(lower.front());
    std::vector<int> closed_upper(upper.begin() + static_cast<std::ptrdiff_t>(nearest),
                                  upper.end());
    closed_upper.insert(closed_upper.end(), upper.begin(),
                        upper.begin() + static_cast<std::ptrdiff_t>(nearest) + 1);
    zip(closed_lower, closed_upper);
}

void ModelSurface::cap(const std::vector<int>& ring, const Vec3& tip) {
    const int centre = add(tip);
    for (std::size_t i = 0; i < ring.size(); ++i) {
        add_triangle(ring[i], ring[(i + 1) % ring.size()], centre);
    }
}

void check_triangle_count(double count) {
    constexpr double kMostTriangles = 2e7;
    if (!(count <= kMostTriangles)) {
        throw InputError("model: these options would make about " +
                         std::to_string(static_cast<long long>(std::min(count, 1e18))) +
                         " triangles, at most 20000000 are allowed; raise resolution or spacing");
    }
}

int piece_count(double length, double resolution) {
    // A length that is a multiple of the resolution up to rounding gets no extra piece.
    return std::max(1, static_cast<int>(std::ceil(length / resolution - 1e-9)));
}

std::vector<double> cut_evenly(double from, double to, double resolution) {
    const int count = piece_count(to - from, resolution);
    std::vector<double> cuts;
    for (int i = 0; i < count; ++i) cuts.push_back(from + (to - from) * i / count);
    cuts.push_back(to);
    return cuts;
}

namespace {

/// Sorted, without planes closer than rounding.
std::vector<double> distinct(std::vector<double> planes) {
    std::sort(planes.begin(), planes.end());
    const double slack = 1e-9 * (planes.back() - planes.front());
    std::vector<double> result;
    for (double plane : planes) {
        if (result.empty() || plane - result.back() > slack) result.push_back(plane);
    }
    return result;
}

class CellGrid {
public:
    CellGrid(const std::array<std::vector<double>, 3>& planes, double resolution,
             const std::function<bool(const Vec3&)>& is_solid) {
        double smallest = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            planes_[axis] = distinct(planes[axis]);
            size_[axis] = static_cast<int>(planes_[axis].size()) - 1;
            for (std::size_t i = 1; i < planes_[axis].size(); ++i) {
                smallest = std::min(smallest, planes_[axis][i] - planes_[axis][i - 1]);
            }
        }
        step_ = std::min(resolution, 3 * smallest);
        double triangle_count = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto extent = [&](int a) { return planes_[a].back() - planes_[a].front(); };
            triangle_count += 4 * extent(axis) * extent((axis + 1) % 3) / (step_ * step_);
        }
        check_triangle_count(triangle_count);
        solid_.resize(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]);
        for_each_cell([&](const Cell& cell) { solid_[cell_index(cell)] = is_solid(centre(cell)); });
    }

    ModelSurface boundary() {
        for_each_cell([&](const Cell& cell) {
            if (!is_solid(cell)) return;
            for (int axis = 0; axis < 3; ++axis) {
                for (int side = 0; side < 2; ++side) {
                    Cell neighbour = cell;
                    neighbour[axis] += 2 * side - 1;
                    if (!is_solid(neighbour)) add_side(cell, axis, side);
                }
            }
        });
        return std::move(surface_);
    }

private:
    using Cell = std::array<int, 3>;

    template <typename Visit>
    void for_each_cell(Visit visit) const {
        for (int z = 0; z < size_[2]; ++z) {
            for (int y = 0; y < size_[1]; ++y) {
                for (int x = 0; x < size_[0]; ++x) visit(Cell{x, y, z});
            }
        }
    }

    std::size_t cell_index(const Cell& cell) const {
        return (static_cast<std::size_t>(cell[2]) * size_[1] + cell[1]) * size_[0] + cell[0];
    }

    Vec3 centre(const Cell& cell) const {
        Vec3 point;
        for (int axis = 0; axis < 3; ++axis) {
            point[axis] = 0.5 * (planes_[axis][cell[axis]] + planes_[axis][cell[axis] + 1]);
        }
        return point;
    }

    bool is_solid(const Cell& cell) const {
        for (int axis = 0; axis < 3; ++axis) {
            if (cell[axis] < 0 || cell[axis] >= size_[axis]) return false;
        }
        return solid_[cell_index(cell)];
    }

    std::vector<double> cuts(int axis, int index) const {
        return cut_evenly(planes_[axis][index], planes_[axis][index + 1], step_);
    }

    /// One side of a cell as a grid of its own; the seams are welded later.
    void add_side(const Cell& cell, int axis, int side) {
        const int u = side == 1 ? (axis + 1) % 3 : (axis + 2) % 3;
        const int v = side == 1 ? (axis + 2) % 3 : (axis + 1) % 3;
        const std::vector<double> along_u = cuts(u, cell[u]);
        const std::vector<double> along_v = cuts(v, cell[v]);
        const int first = static_cast<int>(surface_.points.size());
        Vec3 point;
        point[axis] = planes_[axis][cell[axis] + side];
        for (double at_v : along_v) {
            for (double at_u : along_u) {
                point[u] = at_u;
                point[v] = at_v;
                surface_.add(point);
            }
        }
        const int row = static_cast<int>(along_u.size());
        for (int j = 0; j + 1 < static_cast<int>(along_v.size()); ++j) {
            for (int i = 0; i + 1 < row; ++i) {
                const int corner = first + j * row + i;
                const std::array corners{corner, corner + 1, corner + row + 1, corner + row};
                // Alternating diagonals give no direction to the mesh.
                const int turn = (i + j) % 2;
                surface_.add_triangle(corners[turn], corners[turn + 1], corners[turn + 2]);
                surface_.add_triangle(corners[turn], corners[turn + 2], corners[(turn + 3) % 4]);
            }
        }
    }

    std::array<std::vector<double>, 3> planes_;
    std::array<int, 3> size_{};
    double step_ = 0;
    std::vector<bool> solid_;
    ModelSurface surface_;
};

}  // namespace

ModelSurface boundary_of_cells(const std::array<std::vector<double>, 3>& planes, double resolution,
                               const std::function<bool(const Vec3&)>& is_solid) {
    return CellGrid(planes, resolution, is_solid).boundary();
}

}  // namespace fcn
