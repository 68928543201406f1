// Wires without seeds. Detectors leave creases and crests in pieces where they fade; a link between
// two loose ends is worth drawing where it runs along features itself, that is, where its cost is
// low for its length. Ends that are no ends of something substantial are noise and are not linked,
// nor are ends that look away from each other.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "features/combine.h"
#include "features/edge_chains.h"
#include "features/wire.h"
#include "features/wire_network.h"

namespace fcn {
namespace {

constexpr int kNearestEnds = 6;
constexpr double kDirectionShare = 0.01;  ///< of the diagonal: stretch that gives a direction
constexpr int kWholeMeshFaces = 2000;     ///< links are short: bands even on small meshes

struct LooseEnd {
    int node = -1;
    int component = -1;
    Vec3 position = Vec3::Zero();
    Vec3 direction = Vec3::Zero();  ///< out of the curve, unit
};

struct Link {
    int first = -1, second = -1;
    double rate = 0;  ///< cost per length
    bool is_loop = false;
    WirePath path;
};

std::vector<int> components(const FeatureCurveNetwork& network) {
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
    for (int v = 0; v < static_cast<int>(parent.size()); ++v) parent[v] = root(v);
    return parent;
}

std::vector<LooseEnd> loose_ends(const FeatureCurveNetwork& network, double stretch,
                                 double min_length) {
    const std::vector<int> component = components(network), valences = network.valences();
    std::map<int, double> lengths;
    for (const NetworkArc& arc : network.arcs) lengths[component[arc.nodes[0]]] += arc.length();
    std::vector<LooseEnd> ends;
    for (const NetworkArc& arc : network.arcs) {
        for (int side = 0; side < 2; ++side) {
            const int node = arc.nodes[side];
            if (network.nodes[node].surface.face < 0) continue;
            if (valences[node] != 1 || lengths[component[node]] < min_length) continue;
            LooseEnd end{node, component[node], network.nodes[node].position, {}};
            const int count = static_cast<int>(arc.samples.size());
            for (int k = 1; k < count; ++k) {
                const Vec3& p = arc.samples[side == 0 ? k : count - 1 - k].position;
                end.direction = end.position - p;
                if (end.direction.norm() >= stretch) break;
            }
            end.direction.normalize();
            ends.push_back(end);
        }
    }
    return ends;
}

/// Pairs of ends that look at each other, each with few of its nearest.
std::vector<std::pair<int, int>> candidates(const std::vector<LooseEnd>& ends, double reach,
                                            double min_cosine) {
    std::vector<std::pair<int, int>> pairs;
    const int count = static_cast<int>(ends.size());
    for (int i = 0; i < count; ++i) {
        std::vector<std::pair<double, int>> near;
        for (int k = 0; k < count; ++k) {
            const Vec3 way = ends[k].position - ends[i].position;
            const double distance = way.norm();
            if (k == i || distance > reach || !(distance > 0)) continue;
            if (ends[i].direction.dot(way) < min_cosine * distance) continue;
            if (ends[k].direction.dot(-way) < min_cosine * distance) continue;
            near.emplace_back(distance, k);
        }
        std::ranges::sort(near);
        near.resize(std::min<std::size_t>(near.size(), kNearestEnds));
        for (const auto& [distance, k] : near) pairs.emplace_back(std::min(i, k), std::max(i, k));
    }
    std::ranges::sort(pairs);
    pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
    return pairs;
}

}  // namespace

FeatureCurveNetwork link_loose_ends(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                                    const WireOptions& options, const WireLinkOptions& links) {
    const double diagonal = bounding_box(mesh.mesh).diagonal();
    const WireMetricOptions metric_settings = metric_options(options, diagonal);
    const std::vector<LooseEnd> ends =
        loose_ends(network, kDirectionShare * diagonal, links.min_length * diagonal);
    const auto pairs = candidates(ends, links.reach * diagonal, std::cos(links.max_turning));
    FeatureCurveNetwork result;
    set_provenance(result, mesh);
    if (pairs.empty()) return result;
    const MeshArrays arrays = mesh_arrays(mesh.mesh, options.threads);
    const WireMetric metric(arrays, metric_settings);
    WireSearch search(arrays, metric, {kWholeMeshFaces});
    std::vector<Link> found;
    for (const auto& [i, k] : pairs) {
        const auto point = [&](int end) {
            return search.point_at(network.nodes[ends[end].node].surface);
        };
        Link link{i, k, 0, ends[i].component == ends[k].component, search.path(point(i), point(k))};
        if (link.path.points.empty() || !(link.path.length > 0)) continue;
        link.rate = link.path.cost / link.path.length;
        if (link.rate <= links.max_cost) found.push_back(std::move(link));
    }
    std::ranges::sort(found, {}, [](const Link& link) {
        return std::tuple(!link.is_loop, link.rate, link.first, link.second);
    });
    std::vector<bool> is_used(ends.size(), false);
    std::vector<FeatureCurveNetwork> chosen;
    for (const Link& link : found) {
        if (is_used[link.first] || is_used[link.second]) continue;
        is_used[link.first] = is_used[link.second] = true;
        chosen.push_back(network_of_path(link.path, Pin::None));
    }
    return combine_networks(chosen, mesh, {wire_tolerance(arrays, diagonal)});
}

}  // namespace fcn
