#include "adaptation/initial_state.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/curvature.h"

namespace fcn {

namespace {

/// Spacing of sharpness measurements, in rmin.
constexpr double kSharpnessSpacing = 1.0 / 5;
/// Smooth networks are not blown up by a median of almost nothing (radians).
constexpr double kSmallestMedian = 0.05;
/// Points this close to the surface (in diagonals) keep their coordinates.
constexpr double kOnSurface = 1e-9;

struct ArcMeasures {
    std::vector<double> turning, crease, curvature;
};

double curvature_at(const Mesh& mesh, const PrincipalCurvatures& curvatures,
                    const SurfacePoint& at) {
    if (at.face < 0) return 0;
    const auto vertices = face_vertices(mesh, FaceHandle(at.face));
    double result = 0;
    for (int k = 0; k < 3; ++k) {
        result += at.barycentric[k] * std::abs(curvatures.kappa_max[vertices[k].idx()]);
    }
    return result;
}

/// Fills the values between measured samples (`is_known`) linearly by index.
void interpolate(std::vector<double>& values, const std::vector<int>& known) {
    for (std::size_t i = 1; i < known.size(); ++i) {
        const int a = known[i - 1], b = known[i];
        for (int k = a + 1; k < b; ++k) {
            const double t = static_cast<double>(k - a) / (b - a);
            values[k] = (1 - t) * values[a] + t * values[b];
        }
    }
}

std::vector<int> measured_samples(const std::vector<Vec3>& points, double spacing) {
    std::vector<int> result{0};
    double along = 0;
    const int last = static_cast<int>(points.size()) - 1;
    for (int k = 1; k < last; ++k) {
        along += (points[k] - points[k - 1]).norm();
        if (along >= spacing) {
            result.push_back(k);
            along = 0;
        }
    }
    result.push_back(last);
    return result;
}

class Measurer {
public:
    Measurer(const LoadedMesh& mesh, const AdaptationSurface& surface, const ScaleInterval& scale,
             const AdaptationOptions& options)
        : mesh_(mesh.mesh),
          queries_(surface.queries),
          scale_(scale),
          on_surface_(kOnSurface * bounding_box(mesh.mesh).diagonal()),
          sharpness_(surface.sharpness) {
        if (options.mode == AdaptationMode::Paper) {
            curvatures_ = principal_curvatures(mesh.mesh, {.threads = options.threads});
        }
    }

    /// Straight pieces between samples of different faces leave the surface; brings them back.
    void project(std::vector<Vec3>& points) const {
        for (std::size_t k = 1; k + 1 < points.size(); ++k) {
            const ClosestPoint at = queries_.closest(points[k]);
            if (at.distance > on_surface_) points[k] = at.position;
        }
    }

    ArcMeasures measure(const std::vector<Vec3>& points) const {
        ArcMeasures result;
        const std::size_t count = points.size();
        result.turning.assign(count, 0);
        result.crease.assign(count, 0);
        result.curvature.assign(count, 0);
        const std::vector<int> known = measured_samples(points, kSharpnessSpacing * scale_.rmin);
        for (int k : known) {
            const int before = std::max(0, k - 1);
            const int after = std::min(static_cast<int>(count) - 1, k + 1);
            const Vec3 tangent = (points[after] - points[before]).normalized();
            const ClosestPoint at = queries_.closest(points[k]);
            const PointSharpness sharpness =
                sharpness_.measure(at.surface, at.position, tangent, scale_.rmin / 2);
            result.turning[k] = sharpness.turning;
            result.crease[k] = sharpness.crease;
            if (!curvatures_.kappa_max.empty()) {
                result.curvature[k] = curvature_at(mesh_, curvatures_, at.surface);
            }
        }
        interpolate(result.turning, known);
        interpolate(result.crease, known);
        interpolate(result.curvature, known);
        return result;
    }

private:
    const Mesh& mesh_;
    const SurfaceQueries& queries_;
    const ScaleInterval& scale_;
    double on_surface_;
    const SurfaceSharpness& sharpness_;
    PrincipalCurvatures curvatures_;
};

void fill_origins(const FeatureCurveNetwork& initial, InitialState& state) {
    FeatureCurveNetwork network = initial;
    if (network.curves.empty()) find_curves(network);
    const auto supporting = supporting_curves(network);
    state.origins.resize(network.arcs.size());
    state.crumbs.curve_of_origin.resize(network.arcs.size());
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        state.origins[a].curve_length = supporting[a].length;
        state.origins[a].is_on_loop = supporting[a].is_loop;
    }
    std::vector<int> parent(network.nodes.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const NetworkArc& arc : network.arcs) {
        const int u = root(arc.nodes[0]), v = root(arc.nodes[1]);
        parent[std::max(u, v)] = std::min(u, v);
    }
    state.crumbs.length_of_component.assign(network.nodes.size(), 0.0);
    for (std::size_t c = 0; c < network.curves.size(); ++c) {
        const NetworkCurve& curve = network.curves[c];
        double length = 0;
        for (std::size_t k = 0; k < curve.arcs.size(); ++k) {
            OriginAttributes& origin = state.origins[curve.arcs[k]];
            origin.curve = static_cast<int>(c);
            origin.rank_in_curve = static_cast<int>(k);
            origin.is_reversed_in_curve = curve.is_reversed[k];
            state.crumbs.curve_of_origin[curve.arcs[k]] = static_cast<int>(c);
            length += network.arcs[curve.arcs[k]].length();
        }
        const int component = root(network.arcs[curve.arcs.front()].nodes[0]);
        state.crumbs.length_of_curve.push_back(length);
        state.crumbs.component_of_curve.push_back(component);
        state.crumbs.length_of_component[component] += length;
    }
    for (const SymmetryOrbit& orbit : network.orbits) {
        for (const OrbitMember& member : orbit.members) {
            state.origins[member.arc].is_symmetric = true;
        }
    }
}

double weighted_median(std::vector<std::pair<double, double>> values) {
    std::ranges::sort(values);
    double total = 0;
    for (const auto& [value, weight] : values) total += weight;
    double below = 0;
    for (const auto& [value, weight] : values) {
        below += weight;
        if (below >= total / 2) return value;
    }
    return 0;
}

}  // namespace

InitialState make_initial_state(const LoadedMesh& mesh, const AdaptationSurface& surface,
                                const FeatureCurveNetwork& initial, const ScaleInterval& scale,
                                const AdaptationOptions& options) {
    InitialState state;
    fill_origins(initial, state);
    state.crumbs.min_length = 3 * scale.rmin;
    for (const NetworkNode& node : initial.nodes) state.network.nodes.push_back({node.position});
    const int count = static_cast<int>(initial.arcs.size());
    state.network.arcs.resize(count);
    std::vector<ArcMeasures> measures(count);
    const Measurer measurer(mesh, surface, scale, options);
    tbb::task_arena arena(std::max(1, options.threads));
    arena.execute([&] {
        tbb::parallel_for(0, count, [&](int a) {
            WorkingArc& arc = state.network.arcs[a];
            arc.nodes = initial.arcs[a].nodes;
            arc.points = densify(initial.arcs[a].samples, sample_spacing(scale));
            arc.points.front() = initial.nodes[arc.nodes[0]].position;
            arc.points.back() = initial.nodes[arc.nodes[1]].position;
            measurer.project(arc.points);
            arc.origins.assign(arc.points.size() - 1, a);
            arc.is_pinned = initial.arcs[a].pin == Pin::Keep;
            measures[a] = measurer.measure(arc.points);
        });
    });
    std::vector<std::pair<double, double>> turnings;
    for (int a = 0; a < count; ++a) {
        WorkingArc& arc = state.network.arcs[a];
        for (std::size_t k = 0; k + 1 < arc.points.size(); ++k) {
            const double length = (arc.points[k + 1] - arc.points[k]).norm();
            const double turning = (measures[a].turning[k] + measures[a].turning[k + 1]) / 2;
            turnings.emplace_back(turning, length);
            state.coverage.push_back({(arc.points[k] + arc.points[k + 1]) / 2, turning * length});
        }
    }
    state.median_turning = std::max(kSmallestMedian, weighted_median(std::move(turnings)));
    for (int a = 0; a < count; ++a) {
        WorkingArc& arc = state.network.arcs[a];
        arc.crease = std::move(measures[a].crease);
        arc.sharpness = options.mode == AdaptationMode::Paper ? std::move(measures[a].curvature)
                                                              : std::move(measures[a].turning);
        if (options.mode == AdaptationMode::Best) {
            for (double& value : arc.sharpness) value /= state.median_turning;
        }
        if (initial.arcs[a].pin != Pin::Drop) continue;
        DroppedPiece piece;
        piece.polyline = arc.points;
        piece.origin_arc = a;
        piece.reason = "pinned out";
        state.dropped.push_back(std::move(piece));
        arc = WorkingArc{};
        arc.is_alive = false;
    }
    return state;
}

}  // namespace fcn
