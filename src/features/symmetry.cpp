// Symmetries of a surface after Mitra, Guibas, Pauly (2006): pairs of places vote for isometries
// (symmetry_votes), good votes are refined by iterated closest points with trimming, and what maps
// enough of the surface onto itself is accepted. Instead of clustering the votes by mean shift,
// each is tested at once against a few points of the surface: a wrong vote misses it at nearly all
// of them, so the test costs a handful of queries, and a symmetry that few pairs support is found
// as surely as one that many do. Votes are taken best first; what is near an accepted symmetry, or
// on the slope below it, is passed over.

#include "features/symmetry.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <set>

#include "features/mesh_arrays.h"
#include "features/symmetry_votes.h"
#include "geometry/surface_queries.h"

namespace fcn {

namespace {

constexpr double kRelativeTolerance = 0.005;  // of the diagonal
constexpr double kCurvatureRadius = 0.02;     // of the diagonal
constexpr double kNormalCosine = 0.866;       // 30 degrees: noise turns normals
constexpr int kTestPoints = 128;
constexpr int kFitPoints = 384;
constexpr int kProofPoints = 2048;
constexpr int kRefinements = 12;
constexpr int kMostTrials = 2000;    // refinements
constexpr double kSlopeReach = 0.5;  // of the diagonal
constexpr int kSlopePeaks = 4;       // the nearest

struct SurfaceSample {
    Vec3 point, normal;
};

/// Points spread evenly by area: one in each of `count` strata of the running sum of areas.
std::vector<SurfaceSample> spread_samples(const MeshArrays& arrays, int count, std::uint64_t seed) {
    std::vector<double> sums(1, 0.0);
    for (const double area : arrays.areas) sums.push_back(sums.back() + area);
    std::vector<SurfaceSample> samples;
    if (!(sums.back() > 0)) return samples;
    std::mt19937_64 random(seed);
    const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    for (int k = 0; k < count; ++k) {
        const double goal = sums.back() * (k + unit()) / count;
        const auto next = std::ranges::upper_bound(sums, goal);
        const int face = static_cast<int>(
            std::clamp<std::ptrdiff_t>(next - sums.begin() - 1, 0, arrays.face_count() - 1));
        const double s = std::sqrt(unit());
        const double t = unit();
        const auto& corners = arrays.face_vertices[face];
        samples.push_back({(1 - s) * arrays.points[corners[0]] +
                               s * (1 - t) * arrays.points[corners[1]] +
                               s * t * arrays.points[corners[2]],
                           arrays.normals[face]});
    }
    // Neighbouring strata are neighbouring faces; tests that stop early want them mixed.
    for (int k = 0; k + 1 < count; ++k)
        std::swap(samples[k], samples[k + random() % static_cast<std::uint64_t>(count - k)]);
    return samples;
}

class SymmetryFinder {
public:
    SymmetryFinder(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                   const SymmetryOptions& options)
        : mesh_(mesh),
          network_(network),
          options_(options),
          arrays_(mesh_arrays(mesh.mesh, options.threads)),
          queries_(mesh.mesh) {
        const BoundingBox box = bounding_box(mesh.mesh);
        diagonal_ = box.diagonal();
        center_ = (box.min + box.max) / 2;
        tolerance_ = options.tolerance > 0 ? options.tolerance : kRelativeTolerance * diagonal_;
        samples_ = spread_samples(arrays_, kProofPoints, options.seed);
    }

    std::vector<SurfaceSymmetry> find() {
        if (samples_.empty()) return {};
        std::vector<Isometry> votes =
            pure(votes_of_arcs(arrays_, network_, 2 * tolerance_, options_.seed));
        const std::vector<Isometry> more = pure(votes_of_curvature(
            mesh_.mesh, arrays_, kCurvatureRadius * diagonal_, options_.seed, options_.threads));
        votes.insert(votes.end(), more.begin(), more.end());
        accept(passed(without_repeats(std::move(votes))));
        return std::move(accepted_);
    }

private:
    std::optional<SymmetryKind> kind_of_map(const Isometry& map) const {
        return kind_of(map, center_, diagonal_ / 2, 6 * tolerance_);
    }

    /// Votes that are near one of the three kinds and far from the identity.
    std::vector<Isometry> pure(std::vector<Isometry> votes) const {
        std::erase_if(votes, [&](const Isometry& map) { return !kind_of_map(map).has_value(); });
        return votes;
    }

    /// One vote of each cell of a grid over the images of four points.
    std::vector<Isometry> without_repeats(std::vector<Isometry> votes) const {
        std::set<std::array<std::int64_t, 12>> cells;
        std::erase_if(votes, [&](const Isometry& map) {
            std::array<std::int64_t, 12> cell{};
            for (int k = 0; k < 4; ++k) {
                const Vec3 corner =
                    k == 0 ? center_ : Vec3(center_ + diagonal_ / 2 * Vec3::Unit(k - 1));
                const Vec3 image = map(corner) / (2 * tolerance_);
                for (int i = 0; i < 3; ++i) cell[3 * k + i] = std::llround(image[i]);
            }
            return !cells.insert(cell).second;
        });
        return votes;
    }

    bool is_on_surface(const Isometry& map, const SurfaceSample& sample, double tolerance,
                       ClosestPoint& closest) const {
        const auto found = queries_.closest_within(map(sample.point), tolerance);
        if (!found) return false;
        closest = *found;
        // An improper isometry turns the surface inside out; its normals go along as vectors.
        return (map.linear * sample.normal).dot(arrays_.normals[closest.surface.face]) >=
               kNormalCosine;
    }

    /// Share of the first test points that land on the surface; 0 as soon as that is hopeless.
    double quick_score(const Isometry& map) const {
        int hits = 0;
        ClosestPoint closest;
        for (int k = 0; k < kTestPoints; ++k) {
            hits += is_on_surface(map, samples_[k], 4 * tolerance_, closest) ? 1 : 0;
            const double expected = 0.8 * options_.min_coverage * (k + 1);
            if (hits < expected - 1.5 * std::sqrt(k + 1.0)) return 0;
        }
        const double score = static_cast<double>(hits) / kTestPoints;
        return score >= 0.8 * options_.min_coverage ? score : 0;
    }

    /// The votes that pass, best first.
    std::vector<Isometry> passed(const std::vector<Isometry>& votes) const {
        std::vector<double> scores(votes.size(), 0.0);
        in_parallel(votes.size(), [&](std::size_t v) { scores[v] = quick_score(votes[v]); });
        std::vector<int> order;
        for (std::size_t v = 0; v < votes.size(); ++v)
            if (scores[v] > 0) order.push_back(static_cast<int>(v));
        std::ranges::stable_sort(order, std::greater<>{}, [&](int v) { return scores[v]; });
        std::vector<Isometry> result;
        for (const int v : order) result.push_back(votes[v]);
        return result;
    }

    template <class Body>
    void in_parallel(std::size_t count, const Body& body) const {
        tbb::task_arena arena(options_.threads > 0 ? options_.threads : tbb::task_arena::automatic);
        arena.execute([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 16),
                              [&](const tbb::blocked_range<std::size_t>& range) {
                                  for (std::size_t k = range.begin(); k < range.end(); ++k) body(k);
                              });
        });
    }

    /// Where the first `count` samples land; distance < 0 = not on the surface.
    std::vector<ClosestPoint> landings(const Isometry& map, int count, double reach) const {
        std::vector<ClosestPoint> result(static_cast<std::size_t>(count));
        in_parallel(result.size(), [&](std::size_t k) {
            if (!is_on_surface(map, samples_[k], reach, result[k])) result[k].distance = -1;
        });
        return result;
    }

    SurfaceSymmetry measured(const Isometry& map, SymmetryKind kind, int count) const {
        SurfaceSymmetry symmetry{kind, map, 0, 0};
        int hits = 0;
        double sum = 0;
        for (const ClosestPoint& landing : landings(map, count, tolerance_)) {
            if (landing.distance < 0) continue;
            ++hits;
            sum += landing.distance * landing.distance;
        }
        symmetry.coverage = static_cast<double>(hits) / count;
        symmetry.error = hits > 0 ? std::sqrt(sum / hits) : 0;
        return symmetry;
    }

    /// Iterated closest points over the samples that land on the surface, with a shrinking reach.
    Isometry refined(Isometry map, SymmetryKind kind) const {
        for (int round = 0; round < kRefinements; ++round) {
            const double reach = tolerance_ * std::max(1.0, 4.0 - round / 2.0);
            const std::vector<ClosestPoint> to_points = landings(map, kFitPoints, reach);
            std::vector<Vec3> from, to;
            for (int k = 0; k < kFitPoints; ++k) {
                if (to_points[k].distance < 0) continue;
                from.push_back(samples_[k].point);
                to.push_back(to_points[k].position);
            }
            if (from.size() < 3) break;
            const Isometry next = fit_symmetry(kind, from, to);
            const bool is_settled = is_near(next, map, 1e-3 * tolerance_);
            map = next;
            if (is_settled) break;
        }
        return map;
    }

    bool is_near(const Isometry& a, const Isometry& b, double distance) const {
        return displacement_between(a, b, center_, diagonal_ / 2) <= distance;
    }

    bool is_known(const Isometry& map) const {
        return std::ranges::any_of(accepted_, [&](const SurfaceSymmetry& other) {
            return is_near(other.map, map, 4 * tolerance_);
        });
    }

    /// Does coverage grow when the map moves towards a symmetry that is known already? Surfaces
    /// glide along their flat and round parts, so most of the surroundings of a symmetry cover
    /// much of the surface; a symmetry of its own is a peak.
    bool is_slope(const Isometry& map, int count) const {
        const double here = measured(map, SymmetryKind::Rotation, count).coverage;
        std::vector<std::pair<double, Isometry>> peaks;
        const auto add_peak = [&](const Isometry& peak) {
            const double distance = displacement_between(peak, map, center_, diagonal_ / 2);
            if (peak.is_improper() == map.is_improper() && distance <= kSlopeReach * diagonal_)
                peaks.emplace_back(distance, peak);
        };
        add_peak({});
        for (const SurfaceSymmetry& other : accepted_) add_peak(other.map);
        const std::size_t near_count = std::min<std::size_t>(peaks.size(), kSlopePeaks);
        std::ranges::partial_sort(peaks, peaks.begin() + static_cast<std::ptrdiff_t>(near_count),
                                  {}, [](const auto& peak) { return peak.first; });
        peaks.resize(near_count);
        return std::ranges::any_of(peaks, [&](const auto& peak) {
            const Isometry motion = peak.second.after(map.inverse());
            const double share = std::min(1.0, 6 * tolerance_ / peak.first);
            const Isometry moved = part_of_motion(motion, share).after(map);
            return measured(moved, SymmetryKind::Rotation, count).coverage > here;
        });
    }

    void accept(const std::vector<Isometry>& candidates) {
        int tried = 0;
        for (const Isometry& candidate : candidates) {
            if (static_cast<int>(accepted_.size()) >= options_.max_count) break;
            if (is_known(candidate) || is_slope(candidate, kTestPoints)) continue;
            if (++tried > kMostTrials) break;
            const SymmetryKind kind = *kind_of_map(candidate);
            const SurfaceSymmetry found =
                measured(refined(candidate, kind), kind, static_cast<int>(samples_.size()));
            if (found.coverage < options_.min_coverage || !kind_of_map(found.map) ||
                is_known(found.map) || is_slope(found.map, kFitPoints)) {
                continue;
            }
            accepted_.push_back(found);
        }
        std::ranges::stable_sort(accepted_, std::greater<>{}, &SurfaceSymmetry::coverage);
    }

    const LoadedMesh& mesh_;
    const FeatureCurveNetwork& network_;
    const SymmetryOptions& options_;
    MeshArrays arrays_;
    SurfaceQueries queries_;
    double diagonal_ = 0;
    double tolerance_ = 0;
    Vec3 center_ = Vec3::Zero();
    std::vector<SurfaceSample> samples_;
    std::vector<SurfaceSymmetry> accepted_;
};

}  // namespace

std::vector<SurfaceSymmetry> find_symmetries(const LoadedMesh& mesh,
                                             const FeatureCurveNetwork& network,
                                             const SymmetryOptions& options) {
    if (mesh.mesh.n_faces() == 0) return {};
    return SymmetryFinder(mesh, network, options).find();
}

std::vector<SurfaceSymmetry> add_symmetry_orbits(FeatureCurveNetwork& network,
                                                 const LoadedMesh& mesh,
                                                 const SymmetryOptions& options) {
    std::vector<SurfaceSymmetry> symmetries = find_symmetries(mesh, network, options);
    const double tolerance = options.tolerance > 0
                                 ? options.tolerance
                                 : kRelativeTolerance * bounding_box(mesh.mesh).diagonal();
    network.orbits = symmetry_orbits(network, symmetries, 2 * tolerance);
    return symmetries;
}

}  // namespace fcn
