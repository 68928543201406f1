// Resampling an arc (paper section 5.2.1): the dense samples are the nodes of a directed graph, an
// edge joins samples whose Euclidean distance lies in S, its cost is the integral distance of the
// arc from the chord, and the best chain is a shortest path. The samples are in order, so one
// sweep of dynamic programming replaces Dijkstra's queue. Departures: a tiny cost of uneven
// lengths decides ties (straight arcs have many optima of cost 0); a closed arc carries its
// segment count (up to three) in the state, since fewer than three segments are no closed curve.

#include "adaptation/resampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fcn {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Arcs of more samples than this only look ahead kWindowFactor rmax of arc length: a chord over
/// a longer detour costs more than any sane chain.
constexpr int kFullWindowSamples = 400;
constexpr double kWindowFactor = 3.0;

/// Integral distance of the polyline from the chord; step(k) is the length from sample k - 1 to k.
template <class Step>
double integral_distance(std::span<const Vec3> samples, int first, int last, Step step) {
    const Vec3& a = samples[first];
    const Vec3 axis = samples[last] - a;
    const double squared = axis.squaredNorm();
    const double inverse = squared > 0 ? 1.0 / squared : 0.0;
    double total = 0;
    double previous = 0;
    for (int k = first + 1; k <= last; ++k) {
        const Vec3 d = samples[k] - a;
        const double t = std::clamp(d.dot(axis) * inverse, 0.0, 1.0);
        const double distance = k == last ? 0.0 : (d - t * axis).norm();
        total += step(k) * (previous + distance) / 2;
        previous = distance;
    }
    return total;
}

/// Polyline with prefix lengths and the edge cost.
class ChordCosts {
public:
    ChordCosts(std::span<const Vec3> points, const ScaleInterval& scale, double evenness)
        : points_(points),
          scale_(scale),
          evenness_(evenness),
          steps_(points.size(), 0.0),
          prefix_(points.size(), 0.0) {
        for (std::size_t k = 1; k < points.size(); ++k) {
            steps_[k] = (points[k] - points[k - 1]).norm();
            prefix_[k] = prefix_[k - 1] + steps_[k];
        }
        window_ = static_cast<int>(points.size()) <= kFullWindowSamples
                      ? kInfinity
                      : kWindowFactor * scale.rmax;
    }

    int size() const { return static_cast<int>(points_.size()); }
    double arc_length(int i, int j) const { return prefix_[j] - prefix_[i]; }
    double window() const { return window_; }
    double chord(int i, int j) const { return (points_[j] - points_[i]).norm(); }

    double unevenness(double length) const {
        const double ideal = std::sqrt(scale_.rmin * scale_.rmax);
        const double off = (length - ideal) / scale_.rmin;
        return evenness_ * off * off;
    }

    double deviation(int i, int j, double length) const {
        const double along = arc_length(i, j);
        if (along - length <= 1e-12 * along) return 0.0;
        return integral_distance(points_, i, j, [this](int k) { return steps_[k]; }) /
               (scale_.rmin * scale_.rmin);
    }

    /// First sample that a chord of at least rmin from i can reach: the arc is never shorter.
    int first_reachable(int i) const {
        const double reach = prefix_[i] + scale_.rmin * (1 - kScaleTolerance);
        return static_cast<int>(std::lower_bound(prefix_.begin() + i + 1, prefix_.end(), reach) -
                                prefix_.begin());
    }

private:
    std::span<const Vec3> points_;
    const ScaleInterval& scale_;
    double evenness_;
    double window_ = kInfinity;
    std::vector<double> steps_, prefix_;
};

/// Shortest chains from sample 0 with at least `layers` segments: states are (sample, number of
/// segments so far, capped at layers).
class ChainSearch {
public:
    ChainSearch(const ChordCosts& costs, const ScaleInterval& scale, int layers, int origin,
                int first_count)
        : costs_(costs), scale_(scale), layers_(layers) {
        const std::size_t states = static_cast<std::size_t>(costs.size()) * (layers + 1);
        cost_.assign(states, kInfinity);
        from_.assign(states, -1);
        cost_[state(origin, first_count)] = 0;
        for (int i = origin; i < costs.size(); ++i) relax_from(i);
    }

    double cost(int sample) const { return cost_[state(sample, layers_)]; }
    double cost(int sample, int count) const { return cost_[state(sample, count)]; }

    /// Samples of the best chain, ascending, from the origin to `sample`.
    std::vector<int> chain(int sample, int count) const {
        std::vector<int> result;
        std::int64_t at = state(sample, count);
        while (at >= 0) {
            result.push_back(static_cast<int>(at / (layers_ + 1)));
            at = from_[at];
        }
        std::reverse(result.begin(), result.end());
        return result;
    }

private:
    std::int64_t state(int sample, int count) const {
        return static_cast<std::int64_t>(sample) * (layers_ + 1) + count;
    }

    bool is_reached(int i) const {
        for (int c = 0; c <= layers_; ++c) {
            if (cost_[state(i, c)] < kInfinity) return true;
        }
        return false;
    }

    void relax_from(int i) {
        if (!is_reached(i)) return;
        for (int j = costs_.first_reachable(i); j < costs_.size(); ++j) {
            if (costs_.arc_length(i, j) > costs_.window()) break;
            const double length = costs_.chord(i, j);
            if (!scale_.contains(length)) continue;
            const double uneven = costs_.unevenness(length);
            double deviation = -1;
            for (int c = 0; c <= layers_; ++c) {
                const double base = cost_[state(i, c)] + uneven;
                const std::int64_t target = state(j, std::min(c + 1, layers_));
                if (!(base < cost_[target])) continue;
                if (deviation < 0) deviation = costs_.deviation(i, j, length);
                if (base + deviation < cost_[target]) {
                    cost_[target] = base + deviation;
                    from_[target] = state(i, c);
                }
            }
        }
    }

    const ChordCosts& costs_;
    const ScaleInterval& scale_;
    int layers_;
    std::vector<double> cost_;
    std::vector<std::int64_t> from_;
};

bool is_allowed_long(double length, const ScaleInterval& scale) {
    return length > scale.rmax * (1 + kScaleTolerance) &&
           length <= kLongSegmentFactor * scale.rmin * (1 + kScaleTolerance);
}

/// Best chain over the points with at least `layers` segments; chain empty when none exists.
Resampling best_chain(std::span<const Vec3> points, const ScaleInterval& scale, int layers,
                      double evenness) {
    const ChordCosts costs(points, scale, evenness);
    const int last = costs.size() - 1;
    Resampling result;
    const ChainSearch forward(costs, scale, layers, 0, 0);
    if (forward.cost(last) < kInfinity) {
        result.chain = forward.chain(last, layers);
        result.cost = forward.cost(last);
        return result;
    }
    // One long segment at either end. The end first: it reuses the sweep that failed.
    double best = kInfinity;
    for (int i = 0; i < last; ++i) {
        const double length = costs.chord(i, last);
        if (!is_allowed_long(length, scale) || costs.arc_length(i, last) > costs.window()) continue;
        for (int c = std::max(0, layers - 1); c <= layers; ++c) {
            const double base = forward.cost(i, c);
            if (!(base < kInfinity)) continue;
            const double total = base + costs.unevenness(length) + costs.deviation(i, last, length);
            if (total < best) {
                best = total;
                result.chain = forward.chain(i, c);
                result.chain.push_back(last);
                result.long_segment = static_cast<int>(result.chain.size()) - 2;
            }
        }
    }
    std::vector<Vec3> reversed(points.rbegin(), points.rend());
    const ChordCosts back_costs(reversed, scale, evenness);
    const ChainSearch backward(back_costs, scale, layers, 0, 0);
    for (int i = 0; i < last; ++i) {
        const double length = back_costs.chord(i, last);
        if (!is_allowed_long(length, scale) || back_costs.arc_length(i, last) > costs.window()) {
            continue;
        }
        for (int c = std::max(0, layers - 1); c <= layers; ++c) {
            const double base = backward.cost(i, c);
            if (!(base < kInfinity)) continue;
            const double total =
                base + back_costs.unevenness(length) + back_costs.deviation(i, last, length);
            if (total < best) {
                best = total;
                std::vector<int> chain = backward.chain(i, c);
                chain.push_back(last);
                std::reverse(chain.begin(), chain.end());
                for (int& sample : chain) sample = last - sample;
                result.chain = std::move(chain);
                result.long_segment = 0;
            }
        }
    }
    result.cost = best;
    return result;
}

/// Starts over the first rmax of a short closed arc, where every chain has a node.
std::vector<int> start_candidates(std::span<const Vec3> samples, const ScaleInterval& scale,
                                  int wanted) {
    const int distinct = static_cast<int>(samples.size()) - 1;
    double length = 0;
    int end = 0;
    while (end < distinct - 1 && length < scale.rmax) {
        length += (samples[end + 1] - samples[end]).norm();
        ++end;
    }
    std::vector<int> starts;
    for (int k = 0; k < wanted; ++k) {
        starts.push_back(static_cast<int>(static_cast<std::int64_t>(end) * k / wanted));
    }
    starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
    return starts;
}

/// Best chain once around a closed arc from one start; chain indices count from sample 0.
Resampling resample_from(std::span<const Vec3> samples, const ScaleInterval& scale, int start,
                         double evenness) {
    constexpr int kSegmentsOfClosedArc = 3;
    const int distinct = static_cast<int>(samples.size()) - 1;
    std::vector<Vec3> rotated;
    rotated.reserve(samples.size());
    for (int k = 0; k <= distinct; ++k) rotated.push_back(samples[(start + k) % distinct]);
    Resampling result = best_chain(rotated, scale, kSegmentsOfClosedArc, evenness);
    result.is_unrepresentable = result.chain.empty();
    result.start = start;
    for (int& sample : result.chain) sample += start;
    return result;
}

bool is_better(const Resampling& a, const Resampling& b) {
    if (a.is_unrepresentable || b.is_unrepresentable) return !a.is_unrepresentable;
    if ((a.long_segment < 0) != (b.long_segment < 0)) return a.long_segment < 0;
    return a.cost < b.cost;
}

Resampling resample_closed(std::span<const Vec3> samples, const ScaleInterval& scale,
                           const ResamplingOptions& options) {
    const int distinct = static_cast<int>(samples.size()) - 1;
    Resampling best = resample_from(samples, scale, 0, options.evenness);
    if (options.is_start_fixed) return best;
    if (distinct > kFullWindowSamples * 2 && !best.is_unrepresentable) {
        // Far from its start a best chain has forgotten it: the node half way around is a start
        // that an unconstrained chain would have, so a second run from there is enough.
        const int middle = best.chain[best.chain.size() / 2] % distinct;
        Resampling second = resample_from(samples, scale, middle, options.evenness);
        return is_better(second, best) ? second : best;
    }
    for (int start : start_candidates(samples, scale, options.start_count)) {
        if (start == 0) continue;
        Resampling candidate = resample_from(samples, scale, start, options.evenness);
        if (is_better(candidate, best)) best = std::move(candidate);
    }
    return best;
}

}  // namespace

double chord_deviation(std::span<const Vec3> samples, int first, int last) {
    return integral_distance(samples, first, last,
                             [&](int k) { return (samples[k] - samples[k - 1]).norm(); });
}

Resampling resample_arc(std::span<const Vec3> samples, bool is_closed, const ScaleInterval& scale,
                        const ResamplingOptions& options) {
    if (is_closed) return resample_closed(samples, scale, options);
    Resampling result = best_chain(samples, scale, 1, options.evenness);
    if (result.chain.empty()) {
        result.is_short = true;
        result.cost = 0;
        result.chain = {0, static_cast<int>(samples.size()) - 1};
    }
    return result;
}

}  // namespace fcn
