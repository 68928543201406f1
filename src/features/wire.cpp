// Live-wires through a user's seeds (Zhuang, Zou, Carr, Ju 2014): one cheapest path from each seed
// to the next (wire_metric.cpp, wire_search.cpp). The paths enter the network one by one as
// detectors do (combine.cpp), so that wires that cross, join, or come back along their own way need
// no rules of their own; nodes at seeds where nothing else ends vanish.

#include "features/wire.h"

#include <cmath>

#include "features/combine.h"
#include "features/edge_chains.h"
#include "features/wire_network.h"
#include "geometry/errors.h"
#include "geometry/surface_queries.h"

namespace fcn {
namespace {

constexpr double kLengthShare = 0.02;
constexpr double kEqualSeeds = 1e-9;       ///< in diagonals
constexpr double kFuseEdges = 0.5;         ///< wires this close, in mean edges, are one
constexpr double kLargestFusing = 0.0025;  ///< in diagonals

std::string shown(const Vec3& p) {
    return "(" + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ", " + std::to_string(p[2]) +
           ")";
}

/// The seeds of a wire as points of the mesh.
std::vector<WirePoint> place_seeds(const WireRequest& wire, const MeshArrays& arrays,
                                   const IndexRows& faces, const SurfaceQueries& queries,
                                   const WireMetric& metric, const WireSearch& search,
                                   double diagonal, const WireOptions& options) {
    const double farthest = options.farthest_seed;
    const bool has_vertices = !wire.vertices.empty();
    const std::size_t count = has_vertices ? wire.vertices.size() : wire.points.size();
    const std::size_t least = wire.is_closed ? 3 : 2;
    if (count < least)
        throw InputError(wire.place + ": " + std::to_string(count) + " seeds, " +
                         (wire.is_closed ? "a closed wire" : "a wire") + " needs " +
                         std::to_string(least));
    std::vector<WirePoint> seeds;
    for (std::size_t k = 0; k < count; ++k) {
        const std::string place =
            wire.place + (has_vertices ? "/vertices/" : "/points/") + std::to_string(k);
        if (has_vertices) {
            const int v = wire.vertices[k];
            if (v >= arrays.vertex_count() || faces.size(v) == 0)
                throw InputError(place + ": vertex " + std::to_string(v) +
                                 " does not exist (the mesh has " +
                                 std::to_string(arrays.vertex_count()) + ", from 0)");
            seeds.push_back(search.point_at(surface_point_of_vertex(arrays, v, *faces.begin(v))));
        } else {
            const Vec3& p = wire.points[k];
            if (!p.allFinite()) throw InputError(place + ": the point is not finite");
            const ClosestPoint closest = queries.closest(p);
            if (!(closest.distance <= farthest * diagonal))
                throw InputError(place + ": " + shown(p) + " is " +
                                 std::to_string(closest.distance) +
                                 " from the surface, more than " + std::to_string(100 * farthest) +
                                 "% of the diagonal (a seed of another mesh?)");
            seeds.push_back(search.point_at(
                snapped_seed(arrays, metric, closest.surface, options.snap * diagonal)));
        }
        const auto is_equal = [&](const WirePoint& other) {
            return (seeds.back().position - other.position).norm() <= kEqualSeeds * diagonal;
        };
        const bool is_last = wire.is_closed && k + 1 == count;
        if (k > 0 && is_equal(seeds[k - 1]))
            throw InputError(place + ": the same point as the seed before it");
        if (is_last && is_equal(seeds.front()))
            throw InputError(place +
                             ": the same point as the first seed of a closed wire, which "
                             "must not be repeated");
    }
    if (wire.is_closed) seeds.push_back(seeds.front());
    return seeds;
}

}  // namespace

WireMetricOptions metric_options(const WireOptions& options, double diagonal) {
    if (!(options.length >= 0) || !std::isfinite(options.length))
        throw InputError("wires: length " + std::to_string(options.length) + " is no length");
    if (!(options.attraction >= 0) || !std::isfinite(options.attraction))
        throw InputError("wires: attraction must be >= 0");
    if (!(options.max_anisotropy >= 1) || !std::isfinite(options.max_anisotropy))
        throw InputError("wires: anisotropy must be >= 1");
    WireMetricOptions result;
    result.length = options.length > 0 ? options.length : kLengthShare * diagonal;
    result.attraction = options.attraction;
    result.max_anisotropy = options.max_anisotropy;
    result.threads = options.threads;
    return result;
}

double wire_tolerance(const MeshArrays& arrays, double diagonal) {
    return std::min(kFuseEdges * arrays.mean_edge_length, kLargestFusing * diagonal);
}

FeatureCurveNetwork network_of_path(const WirePath& path, Pin pin) {
    FeatureCurveNetwork network;
    NetworkArc arc;
    arc.source = "wire";
    arc.pin = pin;
    for (const WirePoint& point : path.points) {
        const ArcSample sample{point.position, point.surface};
        if (!arc.samples.empty() && arc.samples.back().position == sample.position) continue;
        arc.samples.push_back(sample);
    }
    if (arc.samples.size() < 2) return network;
    network.nodes.push_back({arc.samples.front().position, arc.samples.front().surface});
    network.nodes.push_back({arc.samples.back().position, arc.samples.back().surface});
    arc.nodes = {0, 1};
    network.arcs.push_back(std::move(arc));
    return network;
}

FeatureCurveNetwork detect_wires(const LoadedMesh& mesh, const std::vector<WireRequest>& wires,
                                 const WireOptions& options) {
    const double diagonal = bounding_box(mesh.mesh).diagonal();
    const WireMetricOptions metric_settings = metric_options(options, diagonal);
    const MeshArrays arrays = mesh_arrays(mesh.mesh, options.threads);
    const IndexRows faces = faces_of_vertices(arrays);
    const SurfaceQueries queries(mesh.mesh);
    const WireMetric metric(arrays, metric_settings);
    WireSearch search(arrays, metric);
    std::vector<std::vector<WirePoint>> seeds;
    for (const WireRequest& wire : wires)
        seeds.push_back(
            place_seeds(wire, arrays, faces, queries, metric, search, diagonal, options));
    std::vector<FeatureCurveNetwork> links;
    for (std::size_t w = 0; w < wires.size(); ++w) {
        for (std::size_t k = 1; k < seeds[w].size(); ++k) {
            const WirePath path = search.path(seeds[w][k - 1], seeds[w][k]);
            if (path.points.empty())
                throw InputError(wires[w].place + ": no way on the surface from seed " +
                                 std::to_string(k - 1) + " to " +
                                 (k == seeds[w].size() - 1 && wires[w].is_closed
                                      ? std::string("the first")
                                      : "seed " + std::to_string(k)) +
                                 " (different components of the mesh)");
            links.push_back(network_of_path(path, wires[w].is_pinned ? Pin::Keep : Pin::None));
        }
    }
    FeatureCurveNetwork network =
        merge_regular_nodes(combine_networks(links, mesh, {wire_tolerance(arrays, diagonal)}));
    set_provenance(network, mesh);
    return network;
}

}  // namespace fcn
