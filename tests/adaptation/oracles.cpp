// Brute-force oracles of the adaptation's tests: enumeration of resampled chains (paper 5.2.1) and
// of conflicting pairs (paper 4.2, 5.2.2; DESIGN 4.2, 4.3).

#include "oracles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace fcn::test {

namespace {

constexpr double kDoubt = 1e-5;
constexpr double kLongest = 2.06;

struct Projection {
    double distance = 0, t = 0;
};

Projection project(const Vec3& p, const Vec3& a, const Vec3& b) {
    const double square = (b - a).squaredNorm();
    const double t = square > 0 ? std::min(1.0, std::max(0.0, (p - a).dot(b - a) / square)) : 0.0;
    return {(a + t * (b - a) - p).norm(), t};
}

double segment_cost(const ChainQuestion& q, int i, int j) {
    const double length = (q.points[j] - q.points[i]).norm();
    const double off = (length - std::sqrt(q.rmin * q.rmax)) / q.rmin;
    return deviation(q.points, i, j) / (q.rmin * q.rmin) + q.evenness * off * off;
}

class ChainEnumeration {
public:
    explicit ChainEnumeration(const ChainQuestion& question) : q_(question) {}

    ChainAnswer run() {
        chain_ = {0};
        extend(0.0, false);
        return answer_;
    }

private:
    void extend(double cost, bool has_long) {
        const int at = chain_.back();
        const int last = static_cast<int>(q_.points.size()) - 1;
        if (at == last) {
            finish(cost, has_long);
            return;
        }
        for (int next = at + 1; next <= last; ++next) {
            const double length = (q_.points[next] - q_.points[at]).norm();
            const bool is_regular = length >= q_.rmin && length <= q_.rmax;
            const bool is_long = length > q_.rmax && length <= kLongest * q_.rmin;
            const bool is_at_end = at == 0 || next == last;
            const bool may_be_long =
                !has_long && (q_.long_segment == LongSegment::Anywhere ||
                              (q_.long_segment == LongSegment::AtAnEnd && is_at_end));
            if (!is_regular && !(is_long && may_be_long)) continue;
            chain_.push_back(next);
            extend(cost + segment_cost(q_, at, next), has_long || is_long);
            chain_.pop_back();
        }
    }

    void finish(double cost, bool has_long) {
        if (static_cast<int>(chain_.size()) - 1 < q_.min_segments) return;
        if (has_long != (q_.long_segment != LongSegment::Nowhere)) return;
        ++answer_.tried;
        if (answer_.exists && cost >= answer_.cost) return;
        answer_.exists = true;
        answer_.cost = cost;
        answer_.chain = chain_;
    }

    const ChainQuestion& q_;
    ChainAnswer answer_;
    std::vector<int> chain_;
};

/// Compares with limits and remembers whether any comparison was too close to call.
class Judge {
public:
    explicit Judge(const ConflictQuestion& question) : q_(question), n_(question.network) {
        const double r = q_.ratio;
        triangle_min_ = std::min(std::acos(r / 2), 2 * std::asin(1 / (2 * r)));
        if (q_.is_quad) {
            const double kite = std::acos((r * r + 1) / (2 * std::sqrt(2) * r));
            min_ = 2 * std::min(std::asin(1 / (std::sqrt(2) * r)), kite);
            max_ = 2 * std::max(std::asin(std::min(1.0, r / std::sqrt(2))), kite);
        } else {
            min_ = triangle_min_;
            max_ = std::max(2 * std::asin(r / 2), std::acos(1 / (2 * r)));
        }
        height_ = q_.rmin * std::sqrt(1 - r * r / 4);
        find_clusters();
    }

    bool is_doubtful() const { return is_doubtful_; }
    void reset() { is_doubtful_ = false; }

    bool in_conflict(int e, int f) {
        return q_.is_best_mode ? in_conflict_best(e, f) : in_conflict_paper(e, f);
    }

    bool are_nodes_close(int u, int v) { return !at_least(distance(u, v), q_.rmin); }

private:
    bool at_least(double value, double limit) {
        if (std::abs(value - limit) <= kDoubt * limit) is_doubtful_ = true;
        return value >= limit;
    }

    const Vec3& at(int point) const { return n_.points[point]; }
    double distance(int u, int v) const { return (at(u) - at(v)).norm(); }
    bool is_short(int e) const { return n_.length(e) < q_.rmin; }
    int other(int e, int point) const {
        return n_.segments[e][0] == point ? n_.segments[e][1] : n_.segments[e][0];
    }

    static double angle(const Vec3& a, const Vec3& b) {
        return std::acos(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0));
    }

    void find_clusters() {
        cluster_.resize(n_.points.size());
        std::iota(cluster_.begin(), cluster_.end(), 0);
        for (bool has_changed = true; has_changed;) {
            has_changed = false;
            for (std::size_t e = 0; e < n_.segments.size(); ++e) {
                const auto [u, v] = n_.segments[e];
                if (!is_short(static_cast<int>(e)) || cluster_[u] == cluster_[v]) continue;
                cluster_[u] = cluster_[v] = std::min(cluster_[u], cluster_[v]);
                has_changed = true;
            }
        }
    }

    bool are_joined(int u, int v) const {
        if (q_.is_best_mode) return cluster_[u] == cluster_[v];
        for (std::size_t s = 0; s < n_.segments.size(); ++s) {
            const auto [a, b] = n_.segments[s];
            if (is_short(static_cast<int>(s)) && ((a == u && b == v) || (a == v && b == u))) {
                return true;
            }
        }
        return false;
    }

    bool is_feasible(double a) {
        bool result = false;
        for (int k = 1; k <= (q_.is_quad ? 2 : 3); ++k) {
            const bool is_above = at_least(a, k * min_);
            const bool is_below = !at_least(a, k * max_);
            result |= is_above && is_below;
        }
        return result;
    }

    /// Ends of e and f through which they are adjacent; {-1, -1} if they are not.
    std::pair<int, int> adjacent_ends(int e, int f) {
        for (const int u : n_.segments[e]) {
            for (const int v : n_.segments[f]) {
                if (u == v) return {u, v};
            }
        }
        std::pair<int, int> ends{-1, -1};
        double nearest = std::numeric_limits<double>::infinity();
        for (const int u : n_.segments[e]) {
            for (const int v : n_.segments[f]) {
                if (!are_joined(u, v) || at_least(distance(u, v), q_.rmin)) continue;
                if (std::abs(distance(u, v) - nearest) < kDoubt) is_doubtful_ = true;
                if (distance(u, v) < nearest) {
                    nearest = distance(u, v);
                    ends = {u, v};
                }
            }
        }
        return ends;
    }

    bool is_angle_feasible(int e, int f, std::pair<int, int> ends) {
        return is_feasible(angle(at(other(e, ends.first)) - at(ends.first),
                                 at(other(f, ends.second)) - at(ends.second)));
    }

    bool in_conflict_paper(int e, int f) {
        const auto ends = adjacent_ends(e, f);
        if (ends.first >= 0) return !is_angle_feasible(e, f, ends);
        const auto [a, b] = n_.segments[e];
        auto [c, d] = n_.segments[f];
        const NumericDistance closest = numeric_distance(at(a), at(b), at(c), at(d));
        if (at_least(closest.distance, q_.rmin)) return false;
        const bool is_interior = is_inside(closest.s) && is_inside(closest.t);
        if (is_interior && !at_least(closest.distance, height_)) return true;
        const double straight = distance(a, c) + distance(b, d);
        const double crossed = distance(a, d) + distance(b, c);
        if (std::abs(straight - crossed) < kDoubt) is_doubtful_ = true;
        if (crossed < straight) std::swap(c, d);
        const bool has_sides =
            at_least(distance(a, c), q_.rmin) && at_least(distance(b, d), q_.rmin);
        const bool has_first = at_least(distance(a, d), q_.rmin);
        const bool has_second = at_least(distance(b, c), q_.rmin);
        if (has_sides && (has_first || has_second)) return false;
        for (const int u : {a, b}) {
            for (const int v : {c, d}) {
                const Vec3 connector = at(v) - at(u);
                const bool is_long_enough = at_least(connector.norm(), q_.rmin);
                const bool has_room_at_e =
                    at_least(angle(at(other(e, u)) - at(u), connector), 2 * triangle_min_);
                const bool has_room_at_f =
                    at_least(angle(at(other(f, v)) - at(v), -connector), 2 * triangle_min_);
                if (is_long_enough && has_room_at_e && has_room_at_f) return false;
            }
        }
        return true;
    }

    /// In doubt when the closest point is hardly off an end.
    bool is_inside(double t) {
        const double margin = std::min(t, 1 - t);
        if (margin > 1e-9 && margin < 1e-4) is_doubtful_ = true;
        return margin > 1e-6;
    }

    bool in_conflict_best(int e, int f) {
        const bool has_short = is_short(e) || is_short(f);
        const auto ends = adjacent_ends(e, f);
        if (ends.first >= 0) {
            if (has_short) return false;
            if (!is_angle_feasible(e, f, ends)) return true;
        } else {
            const auto [a, b] = n_.segments[e];
            const auto [c, d] = n_.segments[f];
            if (!at_least(numeric_distance(at(a), at(b), at(c), at(d)).distance, height_)) {
                return true;
            }
            if (has_short) return false;
        }
        for (const int u : n_.segments[e]) {
            for (const int v : n_.segments[f]) {
                if (u == v || u == ends.first || v == ends.second) continue;
                if (n_.valence(u) != 2 && n_.valence(v) != 2) continue;  // a vertex conflict
                if (!at_least(distance(u, v), q_.rmin)) return true;
            }
        }
        return false;
    }

    const ConflictQuestion& q_;
    const PlainNetwork& n_;
    double min_ = 0, max_ = 0, triangle_min_ = 0, height_ = 0;
    std::vector<int> cluster_;
    bool is_doubtful_ = false;
};

}  // namespace

double deviation(const std::vector<Vec3>& points, int first, int last) {
    double sum = 0;
    for (int k = first; k < last; ++k) {
        const double here = project(points[k], points[first], points[last]).distance;
        const double there = project(points[k + 1], points[first], points[last]).distance;
        sum += (here + there) / 2 * (points[k + 1] - points[k]).norm();
    }
    return sum;
}

ChainAnswer best_chain(const ChainQuestion& question) { return ChainEnumeration(question).run(); }

double chain_cost(const ChainQuestion& question, const std::vector<int>& chain) {
    double cost = 0;
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
        cost += segment_cost(question, chain[k], chain[k + 1]);
    }
    return cost;
}

double PlainNetwork::length(int segment) const {
    return (points[segments[segment][0]] - points[segments[segment][1]]).norm();
}

int PlainNetwork::valence(int point) const {
    int count = 0;
    for (const auto& [a, b] : segments) count += (a == point) + (b == point);
    return count;
}

bool PlainNetwork::share_point(int e, int f) const {
    const auto& a = segments[e];
    const auto& b = segments[f];
    return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
}

PlainNetwork random_network(std::uint64_t seed, int segment_count, double box, bool is_planar,
                            double low, double high) {
    std::mt19937_64 engine(seed);
    const auto uniform = [&](double from, double to) {
        return from + (to - from) * static_cast<double>(engine() >> 11) * 0x1p-53;
    };
    PlainNetwork network;
    while (static_cast<int>(network.segments.size()) < segment_count) {
        const double roll = uniform(0, 1);
        int from = -1;
        if (roll < 0.7 && !network.points.empty()) {
            from = static_cast<int>(engine() % network.points.size());
        } else {
            from = static_cast<int>(network.points.size());
            network.points.emplace_back(uniform(0, box), uniform(0, box),
                                        is_planar ? 0.0 : uniform(0, box / 3));
        }
        Vec3 direction(uniform(-1, 1), uniform(-1, 1), is_planar ? 0.0 : uniform(-1, 1));
        if (direction.norm() < 0.1) direction = Vec3::UnitX();
        const Vec3 to = network.points[from] + uniform(low, high) * direction.normalized();
        network.segments.push_back({from, static_cast<int>(network.points.size())});
        network.points.push_back(to);
    }
    return network;
}

NumericDistance numeric_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
    double low = 0, high = 1;
    const auto value = [&](double s) { return project(a0 + s * (a1 - a0), b0, b1).distance; };
    for (int i = 0; i < 120; ++i) {
        const double left = low + (high - low) / 3;
        const double right = high - (high - low) / 3;
        (value(left) < value(right) ? high : low) = value(left) < value(right) ? right : left;
    }
    // The search stalls about 1e-8 from the minimum, the ends included: take the best of them.
    double s = (low + high) / 2;
    for (const double end : {0.0, 1.0}) {
        if (std::abs(s - end) < 1e-6 && value(end) <= value(s) + 1e-12) s = end;
    }
    const Projection other = project(a0 + s * (a1 - a0), b0, b1);
    return {other.distance, s, other.t};
}

ConflictAnswer all_conflicts(const ConflictQuestion& question) {
    const PlainNetwork& network = question.network;
    Judge judge(question);
    ConflictAnswer answer;
    const int count = static_cast<int>(network.segments.size());
    for (int e = 0; e < count; ++e) {
        for (int f = e + 1; f < count; ++f) {
            judge.reset();
            if (judge.in_conflict(e, f)) answer.conflicts.emplace(e, f);
            if (judge.is_doubtful()) answer.doubtful.emplace(e, f);
        }
    }
    const int point_count = static_cast<int>(network.points.size());
    for (int u = 0; u < point_count; ++u) {
        for (int v = u + 1; v < point_count; ++v) {
            const int valence_u = network.valence(u), valence_v = network.valence(v);
            if (valence_u == 0 || valence_v == 0 || valence_u == 2 || valence_v == 2) continue;
            judge.reset();
            if (judge.are_nodes_close(u, v)) answer.vertex_conflicts.emplace(u, v);
            if (judge.is_doubtful()) answer.doubtful_nodes.emplace(u, v);
        }
    }
    return answer;
}

}  // namespace fcn::test
