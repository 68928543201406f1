#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "meshing/corner_map.h"
#include "meshing/quad_mesh.h"
#include "sample_quads.h"

namespace fcn::test {

/// A triangle mesh and a map of it whose quads are known.
struct MappedMesh {
    Mesh mesh;
    CornerMap map;
};

struct PatchOptions {
    int cells = 4;            ///< pairs of triangles along the side of a patch
    int squares = 3;          ///< of the grid along it
    double jitter = 0;        ///< of inner vertices, in cells; under 0.3 nothing turns over
    bool is_turning = false;  ///< every triangle gets a chart of its own, turned and shifted
    unsigned seed = 1;
};

/// Point of a quad with corners p: bilinear.
inline Vec3 point_of_patch(const std::array<Vec3, 4>& p, double s, double t) {
    return (1 - s) * (1 - t) * p[0] + s * (1 - t) * p[1] + s * t * p[2] + (1 - s) * t * p[3];
}

inline std::array<Vec3, 4> corners_of(const QuadMesh& mesh, std::size_t f) {
    std::array<Vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i)
        corners[i] = mesh.points[static_cast<std::size_t>(mesh.faces[f][i])];
    return corners;
}

/// Triangulates each quad of `patches` and maps it to a square of the grid. Coordinates are
/// multiples of 2^-20.
inline MappedMesh mapped_patches(const QuadMesh& patches, const PatchOptions& options) {
    MappedMesh result;
    std::mt19937 random(options.seed);
    const int n = options.cells;
    const auto rounded = [](double x) { return std::ldexp(std::round(std::ldexp(x, 20)), -20); };
    const auto station = [&](int i) {
        const auto first = [&](int k) { return rounded(double(options.squares) * k / n); };
        return 2 * i <= n ? first(i) : options.squares - first(n - i);
    };
    std::map<std::array<int, 3>, int> known;  // vertices on edges, counted from the lower corner
    std::vector<std::pair<int, Vec2>> grid;
    const auto number = [&](int f, const std::array<int, 4>& quad, int i, int j, const Vec2& uv) {
        std::array<int, 3> key{-1 - f, i, j};
        const auto on_edge = [&](int a, int b, int k) {
            key = k == 0   ? std::array{a, a, 0}
                  : k == n ? std::array{b, b, 0}
                  : a < b  ? std::array{a, b, k}
                           : std::array{b, a, n - k};
        };
        if (j == 0)
            on_edge(quad[0], quad[1], i);
        else if (i == n)
            on_edge(quad[1], quad[2], j);
        else if (j == n)
            on_edge(quad[3], quad[2], i);
        else if (i == 0)
            on_edge(quad[0], quad[3], j);
        const auto [it, is_new] =
            known.try_emplace(key, static_cast<int>(result.mesh.n_vertices()));
        if (is_new) {
            const double size = options.squares;
            result.mesh.add_vertex(point_of_patch(corners_of(patches, static_cast<std::size_t>(f)),
                                                  uv[0] / size, uv[1] / size));
        }
        return it->second;
    };
    const auto add = [&](const std::array<std::pair<int, Vec2>, 3>& corners) {
        const FaceHandle face =
            result.mesh.add_face(VertexHandle(corners[0].first), VertexHandle(corners[1].first),
                                 VertexHandle(corners[2].first));
        const int turns = options.is_turning ? static_cast<int>(random() % 4) : 0;
        const Vec2 shift = options.is_turning ? Vec2(static_cast<int>(random() % 19) - 9,
                                                     static_cast<int>(random() % 19) - 9)
                                              : Vec2(0, 0);
        auto& uv = result.map.uv.emplace_back();
        const auto order = face_vertices(result.mesh, face);
        for (std::size_t i = 0; i < 3; ++i)
            for (const auto& [vertex, image] : corners)
                if (order[i].idx() == vertex) uv[i] = turned(image, turns) + shift;
    };
    for (int f = 0; f < static_cast<int>(patches.faces.size()); ++f) {
        grid.clear();
        for (int j = 0; j <= n; ++j) {
            for (int i = 0; i <= n; ++i) {
                Vec2 uv(station(i), station(j));
                if (i % n != 0 && j % n != 0) {
                    std::uniform_real_distribution<double> push(-options.jitter, options.jitter);
                    const double cell = double(options.squares) / n;
                    uv += Vec2(rounded(cell * push(random)), rounded(cell * push(random)));
                }
                grid.emplace_back(number(f, patches.faces[static_cast<std::size_t>(f)], i, j, uv),
                                  uv);
            }
        }
        const auto at = [&](int i, int j) {
            return grid[static_cast<std::size_t>(j * (n + 1) + i)];
        };
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                const auto a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
                if (random() % 2 == 0) {
                    add({a, b, c});
                    add({a, c, d});
                } else {
                    add({a, b, d});
                    add({b, c, d});
                }
            }
        }
    }
    return result;
}

inline bool are_parallelograms(const QuadMesh& mesh) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto p = corners_of(mesh, f);
        if ((p[0] - p[1] + p[2] - p[3]).norm() > 1e-9) return false;
    }
    return true;
}

/// Faces as positions, rounded, each beginning at its smallest; sorted.
using FacePositions = std::multiset<std::array<std::array<long, 3>, 4>>;
inline void add_face(FacePositions& faces, const std::array<Vec3, 4>& corners) {
    std::array<std::array<long, 3>, 4> face;
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k)
            face[i][static_cast<std::size_t>(k)] = std::lround(corners[i][k] * 1e7);
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    faces.insert(face);
}
inline FacePositions positions_of(const QuadMesh& mesh) {
    FacePositions faces;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) add_face(faces, corners_of(mesh, f));
    return faces;
}
/// What the grid cuts mapped_patches() into.
inline FacePositions expected_faces(const QuadMesh& patches, int squares) {
    FacePositions faces;
    for (std::size_t f = 0; f < patches.faces.size(); ++f) {
        const auto at = [&](int i, int j) {
            return point_of_patch(corners_of(patches, f), double(i) / squares, double(j) / squares);
        };
        for (int j = 0; j < squares; ++j)
            for (int i = 0; i < squares; ++i)
                add_face(faces, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    return faces;
}

/// `sectors` unit rhombi around the origin: a disk around a vertex of that valence.
inline QuadMesh quad_fan(int sectors) {
    QuadMesh mesh;
    mesh.points.emplace_back(0, 0, 0);
    const auto arm = [&](int i) {
        const double angle = 2 * std::numbers::pi * i / sectors;
        return Vec3(std::cos(angle), std::sin(angle), 0);
    };
    for (int i = 0; i < sectors; ++i) {
        mesh.points.push_back(arm(i));
        mesh.points.push_back(arm(i) + arm(i + 1));
    }
    for (int i = 0; i < sectors; ++i)
        mesh.faces.push_back({0, 1 + 2 * i, 2 + 2 * i, 1 + 2 * ((i + 1) % sectors)});
    return mesh;
}

/// Unit cubes at whole places, their surface facing outward.
inline QuadMesh quad_blocks(const std::set<std::array<int, 3>>& blocks) {
    QuadMesh mesh;
    std::map<std::array<int, 3>, int> known;
    const auto corner = [&](const std::array<int, 3>& p) {
        const auto [it, is_new] = known.try_emplace(p, static_cast<int>(mesh.points.size()));
        if (is_new) mesh.points.emplace_back(p[0], p[1], p[2]);
        return it->second;
    };
    for (const auto& block : blocks) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const int side : {0, 1}) {
                auto beside = block;
                beside[axis] += side == 1 ? 1 : -1;
                if (blocks.contains(beside)) continue;
                auto p = block;
                p[axis] += side;
                const std::size_t u = (axis + (side == 1 ? 1 : 2)) % 3;
                const std::size_t v = (axis + (side == 1 ? 2 : 1)) % 3;
                std::array<int, 4> face{};
                face[0] = corner(p);
                ++p[u];
                face[1] = corner(p);
                ++p[v];
                face[2] = corner(p);
                --p[u];
                face[3] = corner(p);
                mesh.faces.push_back(face);
            }
        }
    }
    return mesh;
}

}  // namespace fcn::test
