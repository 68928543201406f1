// Cheapest paths in three steps, each on less of the mesh and closer to the exact path. On large
// meshes a search over vertices alone finds where the path runs (wire_vertices.cpp). A band of
// faces around that path, or the whole of a small mesh, is searched by Dijkstra's algorithm with
// Steiner points on edges, a narrower band with more of them. At last the points slide along their
// edges: a dynamic program over a few places on each, in windows that shrink, since moving points
// one by one converges too slowly on long paths. Ties go to the lower number, so nothing depends on
// the heap.

#include "features/wire_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "features/path_labels.h"

namespace fcn {
namespace {

constexpr double kRounding = 1e-9;
constexpr int kWideRings = 6;
constexpr int kNarrowRings = 2;
constexpr int kWidePoints = 3;  ///< on each edge
constexpr int kNarrowPoints = 8;
constexpr int kMostPoints = 24;
constexpr int kWideBudget = 1500;  ///< points on all edges that a search of few faces may have
constexpr int kNarrowBudget = 4000;

}  // namespace

WireSearch::WireSearch(const MeshArrays& arrays, const WireMetric& metric,
                       const WireSearchOptions& options)
    : arrays_(arrays),
      metric_(metric),
      options_(options),
      faces_(faces_of_vertices(arrays)),
      face_mark_(arrays.face_count(), -1),
      vertex_mark_(arrays.vertex_count(), -1),
      edge_mark_(arrays.edge_count(), -1) {}

WirePoint WireSearch::point_at(const SurfacePoint& surface) const {
    WirePoint point;
    point.surface = surface;
    const auto& corners = arrays_.face_vertices[surface.face];
    const Vec3& b = surface.barycentric;
    for (int i = 0; i < 3; ++i) point.position += b[i] * arrays_.points[corners[i]];
    for (int i = 0; i < 3; ++i) {
        if (b[i] < 1 - kRounding) continue;
        point.vertex = corners[i];
        point.position = arrays_.points[corners[i]];
        return point;
    }
    for (int i = 0; i < 3; ++i) {
        if (b[(i + 2) % 3] > kRounding) continue;
        const int edge = arrays_.face_edges[surface.face][i];
        const double t = b[(i + 1) % 3] / (b[i] + b[(i + 1) % 3]);
        return on_edge(edge, arrays_.edge_vertices[edge][0] == corners[i] ? t : 1 - t);
    }
    return point;
}

WirePoint WireSearch::on_edge(int edge, double t) const {
    const auto [from, to] = arrays_.edge_vertices[edge];
    const int face = std::max(arrays_.edge_faces[edge][0], arrays_.edge_faces[edge][1]);
    WirePoint point;
    if (t <= 0 || t >= 1)
        point.vertex = t <= 0 ? from : to;
    else
        point.edge = edge;
    point.t = std::clamp(t, 0.0, 1.0);
    point.position =
        t >= 1 ? arrays_.points[to]
               : Vec3((1 - point.t) * arrays_.points[from] + point.t * arrays_.points[to]);
    point.surface.face = face;
    for (int i = 0; i < 3; ++i) {
        const int v = arrays_.face_vertices[face][i];
        point.surface.barycentric[i] = v == from ? 1 - point.t : v == to ? point.t : 0;
    }
    return point;
}

std::vector<int> WireSearch::faces_at(const WirePoint& point) const {
    if (point.vertex >= 0) return {faces_.begin(point.vertex), faces_.end(point.vertex)};
    if (point.edge < 0) return {point.surface.face};
    std::vector<int> faces;
    for (int f : arrays_.edge_faces[point.edge])
        if (f >= 0) faces.push_back(f);
    std::ranges::sort(faces);
    return faces;
}

double WireSearch::step(int face, const WirePoint& a, const WirePoint& b) const {
    const Vec3 d = b.position - a.position;
    const auto is_on = [&](const WirePoint& p, int edge) {
        return p.edge == edge || (p.vertex >= 0 && (arrays_.edge_vertices[edge][0] == p.vertex ||
                                                    arrays_.edge_vertices[edge][1] == p.vertex));
    };
    for (int edge : arrays_.face_edges[face])
        if (is_on(a, edge) && is_on(b, edge)) return d.norm() * metric_.along(edge);
    return metric_.across(face, d);
}

int WireSearch::common_face(const WirePoint& a, const WirePoint& b) const {
    const std::vector<int> others = faces_at(b);
    double best = kUnreached;
    int result = -1;
    for (int face : faces_at(a)) {
        if (std::ranges::find(others, face) == others.end()) continue;
        const double cost = step(face, a, b);
        if (cost < best) result = face;
        best = std::min(best, cost);
    }
    return result;
}

double WireSearch::cost_between(const WirePoint& a, const WirePoint& b) const {
    const int face = common_face(a, b);
    return face < 0 ? kUnreached : step(face, a, b);
}

/// Vertices of a path between the ends; empty if there is none.
std::vector<int> WireSearch::vertex_path(const WirePoint& from, const WirePoint& to) {
    if (!vertex_search_) vertex_search_ = std::make_unique<VertexSearch>(arrays_, metric_);
    const auto seeds = [&](const WirePoint& end) {
        std::vector<WireSeed> result;
        WirePoint corner;
        for (int f : faces_at(end)) {
            for (int v : arrays_.face_vertices[f]) {
                corner.vertex = v;
                corner.position = arrays_.points[v];
                result.push_back({v, step(f, end, corner)});
            }
        }
        return result;
    };
    return vertex_search_->path(seeds(from), seeds(to));
}

/// The faces and those within some rings of shared vertices around them, in ascending order.
std::vector<int> WireSearch::grown(std::vector<int> faces, int rings) {
    std::size_t first = 0;
    for (int f : faces) face_mark_[f] = 0;
    for (int ring = 0; ring < rings; ++ring) {
        const std::size_t end = faces.size();
        for (; first < end; ++first) {
            for (int v : arrays_.face_vertices[faces[first]]) {
                for (const int* f = faces_.begin(v); f != faces_.end(v); ++f) {
                    if (face_mark_[*f] >= 0) continue;
                    face_mark_[*f] = 0;
                    faces.push_back(*f);
                }
            }
        }
    }
    for (int f : faces) face_mark_[f] = -1;
    std::ranges::sort(faces);
    faces.erase(std::ranges::unique(faces).begin(), faces.end());
    return faces;
}

WirePath WireSearch::path(const WirePoint& from, const WirePoint& to) {
    std::vector<int> faces;
    const auto add_faces = [&](const WirePoint& point) {
        const std::vector<int> at = faces_at(point);
        faces.insert(faces.end(), at.begin(), at.end());
    };
    const auto points_for = [&](int least, int budget) {
        return std::clamp(budget / std::max(1, static_cast<int>(faces.size())), least, kMostPoints);
    };
    if (arrays_.face_count() <= options_.whole_mesh_faces) {
        for (int f = 0; f < arrays_.face_count(); ++f) faces.push_back(f);
    } else {
        const std::vector<int> vertices = vertex_path(from, to);
        if (vertices.empty() && common_face(from, to) < 0) return {};
        for (int v : vertices) faces.insert(faces.end(), faces_.begin(v), faces_.end(v));
        add_faces(from);
        add_faces(to);
        std::ranges::sort(faces);
        faces.erase(std::ranges::unique(faces).begin(), faces.end());
        faces = grown(std::move(faces), kWideRings);
    }
    WirePath path = search(faces, points_for(kWidePoints, kWideBudget), from, to);
    if (path.points.empty()) return path;
    faces.clear();
    for (const WirePoint& point : path.points) add_faces(point);
    std::ranges::sort(faces);
    faces.erase(std::ranges::unique(faces).begin(), faces.end());
    faces = grown(std::move(faces), kNarrowRings);
    path = search(faces, points_for(kNarrowPoints, kNarrowBudget), from, to);
    tighten(path);
    return path;
}

}  // namespace fcn
