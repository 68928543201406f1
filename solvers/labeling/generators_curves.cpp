// Bundles of curves that run side by side, as feature lines do on machined parts, and cross other
// bundles. A curve of the plane family is a wavy line through the square; one of the sphere family
// is a circle, closed. Each is cut into segments of equal length. What binds them follows the
// adaptation of feature networks: segments of different curves whose midpoints or ends are closer
// than 1 are in conflict unless they meet in a node; successive segments of a curve earn a bonus of
// lambda0 times their mean weight; where curves cross, a node has up to four ends, of which two may
// stay unless its keep-label is on, and keep-labels of nodes closer than 1 are in conflict; a
// segment shorter than 1 needs a neighbour on its curve, and what conflicts with it may not stand
// between both of its neighbours. Weights are length times the curve's strength, in 1/1000.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "labeling/errors.h"
#include "labeling/generators.h"
#include "labeling/random.h"

namespace labeling {
namespace {

using Point = std::array<double, 3>;

constexpr double kUnits = 1000;
constexpr double kCrossing =
    0.35;  ///< midpoints closer than this share of a segment's length cross
constexpr double kPi = std::numbers::pi;

double distance(const Point& a, const Point& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

struct Segment {
    int bundle = 0, curve = 0;
    Point from{}, middle{}, to{};
    double length = 0;
    Label before = -1, after = -1;  ///< on the same curve
};

class CurveFamily {
public:
    explicit CurveFamily(const CurveFamilyOptions& options)
        : options_(options), random_(options.seed) {}

    GeneratedProblem run() {
        for (int bundle = 0; bundle < options_.bundles; ++bundle) {
            if (options_.surface == CurveFamilyOptions::Surface::Plane) {
                plane_bundle(bundle);
            } else {
                sphere_bundle(bundle);
            }
        }
        if (segments_.empty()) builder_.add_label(1);  // all curves missed the square
        find_close();
        add_crossings();
        for (const auto& [i, j] : conflicts_) builder_.add_conflict(i, j);
        add_short_rules();
        builder_.set_units_per_one(kUnits);
        return {builder_.build(), std::nullopt};
    }

private:
    /// Parallel wavy lines through the square, clipped to it.
    void plane_bundle(int bundle) {
        const double angle = kPi * random_.unit(), side = options_.extent;
        const double wave = 0.1 * side * random_.unit(), phase = 2 * kPi * random_.unit();
        const double offset = side * (random_.unit() - 0.5);
        const double across = std::cos(angle), along = std::sin(angle);
        for (int c = 0; c < options_.curves; ++c) {
            const double shift = offset + c * options_.spacing;
            const auto at = [&](double t) {
                const double sideways = shift + wave * std::sin(2 * kPi * t / side + phase);
                return Point{t * across - sideways * along, t * along + sideways * across, 0};
            };
            std::vector<std::vector<Point>> runs(1);
            for (double t = -side; t <= side; t += 1 / options_.density) {
                const Point p = at(t);
                if (std::max(std::abs(p[0]), std::abs(p[1])) <= side / 2) {
                    runs.back().push_back(p);
                } else if (!runs.back().empty()) {
                    runs.emplace_back();
                }
            }
            for (const auto& points : runs) add_curve(bundle, points, false);
        }
    }

    /// Circles of latitude around a random axis.
    void sphere_bundle(int bundle) {
        const double radius = options_.extent / 2;
        const double z = 2 * random_.unit() - 1, turn = 2 * kPi * random_.unit();
        const double flat = std::sqrt(std::max(0.0, 1 - z * z));
        const Point axis{flat * std::cos(turn), flat * std::sin(turn), z};
        const Point u = std::abs(z) < 0.9 ? normalised({-axis[1], axis[0], 0})
                                          : normalised({0, -axis[2], axis[1]});
        const Point v{axis[1] * u[2] - axis[2] * u[1], axis[2] * u[0] - axis[0] * u[2],
                      axis[0] * u[1] - axis[1] * u[0]};
        const double first = 0.4 * kPi * (random_.unit() - 0.5);
        for (int c = 0; c < options_.curves; ++c) {
            const double latitude = first + c * options_.spacing / radius;
            if (std::abs(latitude) > 0.48 * kPi) continue;
            const double ring = radius * std::cos(latitude), height = radius * std::sin(latitude);
            const int count = std::max(3, static_cast<int>(2 * kPi * ring * options_.density));
            std::vector<Point> points;
            for (int k = 0; k < count; ++k) {
                const double a = ring * std::cos(2 * kPi * k / count);
                const double b = ring * std::sin(2 * kPi * k / count);
                Point p;
                for (int d = 0; d < 3; ++d) p[d] = height * axis[d] + a * u[d] + b * v[d];
                points.push_back(p);
            }
            add_curve(bundle, points, true);
        }
    }

    static Point normalised(Point p) {
        const double length = std::hypot(p[0], p[1], p[2]);
        for (double& x : p) x /= length;
        return p;
    }

    void add_curve(int bundle, const std::vector<Point>& points, bool is_closed) {
        if (points.size() < 2) return;
        const double strength = 0.2 + 0.8 * random_.unit();
        const std::size_t count = is_closed ? points.size() : points.size() - 1;
        const auto first = static_cast<Label>(segments_.size());
        for (std::size_t k = 0; k < count; ++k) {
            Segment s{bundle, curve_count_, points[k], {}, points[(k + 1) % points.size()]};
            for (int d = 0; d < 3; ++d) s.middle[d] = (s.from[d] + s.to[d]) / 2;
            s.length = distance(s.from, s.to);
            const Label i = builder_.add_label(worth(s.length * strength * noise()));
            if (k > 0) link(s, i);
            segments_.push_back(s);
            weights_.push_back(s.length * strength);
            if (k > 0) bonus(i - 1, i);
        }
        if (is_closed && count > 2) {
            const auto last = static_cast<Label>(segments_.size()) - 1;
            segments_[first].before = last;
            segments_[last].after = first;
            bonus(first, last);
        }
        ++curve_count_;
    }

    void link(Segment& s, Label i) {
        s.before = i - 1;
        segments_[i - 1].after = i;
    }

    double noise() { return 0.8 + 0.4 * random_.unit(); }
    static Value worth(double real) { return static_cast<Value>(std::llround(kUnits * real)); }

    void bonus(Label i, Label j) {
        const double mean = (weights_[i] + weights_[j]) / 2;
        builder_.add_bonus(i, j, worth(options_.lambda0 * mean * noise()));
    }

    /// Pairs of segments of different curves, closer than 1, by a grid of cells that a segment and
    /// its surroundings reach at most the next of.
    void find_close() {
        const double cell = 1 + 1 / options_.density;
        std::map<std::array<int, 3>, std::vector<Label>> cells;
        const auto count = static_cast<Label>(segments_.size());
        for (Label i = 0; i < count; ++i) {
            std::array<int, 3> at{};
            for (int d = 0; d < 3; ++d) {
                at[d] = static_cast<int>(std::floor(segments_[i].middle[d] / cell));
            }
            for (int k = 0; k < 27; ++k) {
                const auto found =
                    cells.find({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1});
                if (found == cells.end()) continue;
                for (Label j : found->second) relate(j, i);
            }
            cells[at].push_back(i);
        }
    }

    void relate(Label i, Label j) {
        const Segment &a = segments_[i], &b = segments_[j];
        if (a.curve == b.curve) return;
        double least = distance(a.middle, b.middle);
        const double crossing = kCrossing * std::min(a.length, b.length);
        if (a.bundle != b.bundle && least < crossing && a.after >= 0 && b.after >= 0) {
            crossings_.emplace_back(i, j);
        }
        for (const Point& p : {a.from, a.middle, a.to}) {
            for (const Point& q : {b.from, b.middle, b.to}) least = std::min(least, distance(p, q));
        }
        if (least < 1) conflicts_.insert({i, j});
    }

    /// The node stands at the end of both first segments; their successors start there.
    void add_crossings() {
        std::vector<std::pair<Point, Label>> keeps;
        std::set<Label> used;
        for (const auto& [i, j] : crossings_) {
            const std::array<Label, 4> ends{i, segments_[i].after, j, segments_[j].after};
            if (std::any_of(ends.begin(), ends.end(), [&](Label e) { return used.contains(e); })) {
                continue;
            }
            used.insert(ends.begin(), ends.end());
            for (Label a : ends) {
                for (Label b : ends) conflicts_.erase({a, b});
            }
            const Label keep = builder_.add_label(0);
            Rule valence{Relation::LessEqual, 2, {}};
            for (Label e : ends) valence.terms.push_back({1, e});
            valence.terms.push_back({-2, keep});
            builder_.add_rule(std::move(valence));
            const Point place = segments_[i].to;
            for (const auto& [other, label] : keeps) {
                if (distance(place, other) < 1) builder_.add_conflict(label, keep);
            }
            keeps.emplace_back(place, keep);
        }
    }

    void add_short_rules() {
        std::map<Label, std::vector<Label>> enemies;
        for (const auto& [i, j] : conflicts_) {
            enemies[i].push_back(j);
            enemies[j].push_back(i);
        }
        for (Label i = 0; i < static_cast<Label>(segments_.size()); ++i) {
            const Segment& s = segments_[i];
            if (s.length >= 1 || s.before < 0 || s.after < 0 || s.before == s.after) continue;
            builder_.add_rule({Relation::LessEqual, 0, {{1, i}, {-1, s.before}, {-1, s.after}}});
            for (Label e : enemies[i]) {
                const bool is_bound = conflicts_.contains(std::minmax(e, s.before)) ||
                                      conflicts_.contains(std::minmax(e, s.after)) ||
                                      e == s.before || e == s.after;
                if (is_bound) continue;
                builder_.add_rule({Relation::LessEqual, 2, {{1, s.before}, {1, s.after}, {1, e}}});
            }
        }
    }

    const CurveFamilyOptions& options_;
    Random random_;
    ProblemBuilder builder_;
    std::vector<Segment> segments_;
    std::vector<double> weights_;
    std::vector<std::pair<Label, Label>> crossings_;
    std::set<std::pair<Label, Label>> conflicts_;  ///< first < second
    int curve_count_ = 0;
};

}  // namespace

GeneratedProblem curve_family(const CurveFamilyOptions& options) {
    if (options.bundles < 1 || options.curves < 1 || !(options.extent >= 2) ||
        !(options.spacing > 0) || !(options.density > 0) || !(options.lambda0 >= 0)) {
        throw InputError(
            "a family of curves needs bundles, curves, an extent of at least 2, and a "
            "positive spacing and density");
    }
    return CurveFamily(options).run();
}

}  // namespace labeling
