#pragma once

#include <cmath>
#include <map>
#include <vector>

#include "geometry/mesh_io.h"

namespace fcn::test {

/// Rectangle [0, a] x [0, b] in the plane z = height, m x n cells, facing +z.
inline Mesh rectangle(double a, double b, int m, int n, double height = 0) {
    Mesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= m; ++i) mesh.add_vertex({a * i / m, b * j / n, height});
    const auto at = [&](int i, int j) {
        return mesh.vertex_handle(static_cast<unsigned>(j * (m + 1) + i));
    };
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < m; ++i) {
            mesh.add_face(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.add_face(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return mesh;
}

/// Parallelogram of equilateral triangles of side `edge`.
inline Mesh equilateral_grid(double edge, int m, int n) {
    Mesh mesh = rectangle(m * edge, n * edge, m, n);
    for (const VertexHandle vertex : mesh.vertices()) {
        const Vec3 p = mesh.point(vertex);
        mesh.set_point(vertex, {p[0] - p[1] / 2, p[1] * std::sqrt(3.0) / 2, 0});
    }
    return mesh;
}

/// Octahedron, each face cut into 4^levels, on a sphere.
inline Mesh sphere(double radius, int levels) {
    std::vector<Vec3> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<std::array<int, 3>> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                          {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<int, int>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [it, is_new] =
                middles.try_emplace(std::minmax({a, b}), static_cast<int>(points.size()));
            if (is_new)
                points.push_back(
                    (points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)])
                        .normalized());
            return it->second;
        };
        std::vector<std::array<int, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.push_back({a, ab, ca});
            finer.push_back({b, bc, ab});
            finer.push_back({c, ca, bc});
            finer.push_back({ab, bc, ca});
        }
        faces = finer;
    }
    Mesh mesh;
    for (const Vec3& point : points) mesh.add_vertex(radius * point);
    for (const auto& [a, b, c] : faces)
        mesh.add_face(VertexHandle(a), VertexHandle(b), VertexHandle(c));
    return mesh;
}

inline LoadedMesh from_grids(const std::vector<std::array<Vec3, 4>>& quads, int n,
                             const std::vector<int>& labels = {}) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> face_labels;
    std::map<std::array<long, 3>, int> known;
    for (std::size_t q = 0; q < quads.size(); ++q) {
        const auto id = [&](int i, int j) {
            const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
            const Vec3 p = (1 - u) * (1 - v) * quads[q][0] + u * (1 - v) * quads[q][1] +
                           u * v * quads[q][2] + (1 - u) * v * quads[q][3];
            const std::array<long, 3> key{std::lround(p[0] * 1e9), std::lround(p[1] * 1e9),
                                          std::lround(p[2] * 1e9)};
            const auto [it, is_new] = known.try_emplace(key, static_cast<int>(points.size()));
            if (is_new) points.push_back(p);
            return it->second;
        };
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
                triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
                for (int k = 0; k < 2 && !labels.empty(); ++k) face_labels.push_back(labels[q]);
            }
        }
    }
    return mesh_from_soup(points, triangles, face_labels);
}

/// Unit cube, n x n cells a side; each side has a label of its own if asked.
inline LoadedMesh cube(int n, bool is_labeled = false) {
    const auto p = [](int i) { return Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1); };
    const std::vector<std::array<Vec3, 4>> sides{
        {p(0), p(2), p(3), p(1)}, {p(4), p(5), p(7), p(6)}, {p(0), p(1), p(5), p(4)},
        {p(2), p(6), p(7), p(3)}, {p(0), p(4), p(6), p(2)}, {p(1), p(3), p(7), p(5)}};
    return from_grids(sides, n,
                      is_labeled ? std::vector<int>{0, 1, 2, 3, 4, 5} : std::vector<int>{});
}

/// Closed cylinder of height 1 about the z axis: `count` sides, `rings` rings on caps and mantle.
inline LoadedMesh cylinder(double radius, int count, int rings) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    const auto add_ring = [&](double r, double z) {
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * 3.14159265358979323846 * i / count;
            points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
        }
    };
    points.emplace_back(0, 0, 1);
    for (int k = 1; k <= rings; ++k) add_ring(radius * k / rings, 1);
    for (int k = 1; k <= rings; ++k) add_ring(radius, 1 - static_cast<double>(k) / rings);
    for (int k = rings - 1; k >= 1; --k) add_ring(radius * k / rings, 0);
    points.emplace_back(0, 0, 0);
    const int last_ring = 3 * rings - 2;
    const auto at = [&](int ring, int i) { return 1 + ring * count + i % count; };
    for (int i = 0; i < count; ++i) {
        triangles.push_back({0, at(0, i), at(0, i + 1)});
        for (int ring = 0; ring < last_ring; ++ring) {
            triangles.push_back({at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)});
            triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)});
        }
        triangles.push_back(
            {at(last_ring, i), static_cast<int>(points.size()) - 1, at(last_ring, i + 1)});
    }
    return mesh_from_soup(points, triangles);
}

}  // namespace fcn::test
