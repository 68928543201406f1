// Patch borders of variational shape approximation follow whatever edges the flood met last: they
// zigzag, and run beside a crease when both sides of it fit the same proxy. The remedy is the
// binary cut of hierarchical mesh decomposition (Katz and Tal 2003, section 4.3; Boykov and
// Kolmogorov 2004 for the flow): in a band around the border of two patches, each face goes to the
// patch that minimises
//     sum over faces  weight * area * |n - proxy|^2 / h  +  sum over cut edges  length * cost,
// where the cost of an edge falls from 1 on flat ground to almost nothing on a crease, and h is
// the mean edge length. Pairs of patches are cut one after the other, in ascending order.
// The deepest faces of every patch stay, so none vanishes; what a cut tears off goes to the
// neighbour with the longest common border.

#include "features/border_cut.h"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <cmath>
#include <limits>
#include <map>

namespace fcn {
namespace {

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
using FlowGraph = boost::adjacency_list<
    boost::vecS, boost::vecS, boost::directedS,
    boost::property<boost::vertex_index_t, long,
                    boost::property<boost::vertex_color_t, boost::default_color_type,
                                    boost::property<boost::vertex_distance_t, long,
                                                    boost::property<boost::vertex_predecessor_t,
                                                                    Traits::edge_descriptor>>>>,
    boost::property<
        boost::edge_capacity_t, double,
        boost::property<boost::edge_residual_capacity_t, double,
                        boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>>;

/// Minimum cut between two terminals; nodes 0 .. count - 1.
class Cut {
public:
    explicit Cut(int count) : graph_(count + 2), source_(count), sink_(count + 1) {}

    void add_edge(int a, int b, double capacity, double back) {
        const auto forward = boost::add_edge(a, b, graph_).first;
        const auto reverse = boost::add_edge(b, a, graph_).first;
        boost::put(boost::edge_capacity, graph_, forward, capacity);
        boost::put(boost::edge_capacity, graph_, reverse, back);
        boost::put(boost::edge_reverse, graph_, forward, reverse);
        boost::put(boost::edge_reverse, graph_, reverse, forward);
    }
    /// What node `a` costs on the sink's and on the source's side.
    void add_terminals(int a, double cost_at_sink, double cost_at_source) {
        add_edge(source_, a, cost_at_sink, 0);
        add_edge(a, sink_, cost_at_source, 0);
    }
    /// Per node: is it on the source's side?
    std::vector<bool> solve() {
        boost::boykov_kolmogorov_max_flow(graph_, source_, sink_);
        const auto color = boost::get(boost::vertex_color, graph_);
        std::vector<bool> is_source(source_);
        for (int i = 0; i < source_; ++i) is_source[i] = color[i] == color[source_];
        return is_source;
    }

private:
    FlowGraph graph_;
    int source_;
    int sink_;
};

class BorderMover {
public:
    BorderMover(const MeshArrays& arrays, const std::vector<double>& angles,
                const std::vector<int>& face_labels, const std::vector<int>& patch_of_face,
                const std::vector<Vec3>& proxies, const BorderCutOptions& options)
        : arrays_(arrays),
          angles_(angles),
          labels_(face_labels),
          patch_(patch_of_face),
          proxies_(proxies),
          options_(options),
          node_of_face_(arrays.face_count(), -1) {}

    std::vector<int> run() {
        for (int sweep = 0; sweep < options_.sweeps; ++sweep) {
            find_fixed_faces();
            std::map<std::pair<int, int>, std::vector<int>> borders;
            for (int e = 0; e < arrays_.edge_count(); ++e) {
                const auto [f, g] = arrays_.edge_faces[e];
                if (f < 0 || g < 0 || patch_[f] == patch_[g]) continue;
                borders[std::minmax(patch_[f], patch_[g])].push_back(e);
            }
            for (const auto& [pair, edges] : borders) cut(pair.first, pair.second, edges);
            reconnect();
        }
        return patch_;
    }

private:
    double edge_cost(int e) const {
        const auto [f, g] = arrays_.edge_faces[e];
        const double length = arrays_.edge_length(e);
        if (!labels_.empty() && labels_[f] != labels_[g]) return length * options_.crease_cost;
        const double t = (std::abs(angles_[e]) - options_.flat_angle) /
                         (options_.crease_angle - options_.flat_angle);
        const double discount = std::clamp(t, 0.0, 1.0) * (1 - options_.crease_cost);
        return length * (1 - discount);
    }

    double face_cost(int f, int patch) const {
        return options_.normal_weight * arrays_.areas[f] / arrays_.mean_edge_length *
               (arrays_.normals[f] - proxies_[patch]).squaredNorm();
    }

    /// Distance from the patch's border in faces; fixed are faces beyond the band and those at the
    /// greatest distance in their patch.
    void find_fixed_faces() {
        std::vector<int> distance(arrays_.face_count(), -1), queue;
        for (int f = 0; f < arrays_.face_count(); ++f) {
            for (int g : arrays_.face_neighbors[f]) {
                if (g < 0 || patch_[g] == patch_[f] || distance[f] == 0) continue;
                distance[f] = 0;
                queue.push_back(f);
            }
        }
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (int g : arrays_.face_neighbors[queue[i]]) {
                if (g < 0 || distance[g] >= 0) continue;
                distance[g] = distance[queue[i]] + 1;
                queue.push_back(g);
            }
        }
        std::vector<int> depth(proxies_.size(), 0);
        for (int f = 0; f < arrays_.face_count(); ++f) {
            depth[patch_[f]] = std::max(depth[patch_[f]], distance[f]);
        }
        is_fixed_.assign(arrays_.face_count(), false);
        for (int f = 0; f < arrays_.face_count(); ++f) {
            is_fixed_[f] = distance[f] < 0 || distance[f] >= options_.band_width ||
                           distance[f] == depth[patch_[f]];
        }
    }

    std::vector<int> band(int p, int q, const std::vector<int>& edges) {
        std::vector<int> faces;
        const auto visit = [&](int f) {
            if (f < 0 || node_of_face_[f] >= 0 || is_fixed_[f]) return;
            if (patch_[f] != p && patch_[f] != q) return;
            node_of_face_[f] = static_cast<int>(faces.size());
            faces.push_back(f);
        };
        for (int e : edges) {
            for (int f : arrays_.edge_faces[e]) visit(f);
        }
        for (std::size_t i = 0, end = faces.size(), step = 1;
             i < faces.size() && step < static_cast<std::size_t>(options_.band_width);
             end = faces.size(), ++step) {
            for (; i < end; ++i) {
                for (int g : arrays_.face_neighbors[faces[i]]) visit(g);
            }
        }
        return faces;
    }

    void cut(int p, int q, const std::vector<int>& edges) {
        const std::vector<int> faces = band(p, q, edges);
        if (!faces.empty()) {
            const double infinite =
                1e6 * arrays_.mean_edge_length * static_cast<double>(1 + faces.size());
            Cut flow(static_cast<int>(faces.size()));
            for (std::size_t i = 0; i < faces.size(); ++i) {
                double cost_p = face_cost(faces[i], p), cost_q = face_cost(faces[i], q);
                for (int k = 0; k < 3; ++k) {
                    const int g = arrays_.face_neighbors[faces[i]][k];
                    if (g < 0) continue;
                    const double cost = edge_cost(arrays_.face_edges[faces[i]][k]);
                    const int node = node_of_face_[g];
                    if (node > static_cast<int>(i)) {
                        flow.add_edge(static_cast<int>(i), node, cost, cost);
                    } else if (node < 0) {
                        if (patch_[g] == q) cost_p += cost;
                        if (patch_[g] == p) cost_q += cost;
                    }
                }
                flow.add_terminals(static_cast<int>(i), std::min(cost_q, infinite),
                                   std::min(cost_p, infinite));
            }
            const std::vector<bool> is_p = flow.solve();
            for (std::size_t i = 0; i < faces.size(); ++i) patch_[faces[i]] = is_p[i] ? p : q;
        }
        for (int f : faces) node_of_face_[f] = -1;
    }

    /// Keeps the largest part of each patch; the others join the neighbour they share most border
    /// with.
    void reconnect() {
        struct Part {
            std::vector<int> faces;
            double area = 0;
        };
        std::vector<int> part_of_face(arrays_.face_count(), -1);
        std::vector<Part> parts;
        for (int start = 0; start < arrays_.face_count(); ++start) {
            if (part_of_face[start] >= 0) continue;
            Part part{{start}, 0};
            part_of_face[start] = static_cast<int>(parts.size());
            for (std::size_t i = 0; i < part.faces.size(); ++i) {
                part.area += arrays_.areas[part.faces[i]];
                for (int g : arrays_.face_neighbors[part.faces[i]]) {
                    if (g < 0 || part_of_face[g] >= 0 || patch_[g] != patch_[start]) continue;
                    part_of_face[g] = static_cast<int>(parts.size());
                    part.faces.push_back(g);
                }
            }
            parts.push_back(std::move(part));
        }
        std::vector<int> main_part(proxies_.size(), -1);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            int& best = main_part[patch_[parts[k].faces[0]]];
            if (best < 0 || parts[k].area > parts[best].area) best = static_cast<int>(k);
        }
        for (std::size_t k = 0; k < parts.size(); ++k) {
            if (main_part[patch_[parts[k].faces[0]]] == static_cast<int>(k)) continue;
            std::map<int, double> border;
            for (int f : parts[k].faces) {
                for (int i = 0; i < 3; ++i) {
                    const int g = arrays_.face_neighbors[f][i];
                    if (g < 0 || part_of_face[g] == static_cast<int>(k)) continue;
                    border[patch_[g]] += arrays_.edge_length(arrays_.face_edges[f][i]);
                }
            }
            int target = -1;
            for (const auto& [patch, length] : border) {
                if (target < 0 || length > border[target]) target = patch;
            }
            if (target < 0) continue;
            for (int f : parts[k].faces) patch_[f] = target;
        }
    }

    const MeshArrays& arrays_;
    const std::vector<double>& angles_;
    const std::vector<int>& labels_;
    std::vector<int> patch_;
    const std::vector<Vec3>& proxies_;
    BorderCutOptions options_;
    std::vector<int> node_of_face_;
    std::vector<bool> is_fixed_;
};

}  // namespace

std::vector<int> move_borders(const MeshArrays& arrays, const std::vector<double>& angles,
                              const std::vector<int>& face_labels,
                              const std::vector<int>& patch_of_face,
                              const std::vector<Vec3>& proxy_normals,
                              const BorderCutOptions& options) {
    return BorderMover(arrays, angles, face_labels, patch_of_face, proxy_normals, options).run();
}

}  // namespace fcn
