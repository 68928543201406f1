// Self-intersections by boxes and exact predicates (Zomorodian, Edelsbrunner 2002, "Fast software
// for box intersections", as CGAL has it). Triangles that share corners always meet, so those are
// asked whether they meet anywhere else: two that share an edge if one is folded onto the other,
// two that share a vertex if the far side of either reaches the other.
#include "meshing/self_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fcn {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;

/// Squared sine of the angle below which triangles at an edge count as folded onto each other: in
/// a plane that is not parallel to the axes rounding leaves that much.
constexpr double kFlat = 1e-9;

Point to_point(const Vec3& p) { return {p[0], p[1], p[2]}; }

/// A triangle's corners, those that another one has too first.
struct Corners {
    std::array<int, 3> names;
    std::array<Vec3, 3> points;
    int shared = 0;

    Corners(const std::array<int, 3>& own, const std::array<Vec3, 3>& own_points,
            const std::array<int, 3>& other)
        : names(own), points(own_points) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (std::find(other.begin(), other.end(), names[i]) == other.end()) continue;
            std::swap(names[i], names[static_cast<std::size_t>(shared)]);
            std::swap(points[i], points[static_cast<std::size_t>(shared)]);
            ++shared;
        }
    }
    Triangle triangle() const {
        return {to_point(points[0]), to_point(points[1]), to_point(points[2])};
    }
    /// The side across from the first corner.
    Segment far_side() const { return {to_point(points[1]), to_point(points[2])}; }
};

/// Whether the box or the plane of a triangle tells it apart from the corners of another one from
/// `first` on, with room for rounding.
bool are_apart(const std::array<Vec3, 3>& one, const std::array<Vec3, 3>& other,
               std::size_t first = 0) {
    const Vec3 low = one[0].cwiseMin(one[1]).cwiseMin(one[2]);
    const Vec3 high = one[0].cwiseMax(one[1]).cwiseMax(one[2]);
    for (int k = 0; k < 3; ++k) {
        const double before = first == 0 ? other[0][k] : other[1][k];
        if (std::max({before, other[1][k], other[2][k]}) < low[k] ||
            std::min({before, other[1][k], other[2][k]}) > high[k])
            return true;
    }
    const Vec3 u = one[1] - one[0], v = one[2] - one[0];
    const Vec3 normal = u.cross(v);
    double least = std::numeric_limits<double>::infinity(), most = -least, size = 0;
    for (std::size_t i = first; i < 3; ++i) {
        const Vec3 w = other[i] - one[0];
        const double side = normal.dot(w);
        least = std::min(least, side);
        most = std::max(most, side);
        size = std::max({size, w.squaredNorm(), u.squaredNorm(), v.squaredNorm()});
    }
    const double margin = 1e-13 * size * std::sqrt(size);
    return least > margin || most < -margin;
}

bool do_far_side_and_triangle_meet(const Corners& one, const Corners& other) {
    return !are_apart(other.points, one.points, 1) &&
           CGAL::do_intersect(one.far_side(), other.triangle());
}

class Finder {
public:
    Finder(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles)
        : points_(points), triangles_(triangles) {}

    std::vector<std::array<int, 2>> run() const {
        using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, int>;
        std::vector<Box> boxes;
        boxes.reserve(triangles_.size());
        for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
            const Triangle triangle = triangle_of(t);
            if (!triangle.is_degenerate()) boxes.emplace_back(triangle.bbox(), t);
        }
        std::vector<std::array<int, 2>> pairs;
        CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
            if (do_triangles_cross(corners(a.info()), points_of(a.info()), corners(b.info()),
                                   points_of(b.info())))
                pairs.push_back({std::min(a.info(), b.info()), std::max(a.info(), b.info())});
        });
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

private:
    const Vec3& point_of(int v) const { return points_[static_cast<std::size_t>(v)]; }
    const std::array<int, 3>& corners(int t) const {
        return triangles_[static_cast<std::size_t>(t)];
    }
    std::array<Vec3, 3> points_of(int t) const {
        const auto& [a, b, c] = corners(t);
        return {point_of(a), point_of(b), point_of(c)};
    }
    Triangle triangle_of(int t) const {
        const auto [a, b, c] = points_of(t);
        return {to_point(a), to_point(b), to_point(c)};
    }

    const std::vector<Vec3>& points_;
    const std::vector<std::array<int, 3>>& triangles_;
};

}  // namespace

bool do_triangles_cross(const std::array<int, 3>& one, const std::array<Vec3, 3>& points_of_one,
                        const std::array<int, 3>& other,
                        const std::array<Vec3, 3>& points_of_other) {
    const Corners a(one, points_of_one, other), b(other, points_of_other, one);
    if (a.shared == 3) return true;
    if (a.shared == 2) {
        // Folded onto each other; elsewhere they meet in their edge alone.
        const Vec3 edge = a.points[1] - a.points[0];
        const Vec3 n = edge.cross(a.points[2] - a.points[0]);
        const Vec3 m = edge.cross(b.points[2] - a.points[0]);
        const double dot = n.dot(m);
        if (dot < 0) return false;
        if (dot > 0 && dot * dot >= (1 - kFlat) * n.squaredNorm() * m.squaredNorm()) return true;
        const Point p = to_point(a.points[0]), q = to_point(a.points[1]), c = to_point(a.points[2]),
                    d = to_point(b.points[2]);
        return CGAL::coplanar(p, q, c, d) &&
               CGAL::coplanar_orientation(p, q, c, d) == CGAL::POSITIVE;
    }
    if (a.shared == 1)
        return do_far_side_and_triangle_meet(a, b) || do_far_side_and_triangle_meet(b, a);
    if (are_apart(a.points, b.points) || are_apart(b.points, a.points)) return false;
    const Triangle first = a.triangle(), second = b.triangle();
    return !first.is_degenerate() && !second.is_degenerate() && CGAL::do_intersect(first, second);
}

std::vector<std::array<int, 2>> self_intersections(
    const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles) {
    return Finder(points, triangles).run();
}

std::vector<std::array<int, 2>> self_intersections(const Mesh& mesh) {
    std::vector<Vec3> points;
    points.reserve(mesh.n_vertices());
    for (const VertexHandle v : mesh.vertices()) points.push_back(mesh.point(v));
    std::vector<std::array<int, 3>> triangles;
    triangles.reserve(mesh.n_faces());
    for (const FaceHandle f : mesh.faces()) {
        const auto v = face_vertices(mesh, f);
        triangles.push_back({v[0].idx(), v[1].idx(), v[2].idx()});
    }
    return self_intersections(points, triangles);
}

}  // namespace fcn
