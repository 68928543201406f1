// The linear part of a seamless map (Bommes, Zimmer, Kobbelt 2009, section 5): equations for seams,
// integers and alignments, all eliminated exactly. One translation a chain of the cut joins its
// sides; singular vertices are integers, and so is the coordinate across a hard edge. Each
// component is pinned at one vertex, which takes nothing away.
#include "meshing/map_problem.h"

#include <algorithm>
#include <cmath>

namespace fcn {
namespace {

constexpr double kQuarter = 1.57079632679489661923;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class ProblemBuilder {
public:
    ProblemBuilder(const Mesh& mesh, const CrossField& field, const MapGuidance& guidance)
        : mesh_(mesh), field_(field), guidance_(guidance) {
        problem_.cut = cut_to_disks(mesh, field);
        problem_.fault = problem_.cut.fault;
        if (!problem_.fault.empty()) return;
        shape_faces();
        if (!problem_.fault.empty()) return;
        for (const EdgeHandle edge : mesh.edges())
            problem_.is_hard.push_back(
                mesh.is_boundary(edge) ||
                (!guidance.is_hard.empty() && guidance.is_hard[at(edge.idx())] != 0));
        mark_integers();
        IntegerElimination elimination(is_integer_);
        pin_components(elimination);
        align(elimination);
        join_seams(elimination);
        problem_.unknowns = elimination.finish();
    }
    MapProblem take() { return std::move(problem_); }

private:
    void shape_faces() {
        for (const FaceHandle face : mesh_.faces()) {
            const auto corners = face_vertices(mesh_, face);
            const Vec3 p = mesh_.point(corners[0]);
            const Vec3 a = mesh_.point(corners[1]) - p, b = mesh_.point(corners[2]) - p;
            const double length = a.norm(), twice_area = a.cross(b).norm();
            if (!(twice_area > 0)) {
                problem_.fault = "face " + std::to_string(face.idx()) + " has no area";
                return;
            }
            const double unit = guidance_.edge_length;
            const double turn =
                -(field_.angles[at(face.idx())] + kQuarter * problem_.cut.arms[at(face.idx())]);
            const Eigen::Rotation2Dd rotation(turn);
            Eigen::Matrix2d edges;
            edges.col(0) = rotation * Vec2(length / unit, 0);
            edges.col(1) = rotation * Vec2(a.dot(b) / length / unit, twice_area / length / unit);
            FaceShape shape;
            shape.area = twice_area / (2 * unit * unit);
            const Eigen::Matrix2d inverse = edges.inverse().transpose();
            shape.gradients.col(1) = inverse.col(0);
            shape.gradients.col(2) = inverse.col(1);
            shape.gradients.col(0) = -inverse.col(0) - inverse.col(1);
            problem_.shapes.push_back(shape);
        }
    }

    int copy_of(FaceHandle face, VertexHandle vertex) const {
        const auto corners = face_vertices(mesh_, face);
        const std::size_t i = corners[0] == vertex ? 0 : (corners[1] == vertex ? 1 : 2);
        return problem_.cut.copies[at(face.idx())][i];
    }
    /// Copies of a halfedge's ends on the side of its face.
    std::array<int, 2> copies_of(HalfedgeHandle h) const {
        const FaceHandle face = mesh_.face_handle(h);
        return {copy_of(face, mesh_.from_vertex_handle(h)),
                copy_of(face, mesh_.to_vertex_handle(h))};
    }
    bool is_hard(EdgeHandle edge) const { return problem_.is_hard[at(edge.idx())]; }
    /// A halfedge of the edge that has a face.
    HalfedgeHandle inner_halfedge(EdgeHandle edge) const {
        const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
        return mesh_.is_boundary(h) ? mesh_.opposite_halfedge_handle(h) : h;
    }
    /// The coordinate that should stay the same along a halfedge: 0 or 1.
    int coordinate_across(HalfedgeHandle h) const {
        const int face = mesh_.face_handle(h).idx();
        const double angle = halfedge_angle(mesh_, h) - field_.angles[at(face)] -
                             kQuarter * problem_.cut.arms[at(face)];
        return (std::lround(angle / kQuarter) & 1) == 0 ? 1 : 0;
    }

    bool is_asked_for(VertexHandle vertex) const {
        return std::binary_search(guidance_.grid_vertices.begin(), guidance_.grid_vertices.end(),
                                  vertex.idx());
    }

    void mark_integers() {
        const CutMesh& cut = problem_.cut;
        const std::size_t positions = 2 * at(cut.copy_count);
        is_integer_.assign(positions + 2 * cut.chains.size(), false);
        std::fill(is_integer_.begin() + static_cast<std::ptrdiff_t>(positions), is_integer_.end(),
                  true);
        for (const FaceHandle face : mesh_.faces()) {
            const auto corners = face_vertices(mesh_, face);
            for (std::size_t i = 0; i < 3; ++i) {
                if (cut.is_singular[at(corners[i].idx())] == 0 && !is_asked_for(corners[i]))
                    continue;
                const std::size_t copy = at(cut.copies[at(face.idx())][i]);
                is_integer_[2 * copy] = is_integer_[2 * copy + 1] = true;
            }
        }
        for (const EdgeHandle edge : mesh_.edges()) {
            if (!is_hard(edge)) continue;
            const HalfedgeHandle h = inner_halfedge(edge);
            mark_across(h);
            if (!mesh_.is_boundary(edge)) mark_across(mesh_.opposite_halfedge_handle(h));
        }
    }
    void mark_across(HalfedgeHandle h) {
        const int coordinate = coordinate_across(h);
        for (const int copy : copies_of(h)) is_integer_[at(2 * copy + coordinate)] = true;
    }

    /// A copy with as many integers as there is in each component.
    void pin_components(IntegerElimination& elimination) {
        std::vector<std::uint8_t> is_seen(mesh_.n_faces(), 0);
        for (const FaceHandle seed : mesh_.faces()) {
            if (is_seen[at(seed.idx())]) continue;
            int best = -1, best_count = -1;
            std::vector<FaceHandle> queue{seed};
            is_seen[at(seed.idx())] = 1;
            for (std::size_t i = 0; i < queue.size(); ++i) {
                for (const int copy : problem_.cut.copies[at(queue[i].idx())]) {
                    const int count = is_integer_[at(2 * copy)] + is_integer_[at(2 * copy + 1)];
                    if (count > best_count) {
                        best = copy;
                        best_count = count;
                    }
                }
                for (const HalfedgeHandle h : mesh_.fh_range(queue[i])) {
                    const FaceHandle across = mesh_.opposite_face_handle(h);
                    if (!across.is_valid() || is_seen[at(across.idx())]) continue;
                    is_seen[at(across.idx())] = 1;
                    queue.push_back(across);
                }
            }
            elimination.add({{2 * best, 1}});
            elimination.add({{2 * best + 1, 1}});
        }
    }

    void align(IntegerElimination& elimination) {
        const auto equal = [&](HalfedgeHandle h, double weight) {
            const int coordinate = coordinate_across(h);
            const auto copies = copies_of(h);
            const int a = 2 * copies[0] + coordinate, b = 2 * copies[1] + coordinate;
            if (weight > 0)
                problem_.soft.push_back({a, b, weight});
            else
                elimination.add({{a, 1}, {b, -1}});
        };
        for (const EdgeHandle edge : mesh_.edges()) {
            if (is_hard(edge)) {
                equal(inner_halfedge(edge), 0);
            } else if (!guidance_.soft_weight.empty()) {
                const double weight = guidance_.soft_weight[at(edge.idx())];
                if (weight > 0) equal(inner_halfedge(edge), weight);
            }
        }
    }

    void join_seams(IntegerElimination& elimination) {
        int translation = 2 * problem_.cut.copy_count;
        for (const auto& chain : problem_.cut.chains) {
            const int turns = -problem_.cut.turns[at(chain.front().idx())];
            for (std::size_t i = 0; i <= chain.size(); ++i) {
                const bool is_last = i == chain.size();
                const HalfedgeHandle h = is_last ? chain.back() : chain[i];
                const auto here = copies_of(h);
                const auto there = copies_of(mesh_.opposite_halfedge_handle(h));
                join(elimination, here[is_last ? 1 : 0], there[is_last ? 0 : 1], turns,
                     translation);
            }
            translation += 2;
        }
    }
    /// There = turned(here) + translation.
    static void join(IntegerElimination& elimination, int here, int there, int turns,
                     int translation) {
        const Vec2 x = turned({1, 0}, turns), y = turned({0, 1}, turns);
        for (int i = 0; i < 2; ++i) {
            std::vector<IntegerElimination::Term> terms{{2 * there + i, 1}, {translation + i, -1}};
            if (x[i] != 0) terms.push_back({2 * here, -x[i]});
            if (y[i] != 0) terms.push_back({2 * here + 1, -y[i]});
            elimination.add(terms);
        }
    }

    const Mesh& mesh_;
    const CrossField& field_;
    const MapGuidance& guidance_;
    MapProblem problem_;
    std::vector<bool> is_integer_;
};

}  // namespace

MapProblem make_map_problem(const Mesh& mesh, const CrossField& field,
                            const MapGuidance& guidance) {
    return ProblemBuilder(mesh, field, guidance).take();
}

CornerMap corner_map(const MapProblem& problem, const Eigen::VectorXd& values) {
    CornerMap map;
    map.uv.resize(problem.cut.copies.size());
    for (std::size_t f = 0; f < map.uv.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            const int copy = problem.cut.copies[f][i];
            map.uv[f][i] = {values[2 * copy], values[2 * copy + 1]};
        }
    return map;
}

}  // namespace fcn
