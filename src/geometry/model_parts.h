#pragma once

#include <array>
#include <functional>
#include <vector>

#include "geometry/mesh_io.h"

namespace fcn {

/// Points and triangles of a model under construction.
struct ModelSurface {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;

    int add(const Vec3& point);
    void add_triangle(int a, int b, int c) { triangles.push_back({a, b, c}); }
    /// Triangles between two chains of points, the lower one running left to right as seen from
    /// outside; always the shorter new edge first.
    void zip(const std::vector<int>& lower, const std::vector<int>& upper);
    /// The same between two closed rings (first point not repeated).
    void zip_rings(const std::vector<int>& lower, const std::vector<int>& upper);
    /// Closes a ring with one point; the ring runs counter-clockwise as seen from outside.
    void cap(const std::vector<int>& ring, const Vec3& tip);
};

/// Throws InputError if that many triangles would be too many.
void check_triangle_count(double count);

/// The number of pieces of at most `resolution` that a length is cut into, at least one.
int piece_count(double length, double resolution);

/// `from`, ..., `to` in equal pieces of at most `resolution`.
std::vector<double> cut_evenly(double from, double to, double resolution);

/// The boundary of a set of cells of a rectangular grid. The planes given per axis are where
/// creases can lie; between them the grid is cut to `resolution`, or finer, so that no cell's sides
/// differ by more than a factor of three. `is_solid` is asked at cell centres and must leave no
/// cells that touch along an edge only.
ModelSurface boundary_of_cells(const std::array<std::vector<double>, 3>& planes, double resolution,
                               const std::function<bool(const Vec3&)>& is_solid);

}  // namespace fcn
