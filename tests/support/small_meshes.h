#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "geometry/mesh_io.h"

namespace fcn::testing {

/// Points and triangles, to be handed to mesh_from_soup or spoilt first.
struct Soup {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> labels;

    LoadedMesh load(const ReadOptions& options = {}) const {
        return mesh_from_soup(points, triangles, labels, options);
    }
};

/// A unit cube, 12 faces, outward; each side labelled 0..5.
inline Soup cube_soup(const Vec3& origin = Vec3::Zero()) {
    Soup soup;
    for (int i = 0; i < 8; ++i) soup.points.push_back(origin + Vec3(i & 1, i >> 1 & 1, i >> 2 & 1));
    const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int side = 0; side < 6; ++side) {
        const auto& q = quads[side];
        soup.triangles.push_back({q[0], q[1], q[2]});
        soup.triangles.push_back({q[0], q[2], q[3]});
        soup.labels.insert(soup.labels.end(), 2, side);
    }
    return soup;
}

inline Soup tetrahedron_soup() {
    Soup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    soup.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return soup;
}

/// A flat square of n by n cells in the plane z = 0, facing up.
inline Soup square_soup(int n, double size = 1.0) {
    Soup soup;
    for (int y = 0; y <= n; ++y) {
        for (int x = 0; x <= n; ++x) soup.points.emplace_back(size * x / n, size * y / n, 0);
    }
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            const int a = y * (n + 1) + x;
            soup.triangles.push_back({a, a + 1, a + n + 2});
            soup.triangles.push_back({a, a + n + 2, a + n + 1});
        }
    }
    return soup;
}

/// Appends the second soup; labels must be on both or on none.
inline Soup joined(Soup one, const Soup& other) {
    const int shift = static_cast<int>(one.points.size());
    one.points.insert(one.points.end(), other.points.begin(), other.points.end());
    for (const auto& [a, b, c] : other.triangles) {
        one.triangles.push_back({a + shift, b + shift, c + shift});
    }
    one.labels.insert(one.labels.end(), other.labels.begin(), other.labels.end());
    return one;
}

/// Numbers in [0, 1) that are the same with every standard library.
class Randomness {
public:
    explicit Randomness(std::uint64_t seed) : engine_(seed) {}
    double number() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double number(double from, double to) { return from + (to - from) * number(); }
    int index(std::size_t count) { return static_cast<int>(engine_() % count); }
    Vec3 point(double from, double to) {
        const double x = number(from, to);
        const double y = number(from, to);
        return {x, y, number(from, to)};
    }

private:
    std::mt19937_64 engine_;
};

inline double volume(const Mesh& mesh) {
    double sum = 0;
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        sum += mesh.point(a).dot(mesh.point(b).cross(mesh.point(c))) / 6;
    }
    return sum;
}

inline double total_area(const Mesh& mesh) {
    double sum = 0;
    for (const auto face : mesh.faces()) sum += face_area(mesh, face);
    return sum;
}

inline long euler_characteristic(const Mesh& mesh) {
    return static_cast<long>(mesh.n_vertices()) - static_cast<long>(mesh.n_edges()) +
           static_cast<long>(mesh.n_faces());
}

inline std::size_t boundary_edge_count(const Mesh& mesh) {
    std::size_t count = 0;
    for (const auto edge : mesh.edges()) count += mesh.is_boundary(edge) ? 1 : 0;
    return count;
}

inline double smallest_angle(const Mesh& mesh) {
    double smallest = 10;
    for (const auto face : mesh.faces()) {
        const auto corners = face_vertices(mesh, face);
        for (int i = 0; i < 3; ++i) {
            const Vec3 one = mesh.point(corners[(i + 1) % 3]) - mesh.point(corners[i]);
            const Vec3 other = mesh.point(corners[(i + 2) % 3]) - mesh.point(corners[i]);
            smallest = std::min(smallest, std::atan2(one.cross(other).norm(), one.dot(other)));
        }
    }
    return smallest;
}

}  // namespace fcn::testing
