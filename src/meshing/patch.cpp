// Local improvement of angles (after Freitag, Ollivier-Gooch 1997, on a surface): within a patch,
// edges are flipped and vertices moved while the sum of penalties falls. A move is a pattern
// search in the tangent plane; only where it ends is projected and checked. The penalty is steep,
// so that one bad angle weighs more than many fair ones.
#include "meshing/patch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kAim = 0.59;                         ///< radians (34 degrees)
constexpr double kAimCosine = 0.83094;                ///< its cosine
constexpr double kFirstStep = 0.2, kLastStep = 0.01;  ///< of a move, in targets
constexpr int kRounds = 4;

/// arccos near 1, with an error below 1e-7 where the cosine is above kAimCosine: a series of the
/// arcsine of the half angle's sine, since this is asked for most of the time.
double small_angle(double cosine) {
    const double square = 0.5 * (1 - cosine);
    const double series =
        1 + square * (1. / 6 + square * (3. / 40 + square * (15. / 336 + square * 105. / 3456)));
    return 2 * std::sqrt(square) * series;
}

}  // namespace

double angle_penalty(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double cosine = cosine_of_smallest_angle(a, b, c);
    if (cosine <= kAimCosine) return 0;
    const double lack = 1 - small_angle(cosine) / kAim;
    return lack * lack * (1 + 20 * lack * lack);
}

Patch::Patch(WorkingMesh& mesh, const ReferenceSurface& reference, const EdgeTarget& target)
    : mesh_(mesh), reference_(reference), target_(target) {}

void Patch::gather(int face) {
    ++stamp_;
    stamps_.resize(static_cast<std::size_t>(mesh_.face_end()), 0);
    faces_.clear();
    movable_.clear();
    for (const int corner : mesh_.corners(face))
        mesh_.visit_neighbors(corner, [&](int v) {
            movable_.push_back(v);
            return true;
        });
    std::sort(movable_.begin(), movable_.end());
    movable_.erase(std::unique(movable_.begin(), movable_.end()), movable_.end());
    for (const int v : movable_)
        mesh_.visit_star(v, [&](int h) {
            int& stamp = stamps_[static_cast<std::size_t>(WorkingMesh::face(h))];
            if (stamp != stamp_) faces_.push_back(WorkingMesh::face(h));
            stamp = stamp_;
            return true;
        });
    first_new_face_ = mesh_.face_end();
    first_new_vertex_ = mesh_.vertex_end();
}

bool Patch::is_inside(int face) const {
    return face >= first_new_face_ || stamps_[static_cast<std::size_t>(face)] == stamp_;
}

std::vector<int> Patch::faces() const {
    std::vector<int> result;
    for (const int f : faces_)
        if (mesh_.is_face_alive(f)) result.push_back(f);
    for (int f = first_new_face_; f < mesh_.face_end(); ++f)
        if (mesh_.is_face_alive(f)) result.push_back(f);
    return result;
}

double Patch::penalty() const {
    double sum = 0;
    for (const int f : faces()) {
        const auto [a, b, c] = mesh_.corners(f);
        sum += angle_penalty(mesh_.point(a), mesh_.point(b), mesh_.point(c));
    }
    return sum;
}

double Patch::deviation() const {
    double worst = 0;
    for (const int f : faces()) {
        const auto [ia, ib, ic] = mesh_.corners(f);
        const Vec3 &a = mesh_.point(ia), &b = mesh_.point(ib), &c = mesh_.point(ic);
        const Vec3 normal = triangle_normal(a, b, c);
        const double reach = 2 * target_.at(mesh_, ia);
        for (const Vec3& p : {Vec3((a + b + c) / 3), Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)),
                              Vec3(0.5 * (c + a))}) {
            const ReferencePoint near = reference_.closest(p, normal, reach, mesh_.place(ia));
            worst = std::max(worst, near.face < 0 ? reach : near.distance);
        }
    }
    return worst;
}

void Patch::relax() {
    for (int round = 0; round < kRounds; ++round) {
        const std::size_t flips = flip_edges();
        const std::size_t moves = move_vertices();
        if (flips + moves == 0) return;
    }
}

std::size_t Patch::flip_edges() {
    std::size_t count = 0;
    for (const int f : faces()) {
        for (int h = 3 * f; h < 3 * f + 3; ++h) {
            const int t = mesh_.twin(h);
            if (t < 0 || mesh_.is_marked(h) || !is_inside(WorkingMesh::face(t))) continue;
            const Vec3 &a = mesh_.point(mesh_.from(h)), &b = mesh_.point(mesh_.to(h));
            const Vec3 &c = mesh_.point(mesh_.apex(h)), &d = mesh_.point(mesh_.apex(t));
            const double before = angle_penalty(a, b, c) + angle_penalty(b, a, d);
            if (before <= 0) continue;
            if (angle_penalty(d, c, a) + angle_penalty(c, d, b) >= before * 0.999) continue;
            const Vec3 mean = (triangle_normal(a, b, c) + triangle_normal(b, a, d)).normalized();
            const bool is_flat = triangle_normal(a, b, c).dot(mean) > limits_.flatness &&
                                 triangle_normal(d, c, a).dot(mean) > limits_.flatness &&
                                 triangle_normal(c, d, b).dot(mean) > limits_.flatness;
            if (!is_flat || !mesh_.can_flip(h)) continue;
            mesh_.flip(h);
            ++count;
        }
    }
    return count;
}

std::size_t Patch::move_vertices() {
    std::size_t count = 0;
    for (const int v : movable_)
        if (mesh_.is_vertex_alive(v)) count += move(v);
    for (int v = first_new_vertex_; v < mesh_.vertex_end(); ++v)
        if (mesh_.is_vertex_alive(v)) count += move(v);
    return count;
}

double Patch::star_penalty(int v, const Vec3& p, double enough) const {
    double sum = 0;
    mesh_.visit_star(v, [&](int h) {
        sum += angle_penalty(p, mesh_.point(mesh_.to(h)), mesh_.point(mesh_.apex(h)));
        return sum < enough;
    });
    return sum;
}

bool Patch::turns_faces(int v, const Vec3& p) const {
    return !mesh_.visit_star(v, [&](int h) {
        const Vec3 &b = mesh_.point(mesh_.to(h)), &c = mesh_.point(mesh_.apex(h));
        return triangle_normal(p, b, c).dot(triangle_normal(mesh_.point(v), b, c)) >=
               limits_.max_turn;
    });
}

bool Patch::move(int v) {
    if (!mesh_.is_free(v)) return false;
    const Vec3 start = mesh_.point(v);
    const double before = star_penalty(v, start);
    if (before <= 1e-9) return false;
    Vec3 normal = Vec3::Zero();
    mesh_.visit_star(v, [&](int h) {
        const Vec3 &b = mesh_.point(mesh_.to(h)), &c = mesh_.point(mesh_.apex(h));
        normal += (b - start).cross(c - start);
        return true;
    });
    if (!(normal.norm() > 0)) return false;
    normal.normalize();
    int axis = 0;
    normal.cwiseAbs().minCoeff(&axis);
    const Vec3 u = normal.cross(Vec3::Unit(axis)).normalized();
    const Vec3 w = normal.cross(u);
    const double length = target_.at(mesh_, v);
    double best = before;
    Vec3 place = start;
    for (double step = kFirstStep * length; step > kLastStep * length && best > 0;) {
        const Vec3 center = place;
        bool is_better = false;
        for (const auto& [x, y] : std::array<std::array<double, 2>, 6>{
                 {{1, 0}, {0.5, 0.866}, {-0.5, 0.866}, {-1, 0}, {-0.5, -0.866}, {0.5, -0.866}}}) {
            const Vec3 p = center + step * (x * u + y * w);
            const double penalty = star_penalty(v, p, best * 0.999);
            if (penalty >= best * 0.999 || turns_faces(v, p)) continue;
            best = penalty;
            place = p;
            is_better = true;
        }
        if (!is_better) step *= 0.4;
    }
    if (best >= before) return false;
    const ReferencePoint there = reference_.closest(place, normal, 2 * length, mesh_.place(v));
    if (there.face < 0 || star_penalty(v, there.position, before * 0.98) >= before * 0.98 ||
        turns_faces(v, there.position))
        return false;
    mesh_.set_point(v, there.position);
    mesh_.set_place(v, there.face);
    return true;
}

}  // namespace fcn
