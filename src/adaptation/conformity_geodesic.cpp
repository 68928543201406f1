// Exact surface distances on a triangle mesh between two nearby points.
//
// Windows of straight unfolded paths are propagated across edges in order of a lower bound, with
// the filters that keep their number small: one angle, one split (Chen and Han 1990, "Shortest
// paths on a polyhedron") and dominance by vertex distances (Xin and Wang 2009, "Improving Chen and
// Han's algorithm on the discrete geodesic problem", of whose three conditions the two along the
// window's own edge are used). Shortest paths bend only at vertices of total angle above 2 pi and
// at the boundary; those become sources again.
//
// Departures: there is one target, so a path's key is its length so far plus the straight distance
// that remains, and everything outside the ellipsoid of the best length known is never visited.
// Thin walls (DESIGN 4.3) ask whether a distance reaches 3 rmin, where the graph of edges is up to
// some 40% off on regular meshes; that is why the distance is exact here.

#include "adaptation/conformity_geodesic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "adaptation/conformity_measures.h"

namespace fcn::conformity {

namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Parameter along the line from `origin` in unit direction `direction` of the ray from `source`
/// through `through`; `fallback` when they are parallel.
double hit(const Vec2& source, const Vec2& through, const Vec2& origin, const Vec2& direction,
           double fallback) {
    const Vec2 ray = through - source;
    const double denominator = cross(direction, ray);
    return denominator != 0 ? cross(source - origin, ray) / denominator : fallback;
}

}  // namespace

Geodesics::Geodesics(const Surface& surface) : surface_(surface), mesh_(surface.mesh()) {
    const std::size_t vertex_count = mesh_.points.size();
    std::vector<double> angle(vertex_count, 0.0);
    is_bending_.assign(vertex_count, false);
    for (int h = 0; h < 3 * mesh_.face_count(); ++h) {
        const int vertex = mesh_.origin(h);
        angle[vertex] += angle_at(mesh_.points[vertex], mesh_.points[mesh_.target(h)],
                                  mesh_.points[mesh_.apex(h)]);
        if (mesh_.twins[h] < 0) {
            is_bending_[vertex] = true;
            is_bending_[mesh_.target(h)] = true;
        }
    }
    for (std::size_t v = 0; v < vertex_count; ++v) {
        if (angle[v] > 2 * std::numbers::pi + 1e-9) is_bending_[v] = true;
    }
    distances_.assign(vertex_count, 0.0);
    distance_query_.assign(vertex_count, 0);
    corner_records_.resize(3 * mesh_.faces.size());
}

double Geodesics::vertex_distance(int vertex) const {
    return distance_query_[vertex] == query_ ? distances_[vertex] : kInfinity;
}

double Geodesics::length(int halfedge) const {
    return (mesh_.points[mesh_.target(halfedge)] - mesh_.points[mesh_.origin(halfedge)]).norm();
}

Vec2 Geodesics::flatten(int halfedge, const Vec3& point) const {
    const Vec3& origin = mesh_.points[mesh_.origin(halfedge)];
    const Vec3 direction = (mesh_.points[mesh_.target(halfedge)] - origin).normalized();
    const double x = (point - origin).dot(direction);
    return {x, (point - origin - x * direction).norm()};
}

double Geodesics::distance(const Foot& from, const Foot& to, double limit) {
    ++query_;
    windows_.clear();
    queue_.clear();
    target_ = to;
    target_faces_ = touching_faces(mesh_, to);
    best_ = limit;
    for (const int face : touching_faces(mesh_, from)) {
        if (std::binary_search(target_faces_.begin(), target_faces_.end(), face)) {
            best_ = std::min(best_, (to.position - from.position).norm());
            return best_ < limit ? best_ : kInfinity;
        }
    }
    start(from);
    while (!queue_.empty()) {
        std::pop_heap(queue_.begin(), queue_.end());
        const Event event = queue_.back();
        queue_.pop_back();
        if (event.key >= best_) break;
        if (event.window >= 0) {
            const Window window = windows_[event.window];
            if (!is_useless(window)) propagate(window);
        } else if (event.distance == vertex_distance(event.vertex)) {
            expand_vertex(event.vertex);
        }
    }
    return best_ < limit ? best_ : kInfinity;
}

void Geodesics::start(const Foot& from) {
    const std::vector<int> faces = touching_faces(mesh_, from);
    if (faces.size() > 2) {  // at a vertex: the one nearest to the foot
        int nearest = mesh_.faces[from.face][0];
        for (const int vertex : mesh_.faces[from.face]) {
            if ((mesh_.points[vertex] - from.position).norm() <
                (mesh_.points[nearest] - from.position).norm()) {
                nearest = vertex;
            }
        }
        distances_[nearest] = (mesh_.points[nearest] - from.position).norm();
        distance_query_[nearest] = query_;
        expand_vertex(nearest);
        return;
    }
    for (const int face : faces) {
        int shared = -1;
        for (int h = 3 * face; h < 3 * face + 3; ++h) {
            const int twin = mesh_.twins[h];
            if (faces.size() == 2 && twin >= 0 && (twin / 3 == faces[0] || twin / 3 == faces[1])) {
                shared = h;
            }
            reach_vertex(mesh_.origin(h), (mesh_.points[mesh_.origin(h)] - from.position).norm());
        }
        add_face_source(from.position, face, shared, 0.0);
    }
}

void Geodesics::add_face_source(const Vec3& source, int face, int skipped_halfedge, double offset) {
    for (int h = 3 * face; h < 3 * face + 3; ++h) {
        const int twin = mesh_.twins[h];
        if (h == skipped_halfedge || twin < 0) continue;
        const Vec2 flat = flatten(h, source);
        const double edge = length(h);
        add_window({twin, 0.0, edge, edge - flat.x(), -flat.y(), offset});
    }
}

void Geodesics::expand_vertex(int vertex) {
    const double distance = vertex_distance(vertex);
    for (int i = mesh_.corner_offsets[vertex]; i < mesh_.corner_offsets[vertex + 1]; ++i) {
        const int corner = mesh_.corners[i];
        reach_vertex(mesh_.target(corner), distance + length(corner));
        reach_vertex(mesh_.apex(corner), distance + length(FlatMesh::previous(corner)));
        const int opposite = FlatMesh::next(corner);
        const int twin = mesh_.twins[opposite];
        if (twin < 0) continue;
        const Vec2 flat = flatten(opposite, mesh_.points[vertex]);
        const double edge = length(opposite);
        add_window({twin, 0.0, edge, edge - flat.x(), -flat.y(), distance});
    }
}

void Geodesics::reach_vertex(int vertex, double distance) {
    if (distance >= vertex_distance(vertex)) return;
    distances_[vertex] = distance;
    distance_query_[vertex] = query_;
    const double key = distance + (mesh_.points[vertex] - target_.position).norm();
    for (int i = mesh_.corner_offsets[vertex]; i < mesh_.corner_offsets[vertex + 1]; ++i) {
        const int face = mesh_.corners[i] / 3;
        if (std::binary_search(target_faces_.begin(), target_faces_.end(), face)) {
            best_ = std::min(best_, key);
        }
    }
    if (!is_bending_[vertex] || key >= best_) return;
    queue_.push_back({key, ++sequence_, -1, vertex, distance});
    std::push_heap(queue_.begin(), queue_.end());
}

void Geodesics::reach_target(const Window& window) {
    const int face = window.halfedge / 3;
    if (!std::binary_search(target_faces_.begin(), target_faces_.end(), face)) return;
    const Vec2 target = flatten(window.halfedge, target_.position);
    const Vec2 source(window.source_x, window.source_y);
    const double x = hit(source, target, Vec2::Zero(), Vec2::UnitX(), target.x());
    const double slack = 1e-9 * length(window.halfedge);
    if (x < window.first - slack || x > window.last + slack) return;
    best_ = std::min(best_, window.offset + (target - source).norm());
}

bool Geodesics::is_useless(const Window& window) const {
    const Vec2 source(window.source_x, window.source_y);
    const double edge = length(window.halfedge);
    const double to_first = window.offset + (Vec2(window.first, 0) - source).norm();
    const double to_last = window.offset + (Vec2(window.last, 0) - source).norm();
    const double slack = 1e-12 * (to_first + to_last);
    const double from_origin = vertex_distance(mesh_.origin(window.halfedge)) + window.last;
    const double from_target = vertex_distance(mesh_.target(window.halfedge)) + edge - window.first;
    return to_last > from_origin + slack || to_first > from_target + slack;
}

void Geodesics::add_window(const Window& window) {
    reach_target(window);
    const Vec3& origin = mesh_.points[mesh_.origin(window.halfedge)];
    const Vec3 direction = (mesh_.points[mesh_.target(window.halfedge)] - origin).normalized();
    const Vec3 first = origin + window.first * direction;
    const Vec3 last = origin + window.last * direction;
    const double x = std::clamp(window.source_x, window.first, window.last);
    const double so_far = std::hypot(x - window.source_x, window.source_y);
    const double remaining =
        (closest_on_segment(target_.position, first, last) - target_.position).norm();
    const double key = window.offset + so_far + remaining;
    if (key >= best_ || is_useless(window)) return;
    windows_.push_back(window);
    queue_.push_back({key, ++sequence_, static_cast<int>(windows_.size()) - 1, -1, 0.0});
    std::push_heap(queue_.begin(), queue_.end());
}

void Geodesics::propagate(const Window& window) {
    const int h = window.halfedge;
    const int left = FlatMesh::previous(h);  // from the apex to the origin
    const int right = FlatMesh::next(h);     // from the target to the apex
    const Vec2 apex = flatten(h, mesh_.points[mesh_.apex(h)]);
    const Vec2 source(window.source_x, window.source_y);
    const double edge = length(h);
    const double crossing = hit(source, apex, Vec2::Zero(), Vec2::UnitX(), apex.x());
    const double slack = 1e-12 * edge;
    bool is_left = window.first < crossing;
    bool is_right = window.last > crossing;
    if (crossing >= window.first - slack && crossing <= window.last + slack) {
        const double distance = window.offset + (apex - source).norm();
        reach_vertex(mesh_.apex(h), distance);
        CornerRecord& record = corner_records_[h];
        if (record.query != query_ || distance < record.distance) {
            record = {distance, crossing, query_};
        } else if (is_left && is_right) {
            (crossing < record.crossing ? is_right : is_left) = false;
        }
    }
    if (is_left) {
        pass_on(window, left, apex.x(), apex.y(), 0.0, 0.0, window.first,
                std::min(window.last, crossing));
    }
    if (is_right) {
        pass_on(window, right, edge, 0.0, apex.x(), apex.y(), std::max(window.first, crossing),
                window.last);
    }
}

void Geodesics::pass_on(const Window& parent, int halfedge, double origin_x, double origin_y,
                        double target_x, double target_y, double first_x, double last_x) {
    const int twin = mesh_.twins[halfedge];
    if (twin < 0) return;
    const Vec2 origin(target_x, target_y);  // the twin runs the other way
    const double edge = length(halfedge);
    const Vec2 direction = (Vec2(origin_x, origin_y) - origin).normalized();
    const Vec2 source(parent.source_x, parent.source_y);
    const double first = hit(source, {first_x, 0}, origin, direction, 0.0);
    const double last = hit(source, {last_x, 0}, origin, direction, edge);
    const Window child{twin,
                       std::clamp(first, 0.0, edge),
                       std::clamp(last, 0.0, edge),
                       (source - origin).dot(direction),
                       std::min(0.0, cross(direction, source - origin)),
                       parent.offset};
    if (child.last - child.first > 1e-13 * edge) add_window(child);
}

}  // namespace fcn::conformity
