// With the turns fixed, the energy of a field is quadratic in the angles themselves: sum over links
// s (b + x_g - x_f)^2 + sum over guides w (a_f + x_f - arm)^2 with the change x, the bends b so far
// and the arm of the guide's cross that is nearest (Bommes, Zimmer, Kobbelt 2009, "Mixed-integer
// quadrangulation", equation 3 with its integers given).
#include "meshing/matched_field.h"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>

namespace fcn {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;
constexpr double kLeastMass = 1e-9;  ///< keeps angles where no guide holds them

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool relax(const FaceConnection& connection, const std::vector<FieldGuide>& guides,
           MatchedField& matched, double far) {
    const auto n = static_cast<Eigen::Index>(connection.areas.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index f = 0; f < n; ++f) entries.emplace_back(f, f, kLeastMass);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < connection.links.size(); ++i) {
        const FaceLink& link = connection.links[i];
        entries.emplace_back(link.from, link.from, link.stiffness);
        entries.emplace_back(link.to, link.to, link.stiffness);
        entries.emplace_back(std::max(link.from, link.to), std::min(link.from, link.to),
                             -link.stiffness);
        right[link.to] -= link.stiffness * matched.bends[i];
        right[link.from] += link.stiffness * matched.bends[i];
    }
    for (const FieldGuide& guide : guides) {
        const double away =
            std::remainder(guide.angle - matched.field.angles[at(guide.face)], kQuarter);
        if (std::abs(away) > far) continue;
        entries.emplace_back(guide.face, guide.face, guide.weight);
        right[guide.face] += guide.weight * away;
    }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    if (solver.info() != Eigen::Success) return false;
    const Eigen::VectorXd x = solver.solve(right);
    if (!x.allFinite()) return false;
    for (Eigen::Index f = 0; f < n; ++f) matched.field.angles[static_cast<std::size_t>(f)] += x[f];
    for (std::size_t i = 0; i < connection.links.size(); ++i)
        matched.bends[i] += x[connection.links[i].to] - x[connection.links[i].from];
    return true;
}

}  // namespace

MatchedField match_arms(const Mesh& mesh, const FaceConnection& connection,
                        std::vector<double> angles) {
    MatchedField matched;
    matched.field.angles = std::move(angles);
    matched.field.turns.assign(mesh.n_halfedges(), 0);
    for (const FaceLink& link : connection.links) {
        const double between = std::remainder(
            matched.field.angles[at(link.to)] - matched.field.angles[at(link.from)] - link.rotation,
            2 * std::numbers::pi);
        const int turn = static_cast<int>(std::lround(between / kQuarter));
        matched.bends.push_back(between - turn * kQuarter);
        const HalfedgeHandle h(link.halfedge);
        matched.field.turns[at(h.idx())] = (turn + 4) % 4;
        matched.field.turns[at(mesh.opposite_halfedge_handle(h).idx())] = (4 - turn) % 4;
    }
    matched.indices = vertex_indices(mesh, matched.field);
    return matched;
}

void turn_link(const Mesh& mesh, const FaceConnection& connection, std::size_t link, int turns,
               MatchedField& matched) {
    const HalfedgeHandle h(connection.links[link].halfedge);
    int& turn = matched.field.turns[at(h.idx())];
    turn = (((turn + turns) % 4) + 4) % 4;
    matched.field.turns[at(mesh.opposite_halfedge_handle(h).idx())] = (4 - turn) % 4;
    matched.bends[link] -= turns * kQuarter;
    // The link crosses h from its left to its right: clockwise around its origin.
    matched.indices[at(mesh.from_vertex_handle(h).idx())] += turns;
    matched.indices[at(mesh.to_vertex_handle(h).idx())] -= turns;
}

void reconnect(const FaceConnection& before, const FaceConnection& after, MatchedField& matched) {
    for (std::size_t i = 0; i < matched.bends.size(); ++i)
        matched.bends[i] += std::remainder(before.links[i].rotation - after.links[i].rotation,
                                           2 * std::numbers::pi);
}

bool straighten(const FaceConnection& connection, const std::vector<FieldGuide>& guides,
                MatchedField& matched, double far) {
    MatchedField next = matched;
    if (!relax(connection, guides, next, far) || !relax(connection, guides, next, 10)) return false;
    matched = std::move(next);
    return true;
}

}  // namespace fcn
