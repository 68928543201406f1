// Sharpness at a scale. The shape operator of Alliez, Cohen-Steiner, Devillers, Levy, Desbrun
// (2003), sum of beta(e) |e in B| e e^T over the edges in a ball B of radius r, is divided by 2 r
// instead of the ball's area: its largest eigenvalue is then the angle by which the surface turns
// inside the ball, the dihedral angle for a crease through the centre. Unlike a curvature it stays
// the same when the mesh is refined, and on meshes coarser than the ball.

#include "adaptation/surface_sharpness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fcn {

namespace {

/// Length of the part of an edge inside the ball; `height` is the centre's distance, squared, from
/// the edge's line and `along` its foot on it.
double length_in_ball(double length, double along, double height, double radius) {
    const double squared = radius * radius - height;
    if (squared <= 0) return 0;
    const double half = std::sqrt(squared);
    return std::max(0.0, std::min(length, along + half) - std::max(0.0, along - half));
}

}  // namespace

void SurfaceSharpness::Visit::begin(std::size_t face_count, std::size_t edge_count) {
    queue.clear();
    face_round.resize(face_count, 0);
    edge_mark.resize(edge_count, 0);
    if (++round == std::numeric_limits<std::uint32_t>::max() / 2) {
        std::ranges::fill(face_round, 0);
        std::ranges::fill(edge_mark, 0);
        round = 1;
    }
}

void SurfaceSharpness::Visit::add_face(int face) {
    if (face < 0 || face_round[static_cast<std::size_t>(face)] == round) return;
    face_round[static_cast<std::size_t>(face)] = round;
    queue.push_back(face);
}

SurfaceSharpness::SurfaceSharpness(const Mesh& mesh) {
    edges_.reserve(mesh.n_edges());
    double total = 0;
    for (const EdgeHandle edge : mesh.edges()) {
        const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
        const Vec3 from = mesh.point(mesh.from_vertex_handle(halfedge));
        const Vec3 along = mesh.point(mesh.to_vertex_handle(halfedge)) - from;
        const double length = along.norm();
        const Vec3 unit = length > 0 ? Vec3(along / length) : Vec3(Vec3::Zero());
        edges_.push_back({from, unit, length, dihedral_angle(mesh, edge)});
        total += length;
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
    Visit& visit = visits_.local();
    visit.begin(face_edges_.size(), edges_.size());
    visit.add_face(at.face);
    for (std::size_t head = 0; head < visit.queue.size(); ++head) {
        const int face = visit.queue[head];
        for (int k = 0; k < 3; ++k) {
            const int index = face_edges_[face][k];
            // An edge that leads out of the ball does so from either side.
            if (visit.has_edge(index)) {
                if (visit.is_passable(index)) visit.add_face(face_neighbours_[face][k]);
                continue;
            }
            const Edge& edge = edges_[index];
            const Vec3 offset = position - edge.from;
            const double along = offset.dot(edge.unit);
            const double height = (offset - along * edge.unit).squaredNorm();
            const double inside =
                edge.length > 0 ? length_in_ball(edge.length, along, height, radius) : 0;
            const bool is_touching =
                height + std::pow(along - std::clamp(along, 0.0, edge.length), 2) <= touch * touch;
            const bool is_passable = inside > 0 || is_touching;
            visit.add_edge(index, is_passable);
            if (!is_passable) continue;
            visit.add_face(face_neighbours_[face][k]);
            tensor += edge.dihedral * inside * edge.unit * edge.unit.transpose();
            if (is_touching && std::abs(edge.unit.dot(tangent)) >= 0.7) {
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
