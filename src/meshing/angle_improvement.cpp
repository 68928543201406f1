// The last few percent of bad triangles. Incremental remeshing evens out lengths and valences and
// so improves angles on the average; beside fixed edges it leaves the odd needle that no single
// change mends. So trials are compound (the idea of Hu et al. 2017, "Error-bounded and feature
// preserving surface remeshing with minimal angle improvement", one step further): collapse, flip
// or split an edge at the bad triangle or at its neighbours, relax the patch around it by flips and
// moves, then compare the patch as a whole. A journal takes back what did not pay, so that a trial
// costs what it touches. The patch's distance from the reference may not grow beyond a small share
// of the edge length, a face that looks away from the surface there counts as far from it, and no
// triangles may come to cross; the limits loosen in stages, for what is left.
#include "meshing/angle_improvement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "meshing/crossing_guard.h"
#include "meshing/forced_angles.h"
#include "meshing/patch.h"
#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kLeastGain = 0.02;  ///< share of the bad triangle's own penalty
constexpr double kNoNormal = 0.02;   ///< of a face's flatness, below which it has none
constexpr double kLongest = 1.6;     ///< in targets: a collapse makes no longer edge
constexpr double kGrowth = 1.02;     ///< of a deviation that is larger already
constexpr std::size_t kMostChecked = 4;

/// What bad triangles are left may cost more shape: those beside creases that no network keeps.
constexpr std::array<PatchLimits, 4> kStages{
    {{0.8, 0.9, 0.04}, {0.5, 0.65, 0.1}, {0.1, 0.4, 0.25}, {-0.2, 0.1, 0.5}}};

struct Trial {
    enum class Kind { Relax, Flip, Split, Collapse } kind = Kind::Relax;
    int halfedge = -1;
    int vanishing = -1;
};

class Improver {
public:
    Improver(WorkingMesh& mesh, const ReferenceSurface& reference, const EdgeTarget& target,
             const AngleOptions& options)
        : mesh_(mesh),
          reference_(reference),
          target_(target),
          options_(options),
          bad_cosine_(std::cos(options.good_angle)),
          patch_(mesh, reference, target),
          guard_(mesh, target.length) {}

    AngleStatistics run() {
        AngleStatistics statistics;
        statistics.bad_before = bad_faces().size();
        for (const PatchLimits& limits : kStages) {
            limits_ = limits;
            patch_.set_limits(limits);
            tried_.clear();
            for (int round = 0; round < options_.max_rounds; ++round) {
                std::size_t count = 0;
                for (const auto& [cosine, face] : bad_faces())
                    if (mesh_.is_face_alive(face) && cosine_of(face) > bad_cosine_)
                        count += mend_if_new(face);
                statistics.improvements += count;
                if (count == 0) break;
            }
        }
        statistics.bad_after = bad_faces().size();
        return statistics;
    }

private:
    double cosine_of(int face) const {
        const auto [a, b, c] = mesh_.corners(face);
        return cosine_of_smallest_angle(mesh_.point(a), mesh_.point(b), mesh_.point(c));
    }

    bool has_cut(int face) const {
        const auto corners = mesh_.corners(face);
        return std::any_of(corners.begin(), corners.end(), [&](int v) { return mesh_.is_cut(v); });
    }

    /// Worst first.
    std::vector<std::pair<double, int>> bad_faces() const {
        std::vector<std::pair<double, int>> bad;
        for (int f = 0; f < mesh_.face_end(); ++f) {
            if (!mesh_.is_face_alive(f) || mesh_.is_face_resting(f)) continue;
            const double cosine = cosine_of(f);
            if (cosine > bad_cosine_ && (has_cut(f) || !is_between_curves(mesh_, f)))
                bad.emplace_back(-cosine, f);
        }
        std::sort(bad.begin(), bad.end());
        return bad;
    }

    /// A patch that nothing could be done for is not tried again before it has changed.
    bool mend_if_new(int face) {
        patch_.gather(face);
        const auto end = static_cast<std::size_t>(mesh_.face_end());
        changed_.resize(end, 0);
        tried_.resize(end, -1);
        int last_change = 0;
        for (const int f : patch_.faces())
            last_change = std::max(last_change, changed_[static_cast<std::size_t>(f)]);
        int& tried = tried_[static_cast<std::size_t>(face)];
        if (tried >= last_change) return false;
        tried = clock_;
        if (!mend(face)) return false;
        ++clock_;
        changed_.resize(static_cast<std::size_t>(mesh_.face_end()), 0);
        for (const int f : patch_.faces()) changed_[static_cast<std::size_t>(f)] = clock_;
        return true;
    }

    bool mend(int face) {
        const double before = patch_.penalty();
        const auto [a, b, c] = mesh_.corners(face);
        const double own = angle_penalty(mesh_.point(a), mesh_.point(b), mesh_.point(c));
        const double enough = before - kLeastGain * own;
        const std::vector<Trial> trials = trials_at(face);
        std::vector<std::pair<double, std::size_t>> promising;
        for (std::size_t i = 0; i < trials.size(); ++i) {
            const auto checkpoint = mesh_.start_recording();
            double after = enough;
            if (apply(trials[i])) {
                patch_.relax();
                after = patch_.penalty();
            }
            mesh_.undo(checkpoint);
            if (after < enough) promising.emplace_back(after, i);
            if (after <= 0) break;
        }
        if (promising.empty()) return false;
        std::sort(promising.begin(), promising.end());
        const double was = patch_.deviation();
        const std::size_t crossings = guard_.crossings(patch_.faces());
        const double allowed = std::max(limits_.deviation * target_.at(mesh_, a), kGrowth * was);
        for (std::size_t k = 0; k < std::min(promising.size(), kMostChecked); ++k) {
            const auto checkpoint = mesh_.start_recording();
            apply(trials[promising[k].second]);
            patch_.relax();
            if (patch_.deviation() <= allowed && crossings_after() <= crossings) {
                mesh_.forget();
                return true;
            }
            mesh_.undo(checkpoint);
        }
        return false;
    }

    std::size_t crossings_after() {
        const std::vector<int> faces = patch_.faces();
        for (const int f : faces) guard_.update_face(f);
        return guard_.crossings(faces);
    }

    std::vector<Trial> trials_at(int face) const {
        std::vector<Trial> trials{{Trial::Kind::Relax, -1, -1}};
        std::vector<int> edges;
        for (int h = 3 * face; h < 3 * face + 3; ++h) edges.push_back(h);
        for (const int h : edges) {
            trials.push_back({Trial::Kind::Collapse, h, mesh_.from(h)});
            trials.push_back({Trial::Kind::Collapse, h, mesh_.to(h)});
        }
        for (const int h : edges) trials.push_back({Trial::Kind::Flip, h, -1});
        for (const int h : edges) trials.push_back({Trial::Kind::Split, h, -1});
        for (const int h : edges) {
            const int t = mesh_.twin(h);
            if (t < 0) continue;
            for (const int side : {WorkingMesh::next(t), WorkingMesh::prev(t)}) {
                trials.push_back({Trial::Kind::Split, side, -1});
                trials.push_back({Trial::Kind::Collapse, side, mesh_.from(side)});
                trials.push_back({Trial::Kind::Collapse, side, mesh_.to(side)});
            }
        }
        return trials;
    }

    bool apply(const Trial& trial) {
        const int h = trial.halfedge;
        switch (trial.kind) {
            case Trial::Kind::Relax:
                return true;
            case Trial::Kind::Flip:
                if (!is_flat(h) || !mesh_.can_flip(h)) return false;
                mesh_.flip(h);
                return true;
            case Trial::Kind::Split:
                if (mesh_.is_marked(h)) return false;
                return split(h);
            case Trial::Kind::Collapse:
                if (!may_vanish(h, trial.vanishing) || !keeps_faces(h, trial.vanishing) ||
                    !mesh_.can_collapse(h, trial.vanishing))
                    return false;
                mesh_.collapse(h, trial.vanishing);
                return true;
        }
        return false;
    }

    /// Cuts may be taken back along their curve.
    bool may_vanish(int h, int v) const {
        return mesh_.is_free(v) || (mesh_.is_cut(v) && mesh_.is_marked(h));
    }

    bool split(int h) {
        const Vec3 middle = 0.5 * (mesh_.point(mesh_.from(h)) + mesh_.point(mesh_.to(h)));
        Vec3 normal = Vec3::Zero();
        for (const int side : {h, mesh_.twin(h)})
            if (side >= 0)
                normal +=
                    triangle_normal(mesh_.point(mesh_.from(side)), mesh_.point(mesh_.to(side)),
                                    mesh_.point(mesh_.apex(side)));
        const ReferencePoint there = reference_.closest(
            middle, normal.normalized(), 0.3 * target_.length, mesh_.place(mesh_.from(h)));
        if (there.face < 0) return false;
        const int v = mesh_.split(h, middle);
        const bool keeps = mesh_.visit_star(v, [&](int out) {
            const Vec3 &b = mesh_.point(mesh_.to(out)), &c = mesh_.point(mesh_.apex(out));
            return triangle_normal(middle, b, c).dot(triangle_normal(there.position, b, c)) >=
                   limits_.max_turn;
        });
        mesh_.set_point(v, there.position);
        mesh_.set_place(v, there.face);
        return keeps;
    }

    /// Whether the faces that a flip would make look where a normal points.
    bool is_along(const Vec3& normal, const Vec3& d, const Vec3& c, const Vec3& a,
                  const Vec3& b) const {
        return triangle_normal(d, c, a).dot(normal) > limits_.flatness &&
               triangle_normal(c, d, b).dot(normal) > limits_.flatness;
    }

    bool is_flat(int h) const {
        const int t = mesh_.twin(h);
        if (t < 0 || mesh_.is_marked(h)) return false;
        const Vec3 &a = mesh_.point(mesh_.from(h)), &b = mesh_.point(mesh_.to(h));
        const Vec3 &c = mesh_.point(mesh_.apex(h)), &d = mesh_.point(mesh_.apex(t));
        if (flatness_quality(a, b, c) < kNoNormal)
            return is_along(triangle_normal(b, a, d), d, c, a, b);
        const Vec3 sum = triangle_normal(a, b, c) + triangle_normal(b, a, d);
        const double least = 0.8 * limits_.flatness * sum.norm();
        return sum.norm() > 1.8 * limits_.flatness && triangle_normal(d, c, a).dot(sum) > least &&
               triangle_normal(c, d, b).dot(sum) > least;
    }

    bool keeps_faces(int h, int vanishing) const {
        const int staying = mesh_.from(h) == vanishing ? mesh_.to(h) : mesh_.from(h);
        const Vec3& there = mesh_.point(staying);
        const double longest = kLongest * target_.at(mesh_, staying);
        return mesh_.visit_star(vanishing, [&](int out) {
            const int b = mesh_.to(out), c = mesh_.apex(out);
            if (b == staying || c == staying) return true;
            const Vec3 &pb = mesh_.point(b), &pc = mesh_.point(c);
            if ((pb - there).norm() > longest || (pc - there).norm() > longest) return false;
            return triangle_normal(there, pb, pc)
                       .dot(triangle_normal(mesh_.point(vanishing), pb, pc)) >= limits_.max_turn;
        });
    }

    WorkingMesh& mesh_;
    const ReferenceSurface& reference_;
    const EdgeTarget& target_;
    AngleOptions options_;
    double bad_cosine_;
    PatchLimits limits_;
    Patch patch_;
    CrossingGuard guard_;
    std::vector<int> changed_, tried_;  ///< per face: when its patch changed, and was tried, last
    int clock_ = 0;                     ///< changes so far
};

}  // namespace

AngleStatistics improve_angles(WorkingMesh& mesh, const ReferenceSurface& reference,
                               const EdgeTarget& target, const AngleOptions& options) {
    mesh.set_cuts_fixed(false);
    const AngleStatistics statistics = Improver(mesh, reference, target, options).run();
    mesh.set_cuts_fixed(true);
    return statistics;
}

}  // namespace fcn
