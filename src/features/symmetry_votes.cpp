// Who votes for a symmetry. Mitra, Guibas and Pauly (2006) pair points of like principal curvatures
// and let each pair vote for the isometry that takes the one's frame to the other's. We do so too
// (votes_of_curvature), away from umbilics, where the frame is defined. But a mechanical part has
// curvature only along its creases, and there all places look alike; so whole arcs vote as well
// (votes_of_arcs): arcs of like length, points and normals at even steps along them, and the
// isometry of least squares. One such vote is as good as a cluster of those of points, which is
// why votes are tested one by one against the surface instead of being clustered first. Circles,
// which fit each other in any phase, vote through their centres.

#include "features/symmetry_votes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "features/even_polyline.h"
#include "geometry/curvature.h"

namespace fcn {

namespace {

constexpr int kOpenSteps = 13;
constexpr int kClosedSteps = 48;
constexpr double kLengthRatio = 1.1;     // of arcs that may be partners
constexpr double kDihedralSlack = 0.35;  // radians, between their mean dihedral angles
constexpr int kMostArcPairs = 30000;

/// Points along an arc, then the same points moved along the surface normals: normals hold
/// straight arcs, which could turn about themselves otherwise.
struct ArcShape {
    int arc = -1;
    double length = 0;
    std::vector<Vec3> points;
    std::vector<Vec3> normals;
    Vec3 center = Vec3::Zero();
};

std::vector<Vec3> vertex_normals(const MeshArrays& arrays) {
    std::vector<Vec3> normals(arrays.points.size(), Vec3::Zero());
    for (int f = 0; f < arrays.face_count(); ++f) {
        for (const int v : arrays.face_vertices[f])
            normals[v] += arrays.areas[f] * arrays.normals[f];
    }
    for (Vec3& normal : normals) normal.normalize();
    return normals;
}

class ArcVotes {
public:
    ArcVotes(const MeshArrays& arrays, const FeatureCurveNetwork& network, double tolerance)
        : arrays_(arrays), network_(network), tolerance_(tolerance) {
        const std::vector<Vec3> normals = vertex_normals(arrays);
        for (std::size_t a = 0; a < network.arcs.size(); ++a) {
            ArcShape shape = shape_of(static_cast<int>(a), normals);
            if (shape.length > 2 * tolerance) shapes_.push_back(std::move(shape));
        }
        std::ranges::stable_sort(shapes_, {}, [&](const ArcShape& shape) {
            return std::pair(network_.arcs[shape.arc].is_closed(), shape.length);
        });
    }

    std::vector<Isometry> collect(std::uint64_t seed) {
        std::vector<std::pair<int, int>> pairs = like_pairs();
        if (static_cast<int>(pairs.size()) > kMostArcPairs) {
            std::mt19937_64 random(seed);
            for (int k = 0; k < kMostArcPairs; ++k)
                std::swap(pairs[k], pairs[k + random() % (pairs.size() - k)]);
            pairs.resize(kMostArcPairs);
        }
        for (const auto& [a, b] : pairs) {
            vote_by_centers(shapes_[a], shapes_[b]);
            if (network_.arcs[shapes_[a].arc].is_closed())
                vote_closed(shapes_[a], shapes_[b]);
            else
                vote_open(shapes_[a], shapes_[b]);
        }
        return std::move(votes_);
    }

private:
    ArcShape shape_of(int index, const std::vector<Vec3>& normals) const {
        const NetworkArc& arc = network_.arcs[index];
        ArcShape shape;
        shape.arc = index;
        shape.length = arc.length();
        if (shape.length <= 0) return shape;
        shape.points = even_points(arc, arc.is_closed() ? kClosedSteps : kOpenSteps);
        shape.center =
            std::accumulate(shape.points.begin(), shape.points.end(), Vec3(Vec3::Zero())) /
            static_cast<double>(shape.points.size());
        std::size_t nearest = 0;
        for (const Vec3& point : shape.points) {
            // Both run along the arc in the same direction: the nearest sample only moves on.
            while (nearest + 1 < arc.samples.size() &&
                   (arc.samples[nearest + 1].position - point).squaredNorm() <=
                       (arc.samples[nearest].position - point).squaredNorm()) {
                ++nearest;
            }
            shape.normals.push_back(normal_at(arc.samples[nearest].surface, normals));
        }
        return shape;
    }

    Vec3 normal_at(const SurfacePoint& point, const std::vector<Vec3>& normals) const {
        if (point.face < 0 || point.face >= arrays_.face_count()) return Vec3::Zero();
        Vec3 normal = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            normal += point.barycentric[k] * normals[arrays_.face_vertices[point.face][k]];
        return normal.normalized();
    }

    bool is_like(const ArcShape& a, const ArcShape& b) const {
        const NetworkArc& first = network_.arcs[a.arc];
        const NetworkArc& second = network_.arcs[b.arc];
        return first.is_closed() == second.is_closed() && first.kind == second.kind &&
               b.length <= kLengthRatio * a.length + tolerance_ &&
               std::abs(first.dihedral - second.dihedral) <= kDihedralSlack;
    }

    std::vector<std::pair<int, int>> like_pairs() const {
        std::vector<std::pair<int, int>> pairs;
        const int count = static_cast<int>(shapes_.size());
        for (int a = 0; a < count; ++a) {
            const bool is_closed = network_.arcs[shapes_[a].arc].is_closed();
            for (int b = a + 1; b < count; ++b) {
                if (network_.arcs[shapes_[b].arc].is_closed() != is_closed ||
                    shapes_[b].length > kLengthRatio * shapes_[a].length + tolerance_) {
                    break;
                }
                if (is_like(shapes_[a], shapes_[b])) pairs.emplace_back(a, b);
            }
        }
        return pairs;
    }

    /// Correspondence a[k] -> b[shift +- k].
    void pair_up(const ArcShape& a, const ArcShape& b, int shift, bool is_reversed) {
        const int count = static_cast<int>(a.points.size());
        const double offset = a.length / 4;
        from_.clear();
        to_.clear();
        for (int k = 0; k < count; ++k) {
            const int other = ((is_reversed ? shift - k : shift + k) % count + count) % count;
            from_.push_back(a.points[k]);
            to_.push_back(b.points[other]);
            from_.push_back(a.points[k] + offset * a.normals[k]);
            to_.push_back(b.points[other] + offset * b.normals[other]);
        }
    }

    /// Root mean square distance of the points alone: normals are coarse.
    double residual(const Isometry& map) const {
        double sum = 0;
        for (std::size_t k = 0; k < from_.size(); k += 2)
            sum += (map(from_[k]) - to_[k]).squaredNorm();
        return std::sqrt(sum / static_cast<double>(from_.size() / 2));
    }

    void vote_open(const ArcShape& a, const ArcShape& b) {
        for (const bool is_reversed : {false, true}) {
            pair_up(a, b, is_reversed ? kOpenSteps - 1 : 0, is_reversed);
            for (const bool is_improper : {false, true}) {
                const Isometry map = fit_isometry(from_, to_, is_improper);
                if (residual(map) <= tolerance_) votes_.push_back(map);
            }
        }
    }

    void vote_closed(const ArcShape& a, const ArcShape& b) {
        for (const bool is_reversed : {false, true}) {
            for (const bool is_improper : {false, true}) {
                std::vector<Isometry> maps;
                std::vector<double> errors;
                for (int shift = 0; shift < kClosedSteps; ++shift) {
                    pair_up(a, b, shift, is_reversed);
                    maps.push_back(fit_isometry(from_, to_, is_improper));
                    errors.push_back(residual(maps.back()));
                }
                for (int shift = 0; shift < kClosedSteps; ++shift) {
                    const double next = errors[(shift + 1) % kClosedSteps];
                    const double last = errors[(shift + kClosedSteps - 1) % kClosedSteps];
                    if (errors[shift] <= 2 * tolerance_ && errors[shift] <= next &&
                        errors[shift] < last) {
                        votes_.push_back(maps[shift]);
                    }
                }
            }
        }
    }

    void vote_by_centers(const ArcShape& a, const ArcShape& b) {
        if ((a.center - b.center).norm() <= 2 * tolerance_) return;
        votes_.push_back(reflection_between(a.center, b.center));
        votes_.push_back({Eigen::Matrix3d::Identity(), b.center - a.center});
    }

    const MeshArrays& arrays_;
    const FeatureCurveNetwork& network_;
    double tolerance_;
    std::vector<ArcShape> shapes_;
    std::vector<Vec3> from_, to_;
    std::vector<Isometry> votes_;
};

constexpr int kMostPlaces = 1500;
constexpr int kPartners = 24;

/// A curved place: its frame (normal, direction of largest curvature) and its signature.
struct Place {
    Vec3 point, normal, direction;
    double kappa_max = 0, kappa_min = 0;
};

std::vector<Place> curved_places(const Mesh& mesh, const MeshArrays& arrays, double radius,
                                 std::uint64_t seed, int threads) {
    const PrincipalCurvatures curvatures =
        principal_curvatures(mesh, {.radius = radius, .threads = threads});
    const std::vector<Vec3> normals = vertex_normals(arrays);
    std::vector<int> candidates;
    for (int v = 0; v < arrays.vertex_count(); ++v) {
        const double large = curvatures.kappa_max[v];
        const double small = std::abs(curvatures.kappa_min[v]);
        // Nearly flat, alike in all directions, or straight in one: no frame to go by, or one that
        // fits all along a cylinder or a straight crease.
        if (std::abs(large) * radius < 0.1 || small < 0.1 * std::abs(large) ||
            std::abs(large - curvatures.kappa_min[v]) < 0.5 * std::abs(large)) {
            continue;
        }
        candidates.push_back(v);
    }
    std::mt19937_64 random(seed);
    const std::size_t count = std::min<std::size_t>(candidates.size(), kMostPlaces);
    std::vector<Place> places;
    for (std::size_t k = 0; k < count; ++k) {
        std::swap(candidates[k], candidates[k + random() % (candidates.size() - k)]);
        const int v = candidates[k];
        const Vec3& normal = normals[v];
        Vec3 direction = curvatures.direction_max[v];
        direction = (direction - normal * normal.dot(direction)).normalized();
        places.push_back({arrays.points[v], normal, direction, curvatures.kappa_max[v],
                          curvatures.kappa_min[v]});
    }
    return places;
}

/// Columns: normal, direction, and their cross product.
Eigen::Matrix3d frame_of(const Place& place) {
    Eigen::Matrix3d frame;
    frame << place.normal, place.direction, place.normal.cross(place.direction);
    return frame;
}

void vote_by_frames(const Place& a, const Place& b, std::vector<Isometry>& votes) {
    constexpr double kAlignment = 0.96;  // cosine of 16 degrees
    const Isometry mirror = reflection_between(a.point, b.point);
    if ((mirror.linear * a.normal).dot(b.normal) > kAlignment &&
        std::abs((mirror.linear * a.direction).dot(b.direction)) > kAlignment) {
        votes.push_back(mirror);
    }
    Place turned = b;
    for (const double sign : {1.0, -1.0}) {
        turned.direction = sign * b.direction;
        Isometry map;
        map.linear = frame_of(turned) * frame_of(a).transpose();
        map.translation = b.point - map.linear * a.point;
        votes.push_back(map);
    }
}

}  // namespace

std::vector<Isometry> votes_of_arcs(const MeshArrays& arrays, const FeatureCurveNetwork& network,
                                    double tolerance, std::uint64_t seed) {
    return ArcVotes(arrays, network, tolerance).collect(seed);
}

std::vector<Isometry> votes_of_curvature(const Mesh& mesh, const MeshArrays& arrays, double radius,
                                         std::uint64_t seed, int threads) {
    std::vector<Place> places = curved_places(mesh, arrays, radius, seed, threads);
    std::ranges::stable_sort(places, {}, &Place::kappa_max);
    std::vector<Isometry> votes;
    for (std::size_t a = 0; a < places.size(); ++a) {
        int partners = 0;
        for (std::size_t b = a + 1; b < places.size() && partners < kPartners; ++b) {
            const double scale = std::abs(places[a].kappa_max);
            if (places[b].kappa_max - places[a].kappa_max > 0.1 * scale) break;
            if (std::abs(places[b].kappa_min - places[a].kappa_min) > 0.1 * scale ||
                (places[a].point - places[b].point).norm() < 2 * radius) {
                continue;
            }
            vote_by_frames(places[a], places[b], votes);
            ++partners;
        }
    }
    return votes;
}

}  // namespace fcn
