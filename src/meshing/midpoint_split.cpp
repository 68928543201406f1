// Midpoint subdivision, as Catmull and Clark 1978 cut their meshes: whatever the faces are, all
// that come of it are quads. A convex flat face has convex parts, since its centre sees all of it.
#include "meshing/midpoint_split.h"

#include "geometry/errors.h"

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class Splitter {
public:
    Splitter(const PairableTriangles& mesh, const std::vector<int>& labels)
        : mesh_(mesh), labels_(labels) {}

    MidpointSplit run(const std::vector<int>& gone) {
        std::vector<bool> is_gone(mesh_.edges.size(), false), is_paired(mesh_.triangles.size());
        for (const int e : gone) {
            const TriangleEdge& edge = mesh_.edges[at(e)];
            if (edge.right < 0 || is_paired[at(edge.left)] || is_paired[at(edge.right)])
                throw LogicError("quads: the edges that go do not pair triangles");
            is_gone[at(e)] = is_paired[at(edge.left)] = is_paired[at(edge.right)] = true;
        }
        result_.mesh.points = mesh_.points;
        for (std::size_t e = 0; e < mesh_.edges.size(); ++e)
            result_.edge_vertex.push_back(is_gone[e] ? -1 : add_point(mesh_.edges[e].middle));
        for (std::size_t f = 0; f < mesh_.triangles.size(); ++f)
            if (!is_paired[f])
                cut(mesh_.triangles[f], mesh_.triangle_edges[f], static_cast<int>(f));
        for (const int e : gone) {
            const PairedQuad quad = quad_across(mesh_, e);
            cut(quad.corners, quad.edges, mesh_.edges[at(e)].left);
        }
        return std::move(result_);
    }

private:
    int add_point(const Vec3& p) {
        result_.mesh.points.push_back(p);
        return static_cast<int>(result_.mesh.points.size()) - 1;
    }

    template <std::size_t N>
    void cut(const std::array<int, N>& corners, const std::array<int, N>& edges, int triangle) {
        Vec3 centre = Vec3::Zero();
        for (const int v : corners) centre += mesh_.points[at(v)] / static_cast<double>(N);
        const int middle = add_point(centre);
        for (std::size_t i = 0; i < N; ++i) {
            result_.mesh.faces.push_back({corners[i], result_.edge_vertex[at(edges[i])], middle,
                                          result_.edge_vertex[at(edges[(i + N - 1) % N])]});
            if (!labels_.empty()) result_.mesh.face_labels.push_back(labels_[at(triangle)]);
        }
    }

    const PairableTriangles& mesh_;
    const std::vector<int>& labels_;
    MidpointSplit result_;
};

}  // namespace

MidpointSplit split_at_middles(const PairableTriangles& mesh, const std::vector<int>& gone,
                               const std::vector<int>& labels) {
    return Splitter(mesh, labels).run(gone);
}

}  // namespace fcn
