// Creases on lines of the grid (Bommes, Zimmer, Kobbelt 2009, section 5.2, alignment constraints).
// Theirs are all hard from the beginning. Here a map that fails says where, and the least important
// curve there gives way around that place, so that what is too much in one place costs nothing
// elsewhere; after some rounds all curves are soft.
#include "meshing/curve_map.h"

#include <algorithm>
#include <cmath>

namespace fcn {
namespace {

constexpr int kBlamedRings = 4;     ///< around a fault in which curves may be to blame
constexpr double kFirstGap = 1;     ///< in h: what a curve loses on either side of a fault
constexpr double kGapGrowth = 1.5;  ///< each round

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class CurveSoftening {
public:
    CurveSoftening(const QuadDomain& domain, const HardCurveOptions& options)
        : domain_(domain), options_(options) {}

    /// The curves without what is to blame for faults.
    std::vector<HardCurve> run(const std::vector<HardCurve>& curves, const std::vector<int>& faults,
                               double gap) const {
        const std::vector<std::vector<int>> blamed = blame(curves, faults);
        std::vector<HardCurve> result;
        bool is_changed = false;
        for (std::size_t c = 0; c < curves.size(); ++c) {
            if (blamed[c].empty()) {
                result.push_back(curves[c]);
                continue;
            }
            is_changed = true;
            const std::vector<bool> is_gone = near(curves[c], blamed[c], gap);
            for (HardCurve& rest : without_edges(domain_, curves[c], is_gone, options_))
                result.push_back(std::move(rest));
        }
        if (!is_changed) return {};
        std::stable_sort(result.begin(), result.end(), [](const HardCurve& a, const HardCurve& b) {
            return a.importance > b.importance;
        });
        return result;
    }

private:
    std::array<int, 2> ends(int edge) const {
        const HalfedgeHandle h = domain_.mesh.halfedge_handle(EdgeHandle(edge), 0);
        return {domain_.mesh.from_vertex_handle(h).idx(), domain_.mesh.to_vertex_handle(h).idx()};
    }

    /// Per curve the vertices that it is blamed at: the nearest ring around each fault in which
    /// there are curves, and the last of these.
    std::vector<std::vector<int>> blame(const std::vector<HardCurve>& curves,
                                        const std::vector<int>& faults) const {
        std::vector<std::vector<int>> at_vertex(domain_.mesh.n_vertices());
        for (std::size_t c = 0; c < curves.size(); ++c)
            for (const int edge : curves[c].edges)
                for (const int v : ends(edge)) at_vertex[at(v)].push_back(static_cast<int>(c));
        std::vector<std::vector<int>> result(curves.size());
        for (const int fault : faults) {
            std::vector<int> ring{fault};
            std::vector<int> seen = ring;
            for (int r = 0; r <= kBlamedRings; ++r) {
                int worst = -1, where = -1;
                for (const int v : ring)
                    for (const int c : at_vertex[at(v)])
                        if (c > worst) {
                            worst = c;
                            where = v;
                        }
                if (worst >= 0) {
                    result[at(worst)].push_back(where);
                    break;
                }
                ring = next_ring(ring, seen);
            }
        }
        return result;
    }
    std::vector<int> next_ring(const std::vector<int>& ring, std::vector<int>& seen) const {
        std::vector<int> next;
        for (const int v : ring)
            for (const VertexHandle w : domain_.mesh.vv_range(VertexHandle(v)))
                if (std::find(seen.begin(), seen.end(), w.idx()) == seen.end()) {
                    seen.push_back(w.idx());
                    next.push_back(w.idx());
                }
        return next;
    }

    std::vector<bool> near(const HardCurve& curve, const std::vector<int>& places,
                           double gap) const {
        std::vector<bool> result;
        for (const int edge : curve.edges) {
            const auto v = ends(edge);
            result.push_back(std::any_of(places.begin(), places.end(), [&](int place) {
                const Vec3& p = domain_.mesh.point(VertexHandle(place));
                return v[0] == place || v[1] == place ||
                       ((domain_.mesh.point(VertexHandle(v[0])) +
                         domain_.mesh.point(VertexHandle(v[1]))) /
                            2 -
                        p)
                               .norm() < gap;
            }));
        }
        return result;
    }

    const QuadDomain& domain_;
    const HardCurveOptions& options_;
};

std::size_t count_edges(const std::vector<HardCurve>& curves) {
    std::size_t count = 0;
    for (const HardCurve& curve : curves) count += curve.edges.size();
    return count;
}

}  // namespace

CurveMap map_with_curves(const QuadDomain& domain, const CrossField& field,
                         const CurveMapOptions& options) {
    CurveMap map;
    QuadMapOptions guidance;
    guidance.edge_length = options.edge_length;
    guidance.soft_weight = domain.edge_weight;
    for (double& weight : guidance.soft_weight) weight *= options.soft_weight;
    HardCurveOptions finding;
    finding.edge_length = options.edge_length;
    if (options.is_hard && !domain.edge_arc.empty())
        map.curves = find_hard_curves(domain, field, finding);
    map.found_edges = count_edges(map.curves);
    const CurveSoftening softening(domain, finding);
    double gap = kFirstGap * options.edge_length;
    for (int round = 0;; ++round, gap *= kGapGrowth) {
        if (round == options.rounds) map.curves.clear();
        guidance.is_hard.assign(map.curves.empty() ? 0 : domain.mesh.n_edges(), 0);
        for (const HardCurve& curve : map.curves)
            for (const int edge : curve.edges) guidance.is_hard[at(edge)] = 1;
        map.result = options.make_map(domain.mesh, field, guidance);
        ++map.rounds;
        if (map.result.fault.empty() || map.curves.empty()) {
            map.kept_edges = count_edges(map.curves);
            return map;
        }
        map.curves = softening.run(map.curves, map.result.fault_vertices, gap);
    }
}

}  // namespace fcn
