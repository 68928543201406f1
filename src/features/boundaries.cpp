// Mesh boundaries and borders between face labels as arcs. Both run along mesh edges, so they are
// traced like any marked edges (edge_chains.cpp), with nodes at corners and wherever a feature
// arrives; what remains is to fit the detected features to them:
//   - an interval whose two samples lie on one border edge runs along the border and goes;
//   - a sample on a border cuts the feature and becomes a node of the border;
//   - an interval between faces of different labels crosses a border somewhere in between: the
//     closest border edge near by gets a node there.
// A corner must turn by the angle both at its vertex and between the chords three edges to either
// side, where it must turn most: the teeth of a scan's boundary are no corners.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "features/edge_chains.h"

namespace fcn {
namespace {

constexpr double kOnEdge = 1e-4;    // barycentric coordinate below which a sample is on the edge
constexpr int kCornerReach = 3;     // edges to either side
constexpr int kCrossingFaces = 64;  // faces searched for the border edge that an interval crosses

/// Where a sample touches the borders: at a marked vertex, inside a marked edge, or nowhere.
struct Touch {
    int vertex = -1;
    int edge = -1;
    double t = 0;  ///< along the edge's from -> to
    bool is_none() const { return vertex < 0 && edge < 0; }
};

double turning(const Vec3& before, const Vec3& at, const Vec3& after) {
    const Vec3 in = at - before, out = after - at;
    return std::atan2(in.cross(out).norm(), in.dot(out));
}

/// Marks the corners of one traced arc.
void mark_corners(const MeshArrays& arrays, const std::vector<int>& chain, double corner_angle,
                  std::vector<bool>& is_corner) {
    const bool is_closed = chain.front() == chain.back();
    const int count = static_cast<int>(chain.size()) - 1;
    const auto point = [&](int i) {
        const int k = is_closed ? (i % count + count) % count : std::clamp(i, 0, count);
        return arrays.points[chain[k]];
    };
    const int reach = is_closed ? std::min(kCornerReach, std::max(1, count / 4)) : kCornerReach;
    std::vector<double> wide(count + 1, 0);
    const int first = is_closed ? 0 : 1;
    for (int i = first; i < count; ++i)
        wide[i] = turning(point(i - reach), point(i), point(i + reach));
    for (int i = first; i < count; ++i) {
        if (wide[i] < corner_angle ||
            turning(point(i - 1), point(i), point(i + 1)) < corner_angle) {
            continue;
        }
        bool is_largest = true;
        for (int d = -reach; d <= reach; ++d) {
            const int k = is_closed ? ((i + d) % count + count) % count : i + d;
            if (k < first || k >= count || k == i) continue;
            is_largest = is_largest && (wide[k] < wide[i] || (wide[k] == wide[i] && k > i));
        }
        if (is_largest) is_corner[chain[i]] = true;
    }
}

class BorderJoiner {
public:
    BorderJoiner(const FeatureCurveNetwork& network, const LoadedMesh& mesh, BoundaryPolicy policy,
                 double corner_angle)
        : features_(network),
          mesh_(mesh),
          policy_(policy),
          arrays_(mesh_arrays(mesh.mesh)),
          is_border_(arrays_.edge_count(), false) {
        for (int e = 0; e < arrays_.edge_count(); ++e) {
            const auto [f, g] = arrays_.edge_faces[e];
            is_border_[e] = f < 0 || g < 0 || label(f) != label(g);
        }
        border_edges_ = edges_of_vertices(arrays_, is_border_);
        is_corner_.assign(arrays_.vertex_count(), false);
        const EdgeNetwork plain = trace_edges(arrays_, is_border_, mesh.face_labels, "boundary");
        for (const auto& chain : plain.arc_vertices) {
            mark_corners(arrays_, chain, corner_angle, is_corner_);
        }
    }

    FeatureCurveNetwork join() {
        result_ = features_;
        result_.nodes.clear();
        result_.arcs.clear();
        result_.curves.clear();
        result_.segments.clear();
        result_.orbits.clear();
        node_of_feature_node_.assign(features_.nodes.size(), -1);
        for (std::size_t a = 0; a < features_.arcs.size(); ++a) {
            lines_.push_back(cut_feature(static_cast<int>(a)));
            for (const auto& [first, last] : lines_.back().pieces) {
                remember(lines_.back().touches[first]);
                remember(lines_.back().touches[last]);
            }
        }
        std::vector<NetworkArc> borders = border_arcs();
        for (std::size_t a = 0; a < features_.arcs.size(); ++a) add_feature(static_cast<int>(a));
        carry_orbits();
        for (NetworkArc& arc : borders) result_.arcs.push_back(std::move(arc));
        return std::move(result_);
    }

private:
    struct Polyline {
        std::vector<ArcSample> samples;
        std::vector<Touch> touches;
        std::vector<std::pair<int, int>> pieces;  ///< first and last sample of what is kept
    };

    int label(int face) const { return mesh_.face_labels.empty() ? 0 : mesh_.face_labels[face]; }

    Touch touch(const ArcSample& sample) const {
        Touch result;
        const int face = sample.surface.face;
        if (face < 0) return result;
        const Vec3& b = sample.surface.barycentric;
        for (int i = 0; i < 3; ++i) {
            const int v = arrays_.face_vertices[face][i];
            if (b[i] >= 1 - kOnEdge && border_edges_.size(v) > 0) {
                result.vertex = v;
                return result;
            }
        }
        for (int i = 0; i < 3; ++i) {
            const int e = arrays_.face_edges[face][i];
            if (b[(i + 2) % 3] > kOnEdge || !is_border_[e]) continue;
            const double along = b[(i + 1) % 3] / (b[i] + b[(i + 1) % 3]);
            result.edge = e;
            result.t =
                arrays_.edge_vertices[e][0] == arrays_.face_vertices[face][i] ? along : 1 - along;
            return result;
        }
        return result;
    }

    void remember(const Touch& t) {
        if (t.vertex >= 0) is_corner_[t.vertex] = true;
        if (t.edge >= 0) cuts_[t.edge].insert(t.t);
    }

    // --- crossings -----------------------------------------------------------------------------

    void add_crossings(std::vector<ArcSample>& samples) const {
        if (mesh_.face_labels.empty()) return;
        std::vector<ArcSample> with;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (i > 0) {
                const ArcSample& one = samples[i - 1];
                const ArcSample& other = samples[i];
                const int f = one.surface.face, g = other.surface.face;
                if (f >= 0 && g >= 0 && label(f) != label(g) && touch(one).is_none() &&
                    touch(other).is_none()) {
                    add_crossing(one, other, with);
                }
            }
            with.push_back(samples[i]);
        }
        samples = std::move(with);
    }

    /// The point of a border edge near `one` that is closest to the interval.
    void add_crossing(const ArcSample& one, const ArcSample& other,
                      std::vector<ArcSample>& samples) const {
        std::vector<int> faces{one.surface.face};
        double best_distance = std::numeric_limits<double>::infinity();
        ArcSample best;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                const int e = arrays_.face_edges[faces[i]][k];
                if (is_border_[e]) {
                    const auto [distance, t] = edge_distance(e, one.position, other.position);
                    if (distance < best_distance) {
                        best_distance = distance;
                        best = edge_sample(e, t);
                    }
                }
                const int g = arrays_.face_neighbors[faces[i]][k];
                if (g >= 0 && faces.size() < kCrossingFaces &&
                    std::find(faces.begin(), faces.end(), g) == faces.end()) {
                    faces.push_back(g);
                }
            }
        }
        if (best.surface.face < 0) return;
        const double tolerance = 1e-9 * result_.diagonal;
        if ((best.position - one.position).norm() > tolerance &&
            (best.position - other.position).norm() > tolerance) {
            samples.push_back(best);
        }
    }

    /// Distance between edge and segment and where on the edge.
    std::pair<double, double> edge_distance(int e, const Vec3& p, const Vec3& q) const {
        const Vec3& a = arrays_.points[arrays_.edge_vertices[e][0]];
        const Vec3 u = arrays_.points[arrays_.edge_vertices[e][1]] - a, v = q - p, w = a - p;
        const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
        const double determinant = uu * vv - uv * uv;
        double t =
            determinant > 1e-14 * uu * vv ? (uv * v.dot(w) - vv * u.dot(w)) / determinant : 0;
        for (int pass = 0; pass < 2; ++pass) {
            t = std::clamp(t, 0.0, 1.0);
            const double s = std::clamp((a + t * u - p).dot(v) / vv, 0.0, 1.0);
            t = (p + s * v - a).dot(u) / uu;
        }
        t = std::clamp(t, 0.0, 1.0);
        const double s = std::clamp((a + t * u - p).dot(v) / vv, 0.0, 1.0);
        return {(a + t * u - p - s * v).norm(), t};
    }

    ArcSample edge_sample(int e, double t) const {
        if (t < kOnEdge) t = 0;
        if (t > 1 - kOnEdge) t = 1;
        const int face =
            arrays_.edge_faces[e][0] >= 0 ? arrays_.edge_faces[e][0] : arrays_.edge_faces[e][1];
        const auto [from, to] = arrays_.edge_vertices[e];
        ArcSample sample;
        sample.position = (1 - t) * arrays_.points[from] + t * arrays_.points[to];
        sample.surface.face = face;
        for (int i = 0; i < 3; ++i) {
            const int v = arrays_.face_vertices[face][i];
            sample.surface.barycentric[i] = v == from ? 1 - t : v == to ? t : 0;
        }
        return sample;
    }

    // --- borders -------------------------------------------------------------------------------

    std::vector<NetworkArc> border_arcs() {
        EdgeNetwork traced =
            trace_edges(arrays_, is_border_, mesh_.face_labels, "boundary", is_corner_);
        result_.nodes = traced.network.nodes;
        for (std::size_t n = 0; n < traced.node_vertices.size(); ++n) {
            node_of_vertex_[traced.node_vertices[n]] = static_cast<int>(n);
        }
        std::vector<NetworkArc> arcs;
        for (std::size_t a = 0; a < traced.network.arcs.size(); ++a) {
            NetworkArc& arc = traced.network.arcs[a];
            const int first_edge = traced.arc_edges[a].front();
            arc.kind = arrays_.is_boundary(first_edge) ? ArcKind::Boundary : ArcKind::LabelBorder;
            arc.source = arc.kind == ArcKind::Boundary ? "boundary" : "label";
            arc.pin = policy_ == BoundaryPolicy::Keep ? Pin::Keep : Pin::None;
            arc.patches = {-1, -1};
            split_at_cuts(arc, traced.arc_vertices[a], traced.arc_edges[a], arcs);
        }
        return arcs;
    }

    /// Cuts a border arc where features meet it inside an edge.
    void split_at_cuts(const NetworkArc& arc, const std::vector<int>& vertices,
                       const std::vector<int>& edges, std::vector<NetworkArc>& arcs) {
        NetworkArc piece = arc;
        piece.samples = {arc.samples.front()};
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const auto found = cuts_.find(edges[i]);
            if (found != cuts_.end()) {
                std::vector<double> ts(found->second.begin(), found->second.end());
                if (arrays_.edge_vertices[edges[i]][0] != vertices[i]) {
                    std::reverse(ts.begin(), ts.end());
                }
                for (double t : ts) {
                    const ArcSample sample = edge_sample(edges[i], t);
                    const int node = static_cast<int>(result_.nodes.size());
                    result_.nodes.push_back({sample.position, sample.surface});
                    node_of_cut_[{edges[i], t}] = node;
                    piece.samples.push_back(sample);
                    piece.nodes[1] = node;
                    arcs.push_back(piece);
                    piece.nodes[0] = node;
                    piece.samples = {sample};
                }
            }
            piece.samples.push_back(arc.samples[i + 1]);
        }
        piece.nodes[1] = arc.nodes[1];
        arcs.push_back(std::move(piece));
    }

    // --- features ------------------------------------------------------------------------------

    bool is_along(const Touch& one, const Touch& other) const {
        if (one.is_none() || other.is_none()) return false;
        const auto is_on = [&](const Touch& t, int e) {
            return t.edge == e || (t.vertex >= 0 && (arrays_.edge_vertices[e][0] == t.vertex ||
                                                     arrays_.edge_vertices[e][1] == t.vertex));
        };
        if (one.edge >= 0) return is_on(other, one.edge);
        if (other.edge >= 0) return is_on(one, other.edge);
        if (one.vertex == other.vertex) return true;
        const int* begin = border_edges_.begin(one.vertex);
        const int* end = border_edges_.end(one.vertex);
        return std::any_of(begin, end, [&](int e) { return is_on(other, e); });
    }

    int node_of_touch(const Touch& t) const {
        return t.vertex >= 0 ? node_of_vertex_.at(t.vertex) : node_of_cut_.at({t.edge, t.t});
    }

    int node_of_feature_node(int node) {
        int& id = node_of_feature_node_[node];
        if (id < 0) {
            id = static_cast<int>(result_.nodes.size());
            result_.nodes.push_back(features_.nodes[node]);
        }
        return id;
    }

    /// A feature arc between the places where it touches borders, without what runs along them.
    Polyline cut_feature(int a) const {
        const NetworkArc& arc = features_.arcs[a];
        Polyline line{arc.samples, {}, {}};
        add_crossings(line.samples);
        for (const ArcSample& sample : line.samples) line.touches.push_back(touch(sample));
        if (arc.is_closed() && line.touches.front().is_none()) start_at_touch(a, line);
        const int last = static_cast<int>(line.samples.size()) - 1;
        int start = 0;
        for (int i = 1; i <= last; ++i) {
            if (i < last && line.touches[i].is_none()) continue;
            const bool is_single = i == start + 1;
            const bool is_back = line.touches[start].vertex >= 0 && i - start < 3 &&
                                 line.touches[start].vertex == line.touches[i].vertex;
            if (!is_back && !(is_single && is_along(line.touches[start], line.touches[i]))) {
                line.pieces.push_back({start, i});
            }
            start = i;
        }
        return line;
    }

    void add_feature(int a) {
        const NetworkArc& arc = features_.arcs[a];
        const Polyline& line = lines_[a];
        for (const auto& [first, last] : line.pieces) {
            NetworkArc piece = arc;
            piece.curve = -1;
            piece.origins.clear();
            piece.samples.assign(line.samples.begin() + first, line.samples.begin() + last + 1);
            const int ends[2] = {first, last};
            for (int side = 0; side < 2; ++side) {
                const Touch& t = line.touches[ends[side]];
                if (t.is_none()) {
                    piece.nodes[side] = node_of_feature_node(arc.nodes[side]);
                    continue;
                }
                piece.nodes[side] = node_of_touch(t);
                ArcSample& end = side == 0 ? piece.samples.front() : piece.samples.back();
                const NetworkNode& node = result_.nodes[piece.nodes[side]];
                end = {node.position, node.surface};
            }
            if (first == 0 && last + 1 == static_cast<int>(line.samples.size())) {
                whole_arc_[a] = static_cast<int>(result_.arcs.size());
            }
            result_.arcs.push_back(std::move(piece));
        }
    }

    /// A closed arc alone at its node that meets a border starts there.
    void start_at_touch(int a, Polyline& line) const {
        const int node = features_.arcs[a].nodes[0];
        int end_count = 0;
        for (const NetworkArc& other : features_.arcs) {
            end_count += (other.nodes[0] == node) + (other.nodes[1] == node);
        }
        if (end_count != 2) return;
        const auto found = std::find_if(line.touches.begin(), line.touches.end(),
                                        [](const Touch& t) { return !t.is_none(); });
        if (found == line.touches.end()) return;
        const auto shift = found - line.touches.begin();
        line.samples.pop_back();
        line.touches.pop_back();
        std::rotate(line.samples.begin(), line.samples.begin() + shift, line.samples.end());
        std::rotate(line.touches.begin(), line.touches.begin() + shift, line.touches.end());
        line.samples.push_back(line.samples.front());
        line.touches.push_back(line.touches.front());
    }

    /// Orbits whose members all came through whole.
    void carry_orbits() {
        for (SymmetryOrbit orbit : features_.orbits) {
            bool is_whole = true;
            for (OrbitMember& member : orbit.members) {
                const auto found = whole_arc_.find(member.arc);
                is_whole = is_whole && found != whole_arc_.end();
                if (is_whole) member.arc = found->second;
            }
            if (is_whole) result_.orbits.push_back(std::move(orbit));
        }
    }

    const FeatureCurveNetwork& features_;
    const LoadedMesh& mesh_;
    BoundaryPolicy policy_;
    MeshArrays arrays_;
    std::vector<bool> is_border_;
    IndexRows border_edges_;
    std::vector<bool> is_corner_;
    std::vector<Polyline> lines_;
    std::map<int, std::set<double>> cuts_;  ///< per border edge
    std::map<int, int> node_of_vertex_;
    std::map<std::pair<int, double>, int> node_of_cut_;
    std::vector<int> node_of_feature_node_;
    std::map<int, int> whole_arc_;
    FeatureCurveNetwork result_;
};

}  // namespace

FeatureCurveNetwork add_boundaries(const FeatureCurveNetwork& network, const LoadedMesh& mesh,
                                   BoundaryPolicy policy, double corner_angle) {
    if (policy == BoundaryPolicy::Ignore) return network;
    FeatureCurveNetwork joined = BorderJoiner(network, mesh, policy, corner_angle).join();
    if (!(joined.diagonal > 0)) set_provenance(joined, mesh);
    return joined;
}

}  // namespace fcn
