// Vertices of quads on hard edges of the domain are found by their places; from each of them the
// curve is followed both ways to the next one. Where no quad has an edge between the two (a row was
// divided, or a curve ends inside a quad) there is no line.
#include "meshing/lines_on_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace fcn {
namespace {

constexpr double kOnEdge = 1e-7;                         ///< of barycentric coordinates
constexpr double kCorner = 40 * std::numbers::pi / 180;  ///< a curve that turns by more
constexpr std::size_t kLongest = 1000;                   ///< edges between two vertices

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class LineFinder {
public:
    LineFinder(const QuadDomain& domain, const std::vector<int>& hard_edges,
               const QuadExtraction& extraction)
        : domain_(domain), mesh_(domain.mesh), quads_(extraction.mesh) {
        for (const int edge : hard_edges) {
            const HalfedgeHandle h = mesh_.halfedge_handle(EdgeHandle(edge), 0);
            hard_at_[mesh_.from_vertex_handle(h).idx()].push_back(h);
            hard_at_[mesh_.to_vertex_handle(h).idx()].push_back(mesh_.opposite_halfedge_handle(h));
            on_edge_[edge];
        }
        for (const auto& face : quads_.faces)
            for (std::size_t i = 0; i < 4; ++i) {
                const int a = face[i], b = face[(i + 1) % 4];
                quad_edges_.insert({std::min(a, b), std::max(a, b)});
            }
        result_.arc.assign(quads_.points.size(), -1);
        result_.is_corner.assign(quads_.points.size(), false);
        for (std::size_t v = 0; v < extraction.places.size(); ++v)
            place(static_cast<int>(v), extraction.places[v]);
    }

    LinesOnCurves run() {
        for (const auto& [edge, vertices] : on_edge_)
            for (std::size_t i = 1; i < vertices.size(); ++i)
                join(vertices[i - 1].second, vertices[i].second, arc_of(edge));
        for (const auto& [vertex, quad] : at_vertex_)
            for (const HalfedgeHandle h : hard_at_.at(vertex)) follow(quad, h);
        for (const auto& [edge, vertices] : on_edge_) {
            if (vertices.empty()) continue;
            const HalfedgeHandle h = mesh_.halfedge_handle(EdgeHandle(edge), 0);
            continue_from(vertices.back().second, h);
            continue_from(vertices.front().second, mesh_.opposite_halfedge_handle(h));
        }
        return std::move(result_);
    }

private:
    int arc_of(int edge) const { return domain_.edge_arc[at(edge)]; }

    void place(int quad, const SurfacePoint& point) {
        std::array<HalfedgeHandle, 3> sides;
        sides[0] = mesh_.halfedge_handle(FaceHandle(point.face));
        sides[1] = mesh_.next_halfedge_handle(sides[0]);
        sides[2] = mesh_.next_halfedge_handle(sides[1]);
        for (int i = 0; i < 3; ++i) {
            if (!(point.barycentric[i] > 1 - kOnEdge)) continue;
            const int vertex = mesh_.from_vertex_handle(sides[at(i)]).idx();
            const auto hard = hard_at_.find(vertex);
            if (hard == hard_at_.end()) return;
            at_vertex_[vertex] = quad;
            result_.arc[at(quad)] = arc_of(mesh_.edge_handle(hard->second[0]).idx());
            result_.is_corner[at(quad)] = is_corner(hard->second);
            return;
        }
        for (int i = 0; i < 3; ++i) {
            if (!(std::abs(point.barycentric[(i + 2) % 3]) < kOnEdge)) continue;
            const int edge = mesh_.edge_handle(sides[at(i)]).idx();
            const auto found = on_edge_.find(edge);
            if (found == on_edge_.end()) return;
            const bool is_along = mesh_.halfedge_handle(EdgeHandle(edge), 0) == sides[at(i)];
            const double share = point.barycentric[(i + 1) % 3];
            found->second.push_back({is_along ? share : 1 - share, quad});
            std::sort(found->second.begin(), found->second.end());
            result_.arc[at(quad)] = arc_of(edge);
            return;
        }
    }

    bool is_corner(const std::vector<HalfedgeHandle>& out) const {
        if (out.size() != 2) return out.size() > 2;
        if (arc_of(mesh_.edge_handle(out[0]).idx()) != arc_of(mesh_.edge_handle(out[1]).idx()))
            return true;
        const Vec3 a = mesh_.calc_edge_vector(out[0]), b = mesh_.calc_edge_vector(out[1]);
        return std::atan2(a.cross(b).norm(), -a.dot(b)) > kCorner;
    }

    void join(int a, int b, int arc) {
        const std::pair<int, int> ends{std::min(a, b), std::max(a, b)};
        if (a == b || !quad_edges_.contains(ends) || !known_.insert(ends).second) return;
        QuadFeatureEdge edge;
        edge.from = a;
        edge.to = b;
        edge.arc = arc;
        result_.edges.push_back(edge);
    }

    /// From a vertex of the domain along h to the next vertex of quads.
    void follow(int quad, HalfedgeHandle h) {
        const int edge = mesh_.edge_handle(h).idx();
        const auto& here = on_edge_.at(edge);
        if (here.empty()) return continue_from(quad, h);
        const bool is_along = mesh_.halfedge_handle(EdgeHandle(edge), 0) == h;
        join(quad, is_along ? here.front().second : here.back().second, arc_of(edge));
    }

    /// The same from a place on the edge of h behind which there is no other vertex of quads.
    void continue_from(int quad, HalfedgeHandle h) {
        const int arc = arc_of(mesh_.edge_handle(h).idx());
        for (std::size_t i = 0; i < kLongest; ++i) {
            const int vertex = mesh_.to_vertex_handle(h).idx();
            const auto reached = at_vertex_.find(vertex);
            if (reached != at_vertex_.end()) return join(quad, reached->second, arc);
            const auto& out = hard_at_.at(vertex);
            if (out.size() != 2) return;
            const HalfedgeHandle back = mesh_.opposite_halfedge_handle(h);
            h = out[0] == back ? out[1] : out[0];
            const int edge = mesh_.edge_handle(h).idx();
            const auto& here = on_edge_.at(edge);
            if (here.empty()) continue;
            const bool is_along = mesh_.halfedge_handle(EdgeHandle(edge), 0) == h;
            return join(quad, is_along ? here.front().second : here.back().second, arc);
        }
    }

    const QuadDomain& domain_;
    const Mesh& mesh_;
    const QuadMesh& quads_;
    std::map<int, std::vector<HalfedgeHandle>> hard_at_;          ///< per vertex, out of it
    std::map<int, std::vector<std::pair<double, int>>> on_edge_;  ///< per edge, from its first end
    std::map<int, int> at_vertex_;
    std::set<std::pair<int, int>> quad_edges_, known_;
    LinesOnCurves result_;
};

}  // namespace

LinesOnCurves lines_on_curves(const QuadDomain& domain, const std::vector<int>& hard_edges,
                              const QuadExtraction& extraction) {
    return LineFinder(domain, hard_edges, extraction).run();
}

}  // namespace fcn
