// The conformity checker: strict conformity (i)-(iv) of DESIGN 4.3 and the distance ratio of the
// paper's Definition 1(2), read off a finished network.
//
// It trusts nothing that the adaptation computed: a network is its node positions, which nodes each
// segment joins, which arc it lies on and whether that arc is pinned. Flags such as is_long are not
// looked at. Every distance, angle bound and neighbour search is the checker's own
// (conformity_*.cpp).
//
// What the definitions leave open is decided here:
// - Segments that share a node are held to the angles alone, at each node that they share; two
//   segments between the same two nodes thus meet at angle 0 and violate them. An angle at a
//   segment without length does not exist; the segment is a ShortSegment.
// - One segment of an arc may be longer than rmax, up to 2.06 rmin. Of several the first is it.
// - A thin wall: the witnesses are projected to their closest surface points; the pair is exempt if
//   the normals there (mean of the faces at an edge, by angle at a vertex; within rmin / 1000) have
//   a dot product <= -0.5 and the exact surface distance between them is at least 3 rmin.
// - Input-forced: a length on a pinned arc, a pair of segments of pinned arcs, a pair of nodes all
//   of whose arcs are pinned.
// - Definition 1(2) is measured on pairs of segments of different arcs without a common node that
//   are closer than rmax and not a thin wall: surface distance over Euclidean distance of the
//   projected witnesses, cut off at 4.

#include "adaptation/conformity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "adaptation/conformity_boxes.h"
#include "adaptation/conformity_geodesic.h"
#include "adaptation/conformity_measures.h"
#include "adaptation/conformity_surface.h"
#include "geometry/errors.h"

namespace fcn {

using namespace conformity;

namespace {

constexpr double kLongestInRmin = 2.06;
constexpr double kThinWallDot = -0.5;
constexpr double kThinWallDistanceInRmin = 3.0;
constexpr double kCreaseRadiusInRmin = 1e-3;
constexpr double kLargestDistanceRatio = 4.0;

void require(bool is_valid, const std::string& message) {
    if (!is_valid) throw InputError("conformity check: " + message);
}

void check_options(const ConformityOptions& options) {
    require(std::isfinite(options.rmin) && options.rmin > 0,
            "rmin must be positive, got " + std::to_string(options.rmin));
    require(options.ratio >= 1.01 && options.ratio < std::sqrt(3.0),
            "ratio must lie in [1.01, sqrt(3)), got " + std::to_string(options.ratio));
    require(std::isfinite(options.tolerance) && options.tolerance >= 0,
            "tolerance must not be negative, got " + std::to_string(options.tolerance));
}

void check_network(const FeatureCurveNetwork& network) {
    const int node_count = static_cast<int>(network.nodes.size());
    const int arc_count = static_cast<int>(network.arcs.size());
    std::vector<bool> has_segment(network.arcs.size(), false);
    for (std::size_t i = 0; i < network.segments.size(); ++i) {
        const NetworkSegment& segment = network.segments[i];
        const std::string name = "segment " + std::to_string(i);
        for (const int node : segment.nodes) {
            require(node >= 0 && node < node_count, name + " names node " + std::to_string(node) +
                                                        " of " + std::to_string(node_count));
            require(network.nodes[node].position.allFinite(),
                    "node " + std::to_string(node) + " has no finite position");
        }
        require(segment.arc >= 0 && segment.arc < arc_count,
                name + " names arc " + std::to_string(segment.arc) + " of " +
                    std::to_string(arc_count));
        has_segment[segment.arc] = true;
    }
    for (int arc = 0; arc < arc_count; ++arc) {
        require(has_segment[arc], "arc " + std::to_string(arc) +
                                      " has no segments; adapt the network to a scale first");
    }
    require(network.is_adapted(), "the network has no segments; adapt it to a scale first");
}

class Checker {
public:
    Checker(const FeatureCurveNetwork& network, const ConformityOptions& options, const Mesh* mesh)
        : network_(network),
          options_(options),
          rmax_(options.rmin * options.ratio),
          height_(std::sqrt(options.rmin * options.rmin - rmax_ * rmax_ / 4)),
          angles_(angle_bounds(options.ratio, options.is_quad_target)) {
        if (mesh != nullptr && mesh->n_faces() > 0) {
            surface_.emplace(*mesh);
            geodesics_.emplace(*surface_);
        }
        stars_.resize(network.nodes.size());
        for (int i = 0; i < segment_count(); ++i) {
            const auto& ends = network.segments[i].nodes;
            stars_[ends[0]].push_back(i);
            if (ends[1] != ends[0]) stars_[ends[1]].push_back(i);
        }
    }

    ConformityReport run() {
        check_lengths();
        check_nodes();
        check_segments();
        check_angles();
        measure_ratios();
        finish();
        return std::move(report_);
    }

private:
    /// Two segments of different arcs that are close to each other.
    struct ClosePair {
        Foot first, second;
        double distance = 0;     ///< Euclidean, of the feet
        double upper_bound = 0;  ///< of the surface distance
    };

    int segment_count() const { return static_cast<int>(network_.segments.size()); }
    const Vec3& end(int segment, int side) const {
        return network_.nodes[network_.segments[segment].nodes[side]].position;
    }
    double length(int segment) const { return (end(segment, 1) - end(segment, 0)).norm(); }
    bool is_pinned(int segment) const {
        return network_.arcs[network_.segments[segment].arc].pin == Pin::Keep;
    }
    bool is_node_pinned(int node) const {
        return std::all_of(stars_[node].begin(), stars_[node].end(),
                           [&](int segment) { return is_pinned(segment); });
    }

    void check_lengths();
    void check_nodes();
    void check_segments();
    void check_segment_pair(int first, int second);
    void check_angles();
    void check_angle(int node, int first, int second);
    void measure_ratios();
    void finish();

    void add_length(ViolationKind kind, int segment, double required);
    bool is_thin_wall(const Foot& first, const Foot& second, double upper_bound);
    bool is_exempt(const Vec3& first, const Vec3& second);
    Foot foot(const Vec3& point) const {
        return surface_->project(point, kCreaseRadiusInRmin * options_.rmin);
    }

    const FeatureCurveNetwork& network_;
    const ConformityOptions& options_;
    const double rmax_;
    const double height_;
    const AngleBounds angles_;
    std::optional<Surface> surface_;
    std::optional<Geodesics> geodesics_;
    std::vector<std::vector<int>> stars_;  ///< per node its segments, ascending
    std::vector<ClosePair> close_pairs_;
    ConformityReport report_;
};

void Checker::add_length(ViolationKind kind, int segment, double required) {
    report_.violations.push_back({kind, segment, -1, length(segment), required, end(segment, 0),
                                  end(segment, 1), is_pinned(segment), false});
}

void Checker::check_lengths() {
    const double slack = options_.tolerance;
    std::vector<bool> has_long(network_.arcs.size(), false);
    for (int i = 0; i < segment_count(); ++i) {
        const double measured = length(i);
        if (measured < options_.rmin * (1 - slack)) {
            add_length(ViolationKind::ShortSegment, i, options_.rmin);
        } else if (measured > kLongestInRmin * options_.rmin * (1 + slack)) {
            add_length(ViolationKind::LongSegment, i, kLongestInRmin * options_.rmin);
        } else if (measured > rmax_ * (1 + slack)) {
            const int arc = network_.segments[i].arc;
            if (has_long[arc]) {
                add_length(ViolationKind::LongSegment, i, rmax_);
            } else {
                has_long[arc] = true;
                ++report_.long_segments;
            }
        }
    }
}

void Checker::check_nodes() {
    std::vector<int> used;
    std::vector<Box> boxes;
    for (std::size_t v = 0; v < stars_.size(); ++v) {
        if (stars_[v].empty()) continue;
        used.push_back(static_cast<int>(v));
        boxes.emplace_back();
        boxes.back().add(network_.nodes[v].position);
    }
    const BoxTree tree(boxes);
    for (std::size_t i = 0; i < used.size(); ++i) {
        tree.within(boxes[i], options_.rmin, [&](int j) {
            if (j <= static_cast<int>(i)) return;
            const Vec3& first = network_.nodes[used[i]].position;
            const Vec3& second = network_.nodes[used[j]].position;
            const double distance = (second - first).norm();
            if (distance >= options_.rmin * (1 - options_.tolerance)) return;
            const bool is_forced = is_node_pinned(used[i]) && is_node_pinned(used[j]);
            report_.violations.push_back({ViolationKind::CloseNodes, used[i], used[j], distance,
                                          options_.rmin, first, second, is_forced,
                                          !is_forced && is_exempt(first, second)});
        });
    }
}

void Checker::check_segments() {
    std::vector<Box> boxes(network_.segments.size());
    for (int i = 0; i < segment_count(); ++i) {
        boxes[i].add(end(i, 0));
        boxes[i].add(end(i, 1));
    }
    const BoxTree tree(boxes);
    const double reach = surface_ ? rmax_ : height_;
    for (int i = 0; i < segment_count(); ++i) {
        tree.within(boxes[i], reach, [&](int j) {
            if (j > i) check_segment_pair(i, j);
        });
    }
}

void Checker::check_segment_pair(int first, int second) {
    const auto& a = network_.segments[first].nodes;
    const auto& b = network_.segments[second].nodes;
    if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) return;
    const SegmentDistance closest =
        segment_distance(end(first, 0), end(first, 1), end(second, 0), end(second, 1));
    if (closest.distance < height_ * (1 - options_.tolerance)) {
        const bool is_forced = is_pinned(first) && is_pinned(second);
        report_.violations.push_back({ViolationKind::CloseSegments, first, second, closest.distance,
                                      height_, closest.first, closest.second, is_forced,
                                      !is_forced && is_exempt(closest.first, closest.second)});
    }
    if (!surface_ || closest.distance >= rmax_) return;
    if (network_.segments[first].arc == network_.segments[second].arc) return;
    ClosePair pair{foot(closest.first), foot(closest.second), 0, 0};
    pair.distance = (pair.second.position - pair.first.position).norm();
    if (pair.distance <= kCreaseRadiusInRmin * options_.rmin) return;
    pair.upper_bound = surface_->section_length(
        pair.first, pair.second,
        std::max(kLargestDistanceRatio * pair.distance, kThinWallDistanceInRmin * options_.rmin));
    if (options_.is_thin_wall_exempt && is_thin_wall(pair.first, pair.second, pair.upper_bound)) {
        return;
    }
    close_pairs_.push_back(pair);
}

bool Checker::is_thin_wall(const Foot& first, const Foot& second, double upper_bound) {
    if (first.normal.dot(second.normal) > kThinWallDot) return false;
    const double required = kThinWallDistanceInRmin * options_.rmin * (1 - options_.tolerance);
    if (upper_bound < required) return false;
    return geodesics_->distance(first, second, required) >= required;
}

bool Checker::is_exempt(const Vec3& first, const Vec3& second) {
    if (!surface_ || !options_.is_thin_wall_exempt) return false;
    const Foot foot_first = foot(first);
    const Foot foot_second = foot(second);
    const double limit = kThinWallDistanceInRmin * options_.rmin;
    return is_thin_wall(foot_first, foot_second,
                        surface_->section_length(foot_first, foot_second, limit));
}

void Checker::check_angles() {
    for (std::size_t node = 0; node < stars_.size(); ++node) {
        const std::vector<int>& star = stars_[node];
        for (std::size_t i = 0; i < star.size(); ++i) {
            for (std::size_t j = i + 1; j < star.size(); ++j) {
                check_angle(static_cast<int>(node), star[i], star[j]);
            }
        }
    }
}

void Checker::check_angle(int node, int first, int second) {
    if (length(first) == 0 || length(second) == 0) return;
    const auto other_end = [&](int segment) {
        return end(segment, network_.segments[segment].nodes[0] == node ? 1 : 0);
    };
    const Vec3& apex = network_.nodes[node].position;
    const double angle = angle_at(apex, other_end(first), other_end(second));
    if (angles_.contains(angle, options_.tolerance)) return;
    report_.violations.push_back({ViolationKind::Angle, first, second, angle,
                                  angles_.nearest_bound(angle), apex, apex,
                                  is_pinned(first) && is_pinned(second), false});
}

/// Exact distances are only needed where the upper bound could change an answer: the largest ratio,
/// or the number of those above two.
void Checker::measure_ratios() {
    std::stable_sort(close_pairs_.begin(), close_pairs_.end(),
                     [](const ClosePair& a, const ClosePair& b) {
                         return a.upper_bound / a.distance > b.upper_bound / b.distance;
                     });
    report_.distance_ratio_pairs = close_pairs_.size();
    for (const ClosePair& pair : close_pairs_) {
        if (pair.upper_bound <= std::min(2.0, report_.max_distance_ratio) * pair.distance) {
            break;
        }
        const double exact =
            geodesics_->distance(pair.first, pair.second, kLargestDistanceRatio * pair.distance);
        const double ratio = std::min(
            {kLargestDistanceRatio, exact / pair.distance, pair.upper_bound / pair.distance});
        report_.max_distance_ratio = std::max(report_.max_distance_ratio, ratio);
        if (ratio > 2) ++report_.distance_ratio_over_two;
    }
}

void Checker::finish() {
    std::stable_sort(report_.violations.begin(), report_.violations.end(),
                     [](const Violation& a, const Violation& b) {
                         return std::tie(a.kind, a.first, a.second) <
                                std::tie(b.kind, b.first, b.second);
                     });
    for (const Violation& violation : report_.violations) {
        if (violation.is_input_forced) {
            ++report_.input_forced;
        } else if (violation.is_exempt) {
            ++report_.exempt;
        } else {
            ++report_.counted;
        }
    }
}

}  // namespace

const char* to_string(ViolationKind kind) {
    switch (kind) {
        case ViolationKind::ShortSegment:
            return "short segment";
        case ViolationKind::LongSegment:
            return "long segment";
        case ViolationKind::CloseNodes:
            return "close nodes";
        case ViolationKind::CloseSegments:
            return "close segments";
        case ViolationKind::Angle:
            return "angle";
    }
    return "unknown";
}

ConformityReport check_conformity(const FeatureCurveNetwork& network,
                                  const ConformityOptions& options, const Mesh* mesh) {
    check_options(options);
    check_network(network);
    return Checker(network, options, mesh).run();
}

}  // namespace fcn
