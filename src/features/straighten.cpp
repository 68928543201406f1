// Borders between smooth patches zigzag along mesh edges, which pollutes lengths, angles and
// sharpness. Each free run of samples x0 (between nodes, creases and the mesh boundary, which stay)
// is replaced by the discrete smoothing spline
//     min  sum |x_i - x0_i|^2 + lambda sum |x_{i-1} - 2 x_i + x_{i+1}|^2,
// whose response 1 / (1 + lambda (2 - 2 cos w)^2) removes what oscillates within ten samples and
// keeps what does not: unlike Laplacian steps it does not shrink curves. Closed runs get a smaller
// lambda, so that their first harmonic, the loop itself, keeps 95% of its size. Then each sample is
// held within about an edge length of its vertex (softly first, by its weight), comes nearer to any
// other arc by a share of the distance only, so that arcs do not meet, and is projected to the
// faces around its vertex, not to the closest face of all, which may lie on the other side of a
// thin wall.

#include "features/straighten.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "features/smoothing_spline.h"
#include "features/triangle_point.h"

namespace fcn {
namespace {

constexpr double kLoopResponse = 0.95;  // of the first harmonic of a closed run
constexpr double kLoopTurn = 0.5;       // chord over length below which an open run is a loop
constexpr int kPullRounds = 6;
constexpr double kPullFactor = 4;  // of a sample's weight against shifts, per round
constexpr int kNodeReach = 3;      // samples from a shared node where arcs may be close

struct Use {
    int arc;
    int sample;
};

class Straightener {
public:
    Straightener(const MeshArrays& arrays, const EdgeNetwork& edges,
                 const std::vector<bool>& is_crease_edge, const StraightenOptions& options)
        : arrays_(arrays),
          edges_(edges),
          is_crease_edge_(is_crease_edge),
          options_(options),
          faces_(faces_of_vertices(arrays)),
          is_boundary_vertex_(arrays.vertex_count(), false),
          first_use_(arrays.vertex_count() + 1, 0),
          result_(edges.network) {
        for (int e = 0; e < arrays.edge_count(); ++e) {
            if (!arrays.is_boundary(e)) continue;
            for (int v : arrays.edge_vertices[e]) is_boundary_vertex_[v] = true;
        }
        list_uses();
    }

    FeatureCurveNetwork run() {
        const std::vector<int> valences = node_valences();
        for (std::size_t a = 0; a < result_.arcs.size(); ++a) {
            NetworkArc& arc = result_.arcs[a];
            const bool is_free_loop = arc.is_closed() && valences[arc.nodes[0]] == 2;
            smooth_arc(static_cast<int>(a), is_free_loop);
            if (is_free_loop) {
                arc.samples.back() = arc.samples.front();
                result_.nodes[arc.nodes[0]] = {arc.samples.front().position,
                                               arc.samples.front().surface};
            }
            drop_coincident_samples(arc);
        }
        return std::move(result_);
    }

private:
    void list_uses() {
        for (const auto& vertices : edges_.arc_vertices) {
            for (int v : vertices) ++first_use_[v + 1];
        }
        for (int v = 0; v < arrays_.vertex_count(); ++v) first_use_[v + 1] += first_use_[v];
        uses_.resize(first_use_.back());
        std::vector<int> next(first_use_.begin(), first_use_.end() - 1);
        for (std::size_t a = 0; a < edges_.arc_vertices.size(); ++a) {
            const std::vector<int>& vertices = edges_.arc_vertices[a];
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                uses_[next[vertices[i]]++] = {static_cast<int>(a), static_cast<int>(i)};
            }
        }
    }

    std::vector<int> node_valences() const {
        std::vector<int> valences(result_.nodes.size(), 0);
        for (const NetworkArc& arc : result_.arcs) {
            for (int node : arc.nodes) ++valences[node];
        }
        return valences;
    }

    bool is_fixed(int arc, int sample, bool is_free_loop) const {
        const std::vector<int>& intervals = edges_.arc_edges[arc];
        const int count = static_cast<int>(intervals.size());
        const int vertex = edges_.arc_vertices[arc][sample];
        if (is_boundary_vertex_[vertex]) return true;
        const bool is_end = sample == 0 || sample == count;
        if (is_end && !is_free_loop) return true;
        const int before = is_end ? intervals[count - 1] : intervals[sample - 1];
        const int after = is_end ? intervals[0] : intervals[sample];
        return is_crease_edge_[before] || is_crease_edge_[after];
    }

    void smooth_arc(int a, bool is_free_loop) {
        NetworkArc& arc = result_.arcs[a];
        const int count = static_cast<int>(arc.samples.size()) - 1;  // intervals
        std::vector<int> fixed;
        for (int i = 0; i < (is_free_loop ? count : count + 1); ++i) {
            if (is_fixed(a, i, is_free_loop)) fixed.push_back(i);
        }
        if (fixed.empty()) {
            std::vector<int> run(count);
            for (int i = 0; i < count; ++i) run[i] = i;
            smooth_run(a, run, true);
            return;
        }
        if (is_free_loop) fixed.push_back(fixed.front() + count);
        for (std::size_t k = 0; k + 1 < fixed.size(); ++k) {
            if (fixed[k + 1] - fixed[k] < 2) continue;
            std::vector<int> run;
            for (int i = fixed[k]; i <= fixed[k + 1]; ++i) {
                run.push_back(is_free_loop ? i % count : i);
            }
            smooth_run(a, run, false);
        }
    }

    /// Samples of a run; an open one keeps its first and last.
    void smooth_run(int a, const std::vector<int>& run, bool is_cyclic) {
        NetworkArc& arc = result_.arcs[a];
        const int size = static_cast<int>(run.size());
        Eigen::MatrixX3d start(size, 3);
        for (int i = 0; i < size; ++i) start.row(i) = arc.samples[run[i]].position.transpose();
        const Eigen::MatrixX3d smooth = held_spline(a, run, start, is_cyclic);
        for (int i = 0; i < size; ++i) {
            if (!is_cyclic && (i == 0 || i == size - 1)) continue;
            arc.samples[run[i]] = placed(a, run[i], smooth.row(i).transpose());
        }
    }

    double smoothing_weight(const Eigen::MatrixX3d& start, bool is_cyclic) const {
        const auto size = static_cast<int>(start.rows());
        double length = 0;
        for (int i = 0; i + 1 < size; ++i) length += (start.row(i + 1) - start.row(i)).norm();
        const double chord = (start.row(size - 1) - start.row(0)).norm();
        if (!is_cyclic && chord > kLoopTurn * length) return options_.smoothing;
        const double harmonic = 2 - 2 * std::cos(2 * std::numbers::pi / size);
        return std::min(options_.smoothing, (1 / kLoopResponse - 1) / (harmonic * harmonic));
    }

    /// The spline, with samples that would leave their place too far drawn back more strongly.
    Eigen::MatrixX3d held_spline(int a, const std::vector<int>& run, const Eigen::MatrixX3d& start,
                                 bool is_cyclic) const {
        std::vector<double> pull(run.size(), 1);
        Eigen::MatrixX3d smooth = spline(start, pull, is_cyclic);
        for (int round = 0; round < kPullRounds; ++round) {
            bool is_within = true;
            for (std::size_t i = 0; i < run.size(); ++i) {
                const auto row = static_cast<Eigen::Index>(i);
                const double shift = (smooth.row(row) - start.row(row)).norm();
                if (shift <= shift_limit(edges_.arc_vertices[a][run[i]])) continue;
                pull[i] *= kPullFactor;
                is_within = false;
            }
            if (is_within) break;
            smooth = spline(start, pull, is_cyclic);
        }
        return smooth;
    }

    Eigen::MatrixX3d spline(const Eigen::MatrixX3d& start, const std::vector<double>& pull,
                            bool is_cyclic) const {
        return smoothing_spline(start, pull, smoothing_weight(start, is_cyclic), is_cyclic);
    }

    std::vector<int> faces_around(int vertex) const {
        std::vector<int> ring;
        for (const int* f = faces_.begin(vertex); f != faces_.end(vertex); ++f) {
            for (int v : arrays_.face_vertices[*f]) {
                ring.insert(ring.end(), faces_.begin(v), faces_.end(v));
            }
        }
        std::sort(ring.begin(), ring.end());
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
        return ring;
    }

    bool is_near_shared_node(const Use& one, const Use& other) const {
        for (int end_one = 0; end_one < 2; ++end_one) {
            for (int end_other = 0; end_other < 2; ++end_other) {
                if (result_.arcs[one.arc].nodes[end_one] !=
                    result_.arcs[other.arc].nodes[end_other]) {
                    continue;
                }
                if (distance_to_end(one, end_one) <= kNodeReach &&
                    distance_to_end(other, end_other) <= kNodeReach) {
                    return true;
                }
            }
        }
        return false;
    }

    int distance_to_end(const Use& use, int end) const {
        const int last = static_cast<int>(edges_.arc_vertices[use.arc].size()) - 1;
        return end == 0 ? use.sample : last - use.sample;
    }

    double shift_limit(int vertex) const {
        double length = 0;
        for (const int* f = faces_.begin(vertex); f != faces_.end(vertex); ++f) {
            for (int e : arrays_.face_edges[*f]) length += arrays_.edge_length(e);
        }
        return options_.max_shift * length / (3.0 * faces_.size(vertex));
    }

    /// Shortens an offset to local edge lengths, and takes away what brings the sample more than
    /// its share nearer to another arc.
    Vec3 limited(int a, int sample, Vec3 offset, const std::vector<int>& around) const {
        const int vertex = edges_.arc_vertices[a][sample];
        const double limit = shift_limit(vertex);
        if (offset.norm() > limit) offset *= limit / offset.norm();
        const Use own{a, sample};
        for (int f : around) {
            for (int v : arrays_.face_vertices[f]) {
                for (int u = first_use_[v]; u < first_use_[v + 1]; ++u) {
                    const Use& other = uses_[u];
                    if (other.arc == a && std::abs(other.sample - sample) <= 2 * kNodeReach) {
                        continue;
                    }
                    if (v == vertex || is_near_shared_node(own, other)) continue;
                    const Vec3 between = arrays_.points[v] - arrays_.points[vertex];
                    const double excess =
                        offset.dot(between) / between.squaredNorm() - options_.max_neighbor_share;
                    if (excess > 0) offset -= excess * between;
                }
            }
        }
        return offset;
    }

    ArcSample placed(int a, int sample, const Vec3& target) const {
        const int vertex = edges_.arc_vertices[a][sample];
        const std::vector<int> around = faces_around(vertex);
        const Vec3 goal =
            arrays_.points[vertex] + limited(a, sample, target - arrays_.points[vertex], around);
        ArcSample best;
        double best_distance = std::numeric_limits<double>::infinity();
        for (int f : around) {
            const auto [i, j, k] = arrays_.face_vertices[f];
            const Vec3 barycentric =
                closest_barycentric(goal, arrays_.points[i], arrays_.points[j], arrays_.points[k]);
            const Vec3 position = barycentric[0] * arrays_.points[i] +
                                  barycentric[1] * arrays_.points[j] +
                                  barycentric[2] * arrays_.points[k];
            const double distance = (position - goal).squaredNorm();
            if (distance < best_distance) {
                best_distance = distance;
                best.position = position;
                best.surface = {f, barycentric};
            }
        }
        return best;
    }

    /// Smoothing can pull samples of a spike together.
    void drop_coincident_samples(NetworkArc& arc) const {
        const double tolerance = 1e-6 * arrays_.mean_edge_length;
        const std::size_t least = arc.is_closed() ? 4 : 2;
        std::vector<ArcSample> kept{arc.samples.front()};
        for (std::size_t i = 1; i + 1 < arc.samples.size(); ++i) {
            const Vec3& p = arc.samples[i].position;
            const std::size_t rest = arc.samples.size() - i;
            const bool is_needed = kept.size() + rest <= least;
            const bool is_close = (p - kept.back().position).norm() <= tolerance ||
                                  (p - arc.samples.back().position).norm() <= tolerance;
            if (is_needed || !is_close) kept.push_back(arc.samples[i]);
        }
        kept.push_back(arc.samples.back());
        arc.samples = std::move(kept);
    }

    const MeshArrays& arrays_;
    const EdgeNetwork& edges_;
    const std::vector<bool>& is_crease_edge_;
    StraightenOptions options_;
    IndexRows faces_;
    std::vector<bool> is_boundary_vertex_;
    std::vector<int> first_use_;
    std::vector<Use> uses_;
    FeatureCurveNetwork result_;
};

}  // namespace

FeatureCurveNetwork straighten(const MeshArrays& arrays, const EdgeNetwork& edges,
                               const std::vector<bool>& is_crease_edge,
                               const StraightenOptions& options) {
    return Straightener(arrays, edges, is_crease_edge, options).run();
}

}  // namespace fcn
