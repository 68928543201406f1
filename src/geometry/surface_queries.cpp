// Closest-point, segment and ray queries on CGAL's AABB tree. The tree is CGAL's; what happens at
// its nodes and leaves is ours: closest points descend best box first with ties going to the lowest
// face index (CGAL's own query depends on a hint), and segments are tested against triangles with
// exact predicates, so that none slips through between two faces. A ray is the segment that ends
// behind the mesh.

#include "geometry/surface_queries.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/errors.h"

namespace fcn {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Vec3 vec(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }
Exact::Point_3 exact(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

struct Corners {
    Vec3 a, b, c;
    explicit Corners(const Kernel::Triangle_3& t) : a(vec(t[0])), b(vec(t[1])), c(vec(t[2])) {}
    Vec3 at(const Vec3& barycentric) const {
        return barycentric[0] * a + barycentric[1] * b + barycentric[2] * c;
    }
};

double ratio(double part, double whole) {
    return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0;
}

/// Barycentric coordinates of the point of a triangle closest to p, by Voronoi regions.
Vec3 closest_barycentric(const Corners& t, const Vec3& p) {
    const Vec3 ab = t.b - t.a;
    const Vec3 ac = t.c - t.a;
    const Vec3 ap = p - t.a;
    const double d1 = ab.dot(ap);
    const double d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const Vec3 bp = p - t.b;
    const double d3 = ab.dot(bp);
    const double d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double v = ratio(d1, d1 - d3);
        return {1 - v, v, 0};
    }
    const Vec3 cp = p - t.c;
    const double d5 = ab.dot(cp);
    const double d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double w = ratio(d2, d2 - d6);
        return {1 - w, 0, w};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = ratio(d4 - d3, (d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    const double v = ratio(vb, sum);
    const double w = std::min(ratio(vc, sum), 1 - v);
    return {1 - v - w, v, w};
}

double squared_distance(const Vec3& p, const CGAL::Bbox_3& box) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double gap = std::max({box.min(axis) - p[axis], p[axis] - box.max(axis), 0.0});
        sum += gap * gap;
    }
    return sum;
}

class ClosestTraversal {
public:
    using Priority = double;

    explicit ClosestTraversal(const Triangles& triangles,
                              double square_reach = std::numeric_limits<double>::infinity())
        : triangles_(triangles), best_distance_(square_reach) {}

    static constexpr bool go_further() { return true; }

    void intersection(const Vec3& query, const Primitive& primitive) {
        const int face = static_cast<int>(primitive.id() - triangles_.begin());
        const Corners corners(*primitive.id());
        const Vec3 barycentric = closest_barycentric(corners, query);
        const double distance = (corners.at(barycentric) - query).squaredNorm();
        if (distance > best_distance_ || (distance == best_distance_ && face > best_.face)) return;
        best_distance_ = distance;
        best_ = {face, barycentric};
    }

    template <typename Node>
    bool do_intersect(const Vec3& query, const Node& node) const {
        return squared_distance(query, node.bbox()) <= best_distance_;
    }

    template <typename Node>
    std::pair<bool, Priority> do_intersect_with_priority(const Vec3& query,
                                                         const Node& node) const {
        const double distance = squared_distance(query, node.bbox());
        return {distance <= best_distance_, -distance};
    }

    const SurfacePoint& best() const { return best_; }

private:
    const Triangles& triangles_;
    SurfacePoint best_;
    double best_distance_;  ///< squared
};

struct Segment {
    Vec3 from, to;
    Exact::Segment_3 exact_segment;
    Segment(const Vec3& begin, const Vec3& end)
        : from(begin), to(end), exact_segment(exact(begin), exact(end)) {}
};

/// Parameter interval of the segment inside a box, widened by rounding; empty if first > second.
std::pair<double, double> clip(const Segment& segment, const CGAL::Bbox_3& box) {
    double enter = 0;
    double leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double start = segment.from[axis];
        const double run = segment.to[axis] - start;
        if (run == 0) {
            if (start < box.min(axis) || start > box.max(axis)) return {1, 0};
            continue;
        }
        double first = (box.min(axis) - start) / run;
        double second = (box.max(axis) - start) / run;
        if (first > second) std::swap(first, second);
        constexpr double kSlack = 8 * std::numeric_limits<double>::epsilon();
        enter = std::max(enter, first - kSlack * (1 + std::abs(first)));
        leave = std::min(leave, second + kSlack * (1 + std::abs(second)));
    }
    return {enter, leave};
}

/// First parameter at which a segment in the triangle's plane is inside the triangle.
double coplanar_entry(const Corners& t, const Vec3& from, const Vec3& to) {
    const Vec3 normal = (t.b - t.a).cross(t.c - t.a);
    double enter = 0;
    for (const auto& [start, end] :
         {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)}) {
        const Vec3 inward = normal.cross(end - start);
        const double at_from = inward.dot(from - start);
        const double at_to = inward.dot(to - start);
        if (at_from < 0 && at_to > at_from) enter = std::max(enter, at_from / (at_from - at_to));
    }
    return std::clamp(enter, 0.0, 1.0);
}

/// Parameter of the meeting point of a segment and a triangle that are known to meet.
double meeting_parameter(const Corners& t, const Segment& segment) {
    const auto a = exact(t.a);
    const auto b = exact(t.b);
    const auto c = exact(t.c);
    const auto side_from = CGAL::orientation(a, b, c, segment.exact_segment.source());
    const auto side_to = CGAL::orientation(a, b, c, segment.exact_segment.target());
    if (side_from == CGAL::COPLANAR && side_to == CGAL::COPLANAR) {
        return coplanar_entry(t, segment.from, segment.to);
    }
    if (side_from == CGAL::COPLANAR) return 0;
    if (side_to == CGAL::COPLANAR) return 1;
    const Vec3 normal = (t.b - t.a).cross(t.c - t.a);
    const double height_from = normal.dot(segment.from - t.a);
    const double height_to = normal.dot(segment.to - t.a);
    if (height_from == height_to) return coplanar_entry(t, segment.from, segment.to);
    return std::clamp(height_from / (height_from - height_to), 0.0, 1.0);
}

class SegmentTraversal {
public:
    using Priority = double;

    /// With `is_first_only` hits behind the first one beyond `min_parameter` may be left out.
    SegmentTraversal(const Triangles& triangles, bool is_first_only, double min_parameter)
        : triangles_(triangles), is_first_only_(is_first_only), min_parameter_(min_parameter) {}

    static constexpr bool go_further() { return true; }

    void intersection(const Segment& query, const Primitive& primitive) {
        const Kernel::Triangle_3& triangle = *primitive.id();
        const auto [enter, leave] = clip(query, triangle.bbox());
        if (enter > leave || enter > limit_) return;
        const Corners corners(triangle);
        const Exact::Triangle_3 exact_triangle(exact(corners.a), exact(corners.b),
                                               exact(corners.c));
        if (exact_triangle.is_degenerate() ||
            !CGAL::do_intersect(query.exact_segment, exact_triangle)) {
            return;
        }
        const double parameter = meeting_parameter(corners, query);
        if (is_first_only_) {
            if (parameter <= min_parameter_ || parameter > limit_) return;
            limit_ = parameter;
        }
        RayHit hit;
        hit.surface.face = static_cast<int>(primitive.id() - triangles_.begin());
        hit.surface.barycentric =
            closest_barycentric(corners, query.from + parameter * (query.to - query.from));
        hit.position = corners.at(hit.surface.barycentric);
        hit.distance = parameter * (query.to - query.from).norm();
        hits_.push_back(hit);
    }

    template <typename Node>
    bool do_intersect(const Segment& query, const Node& node) const {
        return do_intersect_with_priority(query, node).first;
    }

    template <typename Node>
    std::pair<bool, Priority> do_intersect_with_priority(const Segment& query,
                                                         const Node& node) const {
        const auto [enter, leave] = clip(query, node.bbox());
        return {enter <= leave && enter <= limit_, -enter};
    }

    /// By distance, then face.
    std::vector<RayHit> sorted_hits() && {
        std::sort(hits_.begin(), hits_.end(), [](const RayHit& one, const RayHit& other) {
            return one.distance != other.distance ? one.distance < other.distance
                                                  : one.surface.face < other.surface.face;
        });
        return std::move(hits_);
    }

private:
    const Triangles& triangles_;
    std::vector<RayHit> hits_;
    bool is_first_only_;
    double min_parameter_;
    double limit_ = 1;
};

}  // namespace

struct SurfaceQueries::Tree {
    const Mesh* mesh = nullptr;
    Triangles triangles;
    fcn::Tree boxes;
};

SurfaceQueries::SurfaceQueries(const Mesh& mesh) : tree_(std::make_unique<Tree>()) {
    if (mesh.n_faces() == 0) throw InputError("surface queries need a mesh with faces");
    tree_->mesh = &mesh;
    tree_->triangles.reserve(mesh.n_faces());
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        const auto corner = [&](VertexHandle vertex) {
            const Vec3& p = mesh.point(vertex);
            return Kernel::Point_3(p.x(), p.y(), p.z());
        };
        tree_->triangles.emplace_back(corner(a), corner(b), corner(c));
    }
    tree_->boxes.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
    tree_->boxes.do_not_accelerate_distance_queries();
    tree_->boxes.build();
}

SurfaceQueries::~SurfaceQueries() = default;
SurfaceQueries::SurfaceQueries(SurfaceQueries&&) noexcept = default;
SurfaceQueries& SurfaceQueries::operator=(SurfaceQueries&&) noexcept = default;

const Mesh& SurfaceQueries::mesh() const { return *tree_->mesh; }

ClosestPoint SurfaceQueries::closest(const Vec3& point) const {
    if (!point.allFinite()) throw InputError("closest point: the query is not finite");
    ClosestTraversal traversal(tree_->triangles);
    tree_->boxes.traversal_with_priority(point, traversal);
    ClosestPoint result;
    result.surface = traversal.best();
    result.position = fcn::position(*tree_->mesh, result.surface);
    result.distance = (result.position - point).norm();
    return result;
}

std::optional<ClosestPoint> SurfaceQueries::closest_within(const Vec3& point, double reach) const {
    if (!point.allFinite()) throw InputError("closest point: the query is not finite");
    if (!(reach >= 0)) return std::nullopt;
    // Rounding of the square must not lose what is just within reach.
    ClosestTraversal traversal(tree_->triangles, reach * reach * (1 + 1e-12));
    tree_->boxes.traversal_with_priority(point, traversal);
    if (traversal.best().face < 0) return std::nullopt;
    ClosestPoint result;
    result.surface = traversal.best();
    result.position = fcn::position(*tree_->mesh, result.surface);
    result.distance = (result.position - point).norm();
    return result.distance <= reach ? std::optional(result) : std::nullopt;
}

std::vector<RayHit> SurfaceQueries::intersect_segment(const Vec3& from, const Vec3& to) const {
    if (!from.allFinite() || !to.allFinite()) {
        throw InputError("segment query: an end is not finite");
    }
    SegmentTraversal traversal(tree_->triangles, false, 0);
    tree_->boxes.traversal_with_priority(Segment(from, to), traversal);
    return std::move(traversal).sorted_hits();
}

std::optional<RayHit> SurfaceQueries::first_hit(const Vec3& origin, const Vec3& direction,
                                                double min_distance) const {
    const double length = direction.norm();
    if (!(length > 0) || !std::isfinite(length) || !origin.allFinite()) {
        throw InputError("first hit: the direction has no length or the ray is not finite");
    }
    const CGAL::Bbox_3 box = tree_->boxes.bbox();
    const Vec3 low(box.xmin(), box.ymin(), box.zmin());
    const Vec3 high(box.xmax(), box.ymax(), box.zmax());
    // Long enough to leave the box from wherever the ray starts.
    const double reach = 2 * ((high - low).norm() + (0.5 * (low + high) - origin).norm());
    const Vec3 end = origin + direction * (reach / length);
    const double run = (end - origin).norm();
    if (!std::isfinite(run)) throw InputError("first hit: the ray starts too far away");
    if (min_distance >= run) return std::nullopt;
    // A hit at the origin itself counts only for a negative least distance.
    SegmentTraversal traversal(tree_->triangles, true, min_distance / run);
    tree_->boxes.traversal_with_priority(Segment(origin, end), traversal);
    const std::vector<RayHit> hits = std::move(traversal).sorted_hits();
    if (hits.empty()) return std::nullopt;
    return hits.front();
}

}  // namespace fcn
