#pragma once

#include <cmath>
#include <numbers>

#include "meshing/quad_mesh.h"

namespace fcn::test {

/// m x n unit squares in the plane z = 0, facing +z; vertex (i, j) is j (m + 1) + i.
inline QuadMesh quad_grid(int m, int n) {
    QuadMesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= m; ++i) mesh.points.emplace_back(i, j, 0);
    const auto at = [&](int i, int j) { return j * (m + 1) + i; };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i)
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    return mesh;
}

/// The unit cube, facing outward; vertex x + 2 y + 4 z.
inline QuadMesh quad_cube() {
    QuadMesh mesh;
    for (int v = 0; v < 8; ++v) mesh.points.emplace_back(v & 1, v >> 1 & 1, v >> 2);
    mesh.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    return mesh;
}

/// Torus about the z axis, facing outward, m quads around the axis and n around the tube.
inline QuadMesh quad_torus(double radius, double tube, int m, int n) {
    QuadMesh mesh;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i) {
            const double u = 2 * std::numbers::pi * i / m, v = 2 * std::numbers::pi * j / n;
            const double r = radius + tube * std::cos(v);
            mesh.points.emplace_back(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
        }
    const auto at = [&](int i, int j) { return j % n * m + i % m; };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i)
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    return mesh;
}

}  // namespace fcn::test
