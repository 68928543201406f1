// The metric of live-wires after Zhuang, Zou, Carr and Ju (2014), "Anisotropic geodesics for
// live-wire mesh segmentation": distances shrink along the direction of low curvature by
// 1 + gamma l |kappa_across|, as far as the two curvatures differ (umbilics are isotropic) and up
// to a limit. The curvature is the shape operator of Cohen-Steiner and Morvan, edges weighted by
// angle, blurred over faces until it is that of a neighbourhood of about l / 4; numerator and area
// are blurred alike, so uneven triangles do not matter. Departure: an edge that is sharp by itself
// carries its own gain. On CAD meshes a crease has no faces of its own size, and an average over
// its large neighbours would hide it. Small angles, which noise makes too, add nothing there.

#include "features/wire_metric.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace fcn {
namespace {

constexpr double kRadiusShare = 0.25;  ///< of l: reach of the curvature
constexpr int kMostRounds = 32;
constexpr double kNoiseAngle = 20 * std::numbers::pi / 180;
constexpr double kSmallGain = 1e-9;

/// Integral of the shape operator over a face's surroundings, and their area.
struct Operator {
    std::array<double, 6> sum{};  ///< xx, xy, xz, yy, yz, zz
    double area = 0;

    void add(const Vec3& d, double weight) {
        sum[0] += weight * d[0] * d[0];
        sum[1] += weight * d[0] * d[1];
        sum[2] += weight * d[0] * d[2];
        sum[3] += weight * d[1] * d[1];
        sum[4] += weight * d[1] * d[2];
        sum[5] += weight * d[2] * d[2];
    }
    void add(const Operator& other) {
        for (int k = 0; k < 6; ++k) sum[k] += other.sum[k];
        area += other.area;
    }
    /// The operator's value for two tangent vectors.
    double value(const Vec3& u, const Vec3& v) const {
        const Vec3 image(sum[0] * v[0] + sum[1] * v[1] + sum[2] * v[2],
                         sum[1] * v[0] + sum[3] * v[1] + sum[4] * v[2],
                         sum[2] * v[0] + sum[4] * v[1] + sum[5] * v[2]);
        return u.dot(image) / area;
    }
};

template <class Work>
void for_faces(int count, int threads, Work work) {
    tbb::task_arena arena(std::max(1, threads));
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, count, 4096),
                          [&](const tbb::blocked_range<int>& range) {
                              for (int f = range.begin(); f < range.end(); ++f) work(f);
                          });
    });
}

std::vector<Operator> blurred_operators(const MeshArrays& arrays, double radius, int threads) {
    const int count = arrays.face_count();
    std::vector<Operator> now(count), next(count);
    for_faces(count, threads, [&](int f) {
        for (int edge : arrays.face_edges[f]) {
            const auto [from, to] = arrays.edge_vertices[edge];
            const Vec3 d = arrays.points[to] - arrays.points[from];
            const double length = d.norm();
            // Half of the edge belongs to each of its two faces.
            if (length > 0) now[f].add(d / length, 0.5 * arrays.dihedrals[edge] * length);
        }
        now[f].area = arrays.areas[f];
    });
    // One round mixes a face with its neighbours, whose centres are about 0.58 edges away.
    const double rounds = std::pow(radius / std::max(arrays.mean_edge_length, 1e-300), 2) * 4;
    const int count_rounds =
        static_cast<int>(std::clamp(std::ceil(rounds), 1.0, 1.0 * kMostRounds));
    for (int k = 0; k < count_rounds; ++k) {
        for_faces(count, threads, [&](int f) {
            Operator mixed = now[f];
            for (int g : arrays.face_neighbors[f])
                if (g >= 0) mixed.add(now[g]);
            for (double& value : mixed.sum) value /= 4;
            mixed.area /= 4;
            next[f] = mixed;
        });
        std::swap(now, next);
    }
    return now;
}

}  // namespace

WireMetric::WireMetric(const MeshArrays& arrays, const WireMetricOptions& options)
    : directions_(arrays.face_count(), Vec3::Zero()),
      pulls_(arrays.face_count(), Vec3::Zero()),
      gains_(arrays.face_count(), 1),
      edge_costs_(arrays.edge_count(), 1) {
    const double radius = kRadiusShare * options.length;
    const double strength = options.attraction * options.length;
    const auto gain_of = [&](double curvature) {
        return std::min(options.max_anisotropy, 1 + strength * curvature);
    };
    if (!(strength > 0) || !(options.max_anisotropy > 1)) return;
    const std::vector<Operator> operators = blurred_operators(arrays, radius, options.threads);
    for_faces(arrays.face_count(), options.threads, [&](int f) {
        const Operator& shape = operators[f];
        const Vec3& normal = arrays.normals[f];
        if (!(shape.area > 0) || normal.isZero()) return;
        const auto [a, b, c] = arrays.face_vertices[f];
        const Vec3 u = (arrays.points[b] - arrays.points[a]).normalized(), v = normal.cross(u);
        const double uu = shape.value(u, u), uv = shape.value(u, v), vv = shape.value(v, v);
        // The eigenvector of an edge's term runs along the edge; its value is the curvature across.
        const double mean = (uu + vv) / 2, spread = std::hypot((uu - vv) / 2, uv);
        const double across = mean >= 0 ? mean + spread : mean - spread;
        const double other = mean >= 0 ? mean - spread : mean + spread;
        if (!(std::abs(across) > 0)) return;
        const double fade =
            (std::abs(across) - std::abs(other)) / (std::abs(across) + std::abs(other));
        gains_[f] = gain_of(fade * std::abs(across));
        const double angle =
            0.5 * std::atan2(2 * uv, uu - vv) + (mean >= 0 ? 0 : std::numbers::pi / 2);
        directions_[f] = std::cos(angle) * u + std::sin(angle) * v;
        if (gains_[f] < 1 + kSmallGain) directions_[f].setZero();
        pulls_[f] = std::sqrt(1 - 1 / (gains_[f] * gains_[f])) * directions_[f];
    });
    for (int e = 0; e < arrays.edge_count(); ++e) {
        const double angle = std::max(0.0, std::abs(arrays.dihedrals[e]) - kNoiseAngle);
        const auto [from, to] = arrays.edge_vertices[e];
        const Vec3 d = arrays.points[to] - arrays.points[from];
        const double length = d.norm();
        // The operator of the edge alone, averaged over a disc of the radius around it.
        double cost = 1 / gain_of(2 * angle / (std::numbers::pi * radius));
        for (int f : arrays.edge_faces[e])
            if (f >= 0 && length > 0) cost = std::min(cost, across(f, d) / length);
        edge_costs_[e] = cost;
    }
}

}  // namespace fcn
