// Around a singularity of index -1 a map turns by 450 degrees, on a surface of 360. On five or six
// faces each is stretched so far that the nearest piecewise linear map turns some over (how a map
// behaves there does not depend on the size of the faces, only on their number). Untangling then
// finds maps without such faces that wind around vertices once too often. With twice as many faces
// that hardly ever happens. New vertices lie on the edges, so that the field stays as it is: a part
// of a face has the face's arm, and turns across part of an edge are the edge's.
#include "meshing/singularity_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/errors.h"

namespace fcn {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Part of a face, with the halfedges of the face that its sides lie on.
struct Part {
    std::array<int, 3> corners;
    std::array<int, 3> halfedges;  ///< side i from corner i; -1: inside the face
    int face;
};

class SingularityRefiner {
public:
    explicit SingularityRefiner(const QuadDomain& domain) : domain_(domain), mesh_(domain.mesh) {
        middle_.assign(mesh_.n_edges(), -1);
        vertices_ = static_cast<int>(mesh_.n_vertices());
    }

    RefinedField run(const FieldDesign& design) {
        for (const Singularity& s : design.singularities)
            for (const HalfedgeHandle h : mesh_.voh_range(VertexHandle(s.vertex)))
                if (!mesh_.is_boundary(h)) split(mesh_.edge_handle(mesh_.next_halfedge_handle(h)));
        for (const FaceHandle face : mesh_.faces()) cut(face);
        RefinedField result;
        result.design = design;
        build_mesh(result.domain);
        transfer(design.field, result);
        return result;
    }

private:
    void split(EdgeHandle edge) {
        if (middle_[at(edge.idx())] >= 0) return;
        middle_[at(edge.idx())] = vertices_++;
        split_.push_back(edge);
    }

    /// Into the triangle of its vertices without ears beside split edges; an ear at a time.
    void cut(FaceHandle face) {
        std::vector<int> ring, sides;  // sides[i] from ring[i]
        for (const HalfedgeHandle h : mesh_.fh_range(face)) {
            ring.push_back(mesh_.from_vertex_handle(h).idx());
            sides.push_back(h.idx());
            const int middle = middle_[at(mesh_.edge_handle(h).idx())];
            if (middle < 0) continue;
            ring.push_back(middle);
            sides.push_back(h.idx());
        }
        while (ring.size() > 3) {
            // An ear at an old vertex beside a middle: the middles stay.
            const std::size_t n = ring.size();
            std::size_t ear = n;
            for (std::size_t i = 0; i < n && ear == n; ++i) {
                const std::size_t before = (i + n - 1) % n, after = (i + 1) % n;
                if (ring[i] < old_vertices() &&
                    (ring[before] >= old_vertices() || ring[after] >= old_vertices()) &&
                    sides[before] != sides[i])
                    ear = i;
            }
            if (ear == n) throw LogicError("a face cannot be cut at the middles of its sides");
            const std::size_t before = (ear + n - 1) % n, after = (ear + 1) % n;
            parts_.push_back({{ring[before], ring[ear], ring[after]},
                              {sides[before], sides[ear], -1},
                              face.idx()});
            sides[before] = -1;
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
            sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        parts_.push_back({{ring[0], ring[1], ring[2]}, {sides[0], sides[1], sides[2]}, face.idx()});
    }

    int old_vertices() const { return static_cast<int>(mesh_.n_vertices()); }

    void build_mesh(QuadDomain& refined) const {
        for (const VertexHandle v : mesh_.vertices()) refined.mesh.add_vertex(mesh_.point(v));
        refined.vertex_place = domain_.vertex_place;
        for (const EdgeHandle edge : split_) {
            refined.mesh.add_vertex(mesh_.calc_edge_midpoint(edge));
            const VertexHandle end = mesh_.from_vertex_handle(mesh_.halfedge_handle(edge, 0));
            if (!domain_.vertex_place.empty())
                refined.vertex_place.push_back(domain_.vertex_place[at(end.idx())]);
        }
        for (const Part& part : parts_) {
            const FaceHandle face =
                refined.mesh.add_face(VertexHandle(part.corners[0]), VertexHandle(part.corners[1]),
                                      VertexHandle(part.corners[2]));
            if (!face.is_valid()) throw LogicError("the refined mesh is not a manifold");
            if (!domain_.face_label.empty())
                refined.face_label.push_back(domain_.face_label[at(part.face)]);
        }
        refined.filled_holes = domain_.filled_holes;
        refined.node_vertex = domain_.node_vertex;
        refined.warnings = domain_.warnings;
        refined.edge_arc.assign(refined.mesh.n_edges(), -1);
        refined.edge_segment.assign(refined.mesh.n_edges(), -1);
        refined.edge_weight.assign(refined.mesh.n_edges(), 0);
    }

    void transfer(const CrossField& field, RefinedField& result) const {
        QuadDomain& refined = result.domain;
        CrossField& to = result.design.field;
        to.angles.assign(refined.mesh.n_faces(), 0);
        to.turns.assign(refined.mesh.n_halfedges(), 0);
        for (std::size_t p = 0; p < parts_.size(); ++p) {
            const Part& part = parts_[p];
            const FaceHandle face(static_cast<int>(p));
            to.angles[p] = field.angles[at(part.face)] + frame_angle(refined.mesh, face, part);
            for (const HalfedgeHandle h : refined.mesh.fh_range(face)) {
                const auto corner = std::find(part.corners.begin(), part.corners.end(),
                                              refined.mesh.from_vertex_handle(h).idx());
                const int old =
                    part.halfedges[static_cast<std::size_t>(corner - part.corners.begin())];
                if (old < 0) continue;
                to.turns[at(h.idx())] = field.turns[at(old)];
                const std::size_t e = at(refined.mesh.edge_handle(h).idx());
                const std::size_t before = at(mesh_.edge_handle(HalfedgeHandle(old)).idx());
                refined.edge_arc[e] = domain_.edge_arc[before];
                refined.edge_segment[e] = domain_.edge_segment[before];
                refined.edge_weight[e] = domain_.edge_weight[before];
            }
        }
    }

    /// What a direction's angle grows by from the frame of the face to that of its part.
    double frame_angle(const Mesh& refined, FaceHandle face, const Part& part) const {
        const auto corner = [](const Mesh& mesh, FaceHandle f, std::size_t i) {
            return mesh.point(face_vertices(mesh, f)[i]);
        };
        const FaceHandle whole(part.face);
        const Vec3 x = (corner(mesh_, whole, 1) - corner(mesh_, whole, 0)).stableNormalized();
        const Vec3 y = face_normal(mesh_, whole).cross(x);
        const Vec3 to = corner(refined, face, 1) - corner(refined, face, 0);
        return -std::atan2(to.dot(y), to.dot(x));
    }

    const QuadDomain& domain_;
    const Mesh& mesh_;
    std::vector<int> middle_;  ///< per edge: the vertex that halves it; -1: none
    std::vector<EdgeHandle> split_;
    int vertices_ = 0;
    std::vector<Part> parts_;
};

}  // namespace

RefinedField refine_singularities(const QuadDomain& domain, const FieldDesign& design) {
    if (design.singularities.empty()) return {domain, design};
    return SingularityRefiner(domain).run(design);
}

}  // namespace fcn
