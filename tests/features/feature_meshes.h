#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn::testing {

constexpr double kDegree = std::numbers::pi / 180;

/// A height field over an nx by ny grid of unit cells, facing up; the diagonals all run one way.
inline LoadedMesh height_field(int nx, int ny, const std::function<double(double, double)>& height,
                               const std::function<int(int, int)>& label = {}) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> labels;
    for (int y = 0; y <= ny; ++y) {
        for (int x = 0; x <= nx; ++x) points.emplace_back(x, y, height(x, y));
    }
    for (int y = 0; y < ny; ++y) {
        for (int x = 0; x < nx; ++x) {
            const int a = y * (nx + 1) + x, up = a + nx + 1;
            triangles.push_back({a, a + 1, up + 1});
            triangles.push_back({a, up + 1, up});
            if (label) labels.insert(labels.end(), 2, label(x, y));
        }
    }
    return mesh_from_soup(points, triangles, labels);
}

/// A plane folded along x = fold by an angle that depends on y (radians; > 0 convex): the part
/// beyond the fold falls away.
inline LoadedMesh folded_strip(int nx, int ny, int fold,
                               const std::function<double(double)>& angle) {
    return height_field(nx, ny, [&](double x, double y) {
        return x <= fold ? 0.0 : -(x - fold) * std::tan(angle(y));
    });
}

inline std::set<std::pair<int, int>> edge_set(const std::vector<std::pair<int, int>>& edges) {
    std::set<std::pair<int, int>> result;
    for (const auto& [a, b] : edges) result.insert(std::minmax(a, b));
    return result;
}

/// Everything wrong with a network, in one string; empty is right.
inline std::string problems_of(const FeatureCurveNetwork& network, const Mesh& mesh) {
    std::string text;
    for (const std::string& line : validate(network, mesh)) text += line + "\n";
    return text;
}

inline double length_of_kind(const FeatureCurveNetwork& network, ArcKind kind) {
    double length = 0;
    for (const NetworkArc& arc : network.arcs) length += arc.kind == kind ? arc.length() : 0;
    return length;
}

/// Distance of a point from the arcs of a network.
inline double distance_to(const FeatureCurveNetwork& network, const Vec3& point) {
    double best = 1e300;
    for (const NetworkArc& arc : network.arcs) {
        for (std::size_t i = 0; i + 1 < arc.samples.size(); ++i) {
            const Vec3& a = arc.samples[i].position;
            const Vec3 u = arc.samples[i + 1].position - a;
            const double t = std::clamp((point - a).dot(u) / u.squaredNorm(), 0.0, 1.0);
            best = std::min(best, (a + t * u - point).norm());
        }
    }
    return best;
}

}  // namespace fcn::testing
