// Sharpness at a scale. The shape operator of Alliez, Cohen-Steiner, Devillers, Levy, Desbrun
// (2003), sum of beta(e) |e in B| e e^T over the edges in a ball B of radius r, is divided by 2 r
// instead of the ball's area: its largest eigenvalue is then the angle by which the surface turns
// inside the ball, the dihedral angle for a crease through the centre. Unlike a curvature it stays
// the same when the mesh is refined, and on meshes coarser than the ball.

#include "adaptation/surface_sharpness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "adaptation/point_distance.h"

namespace fcn {

namespace {

/// Length of the part of segment [a, b] inside the ball.
double length_in_ball(const Vec3& a, const Vec3& b, const Vec3& center, double radius) {
    const Vec3 d = b - a;
    const double length = d.norm();
    if (length == 0) return 0;
    const Vec3 unit = d / length;
    const double along = (center - a).dot(unit);
    const double squared = radius * radius - (center - a - along * unit).squaredNorm();
    if (squared <= 0) return 0;
    const double half = std::sqrt(squared);
    return std::max(0.0, std::min(length, along + half) - std::max(0.0, along - half));
}

}  // namespace

SurfaceSharpness::SurfaceSharpness(const Mesh& mesh) {
    edges_.reserve(mesh.n_edges());
    double total = 0;
    for (const EdgeHandle edge : mesh.edges()) {
        const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
        edges_.push_back({mesh.point(mesh.from_vertex_handle(halfedge)),
                          mesh.point(mesh.to_vertex_handle(halfedge)), dihedral_angle(mesh, edge)});
        total += (edges_.back().from - edges_.back().to).norm();
    }
    mean_edge_length_ = edges_.empty() ? 0 : total / static_cast<double>(edges_.size());
    face_edges_.resize(mesh.n_faces());
    face_neighbours_.resize(mesh.n_faces());
    for (const FaceHandle face : mesh.faces()) {
        HalfedgeHandle halfedge = mesh.halfedge_handle(face);
        for (int k = 0; k < 3; ++k) {
            face_edges_[face.idx()][k] = mesh.edge_handle(halfedge).idx();
            face_neighbours_[face.idx()][k] =
                mesh.face_handle(mesh.opposite_halfedge_handle(halfedge)).idx();
            halfedge = mesh.next_halfedge_handle(halfedge);
        }
    }
}

PointSharpness SurfaceSharpness::measure(const SurfacePoint& at, const Vec3& position,
                                         const Vec3& tangent, double radius) const {
    PointSharpness result;
    if (at.face < 0) return result;
    const double touch = 0.05 * mean_edge_length_;
    Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
    std::vector<int> queue{at.face};
    std::unordered_set<int> seen_faces{at.face};
    std::unordered_set<int> seen_edges;
    for (std::size_t head = 0; head < queue.size(); ++head) {
        const int face = queue[head];
        for (int k = 0; k < 3; ++k) {
            const int index = face_edges_[face][k];
            const Edge& edge = edges_[index];
            const double inside = length_in_ball(edge.from, edge.to, position, radius);
            const bool is_touching = distance_to_segment(position, edge.from, edge.to) <= touch;
            if (inside <= 0 && !is_touching) continue;
            const int next = face_neighbours_[face][k];
            if (next >= 0 && seen_faces.insert(next).second) queue.push_back(next);
            if (!seen_edges.insert(index).second) continue;
            const Vec3 unit = (edge.to - edge.from).normalized();
            tensor += edge.dihedral * inside * unit * unit.transpose();
            if (is_touching && std::abs(unit.dot(tangent)) >= 0.7) {
                result.crease = std::max(result.crease, std::abs(edge.dihedral));
            }
        }
    }
    if (radius > 0) {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor / (2 * radius),
                                                                    Eigen::EigenvaluesOnly);
        result.turning = solver.eigenvalues().cwiseAbs().maxCoeff();
    }
    return result;
}

}  // namespace fcn
