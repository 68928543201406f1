// The bridge to CGAL's Polygon_mesh_processing::isotropic_remeshing (Botsch, Kobbelt 2004, after
// Botsch et al., Polygon Mesh Processing, 2010, section 6.5.3). Marked edges are constrained and
// protected; face labels travel as CGAL's patch ids. Vertices are projected to the surface as it
// came in, not to the mesh handed over, whose curves already cut their corners; a projection that
// lands on a sheet facing the other way (a thin wall) looks along the normal for its own sheet.
#include "meshing/isotropic_cgal.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/exceptions.h>

#include <algorithm>
#include <cmath>

namespace fcn {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Vertex = SurfaceMesh::Vertex_index;
using Edge = SurfaceMesh::Edge_index;
using Face = SurfaceMesh::Face_index;
namespace pmp = CGAL::Polygon_mesh_processing;
namespace named = CGAL::parameters;

Vec3 to_vec(const Point& p) { return {p.x(), p.y(), p.z()}; }
Point to_point(const Vec3& p) { return {p[0], p[1], p[2]}; }

/// Projects vertices to the reference surface.
class Projector {
public:
    Projector(const SurfaceMesh& mesh, const SurfaceQueries& reference, double reach)
        : mesh_(&mesh), reference_(&reference), reach_(reach) {}

    Point operator()(Vertex vertex) const {
        const Vec3 here = to_vec(mesh_->point(vertex));
        const ClosestPoint closest = reference_->closest(here);
        const auto n = pmp::compute_vertex_normal(vertex, *mesh_);
        const Vec3 normal(n.x(), n.y(), n.z());
        if (normal.dot(normal_of(closest.surface)) >= 0) return to_point(closest.position);
        double best = reach_;
        Vec3 target = here;
        for (const double sign : {1.0, -1.0}) {
            const auto hit = reference_->first_hit(here, sign * normal);
            if (!hit || hit->distance >= best || normal.dot(normal_of(hit->surface)) <= 0) continue;
            best = hit->distance;
            target = hit->position;
        }
        return to_point(target);
    }

private:
    Vec3 normal_of(const SurfacePoint& point) const {
        return face_normal(reference_->mesh(), FaceHandle(point.face));
    }

    const SurfaceMesh* mesh_;
    const SurfaceQueries* reference_;
    double reach_;
};

/// A CGAL mesh with its marks.
struct Subject {
    SurfaceMesh mesh;
    SurfaceMesh::Property_map<Edge, bool> is_constrained;
    SurfaceMesh::Property_map<Vertex, bool> is_fixed;
    SurfaceMesh::Property_map<Face, int> label;
    std::vector<std::array<Vertex, 2>> features;
};

Subject make_subject(const MarkedMesh& marked) {
    Subject subject;
    SurfaceMesh& mesh = subject.mesh;
    subject.is_constrained = mesh.add_property_map<Edge, bool>("e:constrained", false).first;
    subject.is_fixed = mesh.add_property_map<Vertex, bool>("v:fixed", false).first;
    subject.label = mesh.add_property_map<Face, int>("f:label", 0).first;
    for (const VertexHandle vertex : marked.mesh.vertices())
        mesh.add_vertex(to_point(marked.mesh.point(vertex)));
    const auto vertex_of = [](VertexHandle v) {
        return Vertex(static_cast<SurfaceMesh::size_type>(v.idx()));
    };
    for (const FaceHandle face : marked.mesh.faces()) {
        const auto v = face_vertices(marked.mesh, face);
        const Face added = mesh.add_face(vertex_of(v[0]), vertex_of(v[1]), vertex_of(v[2]));
        if (added == SurfaceMesh::null_face()) continue;
        subject.label[added] = marked.face_label[static_cast<std::size_t>(face.idx())];
    }
    for (const EdgeHandle edge : marked.mesh.edges()) {
        const EdgeRole role = marked.edge_role[static_cast<std::size_t>(edge.idx())];
        if (role == EdgeRole::Free) continue;
        const HalfedgeHandle h = marked.mesh.halfedge_handle(edge, 0);
        const Vertex a = vertex_of(marked.mesh.from_vertex_handle(h));
        const Vertex b = vertex_of(marked.mesh.to_vertex_handle(h));
        const auto there = mesh.halfedge(a, b);
        if (there == SurfaceMesh::null_halfedge()) continue;
        subject.is_constrained[mesh.edge(there)] = true;
        if (role == EdgeRole::Feature) subject.features.push_back({a, b});
    }
    for (const int vertex : marked.station_vertex)
        if (vertex >= 0)
            subject.is_fixed[Vertex(static_cast<SurfaceMesh::size_type>(vertex))] = true;
    return subject;
}

void run_cgal(Subject& subject, const SurfaceQueries& reference, const IsotropicOptions& options) {
    SurfaceMesh& mesh = subject.mesh;
    const Projector projector(mesh, reference, 2 * options.edge_length);
    pmp::isotropic_remeshing(mesh.faces(), options.edge_length, mesh,
                             named::number_of_iterations(static_cast<unsigned>(options.iterations))
                                 .protect_constraints(options.is_protecting)
                                 .edge_is_constrained_map(subject.is_constrained)
                                 .vertex_is_constrained_map(subject.is_fixed)
                                 .face_patch_map(subject.label)
                                 .do_project(options.is_projecting)
                                 .projection_functor(projector));
}

/// The handles of the two meshes correspond by `number`: CGAL's vertex to ours, -1 if gone.
void mark_edges(const Subject& subject, const std::vector<int>& number, IsotropicResult& result) {
    MarkedMesh& marked = result.mesh;
    marked.edge_role.assign(marked.mesh.n_edges(), EdgeRole::Free);
    const auto role = [&](Vertex a, Vertex b) -> EdgeRole& {
        const auto h =
            marked.mesh.find_halfedge(VertexHandle(number[a.idx()]), VertexHandle(number[b.idx()]));
        return marked.edge_role[static_cast<std::size_t>(marked.mesh.edge_handle(h).idx())];
    };
    const SurfaceMesh& mesh = subject.mesh;
    for (const Edge edge : mesh.edges())
        if (subject.is_constrained[edge])
            role(mesh.vertex(edge, 0), mesh.vertex(edge, 1)) = EdgeRole::Border;
    for (const auto& [a, b] : subject.features) {
        const bool is_alive = !mesh.is_removed(a) && !mesh.is_removed(b) &&
                              mesh.halfedge(a, b) != SurfaceMesh::null_halfedge();
        if (is_alive)
            role(a, b) = EdgeRole::Feature;
        else
            ++result.lost_features;
    }
}

void collect(const Subject& subject, const MarkedMesh& before, IsotropicResult& result) {
    const SurfaceMesh& mesh = subject.mesh;
    MarkedMesh& after = result.mesh;
    std::vector<int> number(mesh.num_vertices(), -1);
    for (const Vertex vertex : mesh.vertices()) {
        if (mesh.is_isolated(vertex)) continue;
        const Vec3 point = to_vec(mesh.point(vertex));
        if (!point.allFinite()) {
            result.failure = "a vertex is not finite";
            return;
        }
        number[vertex.idx()] = after.mesh.add_vertex(point).idx();
        after.is_fixed_vertex.push_back(subject.is_fixed[vertex]);
    }
    for (const Face face : mesh.faces()) {
        std::array<VertexHandle, 3> corner;
        std::size_t count = 0;
        for (const Vertex vertex : mesh.vertices_around_face(mesh.halfedge(face)))
            if (count < 3) corner[count++] = VertexHandle(number[vertex.idx()]);
        if (!after.mesh.add_face(corner[0], corner[1], corner[2]).is_valid()) {
            result.failure = "its result is not manifold";
            return;
        }
        after.face_label.push_back(subject.label[face]);
    }
    if (after.mesh.n_faces() == 0) {
        result.failure = "nothing was left";
        return;
    }
    mark_edges(subject, number, result);
    for (const int vertex : before.station_vertex) {
        const Vertex v(static_cast<SurfaceMesh::size_type>(std::max(0, vertex)));
        const bool is_alive = vertex >= 0 && !mesh.is_removed(v);
        after.station_vertex.push_back(is_alive ? number[v.idx()] : -1);
    }
    result.has_succeeded = true;
}

}  // namespace

IsotropicResult remesh_isotropic(const MarkedMesh& marked, const SurfaceQueries& reference,
                                 const IsotropicOptions& options) {
    IsotropicResult result;
    try {
        Subject subject = make_subject(marked);
        run_cgal(subject, reference, options);
        collect(subject, marked, result);
    } catch (const CGAL::Failure_exception& failure) {
        result = {};
        result.failure = failure.message().empty() ? failure.expression() : failure.message();
    }
    return result;
}

}  // namespace fcn
