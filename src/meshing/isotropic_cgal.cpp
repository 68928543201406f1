// The bridge to CGAL's Polygon_mesh_processing::isotropic_remeshing (Botsch, Kobbelt 2004, after
// Botsch et al., Polygon Mesh Processing, 2010, section 6.5.3). Marked edges are constrained and
// protected; face labels travel as CGAL's patch ids. Vertices are projected to the surface as it
// came in, not to the mesh handed over, whose curves already cut their corners; a projection that
// lands on a sheet facing the other way (a thin wall) looks along the normal for its own sheet.
//
// Splits, collapses and flips are CGAL's. Two things it does not survive. A closed part smaller
// than the edge length collapses beyond the tetrahedron, and its connectivity breaks: parts of less
// than two edge lengths are left as they are. And its tangential relaxation reads outside its
// arrays at a vertex all of whose faces are degenerate: that step (uniform Laplacian in the tangent
// plane, halved until no face turns over) is done here, round by round.
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

constexpr double kSmallestPart = 2;         // diagonal of its box, in edge lengths
constexpr double kSmallestStep = 1.0 / 50;  // of a relaxation that would turn faces over

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
    SurfaceMesh::Property_map<Vertex, bool> is_in_small_part;
    SurfaceMesh::Property_map<Face, int> label;
    std::vector<std::array<Vertex, 2>> features;
};

Subject make_subject(const MarkedMesh& marked) {
    Subject subject;
    SurfaceMesh& mesh = subject.mesh;
    subject.is_constrained = mesh.add_property_map<Edge, bool>("e:constrained", false).first;
    subject.is_fixed = mesh.add_property_map<Vertex, bool>("v:fixed", false).first;
    subject.is_in_small_part = mesh.add_property_map<Vertex, bool>("v:small", false).first;
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

/// Marks the connected parts whose bounding box has a smaller diagonal; returns all other faces.
std::vector<Face> set_small_parts_apart(Subject& subject, double smallest_diagonal) {
    const SurfaceMesh& mesh = subject.mesh;
    std::vector<Face> faces;
    std::vector<bool> is_visited(mesh.number_of_vertices() + mesh.number_of_removed_vertices());
    for (const Vertex start : mesh.vertices()) {
        if (is_visited[start.idx()] || mesh.is_isolated(start)) continue;
        is_visited[start.idx()] = true;
        std::vector<Vertex> part{start};
        for (std::size_t i = 0; i < part.size(); ++i) {
            for (const Vertex next : CGAL::vertices_around_target(part[i], mesh)) {
                if (!is_visited[next.idx()]) part.push_back(next);
                is_visited[next.idx()] = true;
            }
        }
        BoundingBox box{to_vec(mesh.point(start)), to_vec(mesh.point(start))};
        for (const Vertex vertex : part) {
            box.min = box.min.cwiseMin(to_vec(mesh.point(vertex)));
            box.max = box.max.cwiseMax(to_vec(mesh.point(vertex)));
        }
        const bool is_small = box.diagonal() < smallest_diagonal;
        for (const Vertex vertex : part) subject.is_in_small_part[vertex] = is_small;
    }
    for (const Face face : mesh.faces())
        if (!subject.is_in_small_part[mesh.target(mesh.halfedge(face))]) faces.push_back(face);
    return faces;
}

/// Where the remesher may move a vertex: inside a patch.
bool is_free(const Subject& subject, Vertex vertex) {
    const SurfaceMesh& mesh = subject.mesh;
    if (mesh.is_isolated(vertex) || subject.is_fixed[vertex]) return false;
    if (subject.is_in_small_part[vertex]) return false;
    for (const auto h : CGAL::halfedges_around_target(vertex, mesh))
        if (mesh.is_border(mesh.edge(h)) || subject.is_constrained[mesh.edge(h)]) return false;
    return true;
}

/// Whether no two consecutive faces around a vertex face each other; degenerate ones do not count,
/// but one must not be.
bool is_unfolded(const SurfaceMesh& mesh, Vertex vertex) {
    std::vector<Kernel::Vector_3> normals;
    for (const Face face : CGAL::faces_around_target(mesh.halfedge(vertex), mesh)) {
        const Kernel::Vector_3 normal = pmp::compute_face_normal(face, mesh);
        if (normal != CGAL::NULL_VECTOR) normals.push_back(normal);
    }
    for (std::size_t i = 0; i < normals.size(); ++i)
        if (normals[i] * normals[(i + 1) % normals.size()] <= 0) return false;
    return !normals.empty();
}

/// The steps are computed before the first vertex moves.
void relax(Subject& subject) {
    SurfaceMesh& mesh = subject.mesh;
    const auto normals = mesh.add_property_map<Vertex, Kernel::Vector_3>("v:normal").first;
    pmp::compute_vertex_normals(mesh, normals);
    std::vector<std::pair<Vertex, Kernel::Vector_3>> steps;
    for (const Vertex vertex : mesh.vertices()) {
        if (!is_free(subject, vertex)) continue;
        const Point& here = mesh.point(vertex);
        Kernel::Vector_3 step = CGAL::NULL_VECTOR;
        int count = 0;
        for (const Vertex around : CGAL::vertices_around_target(vertex, mesh)) {
            step += mesh.point(around) - here;
            ++count;
        }
        step = step / count;
        steps.emplace_back(vertex, step - (normals[vertex] * step) * normals[vertex]);
    }
    for (const auto& [vertex, step] : steps) {
        const Point before = mesh.point(vertex);
        double share = 1;
        mesh.point(vertex) = before + step;
        while (share > kSmallestStep && !is_unfolded(mesh, vertex)) {
            share /= 2;
            mesh.point(vertex) = share > kSmallestStep ? before + share * step : before;
        }
    }
}

void project(Subject& subject, const Projector& projector) {
    for (const Vertex vertex : subject.mesh.vertices())
        if (is_free(subject, vertex)) subject.mesh.point(vertex) = projector(vertex);
}

void run_cgal(Subject& subject, const SurfaceQueries& reference, const IsotropicOptions& options) {
    SurfaceMesh& mesh = subject.mesh;
    const Projector projector(mesh, reference, 2 * options.edge_length);
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
        const std::vector<Face> faces =
            set_small_parts_apart(subject, kSmallestPart * options.edge_length);
        if (faces.empty()) return;
        pmp::isotropic_remeshing(faces, options.edge_length, mesh,
                                 named::number_of_iterations(1)
                                     .number_of_relaxation_steps(0)
                                     .protect_constraints(options.is_protecting)
                                     .edge_is_constrained_map(subject.is_constrained)
                                     .vertex_is_constrained_map(subject.is_fixed)
                                     .face_patch_map(subject.label)
                                     .do_project(false));
        relax(subject);
        if (options.is_projecting) project(subject, projector);
    }
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
