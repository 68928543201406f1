// Symmetric partners exist together or not at all (paper section 5.3.1), so they share one label,
// and for that they need corresponding segments: one representative is resampled, the others take
// over its chain through the orbit's transformations.

#include "adaptation/orbits.h"

#include <algorithm>
#include <limits>

namespace fcn {

namespace {

int nearest_sample(const std::vector<Vec3>& points, const Vec3& target, int from, int to) {
    int best = from;
    double distance = std::numeric_limits<double>::infinity();
    for (int k = from; k <= to; ++k) {
        const double d = (points[k] - target).squaredNorm();
        if (d < distance) {
            distance = d;
            best = k;
        }
    }
    return best;
}

bool has_lengths_in_scale(const WorkingArc& arc, const std::vector<int>& chain, int long_segment,
                          const ScaleInterval& scale) {
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
        const double length = (arc.points[chain[k + 1]] - arc.points[chain[k]]).norm();
        if (static_cast<int>(k) == long_segment) {
            if (length < scale.rmin || length > kLongSegmentFactor * scale.rmin) return false;
        } else if (!scale.contains(length)) {
            return false;
        }
    }
    return true;
}

bool transport(WorkingNetwork& network, int from, int to, const OrbitMember& member,
               const ScaleInterval& scale) {
    const WorkingArc& source = network.arcs[from];
    WorkingArc& target = network.arcs[to];
    if (source.is_closed() != target.is_closed() || source.is_short != target.is_short)
        return false;
    const auto image = [&](const Vec3& x) { return Vec3(member.linear * x + member.translation); };
    if (member.is_reversed) network.reverse(to);
    if (source.is_short) return true;
    const int last = static_cast<int>(target.points.size()) - 1;
    if (target.is_closed()) {
        network.rotate_closed(to,
                              nearest_sample(target.points, image(source.points[0]), 0, last - 1));
    }
    std::vector<int> chain{0};
    for (std::size_t k = 1; k + 1 < source.chain.size(); ++k) {
        const Vec3 goal = image(source.points[source.chain[k]]);
        chain.push_back(nearest_sample(target.points, goal, chain.back(), last));
    }
    chain.push_back(last);
    if (!std::ranges::is_sorted(chain, std::less_equal<>{}) ||
        !has_lengths_in_scale(target, chain, source.long_segment, scale)) {
        return false;
    }
    target.chain = std::move(chain);
    target.long_segment = source.long_segment;
    return true;
}

}  // namespace

void transport_orbits(WorkingNetwork& network, const std::vector<SymmetryOrbit>& orbits,
                      const std::vector<int>& arc_of_origin, const ScaleInterval& scale,
                      std::vector<std::string>& warnings) {
    int next_class = 0;
    for (std::size_t o = 0; o < orbits.size(); ++o) {
        const std::vector<OrbitMember>& members = orbits[o].members;
        if (members.empty()) continue;
        const int first = arc_of_origin[members[0].arc];
        if (first < 0 || !network.arcs[first].is_alive || network.arcs[first].chain.empty()) {
            warnings.push_back("symmetry orbit " + std::to_string(o) +
                               ": its first arc was merged or dropped; labels are not shared");
            continue;
        }
        const int count = network.arcs[first].segment_count();
        for (std::size_t m = 0; m < members.size(); ++m) {
            const int arc = arc_of_origin[members[m].arc];
            const bool is_shared = m == 0 || (arc >= 0 && network.arcs[arc].is_alive &&
                                              transport(network, first, arc, members[m], scale));
            if (!is_shared) {
                warnings.push_back("symmetry orbit " + std::to_string(o) + ": arc " +
                                   std::to_string(members[m].arc) +
                                   " does not match its image; it is labeled on its own");
                continue;
            }
            network.arcs[arc].orbit_classes.resize(count);
            for (int k = 0; k < count; ++k) network.arcs[arc].orbit_classes[k] = next_class + k;
        }
        next_class += count;
    }
}

}  // namespace fcn
