// Flat copies of what the detectors read in their inner loops. A halfedge walk through the mesh
// kernel touches three arrays of connectivity per step; the loops here touch one.

#include "features/mesh_arrays.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace fcn {
namespace {

double signed_dihedral(const MeshArrays& arrays, int edge) {
    const auto [left, right] = arrays.edge_faces[edge];
    if (left < 0 || right < 0) return 0;
    const Vec3& normal_left = arrays.normals[left];
    const Vec3& normal_right = arrays.normals[right];
    const auto [from, to] = arrays.edge_vertices[edge];
    const Vec3 direction = (arrays.points[to] - arrays.points[from]).normalized();
    return std::atan2(normal_left.cross(normal_right).dot(direction),
                      normal_left.dot(normal_right));
}

void fill_edges(const Mesh& mesh, MeshArrays& arrays) {
    for (int e = 0; e < arrays.edge_count(); ++e) {
        const HalfedgeHandle h0 = mesh.halfedge_handle(EdgeHandle(e), 0);
        const HalfedgeHandle h1 = mesh.opposite_halfedge_handle(h0);
        arrays.edge_vertices[e] = {mesh.from_vertex_handle(h0).idx(),
                                   mesh.to_vertex_handle(h0).idx()};
        arrays.edge_faces[e] = {mesh.is_boundary(h0) ? -1 : mesh.face_handle(h0).idx(),
                                mesh.is_boundary(h1) ? -1 : mesh.face_handle(h1).idx()};
    }
}

void fill_face(const Mesh& mesh, int f, MeshArrays& arrays) {
    HalfedgeHandle h = mesh.halfedge_handle(FaceHandle(f));
    for (int i = 0; i < 3; ++i) {
        const HalfedgeHandle opposite = mesh.opposite_halfedge_handle(h);
        arrays.face_vertices[f][i] = mesh.from_vertex_handle(h).idx();
        arrays.face_edges[f][i] = mesh.edge_handle(h).idx();
        arrays.face_neighbors[f][i] =
            mesh.is_boundary(opposite) ? -1 : mesh.face_handle(opposite).idx();
        h = mesh.next_halfedge_handle(h);
    }
    const auto [a, b, c] = arrays.face_vertices[f];
    const Vec3 cross =
        (arrays.points[b] - arrays.points[a]).cross(arrays.points[c] - arrays.points[a]);
    const double norm = cross.norm();
    arrays.areas[f] = 0.5 * norm;
    arrays.normals[f] = norm > 0 ? Vec3(cross / norm) : Vec3(Vec3::Zero());
}

}  // namespace

double MeshArrays::edge_length(int edge) const {
    return (points[edge_vertices[edge][1]] - points[edge_vertices[edge][0]]).norm();
}

Vec3 MeshArrays::centroid(int face) const {
    const auto [a, b, c] = face_vertices[face];
    return (points[a] + points[b] + points[c]) / 3;
}

bool MeshArrays::is_boundary(int edge) const {
    return edge_faces[edge][0] < 0 || edge_faces[edge][1] < 0;
}

MeshArrays mesh_arrays(const Mesh& mesh, int threads) {
    MeshArrays arrays;
    const std::size_t vertex_count = mesh.n_vertices();
    const std::size_t face_count = mesh.n_faces();
    const std::size_t edge_count = mesh.n_edges();
    arrays.points.resize(vertex_count);
    for (std::size_t v = 0; v < vertex_count; ++v) {
        arrays.points[v] = mesh.point(VertexHandle(static_cast<int>(v)));
    }
    arrays.face_vertices.resize(face_count);
    arrays.face_edges.resize(face_count);
    arrays.face_neighbors.resize(face_count);
    arrays.normals.resize(face_count);
    arrays.areas.resize(face_count);
    arrays.edge_vertices.resize(edge_count);
    arrays.edge_faces.resize(edge_count);
    arrays.dihedrals.resize(edge_count);
    tbb::task_arena arena(std::max(1, threads));
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, static_cast<int>(face_count), 4096),
                          [&](const tbb::blocked_range<int>& range) {
                              for (int f = range.begin(); f < range.end(); ++f) {
                                  fill_face(mesh, f, arrays);
                              }
                          });
        fill_edges(mesh, arrays);
        tbb::parallel_for(tbb::blocked_range<int>(0, static_cast<int>(edge_count), 4096),
                          [&](const tbb::blocked_range<int>& range) {
                              for (int e = range.begin(); e < range.end(); ++e) {
                                  arrays.dihedrals[e] = signed_dihedral(arrays, e);
                              }
                          });
    });
    double total = 0;
    for (int e = 0; e < arrays.edge_count(); ++e) total += arrays.edge_length(e);
    arrays.mean_edge_length = edge_count > 0 ? total / static_cast<double>(edge_count) : 0;
    return arrays;
}

IndexRows faces_of_vertices(const MeshArrays& arrays) {
    IndexRows rows;
    rows.offsets.assign(arrays.vertex_count() + 1, 0);
    for (const auto& corners : arrays.face_vertices) {
        for (int v : corners) ++rows.offsets[v + 1];
    }
    for (int v = 0; v < arrays.vertex_count(); ++v) rows.offsets[v + 1] += rows.offsets[v];
    rows.values.resize(rows.offsets.back());
    std::vector<int> next(rows.offsets.begin(), rows.offsets.end() - 1);
    for (int f = 0; f < arrays.face_count(); ++f) {
        for (int v : arrays.face_vertices[f]) rows.values[next[v]++] = f;
    }
    return rows;
}

IndexRows edges_of_vertices(const MeshArrays& arrays, const std::vector<bool>& is_marked_edge) {
    IndexRows rows;
    rows.offsets.assign(arrays.vertex_count() + 1, 0);
    for (int e = 0; e < arrays.edge_count(); ++e) {
        if (!is_marked_edge[e]) continue;
        for (int v : arrays.edge_vertices[e]) ++rows.offsets[v + 1];
    }
    for (int v = 0; v < arrays.vertex_count(); ++v) rows.offsets[v + 1] += rows.offsets[v];
    rows.values.resize(rows.offsets.back());
    std::vector<int> next(rows.offsets.begin(), rows.offsets.end() - 1);
    for (int e = 0; e < arrays.edge_count(); ++e) {
        if (!is_marked_edge[e]) continue;
        for (int v : arrays.edge_vertices[e]) rows.values[next[v]++] = e;
    }
    return rows;
}

SurfacePoint surface_point_of_vertex(const MeshArrays& arrays, int vertex, int face) {
    SurfacePoint point;
    point.face = face;
    for (int i = 0; i < 3; ++i) {
        point.barycentric[i] = arrays.face_vertices[face][i] == vertex ? 1.0 : 0.0;
    }
    return point;
}

}  // namespace fcn
