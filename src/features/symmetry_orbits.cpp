// Which arcs belong together under given symmetries. An arc's image is compared with the arcs that
// pass near it: points at even steps against the other's polyline, both ways, so that a part of a
// longer arc is no partner. Partners are joined by union-find; members of an orbit get their map
// from the representative along a shortest chain of partners.

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <numeric>

#include "features/even_polyline.h"
#include "features/symmetry.h"

namespace fcn {

namespace {

constexpr int kSteps = 33;
constexpr double kShare = 0.8;             // of the points that must agree
constexpr double kCenterShift = 0.05;      // of the length: a piece of a line is not its neighbour
constexpr double kTangentCosine = 0.9659;  // 15 degrees

struct SampledArc {
    std::vector<Vec3> points, tangents;
    double length = 0;
    bool is_closed = false;
    Vec3 center = Vec3::Zero();
    double radius = 0;  ///< of a ball about the centre that holds all points
};

SampledArc sampled(const NetworkArc& arc) {
    SampledArc result;
    result.length = arc.length();
    result.is_closed = arc.is_closed();
    result.points = even_points(arc, kSteps);
    const int count = kSteps;
    for (int k = 0; k < count; ++k) {
        const int before = result.is_closed ? (k + count - 1) % count : std::max(0, k - 1);
        const int after = result.is_closed ? (k + 1) % count : std::min(count - 1, k + 1);
        result.tangents.push_back((result.points[after] - result.points[before]).normalized());
    }
    for (const Vec3& point : result.points) result.center += point / count;
    for (const Vec3& point : result.points)
        result.radius = std::max(result.radius, (point - result.center).norm());
    return result;
}

struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    Vec3 tangent = Vec3::Zero();
};

Nearest nearest_on(const SampledArc& arc, const Vec3& point) {
    Nearest best;
    const int count = static_cast<int>(arc.points.size());
    for (int k = 0; k < (arc.is_closed ? count : count - 1); ++k) {
        const Vec3& a = arc.points[k];
        const Vec3 step = arc.points[(k + 1) % count] - a;
        const double square = step.squaredNorm();
        const double t = square > 0 ? std::clamp((point - a).dot(step) / square, 0.0, 1.0) : 0.0;
        const double distance = (a + t * step - point).norm();
        if (distance < best.distance) best = {distance, step.normalized()};
    }
    return best;
}

/// Does the image of `a` run along `b`? Positive: in b's direction, negative: against it, 0: no.
int agreement(const SampledArc& a, const SampledArc& b, const Isometry& map, double tolerance) {
    int along = 0;
    int against = 0;
    for (std::size_t k = 0; k < a.points.size(); ++k) {
        const Nearest nearest = nearest_on(b, map(a.points[k]));
        if (nearest.distance > tolerance) continue;
        const double cosine = (map.linear * a.tangents[k]).dot(nearest.tangent);
        along += cosine >= kTangentCosine ? 1 : 0;
        against += cosine <= -kTangentCosine ? 1 : 0;
    }
    const double needed = kShare * static_cast<double>(a.points.size());
    return along >= needed ? 1 : against >= needed ? -1 : 0;
}

class OrbitBuilder {
public:
    OrbitBuilder(const FeatureCurveNetwork& network, const std::vector<SurfaceSymmetry>& symmetries,
                 double tolerance)
        : network_(network), symmetries_(symmetries), tolerance_(tolerance) {
        for (const NetworkArc& arc : network.arcs) arcs_.push_back(sampled(arc));
        order_.resize(arcs_.size());
        std::iota(order_.begin(), order_.end(), 0);
        std::ranges::stable_sort(order_, {}, [&](int a) { return arcs_[a].center.x(); });
        links_.resize(arcs_.size());
    }

    std::vector<SymmetryOrbit> build() {
        for (const SurfaceSymmetry& symmetry : symmetries_) {
            for (std::size_t a = 0; a < arcs_.size(); ++a) link(static_cast<int>(a), symmetry.map);
        }
        std::vector<SymmetryOrbit> orbits;
        std::vector<bool> is_taken(arcs_.size(), false);
        for (std::size_t a = 0; a < arcs_.size(); ++a) {
            if (is_taken[a] || links_[a].empty()) continue;
            orbits.push_back(orbit_of(static_cast<int>(a), is_taken));
        }
        return orbits;
    }

private:
    struct Link {
        int arc;
        Isometry map;
        bool is_reversed;
    };

    bool may_be_partners(int a, int b, const Vec3& center) const {
        const NetworkArc& first = network_.arcs[a];
        const NetworkArc& second = network_.arcs[b];
        return a != b && first.is_closed() == second.is_closed() && first.kind == second.kind &&
               first.pin == Pin::None && second.pin == Pin::None &&
               arcs_[a].length <= 1.25 * arcs_[b].length &&
               arcs_[b].length <= 1.25 * arcs_[a].length &&
               (arcs_[b].center - center).norm() <= kCenterShift * arcs_[a].length + tolerance_;
    }

    void link(int a, const Isometry& map) {
        const Vec3 center = map(arcs_[a].center);
        const double reach = kCenterShift * arcs_[a].length + tolerance_;
        const auto from = std::ranges::lower_bound(order_, center.x() - reach, {},
                                                   [&](int b) { return arcs_[b].center.x(); });
        for (auto at = from; at != order_.end() && arcs_[*at].center.x() <= center.x() + reach;
             ++at) {
            const int b = *at;
            if (!may_be_partners(a, b, center)) continue;
            const int forth = agreement(arcs_[a], arcs_[b], map, tolerance_);
            if (forth == 0 || agreement(arcs_[b], arcs_[a], map.inverse(), tolerance_) != forth)
                continue;
            links_[a].push_back({b, map, forth < 0});
            links_[b].push_back({a, map.inverse(), forth < 0});
            return;
        }
    }

    SymmetryOrbit orbit_of(int representative, std::vector<bool>& is_taken) const {
        SymmetryOrbit orbit;
        orbit.members.push_back({representative});
        is_taken[representative] = true;
        for (std::size_t next = 0; next < orbit.members.size(); ++next) {
            const OrbitMember member = orbit.members[next];
            const Isometry here{member.linear, member.translation};
            for (const Link& to : links_[member.arc]) {
                if (is_taken[to.arc]) continue;
                is_taken[to.arc] = true;
                const Isometry map = to.map.after(here);
                orbit.members.push_back(
                    {to.arc, map.linear, map.translation, member.is_reversed != to.is_reversed});
            }
        }
        std::sort(orbit.members.begin() + 1, orbit.members.end(),
                  [](const OrbitMember& a, const OrbitMember& b) { return a.arc < b.arc; });
        return orbit;
    }

    const FeatureCurveNetwork& network_;
    const std::vector<SurfaceSymmetry>& symmetries_;
    double tolerance_;
    std::vector<SampledArc> arcs_;
    std::vector<int> order_;  ///< arcs by their centre's x
    std::vector<std::vector<Link>> links_;
};

}  // namespace

std::vector<SymmetryOrbit> symmetry_orbits(const FeatureCurveNetwork& network,
                                           const std::vector<SurfaceSymmetry>& symmetries,
                                           double tolerance) {
    return OrbitBuilder(network, symmetries, tolerance).build();
}

}  // namespace fcn
