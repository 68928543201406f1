#include "geometry/mesh_curves.h"

#include <algorithm>
#include <map>
#include <set>

#include "geometry/text_writer.h"

namespace fcn {
namespace {

class Chaining {
public:
    explicit Chaining(const std::vector<std::array<int, 2>>& edges) {
        std::set<std::array<int, 2>> known;
        for (const auto& [a, b] : edges) {
            if (a == b || !known.insert({std::min(a, b), std::max(a, b)}).second) continue;
            const int edge = static_cast<int>(edges_.size());
            edges_.push_back({a, b});
            stars_[a].push_back(edge);
            stars_[b].push_back(edge);
        }
        is_used_.assign(edges_.size(), false);
    }

    std::vector<std::vector<int>> run() {
        for (const bool starts_anywhere : {false, true})  // closed curves are what is left
            for (std::size_t e = 0; e < edges_.size(); ++e)
                for (const int end : edges_[e]) {
                    if (is_used_[e] || (!starts_anywhere && stars_[end].size() == 2)) continue;
                    curves_.emplace_back(static_cast<int>(e), walk(end, static_cast<int>(e)));
                }
        std::ranges::sort(curves_, {}, [](const auto& curve) { return curve.first; });
        std::vector<std::vector<int>> result;
        for (auto& [edge, vertices] : curves_) result.push_back(std::move(vertices));
        return result;
    }

private:
    std::vector<int> walk(int vertex, int edge) {
        std::vector<int> vertices{vertex};
        for (;;) {
            is_used_[static_cast<std::size_t>(edge)] = true;
            const auto& [a, b] = edges_[static_cast<std::size_t>(edge)];
            vertices.push_back(a == vertices.back() ? b : a);
            const std::vector<int>& star = stars_[vertices.back()];
            if (star.size() != 2) return vertices;
            edge = star[0] == edge ? star[1] : star[0];
            if (is_used_[static_cast<std::size_t>(edge)]) return vertices;
        }
    }

    std::vector<std::array<int, 2>> edges_;
    std::map<int, std::vector<int>> stars_;
    std::vector<bool> is_used_;
    std::vector<std::pair<int, std::vector<int>>> curves_;  ///< behind the edge they began with
};

}  // namespace

std::vector<std::vector<int>> chain_vertex_pairs(const std::vector<std::array<int, 2>>& edges) {
    return Chaining(edges).run();
}

std::size_t curve_edge_count(const LoadedMesh& mesh) {
    std::size_t count = 0;
    for_each_curve_edge(mesh, [&](std::size_t, int, int) { ++count; });
    return count;
}

std::vector<int> curve_corners(const LoadedMesh& mesh) {
    std::map<int, int> ends;
    for (const std::vector<int>& curve : mesh.curves)
        if (!curve.empty()) {
            ++ends[curve.front()];
            ++ends[curve.back()];
        }
    std::vector<int> corners;
    for (const auto& [vertex, count] : ends)
        if (count != 2) corners.push_back(vertex);
    return corners;
}

std::string write_sharp_curves(const Mesh& mesh, const VertexCurves& curves) {
    std::vector<bool> is_taken(mesh.n_edges(), false);
    std::size_t count = 0;
    TextWriter lines;
    for (const std::vector<int>& curve : curves)
        for (std::size_t k = 1; k < curve.size(); ++k) {
            const EdgeHandle edge = mesh.edge_handle(
                mesh.find_halfedge(VertexHandle(curve[k - 1]), VertexHandle(curve[k])));
            if (is_taken[static_cast<std::size_t>(edge.idx())]) continue;
            is_taken[static_cast<std::size_t>(edge.idx())] = true;
            const int type = dihedral_angle(mesh, edge) < 0 ? 0 : 1;
            for (unsigned side = 0; side < 2; ++side) {
                const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, side);
                const FaceHandle face = mesh.face_handle(halfedge);
                if (!face.is_valid()) continue;
                const auto corners = face_vertices(mesh, face);
                const auto from =
                    std::find(corners.begin(), corners.end(), mesh.from_vertex_handle(halfedge));
                lines << type << ',' << face.idx() << ',' << from - corners.begin() << '\n';
                ++count;
            }
        }
    return std::to_string(count) + "\n" + lines.take();
}

std::string write_fl_curves(const VertexCurves& curves) {
    TextWriter out;
    out << curves.size() << '\n';
    for (const std::vector<int>& curve : curves) {
        out << curve.size();
        for (const int vertex : curve) out << ' ' << vertex;
        out << '\n';
    }
    return out.take();
}

}  // namespace fcn
