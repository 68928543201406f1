// A singularity a fraction of a quad beside a line of the grid has to be a whole quad away from it
// or lie on it, which no rounding can tell. So it is decided before there is a map: it moves to
// where there is room, or onto the curve if that makes a sector of three quads out of one of two
// (three into one would be a flat corner). A quarter of index moves along a path of edges whose
// turns change (singularity_merging.h); the path keeps off the curves, so that what lies along them
// stays as it is. The angles are then relaxed with the new turns.
#include "meshing/curve_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

#include "meshing/field_guides.h"
#include "meshing/matched_field.h"

namespace fcn {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class Clearance {
public:
    Clearance(const QuadDomain& domain, const std::vector<HardCurve>& curves,
              const ClearanceOptions& options, FieldDesign& design)
        : domain_(domain),
          mesh_(domain.mesh),
          options_(options),
          design_(design),
          connection_(connect_faces(mesh_)),
          is_on_curve_(mesh_.n_vertices(), false) {
        for (const HardCurve& curve : curves)
            for (const int edge : curve.edges)
                for (const unsigned side : {0U, 1U})
                    is_on_curve_[at(
                        mesh_.to_vertex_handle(mesh_.halfedge_handle(EdgeHandle(edge), side))
                            .idx())] = true;
        for (const VertexHandle vertex : mesh_.vertices())
            if (!mesh_.is_isolated(vertex) && mesh_.is_boundary(vertex))
                is_on_curve_[at(vertex.idx())] = true;
        link_of_.assign(mesh_.n_edges(), -1);
        for (std::size_t i = 0; i < connection_.links.size(); ++i)
            link_of_[at(mesh_.edge_handle(HalfedgeHandle(connection_.links[i].halfedge)).idx())] =
                static_cast<int>(i);
        matched_.field = design.field;
        for (const FaceLink& link : connection_.links)
            matched_.bends.push_back(
                arm_rotation(mesh_, design.field, HalfedgeHandle(link.halfedge)));
        matched_.indices = vertex_indices(mesh_, design.field);
        std::vector<int> sources;
        for (int v = 0; v < static_cast<int>(is_on_curve_.size()); ++v)
            if (is_on_curve_[at(v)]) sources.push_back(v);
        from_curves_ = distances(sources, options.away * options.edge_length);
    }

    int run() {
        int moved = 0;
        for (const Singularity& s : inner_singularities(mesh_, matched_.indices)) {
            const auto distance = from_curves_.find(s.vertex);
            if (is_on_curve_[at(s.vertex)] || std::abs(s.index) != 1 ||
                distance == from_curves_.end() ||
                distance->second.length > options_.near * options_.edge_length)
                continue;
            moved += move(s);
        }
        return moved > 0 && update() ? moved : 0;
    }

private:
    struct Reached {
        double length = kFar;
        HalfedgeHandle by{};  ///< invalid at a source
    };
    using Distances = std::map<int, Reached>;

    /// Along inner edges, up to `farthest`. Curves are reached, not crossed.
    Distances distances(const std::vector<int>& sources, double farthest) const {
        Distances known;
        using Entry = std::pair<double, int>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        for (const int v : sources) {
            known[v] = {0, HalfedgeHandle()};
            queue.push({0, v});
        }
        while (!queue.empty()) {
            const auto [length, v] = queue.top();
            queue.pop();
            if (length > known[v].length || (length > 0 && is_on_curve_[at(v)])) continue;
            for (const HalfedgeHandle h : mesh_.voh_range(VertexHandle(v))) {
                if (mesh_.is_boundary(mesh_.edge_handle(h))) continue;
                const double next = length + mesh_.calc_edge_length(h);
                if (next > farthest) continue;
                Reached& there = known[mesh_.to_vertex_handle(h).idx()];
                if (there.length <= next) continue;
                there = {next, h};
                queue.push({next, mesh_.to_vertex_handle(h).idx()});
            }
        }
        return known;
    }

    bool move(const Singularity& s) {
        const double h = options_.edge_length;
        const Distances around = distances({s.vertex}, options_.farthest * h);
        std::vector<int> others;
        for (const Singularity& other : inner_singularities(mesh_, matched_.indices))
            if (other.vertex != s.vertex) others.push_back(other.vertex);
        const Distances from_others = distances(others, options_.away * h);
        int best = -1, nearest_on_curve = -1;
        const auto length = [&](int v) { return v < 0 ? kFar : around.at(v).length; };
        for (const auto& [v, reached] : around) {
            if (v == s.vertex || from_others.contains(v)) continue;
            if (is_on_curve_[at(v)]) {
                if (!mesh_.is_boundary(VertexHandle(v)) && matched_.indices[at(v)] == 0 &&
                    reached.length < length(nearest_on_curve))
                    nearest_on_curve = v;
            } else if (!from_curves_.contains(v) && reached.length < length(best)) {
                best = v;
            }
        }
        if (s.index < 0 && length(nearest_on_curve) < length(best)) best = nearest_on_curve;
        if (best < 0) return false;
        for (HalfedgeHandle e = around.at(best).by; e.is_valid();
             e = around.at(mesh_.from_vertex_handle(e).idx()).by) {
            const int link = link_of_[at(mesh_.edge_handle(e).idx())];
            const bool is_along = connection_.links[at(link)].halfedge == e.idx();
            turn_link(mesh_, connection_, at(link), is_along == (s.index > 0) ? -1 : 1, matched_);
        }
        return true;
    }

    bool update() {
        const double h = options_.edge_length;
        std::vector<FieldGuide> guides = boundary_guides(mesh_, h, options_.boundary_strength);
        const auto more = curve_guides(domain_, h, options_.curve_strength);
        guides.insert(guides.end(), more.begin(), more.end());
        if (!straighten(connection_, guides, matched_) ||
            vertex_indices(mesh_, matched_.field) != matched_.indices)
            return false;
        design_.field = std::move(matched_.field);
        design_.singularities = inner_singularities(mesh_, matched_.indices);
        design_.close_pairs = close_pairs(mesh_, design_.singularities, h);
        return true;
    }

    const QuadDomain& domain_;
    const Mesh& mesh_;
    const ClearanceOptions& options_;
    FieldDesign& design_;
    FaceConnection connection_;
    MatchedField matched_;
    std::vector<bool> is_on_curve_;
    std::vector<int> link_of_;  ///< per edge
    Distances from_curves_;
};

}  // namespace

int clear_curves(const QuadDomain& domain, const std::vector<HardCurve>& curves,
                 const ClearanceOptions& options, FieldDesign& design) {
    if (curves.empty() || design.singularities.empty()) return 0;
    return Clearance(domain, curves, options, design).run();
}

}  // namespace fcn
