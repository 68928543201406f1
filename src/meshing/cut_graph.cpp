// Cutting a mesh to a disk through all singularities, and combing the field (Bommes, Zimmer,
// Kobbelt 2009, sections 3 and 5.1). What a spanning tree of the faces does not cross is cut, loose
// ends are taken away, and the nearest singularity is joined by a shortest path until none is
// left. Singularities here are the vertices around which the turns do not add up to 0 modulo 4.
#include "meshing/cut_graph.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "meshing/vertex_sectors.h"

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class Cutter {
public:
    Cutter(const Mesh& mesh, const CrossField& field) : mesh_(mesh), field_(field) {
        cut_.is_cut.assign(mesh.n_edges(), 0);
        is_on_graph_.assign(mesh.n_vertices(), 0);
        find_singularities();
        cut_between_faces();
        take_loose_ends();
        join_singularities();
        comb();
        number_copies();
        collect_chains();
    }
    CutMesh take() { return std::move(cut_); }

private:
    bool is_cut(EdgeHandle edge) const { return cut_.is_cut[at(edge.idx())] != 0; }

    void find_singularities() {
        cut_.is_singular.assign(mesh_.n_vertices(), 0);
        for (const VertexHandle vertex : mesh_.vertices()) {
            if (mesh_.is_boundary(vertex)) continue;
            int turns = 0;
            for (const HalfedgeHandle h : mesh_.voh_range(vertex))
                turns += field_.turns[at(h.idx())];
            cut_.is_singular[at(vertex.idx())] = (turns & 3) != 0;
        }
    }

    /// Cuts all inner edges that a breadth-first tree of each component's faces does not cross.
    void cut_between_faces() {
        for (const EdgeHandle edge : mesh_.edges())
            cut_.is_cut[at(edge.idx())] = !mesh_.is_boundary(edge);
        std::vector<std::uint8_t> is_seen(mesh_.n_faces(), 0);
        for (const FaceHandle seed : mesh_.faces()) {
            if (is_seen[at(seed.idx())]) continue;
            is_seen[at(seed.idx())] = 1;
            component_seeds_.push_back(seed);
            std::vector<FaceHandle> queue{seed};
            for (std::size_t i = 0; i < queue.size(); ++i) {
                for (const HalfedgeHandle h : mesh_.fh_range(queue[i])) {
                    const FaceHandle across = mesh_.opposite_face_handle(h);
                    if (!across.is_valid() || is_seen[at(across.idx())]) continue;
                    is_seen[at(across.idx())] = 1;
                    cut_.is_cut[at(mesh_.edge_handle(h).idx())] = 0;
                    queue.push_back(across);
                }
            }
        }
    }

    int degree(VertexHandle vertex) const {
        int count = 0;
        for (const EdgeHandle edge : mesh_.ve_range(vertex))
            count += is_cut(edge) || mesh_.is_boundary(edge);
        return count;
    }

    void take_loose_ends() {
        std::vector<VertexHandle> ends;
        for (const VertexHandle vertex : mesh_.vertices())
            if (degree(vertex) == 1) ends.push_back(vertex);
        while (!ends.empty()) {
            const VertexHandle vertex = ends.back();
            ends.pop_back();
            for (const HalfedgeHandle h : mesh_.voh_range(vertex)) {
                if (!is_cut(mesh_.edge_handle(h))) continue;
                cut_.is_cut[at(mesh_.edge_handle(h).idx())] = 0;
                if (degree(mesh_.to_vertex_handle(h)) == 1)
                    ends.push_back(mesh_.to_vertex_handle(h));
            }
        }
        for (const VertexHandle vertex : mesh_.vertices())
            is_on_graph_[at(vertex.idx())] = degree(vertex) > 0;
    }

    /// The vertices of a component, those on the graph so far as sources; without any, its first
    /// singularity.
    void join_singularities() {
        std::vector<double> distance(mesh_.n_vertices(), std::numeric_limits<double>::infinity());
        std::vector<HalfedgeHandle> way(mesh_.n_vertices());
        std::vector<std::uint8_t> is_seen(mesh_.n_faces(), 0);
        for (const FaceHandle seed : component_seeds_) {
            VertexHandle first;
            bool has_graph = false;
            std::vector<VertexHandle> sources;
            for (const VertexHandle vertex : component_vertices(seed, is_seen)) {
                if (is_on_graph_[at(vertex.idx())]) {
                    has_graph = true;
                    sources.push_back(vertex);
                } else if (!first.is_valid() && cut_.is_singular[at(vertex.idx())]) {
                    first = vertex;
                }
            }
            if (!has_graph && first.is_valid()) {
                sources.push_back(first);
                is_on_graph_[at(first.idx())] = 1;
            }
            grow(sources, distance, way);
        }
    }

    std::vector<VertexHandle> component_vertices(FaceHandle seed,
                                                 std::vector<std::uint8_t>& is_seen) const {
        std::vector<VertexHandle> result;
        std::vector<FaceHandle> queue{seed};
        is_seen[at(seed.idx())] = 1;
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (const HalfedgeHandle h : mesh_.fh_range(queue[i])) {
                result.push_back(mesh_.to_vertex_handle(h));
                const FaceHandle across = mesh_.opposite_face_handle(h);
                if (!across.is_valid() || is_seen[at(across.idx())]) continue;
                is_seen[at(across.idx())] = 1;
                queue.push_back(across);
            }
        }
        std::sort(result.begin(), result.end());
        result.erase(std::unique(result.begin(), result.end()), result.end());
        return result;
    }

    /// Shortest paths from the graph; each singularity that is reached joins it with its path.
    void grow(const std::vector<VertexHandle>& sources, std::vector<double>& distance,
              std::vector<HalfedgeHandle>& way) {
        using Item = std::pair<double, int>;
        std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
        const auto enqueue = [&](VertexHandle vertex, double length, HalfedgeHandle from) {
            distance[at(vertex.idx())] = length;
            way[at(vertex.idx())] = from;
            queue.emplace(length, vertex.idx());
        };
        for (const VertexHandle vertex : sources) enqueue(vertex, 0, HalfedgeHandle());
        while (!queue.empty()) {
            const auto [length, index] = queue.top();
            queue.pop();
            if (length > distance[at(index)]) continue;
            VertexHandle vertex(index);
            if (cut_.is_singular[at(index)] && !is_on_graph_[at(index)]) {
                for (VertexHandle v = vertex; !is_on_graph_[at(v.idx())];) {
                    const HalfedgeHandle h = way[at(v.idx())];
                    is_on_graph_[at(v.idx())] = 1;
                    cut_.is_cut[at(mesh_.edge_handle(h).idx())] = 1;
                    const VertexHandle next = mesh_.from_vertex_handle(h);
                    enqueue(v, 0, HalfedgeHandle());
                    v = next;
                }
                continue;
            }
            for (const HalfedgeHandle h : mesh_.voh_range(vertex)) {
                const VertexHandle to = mesh_.to_vertex_handle(h);
                const double reached = length + mesh_.calc_edge_length(h);
                if (reached < distance[at(to.idx())]) enqueue(to, reached, h);
            }
        }
    }

    void comb() {
        cut_.arms.assign(mesh_.n_faces(), 0);
        cut_.turns.assign(mesh_.n_halfedges(), 0);
        std::vector<std::uint8_t> is_seen(mesh_.n_faces(), 0);
        for (const FaceHandle seed : component_seeds_) {
            std::vector<FaceHandle> queue{seed};
            is_seen[at(seed.idx())] = 1;
            for (std::size_t i = 0; i < queue.size(); ++i) {
                for (const HalfedgeHandle h : mesh_.fh_range(queue[i])) {
                    const FaceHandle across = mesh_.opposite_face_handle(h);
                    if (!across.is_valid() || is_seen[at(across.idx())] ||
                        is_cut(mesh_.edge_handle(h)))
                        continue;
                    is_seen[at(across.idx())] = 1;
                    cut_.arms[at(across.idx())] =
                        (cut_.arms[at(queue[i].idx())] - field_.turns[at(h.idx())]) & 3;
                    queue.push_back(across);
                }
            }
        }
        for (const HalfedgeHandle h : mesh_.halfedges()) {
            if (mesh_.is_boundary(mesh_.edge_handle(h))) continue;
            const int here = cut_.arms[at(mesh_.face_handle(h).idx())];
            const int there = cut_.arms[at(mesh_.opposite_face_handle(h).idx())];
            const int turns = (field_.turns[at(h.idx())] + there - here) & 3;
            cut_.turns[at(h.idx())] = turns;
            if (turns != 0 && !is_cut(mesh_.edge_handle(h)))
                cut_.fault = "the field's turns do not fit together inside the cut surface";
        }
        if (std::count(is_seen.begin(), is_seen.end(), 0) > 0)
            cut_.fault = "the cut takes the surface apart";
    }

    /// One copy a sector between cut edges.
    void number_copies() {
        cut_.vertex_count = static_cast<int>(mesh_.n_vertices());
        for (const FaceHandle face : mesh_.faces()) {
            const auto corners = face_vertices(mesh_, face);
            cut_.corners.push_back({corners[0].idx(), corners[1].idx(), corners[2].idx()});
        }
        VertexSectors sectors = vertex_sectors(mesh_, {cut_.is_cut.begin(), cut_.is_cut.end()});
        cut_.copy_count = sectors.count();
        cut_.copies = std::move(sectors.of_corner);
    }

    bool is_chain_end(VertexHandle vertex) const {
        if (cut_.is_singular[at(vertex.idx())] || mesh_.is_boundary(vertex)) return true;
        return degree(vertex) != 2;
    }

    void collect_chains() {
        std::vector<std::uint8_t> is_seen(mesh_.n_edges(), 0);
        const auto follow = [&](HalfedgeHandle h) {
            std::vector<HalfedgeHandle> chain;
            const VertexHandle start = mesh_.from_vertex_handle(h);
            for (;;) {
                chain.push_back(h);
                is_seen[at(mesh_.edge_handle(h).idx())] = 1;
                const VertexHandle vertex = mesh_.to_vertex_handle(h);
                if (vertex == start || is_chain_end(vertex)) break;
                for (const HalfedgeHandle next : mesh_.voh_range(vertex)) {
                    if (is_cut(mesh_.edge_handle(next)) &&
                        !is_seen[at(mesh_.edge_handle(next).idx())]) {
                        h = next;
                        break;
                    }
                }
            }
            cut_.chains.push_back(std::move(chain));
        };
        for (int pass = 0; pass < 2; ++pass) {  // then loops without an end
            for (const HalfedgeHandle h : mesh_.halfedges()) {
                const EdgeHandle edge = mesh_.edge_handle(h);
                if (!is_cut(edge) || is_seen[at(edge.idx())]) continue;
                if (pass == 1 || is_chain_end(mesh_.from_vertex_handle(h))) follow(h);
            }
        }
    }

    const Mesh& mesh_;
    const CrossField& field_;
    CutMesh cut_;
    std::vector<std::uint8_t> is_on_graph_;
    std::vector<FaceHandle> component_seeds_;
};

}  // namespace

CutMesh cut_to_disks(const Mesh& mesh, const CrossField& field) {
    return Cutter(mesh, field).take();
}

}  // namespace fcn
