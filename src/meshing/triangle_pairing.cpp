// Triangles are paired to quads by a heaviest matching of their dual graph, after Remacle et al.
// 2012, "Blossom-Quad: a non-uniform quadrilateral mesh generator using a minimum-cost
// perfect-matching algorithm". Departures: the mesh is cut at all edge middles afterwards, so a
// triangle may stay alone and the matching need not be perfect; the weight of a pair comes from the
// four quads that it will be cut into, and a pair with a bad one of these does not exist. And
// Blossom-Quad does not see how many quads come to meet at a vertex, which is what makes a mesh
// irregular: vertices cost the square of their distance from a regular number. That makes the
// objective concave, and it is climbed by the steps of Frank and Wolfe 1956: match by the gradient
// at the mean of the matchings so far; the best matching on the way is taken.
#include "meshing/triangle_pairing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meshing/quad_shape.h"
#include "meshing/weighted_matching.h"

namespace fcn {
namespace {

constexpr double kLeastSine = 0.25;    ///< of the corners of the four quads of a pair
constexpr double kPairWorth = 1.0;     ///< of a pair besides its shape, which is worth [0, 1]
constexpr double kValenceCost = 0.25;  ///< of a vertex, per square of what is too much
constexpr int kSteps = 16;
constexpr double kUnits = 1e6;  ///< the matching has integer weights

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class Pairing {
public:
    explicit Pairing(const PairableTriangles& mesh) : mesh_(mesh) {
        for (int e = 0; e < static_cast<int>(mesh.edges.size()); ++e) {
            if (mesh.edges[at(e)].is_curve || mesh.edges[at(e)].right < 0) continue;
            const double shape = shape_of(quad_across(mesh, e));
            if (shape <= 0) continue;
            edges_.push_back(e);
            worth_.push_back(kPairWorth + shape);
        }
        set_surplus();
    }

    std::vector<int> run() const {
        std::vector<double> mean(edges_.size(), 0);
        std::vector<bool> best;
        double best_value = -std::numeric_limits<double>::infinity();
        for (int step = 0; step < kSteps; ++step) {
            const std::vector<bool> taken = match(surplus_after(mean));
            const double value = value_of(taken);
            if (value > best_value) {
                best_value = value;
                best = taken;
            }
            const double share = 2.0 / (step + 2);
            for (std::size_t i = 0; i < mean.size(); ++i)
                mean[i] += share * ((taken[i] ? 1 : 0) - mean[i]);
        }
        std::vector<int> result;
        for (std::size_t i = 0; i < edges_.size(); ++i)
            if (best[i]) result.push_back(edges_[i]);
        return result;
    }

private:
    const Vec3& point(int v) const { return mesh_.points[at(v)]; }

    /// In (0, 1]; 0: no pair.
    double shape_of(const PairedQuad& quad) const {
        Vec3 centre = Vec3::Zero();
        for (const int v : quad.corners) centre += 0.25 * point(v);
        double least = 1, sum = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const double sine =
                scaled_jacobian({point(quad.corners[i]), mesh_.edges[at(quad.edges[i])].middle,
                                 centre, mesh_.edges[at(quad.edges[(i + 3) % 4])].middle});
            least = std::min(least, sine);
            sum += sine;
        }
        return least < kLeastSine ? 0 : 0.5 * least + 0.125 * sum;
    }

    /// How many edges more than regular there are at each vertex before any pair is made. In each
    /// sector between curves, as many quads are regular as make right angles.
    void set_surplus() {
        const std::size_t count = mesh_.points.size();
        std::vector<double> angle(count, 0);
        std::vector<int> valence(count, 0), curves(count, 0), open(count, 0);
        for (const auto& corners : mesh_.triangles)
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3 a = point(corners[(i + 1) % 3]) - point(corners[i]);
                const Vec3 b = point(corners[(i + 2) % 3]) - point(corners[i]);
                angle[at(corners[i])] += std::atan2(a.cross(b).norm(), a.dot(b));
            }
        for (const TriangleEdge& edge : mesh_.edges)
            for (const int v : {edge.from, edge.to}) {
                ++valence[at(v)];
                curves[at(v)] += edge.is_curve;
                open[at(v)] += edge.right < 0;
            }
        surplus_.assign(count, 0);
        for (std::size_t v = 0; v < count; ++v) {
            // One quad at least between two curves.
            const int sectors = std::max(1, open[v] > 0 ? curves[v] - 1 : curves[v]);
            const int quads =
                std::max(sectors, static_cast<int>(std::lround(angle[v] / (std::numbers::pi / 2))));
            surplus_[v] = valence[v] - (open[v] > 0 ? quads + 1 : std::max(3, quads));
        }
    }

    std::vector<double> surplus_after(const std::vector<double>& taken) const {
        std::vector<double> surplus = surplus_;
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            const TriangleEdge& edge = mesh_.edges[at(edges_[i])];
            surplus[at(edge.from)] -= taken[i];
            surplus[at(edge.to)] -= taken[i];
        }
        return surplus;
    }

    std::vector<bool> match(const std::vector<double>& surplus) const {
        std::vector<MatchingEdge> dual;
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            const TriangleEdge& edge = mesh_.edges[at(edges_[i])];
            const double gain = 2 * kValenceCost * (surplus[at(edge.from)] + surplus[at(edge.to)]);
            dual.push_back({edge.left, edge.right, std::llround(kUnits * (worth_[i] + gain))});
        }
        const std::vector<int> partner =
            heaviest_matching(static_cast<int>(mesh_.triangles.size()), dual);
        std::vector<bool> taken(edges_.size(), false);
        std::vector<bool> is_done(mesh_.triangles.size(), false);
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            if (partner[at(dual[i].a)] != dual[i].b || is_done[at(dual[i].a)]) continue;
            // Two triangles may share two edges: the heavier one is meant.
            if (has_heavier_twin(dual, i)) continue;
            taken[i] = true;
            is_done[at(dual[i].a)] = true;
        }
        return taken;
    }

    bool has_heavier_twin(const std::vector<MatchingEdge>& dual, std::size_t i) const {
        for (const int e : mesh_.triangle_edges[at(dual[i].a)]) {
            const auto found = std::lower_bound(edges_.begin(), edges_.end(), e);
            if (found == edges_.end() || *found != e) continue;
            const MatchingEdge& other = dual[static_cast<std::size_t>(found - edges_.begin())];
            if (std::min(other.a, other.b) == std::min(dual[i].a, dual[i].b) &&
                std::max(other.a, other.b) == std::max(dual[i].a, dual[i].b) &&
                other.weight > dual[i].weight)
                return true;
        }
        return false;
    }

    double value_of(const std::vector<bool>& taken) const {
        double value = 0;
        std::vector<double> whole(taken.size());
        for (std::size_t i = 0; i < taken.size(); ++i) {
            whole[i] = taken[i] ? 1 : 0;
            if (taken[i]) value += worth_[i];
        }
        for (const double surplus : surplus_after(whole)) value -= kValenceCost * surplus * surplus;
        return value;
    }

    const PairableTriangles& mesh_;
    std::vector<int> edges_;     ///< that may go, ascending
    std::vector<double> worth_;  ///< of them
    std::vector<double> surplus_;
};

}  // namespace

PairedQuad quad_across(const PairableTriangles& mesh, int edge) {
    const TriangleEdge& across = mesh.edges[at(edge)];
    const auto& left = mesh.triangles[at(across.left)];
    const auto& left_edges = mesh.triangle_edges[at(across.left)];
    const auto& right = mesh.triangles[at(across.right)];
    const auto& right_edges = mesh.triangle_edges[at(across.right)];
    const std::size_t i = static_cast<std::size_t>(
        std::find(left_edges.begin(), left_edges.end(), edge) - left_edges.begin());
    const std::size_t j = static_cast<std::size_t>(
        std::find(right_edges.begin(), right_edges.end(), edge) - right_edges.begin());
    return {{left[i], right[(j + 2) % 3], left[(i + 1) % 3], left[(i + 2) % 3]},
            {right_edges[(j + 1) % 3], right_edges[(j + 2) % 3], left_edges[(i + 1) % 3],
             left_edges[(i + 2) % 3]}};
}

std::vector<int> pair_triangles(const PairableTriangles& mesh) { return Pairing(mesh).run(); }

}  // namespace fcn
