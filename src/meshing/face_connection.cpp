// The Levi-Civita connection of a triangle mesh turns around each vertex by its angle defect. Bumps
// that are smaller than a quad have defects large enough for singularities of their own, although
// no quad mesh of that size can show them. So the connection is changed, as in Ebke, Campen,
// Bommes, Kobbelt 2014, "Level-of-detail quad meshing": its curvature is what the defects become by
// diffusion over the given length. With mass M, Laplacian L, time t: (M + t L) x = K makes the
// curvature M x, and the difference -t L x is what the rotations -t c (x_j - x_i) across the edges
// i j of cotangent weight c add up to around each vertex, so one solve gives both. Departure: the
// defects of vertices on the network stay up to a quarter, since what the network keeps should be
// kept sharply.
#include "meshing/face_connection.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshing/cross_field.h"

namespace fcn {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;
constexpr double kLeastCotangent = 0.05;  ///< keeps the Laplacian's weights positive
constexpr double kLeastArea = 1e-6;       ///< of the mean, for degenerate faces

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Cotangent of the angle opposite to h in its face.
double cotangent(const Mesh& mesh, HalfedgeHandle h) {
    const Vec3& p = mesh.point(mesh.to_vertex_handle(mesh.next_halfedge_handle(h)));
    const Vec3 a = mesh.point(mesh.from_vertex_handle(h)) - p;
    const Vec3 b = mesh.point(mesh.to_vertex_handle(h)) - p;
    return a.dot(b) / std::max(a.cross(b).norm(), 1e-12 * a.norm() * b.norm() + 1e-300);
}

/// Per edge; 0 at boundaries, across which nothing is rotated.
std::vector<double> cotangent_weights(const Mesh& mesh) {
    std::vector<double> weights(mesh.n_edges(), 0);
    for (const EdgeHandle edge : mesh.edges()) {
        if (mesh.is_boundary(edge)) continue;
        const double sum = cotangent(mesh, mesh.halfedge_handle(edge, 0)) +
                           cotangent(mesh, mesh.halfedge_handle(edge, 1));
        weights[at(edge.idx())] = std::max(sum / 2, kLeastCotangent);
    }
    return weights;
}

/// Defects of inner vertices that are to be spread.
Eigen::VectorXd spread_defects(const Mesh& mesh, const std::vector<bool>& is_kept) {
    Eigen::VectorXd defects = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.n_vertices()));
    for (const VertexHandle v : mesh.vertices()) {
        if (mesh.is_boundary(v)) continue;
        double sum = 0;
        for (const HalfedgeHandle h : mesh.voh_range(v)) {
            const Vec3 a = mesh.point(mesh.to_vertex_handle(h)) - mesh.point(v);
            const Vec3 b =
                mesh.point(mesh.from_vertex_handle(mesh.prev_halfedge_handle(h))) - mesh.point(v);
            sum += std::atan2(a.cross(b).norm(), a.dot(b));
        }
        const double defect = 2 * std::numbers::pi - sum;
        const bool is_whole = is_kept.empty() || !is_kept[at(v.idx())];
        defects[v.idx()] = is_whole ? defect : defect - std::clamp(defect, -kQuarter, kQuarter);
    }
    return defects;
}

/// Per edge, what is added to the rotation across its first halfedge.
std::vector<double> smoothing_rotations(const Mesh& mesh, const ConnectionOptions& options,
                                        const std::vector<double>& areas) {
    const double time = options.smoothing * options.smoothing / 2;
    const std::vector<double> weights = cotangent_weights(mesh);
    std::vector<Eigen::Triplet<double>> entries;
    for (const FaceHandle face : mesh.faces())
        for (const VertexHandle v : face_vertices(mesh, face))
            entries.emplace_back(v.idx(), v.idx(), areas[at(face.idx())] / 3);
    for (const EdgeHandle edge : mesh.edges()) {
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const int i = mesh.from_vertex_handle(h).idx(), j = mesh.to_vertex_handle(h).idx();
        const double value = time * weights[at(edge.idx())];
        entries.emplace_back(i, i, value);
        entries.emplace_back(j, j, value);
        entries.emplace_back(std::max(i, j), std::min(i, j), -value);
    }
    for (const VertexHandle v : mesh.vertices())
        if (mesh.is_isolated(v)) entries.emplace_back(v.idx(), v.idx(), 1);
    const auto n = static_cast<Eigen::Index>(mesh.n_vertices());
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    std::vector<double> rotations(mesh.n_edges(), 0);
    if (solver.info() != Eigen::Success) return rotations;
    const Eigen::VectorXd x = solver.solve(spread_defects(mesh, options.is_kept));
    for (const EdgeHandle edge : mesh.edges()) {
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        rotations[at(edge.idx())] =
            -time * weights[at(edge.idx())] *
            (x[mesh.to_vertex_handle(h).idx()] - x[mesh.from_vertex_handle(h).idx()]);
    }
    return rotations;
}

}  // namespace

FaceConnection connect_faces(const Mesh& mesh, const ConnectionOptions& options) {
    FaceConnection connection;
    double total = 0;
    for (const FaceHandle face : mesh.faces()) {
        connection.areas.push_back(face_area(mesh, face));
        total += connection.areas.back();
    }
    const double least = std::max(
        kLeastArea * total / std::max<double>(1, static_cast<double>(mesh.n_faces())), 1e-300);
    for (double& area : connection.areas) area = std::max(area, least);
    std::vector<double> added;
    if (options.smoothing > 0) added = smoothing_rotations(mesh, options, connection.areas);
    for (const EdgeHandle edge : mesh.edges()) {
        if (mesh.is_boundary(edge)) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        FaceLink link;
        link.from = mesh.face_handle(h).idx();
        link.to = mesh.face_handle(mesh.opposite_halfedge_handle(h)).idx();
        link.halfedge = h.idx();
        link.rotation = frame_rotation(mesh, h) + (added.empty() ? 0 : added[at(edge.idx())]);
        const double length = mesh.calc_edge_length(h);
        link.stiffness =
            std::max(1e-3, 3 * length * length /
                               (connection.areas[at(link.from)] + connection.areas[at(link.to)]));
        connection.links.push_back(link);
    }
    return connection;
}

}  // namespace fcn
