// Repair of what a remesh of one edge length cannot do: walls, tips and gaps between features that
// are thinner than that length. Where the mesh has a fault, a source asks for edges two thirds as
// long as now; the mesh around it is remeshed while the rest of it rests. As edges shrink the mesh
// comes nearer to the surface, whose sheets are apart, so crossings end, at last. Features between
// fixed vertices are in the way of that, so from the second round on they are cut where crossings
// and needles touch them. Rounds that make things worse may lead to better ones; the best is kept.
#include "meshing/local_repair.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "meshing/angle_improvement.h"
#include "meshing/crossing_guard.h"
#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kShrink = 0.65;          ///< of an edge length around a fault, a round
constexpr double kLeast = 0.12;           ///< in targets: edges are not asked to be shorter
constexpr double kPinhole = 0.5;          ///< in targets: boundary edges below that are no choice
constexpr double kLeastAtPinhole = 0.03;  ///< in targets, since checks for crossings slow down
constexpr int kIterations = 4;            ///< of remeshing, a round
constexpr int kFirstCut = 1;              ///< round from which features are cut
constexpr double kLeastQuality = 0.15;    ///< of faces at a vertex that is moved to a far sample
constexpr double kLeastAngle = 2;         ///< radians: a sharper tip has no room for good triangles

/// The curves of a network as degenerate triangles.
std::optional<ReferenceSurface> curves_of(const FeatureCurveNetwork& network) {
    std::vector<std::array<Vec3, 3>> pieces;
    for (const NetworkArc& arc : network.arcs)
        for (std::size_t i = 1; i < arc.samples.size(); ++i)
            pieces.push_back(
                {arc.samples[i - 1].position, arc.samples[i].position, arc.samples[i].position});
    if (pieces.empty()) return std::nullopt;
    return ReferenceSurface(pieces);
}

class Repair {
public:
    Repair(WorkingMesh& mesh, const ReferenceSurface& reference, const FaultFinder& finder,
           const FeatureCurveNetwork& network, EdgeTarget& target, SurfaceFaults& faults,
           const RepairOptions& options)
        : mesh_(mesh),
          reference_(reference),
          finder_(finder),
          network_(network),
          target_(target),
          faults_(faults),
          options_(options) {}

    RepairStatistics run() {
        RepairStatistics statistics;
        statistics.sources = target_.sources.sources().size();
        WorkingMesh best = mesh_;
        SurfaceFaults best_faults = faults_;
        std::size_t cuts = 0;
        int idle = 0;
        while (faults_.severity > 0 && statistics.rounds < options_.max_rounds &&
               idle < options_.max_idle_rounds) {
            ask_around_faults(statistics.rounds >= kFirstCut);
            cuts += cut();
            remesh();
            ++statistics.rounds;
            faults_ = finder_.find_near_sources(mesh_, target_, best_faults);
            ++idle;
            if (faults_.severity >= best_faults.severity) continue;
            best = mesh_;
            best_faults = faults_;
            statistics.cuts = cuts;
            statistics.sources = target_.sources.sources().size();
            idle = 0;
        }
        mesh_ = std::move(best);
        faults_ = std::move(best_faults);
        return statistics;
    }

private:
    void ask_around_faults(bool is_cutting) {
        CrossingGuard guard(mesh_, target_.length);
        for (const auto& pair : faults_.crossings)
            for (const int f : pair) ask_at_face(f, is_cutting);
        for (const int f : faults_.needles) ask_at_face(f, is_cutting);
        for (const FarSample& sample : faults_.far)
            if (!anchor(sample, guard)) ask(sample.sample.position);
        requests_.grant(target_.sources);
    }

    void ask_at_face(int f, bool is_cutting) {
        ask(face_center(mesh_, f));
        ask_at_pinhole(f);
        if (!is_cutting) return;
        for (int h = 3 * f; h < 3 * f + 3; ++h) {
            if (mesh_.role(h) != EdgeRole::Feature) continue;
            const double length = (mesh_.point(mesh_.to(h)) - mesh_.point(mesh_.from(h))).norm();
            target_.curve_sources.add(0.5 * (mesh_.point(mesh_.from(h)) + mesh_.point(mesh_.to(h))),
                                      std::max(kLeast * target_.length, 0.5 * length));
        }
    }

    /// Short boundary edges stay, and only edges that grow from there fit them.
    void ask_at_pinhole(int f) {
        for (int h = 3 * f; h < 3 * f + 3; ++h) {
            if (mesh_.twin(h) >= 0) continue;
            const Vec3 &a = mesh_.point(mesh_.from(h)), &b = mesh_.point(mesh_.to(h));
            const double length = (b - a).norm();
            const Vec3 middle = 0.5 * (a + b);
            if (length > 0 && length < kPinhole * target_.at(middle))
                requests_.ask(middle, length, std::max(kLeastAtPinhole * target_.length, length));
        }
    }

    void ask(const Vec3& p) {
        const double now = target_.at(p);
        requests_.ask(p, now, std::max(kLeast * target_.length, kShrink * now));
    }

    /// Moves a free vertex to the sample and fixes it, if the faces around it stay sound.
    bool anchor(const FarSample& far, CrossingGuard& guard) {
        const Vec3& p = far.sample.position;
        if (far.nearest_face < 0) return false;
        double nearest = target_.at(p);
        int best = -1;
        for (const int v : mesh_.corners(far.nearest_face)) {
            const double distance = (mesh_.point(v) - p).norm();
            if (mesh_.is_free(v) && distance < nearest) {
                nearest = distance;
                best = v;
            }
        }
        if (best < 0 || !has_room(best, far.sample) || !guard.allows_move(best, p)) return false;
        mesh_.set_point(best, p);
        mesh_.set_place(best, far.sample.face);
        mesh_.fix(best);
        guard.update_star(best);
        target_.sources.add(p, target_.at(p));
        return true;
    }

    bool has_room(int v, const SurfaceSample& sample) const {
        const Vec3 &p = sample.position, &old = mesh_.point(v);
        double angles = 0;
        const bool is_sound = mesh_.visit_star(v, [&](int h) {
            const Vec3 &b = mesh_.point(mesh_.to(h)), &c = mesh_.point(mesh_.apex(h));
            const Vec3 x = b - p, y = c - p;
            angles += std::atan2(x.cross(y).norm(), x.dot(y));
            const Vec3 normal = triangle_normal(p, b, c);
            if (flatness_quality(p, b, c) < kLeastQuality ||
                normal.dot(triangle_normal(old, b, c)) < 0)
                return false;
            const ReferencePoint there =
                reference_.closest((p + b + c) / 3, Vec3::Zero(), 2 * target_.length, sample.face);
            return there.face >= 0 && reference_.normal(there.face).dot(normal) > 0;
        });
        return is_sound && angles > kLeastAngle;
    }

    std::size_t cut() {
        if (target_.curve_sources.is_empty()) return 0;
        if (!curves_) curves_ = curves_of(network_);
        return curves_ ? cut_features(mesh_, *curves_, target_) : 0;
    }

    void remesh() {
        for (int i = 0; i < kIterations; ++i) {
            rest();
            mark_thin_places(mesh_, reference_, target_.length);
            split_long_edges(mesh_, target_);
            collapse_short_edges(mesh_, target_, kShortestEdge);
            flip_for_valence(mesh_, target_);
            smooth(mesh_, reference_, target_);
            mesh_.compact();
        }
        rest();
        flip_for_angles(mesh_, target_);
        improve_angles(mesh_, reference_, target_);
        mesh_.compact();
        for (int v = 0; v < mesh_.vertex_end(); ++v) mesh_.set_resting(v, false);
    }

    void rest() {
        for (int v = 0; v < mesh_.vertex_end(); ++v)
            if (mesh_.is_vertex_alive(v))
                mesh_.set_resting(v, !target_.sources.is_near(mesh_.point(v)));
    }

    WorkingMesh& mesh_;
    const ReferenceSurface& reference_;
    const FaultFinder& finder_;
    const FeatureCurveNetwork& network_;
    EdgeTarget& target_;
    SurfaceFaults& faults_;
    RepairOptions options_;
    std::optional<ReferenceSurface> curves_;
    SizeRequests requests_;
};

}  // namespace

RepairStatistics repair_locally(WorkingMesh& mesh, const ReferenceSurface& reference,
                                const FaultFinder& finder, const FeatureCurveNetwork& network,
                                EdgeTarget& target, SurfaceFaults& faults,
                                const RepairOptions& options) {
    return Repair(mesh, reference, finder, network, target, faults, options).run();
}

}  // namespace fcn
