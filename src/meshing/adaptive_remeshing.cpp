// Incremental remeshing knows one edge length, and some surfaces do not fit it: horns and fins
// vanish when they are coarsened, since no step asks whether the surface is covered; walls thinner
// than an edge's sagitta cross. Where is hard to foretell and easy to see afterwards, so the whole
// is done, its faults are found, and it is done again from a mesh four times as fine as the target,
// in which the tips of what was lost are fixed (with them the rest of a protrusion stays) and edges
// around the other faults are asked to be shorter. A few attempts mend most; the best goes on to
// local repair, which alone is enough for small faults. Large meshes have one attempt: their faults
// are few and small.
#include "meshing/adaptive_remeshing.h"

#include <algorithm>
#include <chrono>

namespace fcn {
namespace {

constexpr int kMaxAttempts = 4;
constexpr int kManyFaces = 300000;     ///< from which on there is one attempt
constexpr double kLost = 0.6;          ///< in targets: what is less far repair brings back
constexpr double kShrink = 0.7;        ///< of the edge length around a fault, an attempt
constexpr double kLeast = 0.15;        ///< in targets: edges are not asked to be shorter
constexpr double kSame = 0.99;         ///< in targets: sources of more ask for nothing
constexpr double kApart = 0.6;         ///< in targets: distance of fixed tips from curves
constexpr double kFittingScale = 0.6;  ///< in targets: least rmin of a network that fits
constexpr double kTipTolerance = 0.3;  ///< in targets: distance of a tip's vertex from its sample

/// Whether the network was adapted to about this edge length.
bool fits(const FeatureCurveNetwork& network, double edge_length) {
    return network.is_adapted() && network.scale > kFittingScale * edge_length;
}

class AdaptiveRemesher {
public:
    AdaptiveRemesher(WorkingMesh& mesh, const ReferenceSurface& reference, const Mesh& input,
                     const FeatureCurveNetwork& network, EdgeTarget& target,
                     const IncrementalOptions& options)
        : mesh_(mesh),
          reference_(reference),
          network_(network),
          target_(target),
          options_(options),
          finder_(input, target.length, fits(network, target.length)) {
        if (target_.sources.is_empty()) target_.sources = SizeSources(target.length);
        target_.curve_sources = SizeSources(target.length);
    }

    AdaptiveStatistics run() {
        AdaptiveStatistics statistics;
        coarsen_early(mesh_, target_, reference_);
        const WorkingMesh start = mesh_;
        const int limit = start.face_end() < kManyFaces ? kMaxAttempts : 1;
        WorkingMesh best = start;
        EdgeTarget best_target = target_;
        SurfaceFaults best_faults;
        for (int attempt = 0; attempt < limit; ++attempt) {
            if (attempt > 0) mesh_ = start;
            fix_tips();
            const IncrementalStatistics one =
                remesh_incrementally(mesh_, reference_, target_, options_);
            const SurfaceFaults faults = finder_.find(mesh_, target_);
            ++statistics.attempts;
            add_seconds(statistics.incremental, one);
            if (attempt == 0 || faults.severity < best_faults.severity) {
                best = mesh_;
                best_target = target_;
                best_faults = faults;
                statistics.incremental.angles = one.angles;
            }
            if (!is_worth_an_attempt(faults)) break;
            learn(faults);
        }
        mesh_ = std::move(best);
        target_ = std::move(best_target);
        const auto from = std::chrono::steady_clock::now();
        statistics.repair.sources = target_.sources.sources().size();
        if (best_faults.severity > 0)
            statistics.repair =
                repair_locally(mesh_, reference_, finder_, network_, target_, best_faults);
        statistics.crossings = best_faults.crossings.size();
        for (std::size_t i = 0; i < statistics.repair.sources; ++i)
            if (target_.sources.sources()[i].size < kSame * target_.length)
                statistics.refined.push_back(target_.sources.sources()[i]);
        statistics.repairing =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
        return statistics;
    }

private:
    bool is_worth_an_attempt(const SurfaceFaults& faults) const {
        return !faults.crossings.empty() ||
               (!faults.far.empty() && faults.far[0].distance > kLost * target_.length);
    }

    static void add_seconds(IncrementalStatistics& sum, const IncrementalStatistics& one) {
        sum.coarsening += one.coarsening;
        sum.iterating += one.iterating;
        sum.improving += one.improving;
    }

    /// The vertices nearest to the tips, where no curve is too close for good triangles.
    void fix_tips() {
        for (const Vec3& tip : tips_) {
            const double apart = kApart * target_.at(tip);
            double nearest = kTipTolerance * target_.length;
            int best = -1;
            bool is_clear = true;
            for (int v = 0; v < mesh_.vertex_end(); ++v) {
                const double distance = (mesh_.point(v) - tip).norm();
                if (mesh_.is_free(v) && distance < nearest) {
                    nearest = distance;
                    best = v;
                }
                is_clear = is_clear && (mesh_.is_free(v) || distance >= apart);
            }
            if (best >= 0 && is_clear) mesh_.fix(best);
        }
    }

    void learn(const SurfaceFaults& faults) {
        for (const auto& pair : faults.crossings)
            for (const int f : pair) ask(face_center(mesh_, f));
        for (const int f : faults.needles) ask(face_center(mesh_, f));
        for (const FarSample& far : faults.far) {
            const Vec3& p = far.sample.position;
            if (!is_near_tip(p, target_.length)) {
                tips_.push_back(p);
                continue;
            }
            ask(p);
            if (!is_near_tip(p, target_.at(p))) tips_.push_back(p);
        }
        requests_.grant(target_.sources);
    }

    bool is_near_tip(const Vec3& p, double distance) const {
        return std::any_of(tips_.begin(), tips_.end(),
                           [&](const Vec3& tip) { return (tip - p).norm() < distance; });
    }

    void ask(const Vec3& p) {
        const double now = target_.at(p);
        requests_.ask(p, now, std::max(kLeast * target_.length, kShrink * now));
    }

    WorkingMesh& mesh_;
    const ReferenceSurface& reference_;
    const FeatureCurveNetwork& network_;
    EdgeTarget& target_;
    IncrementalOptions options_;
    FaultFinder finder_;
    std::vector<Vec3> tips_;
    SizeRequests requests_;
};

}  // namespace

AdaptiveStatistics remesh_adaptively(WorkingMesh& mesh, const ReferenceSurface& reference,
                                     const Mesh& input, const FeatureCurveNetwork& network,
                                     EdgeTarget target, const IncrementalOptions& options) {
    return AdaptiveRemesher(mesh, reference, input, network, target, options).run();
}

}  // namespace fcn
