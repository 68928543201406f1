// Noise that a fit lets through moves the zero of e by a share of the fit's radius, so that lines
// swing about the crest and come out too long. Neighbouring fits share most of their vertices: what
// swings faster than that is not on the surface. Each line is replaced by the smoothing spline
//     min  sum |x_i - p_i|^2 + lambda sum |x_{i-1} - 2 x_i + x_{i+1}|^2,
// whose response 1 / (1 + (w / w0)^4) is set to one half at wavelengths of twice the radius, and
// its crossings move to the points of their edges that are nearest to it; so lines stay on the
// mesh.

#include "features/crest_smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "features/smoothing_spline.h"

namespace fcn {
namespace {

constexpr double kWavelength = 2;       // in radii of the fits, at which half remains
constexpr double kLoopResponse = 0.98;  // of a closed line's first harmonic, at least
constexpr int kNearIntervals = 6;       // of the spline that a crossing is compared with
constexpr double kCoincident = 1e-9;    // of an edge: crossings that are vertices anyway

/// Squared distance of segments pq and ab, and the parameter on ab of its closest point.
std::pair<double, double> closest_on(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q) {
    const Vec3 u = b - a, v = q - p, w = a - p;
    const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
    const double determinant = uu * vv - uv * uv;
    double t = determinant > 1e-14 * uu * vv ? (uv * v.dot(w) - vv * u.dot(w)) / determinant : 0.5;
    t = std::clamp(t, 0.0, 1.0);
    double s = vv > 0 ? std::clamp((a + t * u - p).dot(v) / vv, 0.0, 1.0) : 0;
    t = std::clamp((p + s * v - a).dot(u) / uu, 0.0, 1.0);
    s = vv > 0 ? std::clamp((a + t * u - p).dot(v) / vv, 0.0, 1.0) : 0;
    return {(a + t * u - p - s * v).squaredNorm(), t};
}

/// Smooths the run of a line's points between two that stay.
class Smoother {
public:
    Smoother(const MeshArrays& arrays, CrestGraph& graph)
        : arrays_(arrays), graph_(graph), valence_(graph.points.size(), 0) {
        for (const auto& piece : graph.pieces) {
            for (int p : piece) ++valence_[p];
        }
    }

    void smooth(const CrestLine& line) {
        std::vector<int> points = line.points;
        const auto is_fixed = [&](int p) { return valence_[p] != 2; };
        if (line.is_closed) {
            points.pop_back();
            const auto found = std::find_if(points.begin(), points.end(), is_fixed);
            if (found == points.end()) {
                smooth_run(points, true);
                return;
            }
            std::rotate(points.begin(), found, points.end());
            points.push_back(points.front());
        }
        std::size_t first = 0;
        for (std::size_t k = 1; k < points.size(); ++k) {
            if (k + 1 < points.size() && !is_fixed(points[k])) continue;
            smooth_run({points.begin() + static_cast<std::ptrdiff_t>(first),
                        points.begin() + static_cast<std::ptrdiff_t>(k) + 1},
                       false);
            first = k;
        }
    }

private:
    void smooth_run(const std::vector<int>& points, bool is_cyclic) {
        const int count = static_cast<int>(points.size());
        if (count < 4) return;
        Eigen::MatrixX3d start(count, 3);
        double length = 0, radius = 0;
        for (int i = 0; i < count; ++i) {
            const CrestPoint& point = graph_.points[points[i]];
            start.row(i) = point.position.transpose();
            radius += point.radius / count;
            if (i > 0) length += (start.row(i) - start.row(i - 1)).norm();
        }
        if (!(length > 0)) return;
        const double frequency = 2 * std::numbers::pi * length / count / (kWavelength * radius);
        double weight = 1 / std::pow(std::min(frequency, std::numbers::pi), 4);
        if (is_cyclic) {
            const double harmonic = 2 - 2 * std::cos(2 * std::numbers::pi / count);
            weight = std::min(weight, (1 / kLoopResponse - 1) / (harmonic * harmonic));
        }
        const std::vector<double> pull(static_cast<std::size_t>(start.rows()), 1.0);
        const Eigen::MatrixX3d smooth = smoothing_spline(start, pull, weight, is_cyclic);
        for (int i = 0; i < count; ++i) {
            if (!is_cyclic && (i == 0 || i == count - 1)) continue;
            slide(points[i], i, smooth, is_cyclic);
        }
    }

    void slide(int p, int at, const Eigen::MatrixX3d& smooth, bool is_cyclic) {
        CrestPoint& point = graph_.points[p];
        if (point.edge < 0) return;
        const auto [from, to] = arrays_.edge_vertices[point.edge];
        const int count = static_cast<int>(smooth.rows());
        double best = std::numeric_limits<double>::infinity(), best_t = 0;
        for (int k = at - kNearIntervals; k < at + kNearIntervals; ++k) {
            if (!is_cyclic && (k < 0 || k + 1 >= count)) continue;
            const Vec3 one = smooth.row(((k % count) + count) % count).transpose();
            const Vec3 other = smooth.row((((k + 1) % count) + count) % count).transpose();
            const auto [distance, t] =
                closest_on(arrays_.points[from], arrays_.points[to], one, other);
            if (distance >= best) continue;
            best = distance;
            best_t = t;
        }
        if (std::isfinite(best)) place_on_edge(arrays_, point.edge, best_t, point);
    }

    const MeshArrays& arrays_;
    CrestGraph& graph_;
    std::vector<int> valence_;
};

}  // namespace

void place_on_edge(const MeshArrays& arrays, int edge, double t, CrestPoint& point) {
    const auto [from, to] = arrays.edge_vertices[edge];
    const int face = std::max(arrays.edge_faces[edge][0], arrays.edge_faces[edge][1]);
    point.edge = edge;
    point.surface.face = face;
    for (int i = 0; i < 3; ++i) {
        const int v = arrays.face_vertices[face][i];
        point.surface.barycentric[i] = v == from ? 1 - t : v == to ? t : 0;
    }
    point.position = (1 - t) * arrays.points[from] + t * arrays.points[to];
    if (t == 0) point.position = arrays.points[from];
    if (t == 1) point.position = arrays.points[to];
}

void smooth_lines(const MeshArrays& arrays, CrestGraph& graph) {
    Smoother smoother(arrays, graph);
    for (const CrestLine& line : crest_lines(graph)) smoother.smooth(line);
}

void snap_to_vertices(const MeshArrays& arrays, double share, CrestGraph& graph) {
    share = std::max(share, kCoincident);
    std::vector<int> point_of_vertex(arrays.vertex_count(), -1);
    std::vector<int> target(graph.points.size());
    for (std::size_t p = 0; p < graph.points.size(); ++p) {
        target[p] = static_cast<int>(p);
        CrestPoint& point = graph.points[p];
        if (point.edge < 0) continue;
        for (int i = 0; i < 3; ++i) {
            if (point.surface.barycentric[i] <= 1 - share) continue;
            point.vertex = arrays.face_vertices[point.surface.face][i];
            point.surface.barycentric = Vec3::Unit(i);
            point.position = arrays.points[point.vertex];
            if (point_of_vertex[point.vertex] < 0) point_of_vertex[point.vertex] = target[p];
            target[p] = point_of_vertex[point.vertex];
            break;
        }
    }
    std::vector<std::array<int, 3>> pieces;
    for (std::size_t k = 0; k < graph.pieces.size(); ++k) {
        const int a = target[graph.pieces[k][0]], b = target[graph.pieces[k][1]];
        if (a != b) pieces.push_back({std::min(a, b), std::max(a, b), graph.piece_faces[k]});
    }
    std::sort(pieces.begin(), pieces.end());
    graph.pieces.clear();
    graph.piece_faces.clear();
    for (const auto& [a, b, face] : pieces) {
        if (!graph.pieces.empty() && graph.pieces.back() == std::array{a, b}) continue;
        graph.pieces.push_back({a, b});
        graph.piece_faces.push_back(face);
    }
}

}  // namespace fcn
