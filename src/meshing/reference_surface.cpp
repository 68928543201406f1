// Closest points on one sheet of a surface. The tree halves triangles at the median of their
// centres along the longest side of the box of centres; its nodes lie in depth-first order with
// boxes of single precision, rounded outwards, so that two of them share a cache line. A search
// begins with the triangle where the last one for this vertex ended: what is left to do is to prove
// that nothing is closer. Faces that look away from the asker's normal do not count, or vertices
// of a thin wall would swap sides (the one thing that a plain closest-point query, as in
// geometry/surface_queries, cannot say). A cone around the normals below each node skips the far
// side of the wall as a whole.
#include "meshing/reference_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr int kLeafSize = 4;
constexpr int kMaxDepth = 64;

double ratio(double part, double whole) {
    return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0;
}

/// The point of the triangle a, a + ab, a + ac closest to p, by regions (Ericson 2005, 5.1.5).
Vec3 closest_in_triangle(const Vec3& a, const Vec3& ab, const Vec3& ac, const Vec3& p) {
    const Vec3 ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm();
    const double d3 = d1 - bb, d4 = d2 - bc;  // the same dot products from corner b
    if (d3 >= 0 && d4 <= d3) return a + ab;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ratio(d1, d1 - d3) * ab;
    const double d5 = d1 - bc, d6 = d2 - cc;
    if (d6 >= 0 && d5 <= d6) return a + ac;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ratio(d2, d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return a + ab + ratio(d4 - d3, (d4 - d3) + (d5 - d6)) * (ac - ab);
    const double sum = va + vb + vc;
    return a + ratio(vb, sum) * ab + ratio(vc, sum) * ac;
}

float rounded_down(double x) {
    return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float rounded_up(double x) {
    return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

std::vector<std::array<Vec3, 3>> corners_of(const Mesh& mesh) {
    std::vector<std::array<Vec3, 3>> corners;
    corners.reserve(mesh.n_faces());
    for (const FaceHandle face : mesh.faces()) {
        const auto v = face_vertices(mesh, face);
        corners.push_back({mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2])});
    }
    return corners;
}

}  // namespace

struct ReferenceSurface::Item {
    std::array<float, 3> center;
    int face;
};

ReferenceSurface::ReferenceSurface(const Mesh& mesh) : ReferenceSurface(corners_of(mesh)) {}

ReferenceSurface::ReferenceSurface(const std::vector<std::array<Vec3, 3>>& corners) {
    const std::size_t count = corners.size();
    if (count == 0) throw InputError("reference surface: the mesh has no faces");
    std::vector<Item> items(count);
    triangles_.resize(count);
    for (std::size_t f = 0; f < count; ++f) {
        const auto& [a, b, c] = corners[f];
        const Vec3 center = (a + b + c) / 3;
        items[f].face = static_cast<int>(f);
        for (std::size_t i = 0; i < 3; ++i)
            items[f].center[i] = static_cast<float>(center[static_cast<int>(i)]);
        triangles_[f] = {a, b - a, c - a};
    }
    nodes_.reserve(count);
    build(items, 0, static_cast<int>(count));

    std::vector<Triangle> ordered(count);
    normals_.resize(count);
    faces_.resize(count);
    slots_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto face = static_cast<std::size_t>(items[i].face);
        ordered[i] = triangles_[face];
        const Vec3 cross = ordered[i].ab.cross(ordered[i].ac);
        const double norm = cross.norm();
        normals_[i] = norm > 0 ? Vec3(cross / norm) : Vec3(Vec3::Zero());
        faces_[i] = items[i].face;
        slots_[face] = static_cast<int>(i);
    }
    triangles_ = std::move(ordered);
    cones_.resize(nodes_.size());
    add_cones(0);
}

/// Fills the cones of a subtree, from the leaves up; returns the half angle of its node's.
double ReferenceSurface::add_cones(int index) {
    constexpr double kRounding = 1e-3;
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    const auto axis_of = [&](int of) {
        const auto& axis = cones_[static_cast<std::size_t>(of)].axis;
        return Vec3(axis[0], axis[1], axis[2]);
    };
    const auto angle = [](const Vec3& a, const Vec3& b) {
        return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
    };
    Vec3 axis = Vec3::Zero();
    double half = 0;
    if (node.count > 0) {
        for (int i = node.begin; i < node.begin + node.count; ++i)
            axis += normals_[static_cast<std::size_t>(i)];
        axis.normalize();
        for (int i = node.begin; i < node.begin + node.count; ++i) {
            const Vec3& normal = normals_[static_cast<std::size_t>(i)];
            // A triangle without a normal counts from everywhere.
            half = std::max(half, normal.isZero(0) ? std::numbers::pi : angle(axis, normal));
        }
        half += kRounding;
    } else {
        const double left = add_cones(index + 1), right = add_cones(node.begin);
        axis = (axis_of(index + 1) + axis_of(node.begin)).normalized();
        half = std::max(left + angle(axis, axis_of(index + 1)),
                        right + angle(axis, axis_of(node.begin)));
    }
    if (!(half < std::numbers::pi) || axis.isZero(0)) half = std::numbers::pi;
    Cone& cone = cones_[static_cast<std::size_t>(index)];
    for (std::size_t k = 0; k < 3; ++k)
        cone.axis[k] = static_cast<float>(axis[static_cast<int>(k)]);
    cone.cosine = static_cast<float>(std::cos(half));
    cone.sine = static_cast<float>(std::sin(half));
    if (half == std::numbers::pi) cone.sine = 0;
    return half;
}

bool ReferenceSurface::is_any_facing(const Vec3& point, const Vec3& normal, double reach,
                                     double least_cosine) const {
    const double square_reach = reach * reach;
    const double wide_sine = std::sqrt(std::max(0.0, 1 - least_cosine * least_cosine));
    const auto is_worth = [&](std::size_t index) {
        double gaps = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = point[static_cast<int>(k)];
            const double gap = std::max({nodes_[index].low[k] - x, x - nodes_[index].high[k], 0.0});
            gaps += gap * gap;
        }
        if (gaps >= square_reach) return false;
        const Cone& cone = cones_[index];
        const double sine = cone.sine * least_cosine + cone.cosine * wide_sine;
        if (!(sine > 0)) return true;  // together half a turn and more
        const double along =
            cone.axis[0] * normal[0] + cone.axis[1] * normal[1] + cone.axis[2] * normal[2];
        return along >= cone.cosine * least_cosine - cone.sine * wide_sine;
    };
    std::array<std::size_t, kMaxDepth> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::size_t index = stack[--depth];
        if (!is_worth(index)) continue;
        const Node& node = nodes_[index];
        if (node.count == 0) {
            stack[depth++] = static_cast<std::size_t>(node.begin);
            stack[depth++] = index + 1;
            continue;
        }
        for (int k = 0; k < node.count; ++k) {
            const auto i = static_cast<std::size_t>(node.begin + k);
            if (!(normals_[i].dot(normal) > least_cosine)) continue;
            const Triangle& t = triangles_[i];
            if ((closest_in_triangle(t.a, t.ab, t.ac, point) - point).squaredNorm() < square_reach)
                return true;
        }
    }
    return false;
}

/// Builds the subtree over items [begin, end), which it reorders; returns its node.
int ReferenceSurface::build(std::vector<Item>& items, int begin, int end) {
    const int index = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec3 low = Vec3::Constant(kInfinity), high = -low;
    std::array<float, 3> center_low{}, center_high{};
    for (int i = begin; i < end; ++i) {
        const Item& item = items[static_cast<std::size_t>(i)];
        const Triangle& t = triangles_[static_cast<std::size_t>(item.face)];
        for (const Vec3& p : {t.a, Vec3(t.a + t.ab), Vec3(t.a + t.ac)}) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            center_low[k] = i == begin ? item.center[k] : std::min(center_low[k], item.center[k]);
            center_high[k] = i == begin ? item.center[k] : std::max(center_high[k], item.center[k]);
        }
    }
    Node node;
    for (std::size_t k = 0; k < 3; ++k) {
        node.low[k] = rounded_down(low[static_cast<int>(k)]);
        node.high[k] = rounded_up(high[static_cast<int>(k)]);
    }
    if (end - begin <= kLeafSize) {
        node.begin = begin;
        node.count = end - begin;
        nodes_[static_cast<std::size_t>(index)] = node;
        return index;
    }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (center_high[k] - center_low[k] > center_high[axis] - center_low[axis]) axis = k;
    const int middle = (begin + end) / 2;
    std::nth_element(items.begin() + begin, items.begin() + middle, items.begin() + end,
                     [axis](const Item& one, const Item& other) {
                         return one.center[axis] != other.center[axis]
                                    ? one.center[axis] < other.center[axis]
                                    : one.face < other.face;
                     });
    build(items, begin, middle);
    node.begin = build(items, middle, end);
    nodes_[static_cast<std::size_t>(index)] = node;
    return index;
}

ReferencePoint ReferenceSurface::closest(const Vec3& point, const Vec3& normal, double reach,
                                         int hint, double least_cosine) const {
    const bool is_any_sheet = normal.isZero(0);
    ReferencePoint best;
    double best_square = reach * reach;
    const auto try_triangle = [&](std::size_t i) {
        if (!is_any_sheet && !(normals_[i].dot(normal) > least_cosine)) return;
        const Triangle& t = triangles_[i];
        const Vec3 nearest = closest_in_triangle(t.a, t.ab, t.ac, point);
        const double square = (nearest - point).squaredNorm();
        if (square >= best_square) return;
        best_square = square;
        best.face = faces_[i];
        best.position = nearest;
    };
    if (hint >= 0) try_triangle(slot(hint));

    const auto box_square = [&](const Node& node) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = point[static_cast<int>(k)];
            const double gap = std::max({node.low[k] - x, x - node.high[k], 0.0});
            sum += gap * gap;
        }
        return sum;
    };
    // Of the largest angle from `normal` at which a triangle counts.
    const double length = normal.norm();
    const double wide_cosine = is_any_sheet ? -1 : std::max(-1.0, least_cosine / length);
    const double wide_sine = std::sqrt(std::max(0.0, 1 - wide_cosine * wide_cosine));
    const auto looks_away = [&](int index) {
        const Cone& cone = cones_[static_cast<std::size_t>(index)];
        const double sine = cone.sine * wide_cosine + cone.cosine * wide_sine;
        if (!(sine > 0)) return false;  // together half a turn and more
        const double along =
            cone.axis[0] * normal[0] + cone.axis[1] * normal[1] + cone.axis[2] * normal[2];
        return along < (cone.cosine * wide_cosine - cone.sine * wide_sine) * length;
    };
    std::array<std::pair<double, int>, kMaxDepth> stack;
    std::size_t depth = 0;
    stack[depth++] = {box_square(nodes_[0]), 0};
    while (depth > 0) {
        const auto [square, index] = stack[--depth];
        if (square >= best_square || looks_away(index)) continue;
        const Node& node = nodes_[static_cast<std::size_t>(index)];
        if (node.count > 0) {
            for (int i = 0; i < node.count; ++i)
                try_triangle(static_cast<std::size_t>(node.begin + i));
            continue;
        }
        std::pair<double, int> near{box_square(nodes_[static_cast<std::size_t>(index) + 1]),
                                    index + 1};
        std::pair<double, int> far{box_square(nodes_[static_cast<std::size_t>(node.begin)]),
                                   node.begin};
        if (far.first < near.first) std::swap(near, far);
        if (far.first < best_square) stack[depth++] = far;
        if (near.first < best_square) stack[depth++] = near;
    }
    if (best.face >= 0) best.distance = std::sqrt(best_square);
    return best;
}

}  // namespace fcn
