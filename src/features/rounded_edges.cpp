// Filtering normals makes a stair of a narrow fillet, and its steps look like creases. What noise
// and filter cannot hide is how much the surface turns: plain signed dihedrals err by as much to
// either side, so that their mean over some twenty edges of a chain is close to that of the clean
// shape. Where it is below the angle that seeds a crease, the chain is a crease only if most of the
// turning happens on it: the edges beside it, up to one edge away, must not turn along with it. A
// fillet of radius two edges turns by 30 degrees at each edge, and by 60 beside it.
//
// The noise chose the chain, which therefore turns too much and its surroundings too little; hence
// the share that is asked for is above one half. And where what turns beside it is too sharp for
// facets, a chain has strayed from a crease or runs beside one, and stays.

#include "features/rounded_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fcn {
namespace {

constexpr int kReach = 12;         // edges of a chain to either side
constexpr int kLeastEdges = 7;     // fewer tell too little
constexpr double kOwnShare = 0.7;  // of the turning of a crease
constexpr double kHeights = 3;     // of faces, over the displacement: lower ones tell nothing
constexpr double kNoFacet = 60 * std::numbers::pi / 180;
constexpr double kCreasedShare = 0.3;  // of the turning beside a chain, if a crease is there
constexpr int kMostRounds = 3;
constexpr int kLeastRest = 6;  // edges that are left between what goes, or go too

/// Of an edge of a chain: turning times length, the same of what lies beside it, and the height of
/// the lower of its faces.
struct Turning {
    double own = 0, beside = 0, length = 0, height = 0;
    double creased = 0;  ///< of what lies beside, by edges too sharp for a facet
};

struct Sums : Turning {
    int count = 0;
    void add(const Turning& edge) {
        own += edge.own;
        beside += edge.beside;
        creased += edge.creased;
        length += edge.length;
        height += edge.height;
        ++count;
    }
};

class RoundedEdges {
public:
    RoundedEdges(const MeshArrays& arrays, const RobustDihedrals& dihedrals, double high_angle)
        : arrays_(arrays),
          dihedrals_(dihedrals),
          high_angle_(high_angle),
          at_vertex_(edges_of_vertices(arrays, std::vector<bool>(arrays.edge_count(), true))),
          stamp_(arrays.edge_count(), -1),
          nearest_(arrays.edge_count(), -1),
          distance_(arrays.edge_count(), 0) {}

    /// Edges of an arc that are none of a crease.
    std::vector<bool> rounded(const std::vector<int>& arc, bool is_closed) {
        const int count = static_cast<int>(arc.size());
        std::vector<bool> result(arc.size(), false);
        const std::vector<Turning> turning = measure(arc);
        const bool wraps = is_closed && count > 2 * kReach;
        for (int i = 0; i < count; ++i) {
            if (!dihedrals_.is_noisy_edge[arc[i]]) continue;
            Sums sums;
            const auto add = [&](int k) {
                const int at = wraps ? (k + count) % count : k;
                if (at < 0 || at >= count) return false;
                // A chain may go on from a convex crease to a concave one.
                if (dihedrals_.angles[arc[at]] * dihedrals_.angles[arc[i]] < 0) return false;
                sums.add(turning[at]);
                return true;
            };
            add(i);
            for (int k = 1; k <= kReach && add(i - k);) ++k;
            for (int k = 1; k <= kReach && add(i + k);) ++k;
            result[i] = is_rounded(sums);
        }
        fill_rests(arc, result);
        return result;
    }

private:
    /// Of the lower face beside an edge.
    double least_height(int edge) const {
        double area = arrays_.areas[arrays_.edge_faces[edge][0]];
        for (int f : arrays_.edge_faces[edge])
            if (f >= 0) area = std::min(area, arrays_.areas[f]);
        return 2 * area / arrays_.edge_length(edge);
    }

    Vec3 direction(int edge) const {
        const auto [a, b] = arrays_.edge_vertices[edge];
        return arrays_.points[b] - arrays_.points[a];
    }

    Vec3 middle(int edge) const {
        const auto [a, b] = arrays_.edge_vertices[edge];
        return 0.5 * (arrays_.points[a] + arrays_.points[b]);
    }

    bool is_rounded(const Sums& sums) const {
        if (sums.count < kLeastEdges) return false;
        if (sums.height < kHeights * dihedrals_.displacement * sums.count) return false;
        if (std::abs(sums.own) >= high_angle_ * sums.length) return false;
        const double sign = sums.own < 0 ? -1 : 1;
        if (sign * sums.creased > kCreasedShare * sign * sums.beside) return false;
        return sign * sums.own < kOwnShare * sign * (sums.own + sums.beside);
    }

    std::vector<Turning> measure(const std::vector<int>& arc) {
        ++arc_count_;
        std::vector<int> near;
        for (std::size_t i = 0; i < arc.size(); ++i) {
            const Vec3 at = middle(arc[i]);
            for (int v : arrays_.edge_vertices[arc[i]]) {
                for (const int* e = at_vertex_.begin(v); e != at_vertex_.end(v); ++e) {
                    for (int w : arrays_.edge_vertices[*e])
                        for (const int* f = at_vertex_.begin(w); f != at_vertex_.end(w); ++f)
                            claim(*f, static_cast<int>(i), at, near);
                }
            }
        }
        std::vector<Turning> result;
        for (int e : arc) {
            const double length = arrays_.edge_length(e);
            result.push_back({length * arrays_.dihedrals[e], 0, length, least_height(e), 0});
            stamp_[e] = -1;
        }
        for (int e : near) {
            if (stamp_[e] != arc_count_) continue;
            const Vec3 edge = direction(e), chain = direction(arc[nearest_[e]]);
            const double dot = edge.dot(chain);
            const double norms = edge.norm() * chain.squaredNorm();
            if (!(norms > 0)) continue;
            const double turning = arrays_.dihedrals[e] * dot * dot / norms;
            result[nearest_[e]].beside += turning;
            if (std::abs(arrays_.dihedrals[e]) >= kNoFacet) result[nearest_[e]].creased += turning;
        }
        return result;
    }

    /// An edge beside the chain counts at the closest edge of the chain.
    void claim(int edge, int place, const Vec3& at, std::vector<int>& near) {
        const double distance = (middle(edge) - at).squaredNorm();
        if (stamp_[edge] != arc_count_) {
            stamp_[edge] = arc_count_;
            near.push_back(edge);
        } else if (distance >= distance_[edge]) {
            return;
        }
        nearest_[edge] = place;
        distance_[edge] = distance;
    }

    /// What is left of an arc in short pieces goes too.
    void fill_rests(const std::vector<int>& arc, std::vector<bool>& is_rounded) const {
        for (std::size_t i = 0; i < is_rounded.size();) {
            std::size_t end = i;
            while (end < is_rounded.size() && is_rounded[end] == is_rounded[i]) ++end;
            const bool is_whole = i == 0 && end == is_rounded.size();
            if (!is_rounded[i] && !is_whole && end - i < kLeastRest) {
                for (std::size_t k = i; k < end; ++k)
                    is_rounded[k] = dihedrals_.is_noisy_edge[arc[k]];
            }
            i = end;
        }
    }

    const MeshArrays& arrays_;
    const RobustDihedrals& dihedrals_;
    double high_angle_;
    IndexRows at_vertex_;
    std::vector<int> stamp_, nearest_;  ///< per edge: arc that it was seen from, place in it
    std::vector<double> distance_;
    int arc_count_ = 0;
};

}  // namespace

void drop_rounded_edges(const MeshArrays& arrays, const RobustDihedrals& dihedrals,
                        double high_angle, std::vector<bool>& is_sharp) {
    const auto& noisy = dihedrals.is_noisy_edge;
    if (std::none_of(noisy.begin(), noisy.end(), [](bool is) { return is; })) return;
    RoundedEdges rounded_edges(arrays, dihedrals, high_angle);
    // What goes first makes longer chains of what remains of a stair, which tell more.
    bool is_changed = true;
    for (int round = 0; round < kMostRounds && is_changed; ++round) {
        is_changed = false;
        const EdgeNetwork edges = trace_edges(arrays, is_sharp, {}, "sharp");
        for (std::size_t a = 0; a < edges.arc_edges.size(); ++a) {
            const std::vector<int>& arc = edges.arc_edges[a];
            const std::vector<bool> is_rounded =
                rounded_edges.rounded(arc, edges.network.arcs[a].is_closed());
            for (std::size_t i = 0; i < arc.size(); ++i) {
                if (!is_rounded[i]) continue;
                is_sharp[arc[i]] = false;
                is_changed = true;
            }
        }
    }
}

}  // namespace fcn
