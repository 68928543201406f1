// What remains of an arc beside a network that goes before it. The arc is probed at steps of half
// the reach. A stretch runs along the network if the closest places on it advance as the probes do:
// this compares neither tangents (detectors' polylines zigzag along mesh edges) nor samples (they
// lie anywhere), and a crossing arc, whose closest places stand still, is told from one that joins.
// What is close but on the other side of a thin wall is known by its normals. The rest of the arc
// is cut where it crosses the network, seen in the tangent plane since chords of two polylines pass
// each other in space, and where it passes a loose end. A piece that hangs on the network and lies
// wholly within twice the reach of it says nothing new and goes.

#include "features/combine_cuts.h"

#include <algorithm>
#include <cmath>

namespace fcn {
namespace {

constexpr double kProbesPerReach = 2;
constexpr int kWindow = 3;              ///< probes to either side that show where the arc goes
constexpr double kAdvance = 0.8;        ///< cosine up to which a stretch runs along
constexpr int kJoinAhead = 3;           ///< probes into the fused stretch at which a piece joins
constexpr double kMostProbes = 4096;    ///< of one interval
constexpr double kOppositeSide = -0.5;  ///< cosine between normals across a thin wall
constexpr double kRounding = 1e-9;

bool is_opposite(const Vec3& a, const Vec3& b) {
    return a.dot(b) < kOppositeSide * a.norm() * b.norm();
}

}  // namespace

/// A point of the later arc; `at` counts sample intervals.
struct ArcCutter::Probe {
    double at = 0;
    Vec3 position;
    PolylinePlace place;
    bool is_fused = false;
};

/// Where a piece begins or ends.
struct ArcCutter::Event {
    double at = 0;
    PolylinePlace place;       ///< arc = -1: a node of the arc's own
    bool is_trimmed = false;   ///< the arc itself goes on: its point stays beside the place
    bool is_dead_end = false;  ///< of an own node
};

struct ArcCutter::Line {
    std::vector<ArcSample> samples;
    std::vector<Vec3> normals;
    std::vector<Probe> probes;
    double last() const { return static_cast<double>(samples.size() - 1); }
};

ArcCutter::ArcCutter(const FeatureCurveNetwork& earlier, const PolylineTree& tree,
                     const SurfaceLines& lines, double reach)
    : earlier_(earlier), tree_(tree), lines_(lines), reach_(reach), valences_(earlier.valences()) {
    for (const NetworkArc& arc : earlier.arcs) {
        normals_.emplace_back();
        for (const ArcSample& sample : arc.samples)
            normals_.back().push_back(lines.normal(sample.surface));
    }
}

Vec3 ArcCutter::normal_at(const PolylinePlace& place) const {
    const std::vector<Vec3>& normals = normals_[place.arc];
    return (1 - place.t) * normals[place.interval] + place.t * normals[place.interval + 1];
}

PolylinePlace ArcCutter::closest(const Vec3& point, const Vec3& normal, double reach) const {
    const PolylinePlace place = tree_.closest(point, reach);
    return place.arc >= 0 && is_opposite(normal, normal_at(place)) ? PolylinePlace() : place;
}

PolylinePlace ArcCutter::place_of(const NetworkNode& node) const {
    return closest(node.position, lines_.normal(node.surface), reach_);
}

ArcCutter::Line ArcCutter::make_line(const std::vector<ArcSample>& samples) const {
    Line line{samples, {}, {}};
    for (const ArcSample& sample : samples) line.normals.push_back(lines_.normal(sample.surface));
    const auto add = [&](std::size_t i, double t) {
        Probe probe;
        probe.at = static_cast<double>(i) + t;
        probe.position = samples[i].position;
        Vec3 normal = line.normals[i];
        if (t > 0) {
            probe.position = (1 - t) * probe.position + t * samples[i + 1].position;
            normal = (1 - t) * normal + t * line.normals[i + 1];
        }
        probe.place = closest(probe.position, normal, 3 * reach_);
        line.probes.push_back(probe);
    };
    for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
        const double length = (samples[i + 1].position - samples[i].position).norm();
        const int steps = static_cast<int>(
            std::clamp(std::ceil(kProbesPerReach * length / reach_ - kRounding), 1.0, kMostProbes));
        for (int k = 0; k < steps; ++k) add(i, static_cast<double>(k) / steps);
    }
    add(samples.size() - 1, 0);
    for (std::size_t k = 0; k < line.probes.size(); ++k)
        line.probes[k].is_fused = is_along(line.probes, k);
    return line;
}

bool ArcCutter::is_along(const std::vector<Probe>& probes, std::size_t k) const {
    const auto is_near = [&](std::size_t i) { return probes[i].place.arc >= 0; };
    if (!is_near(k) || probes[k].place.distance > reach_) return false;
    const double window = kWindow * reach_ / kProbesPerReach;
    std::size_t first = k, last = k;
    const auto walked = [&](std::size_t i) {
        return (probes[i].position - probes[k].position).norm();
    };
    while (first > 0 && is_near(first - 1) && walked(first) < window) --first;
    while (last + 1 < probes.size() && is_near(last + 1) && walked(last) < window) ++last;
    const double went = (probes[last].position - probes[first].position).norm();
    const double moved = (probes[last].place.position - probes[first].place.position).norm();
    return moved >= kAdvance * went - kRounding * reach_;
}

ArcSample ArcCutter::sample_at(const Line& line, double at) const {
    const auto i = std::min(static_cast<std::size_t>(at), line.samples.size() - 2);
    return lines_.between(line.samples[i], line.samples[i + 1], at - static_cast<double>(i));
}

std::vector<ArcCutter::Event> ArcCutter::crossings(const Line& line, double from, double to) const {
    std::vector<Event> events;
    const auto end = std::min(static_cast<std::size_t>(std::ceil(to)), line.samples.size() - 1);
    for (auto i = static_cast<std::size_t>(from); i < end; ++i) {
        const Vec3& p = line.samples[i].position;
        const Vec3 u = line.samples[i + 1].position - p;
        Eigen::AlignedBox3d box(p);
        box.extend(line.samples[i + 1].position);
        box.min().array() -= reach_;
        box.max().array() += reach_;
        for (const PolylineTree::Interval& interval : tree_.meeting(box)) {
            const Vec3& q = tree_.from(interval);
            const Vec3 v = tree_.to(interval) - q, w = q - p;
            Vec3 normal = line.normals[i] + line.normals[i + 1];
            if (normal.isZero()) normal = u.cross(v);
            const double determinant = normal.dot(u.cross(v));
            if (std::abs(determinant) <= kRounding * normal.norm() * u.norm() * v.norm()) continue;
            const double s = normal.dot(w.cross(v)) / determinant;
            const double t = normal.dot(w.cross(u)) / determinant;
            if (std::min(s, t) < -kRounding || std::max(s, t) > 1 + kRounding) continue;
            PolylinePlace place{interval.arc, interval.interval, std::clamp(t, 0.0, 1.0), {}, 0};
            place.position = q + place.t * v;
            place.distance = (p + s * u - place.position).norm();
            const double at = static_cast<double>(i) + std::clamp(s, 0.0, 1.0);
            if (place.distance > reach_ || at < from || at > to) continue;
            if (!is_opposite(normal, normal_at(place))) events.push_back({at, place});
        }
    }
    return events;
}

std::vector<ArcCutter::Event> ArcCutter::touched_dead_ends(const Line& line, std::size_t first,
                                                           std::size_t last) const {
    std::vector<Event> events;
    int open_node = -1;
    for (std::size_t k = first; k <= last; ++k) {
        const PolylinePlace& place = line.probes[k].place;
        int node = -1;
        if (place.arc >= 0 && place.distance <= reach_) {
            const NetworkArc& arc = earlier_.arcs[place.arc];
            if (place.interval == 0 && place.t == 0) node = arc.nodes[0];
            if (place.interval + 2 == static_cast<int>(arc.samples.size()) && place.t == 1)
                node = arc.nodes[1];
            if (node >= 0 && valences_[node] != 1) node = -1;
        }
        if (node >= 0 && node != open_node) events.push_back({line.probes[k].at, place});
        if (node >= 0 && node == open_node && place.distance < events.back().place.distance)
            events.back() = {line.probes[k].at, place};
        open_node = node;
    }
    return events;
}

/// Adds the piece between two events unless it says nothing new. `is_held`: it must stay, since an
/// own node with other arcs would lose it.
void ArcCutter::add_piece(const Line& line, const Event& from, const Event& to, bool is_held,
                          ArcCuts& cuts) const {
    bool is_near = true;
    std::vector<PolylinePlace> places;
    auto probe = std::ranges::lower_bound(line.probes, from.at, {}, &Probe::at);
    for (; probe != line.probes.end() && probe->at <= to.at; ++probe) {
        is_near = is_near && probe->place.arc >= 0 && probe->place.distance <= 2 * reach_;
        places.push_back(probe->place);
    }
    const bool is_attached = from.place.arc >= 0 || to.place.arc >= 0;
    if (is_attached && is_near && !is_held) {
        if (!places.empty()) cuts.fused.push_back(std::move(places));
        return;
    }
    ArcPiece piece;
    piece.attachments = {from.place, to.place};
    if (from.place.arc < 0 || from.is_trimmed) piece.samples.push_back(sample_at(line, from.at));
    for (auto i = static_cast<std::size_t>(from.at) + 1; static_cast<double>(i) < to.at; ++i)
        piece.samples.push_back(line.samples[i]);
    if (to.place.arc < 0 || to.is_trimmed) piece.samples.push_back(sample_at(line, to.at));
    cuts.pieces.push_back(std::move(piece));
}

/// The probes [first, last] are a run of those that are not fused.
void ArcCutter::add_run(const Line& line, std::size_t first, std::size_t last,
                        const std::array<CutEnd, 2>& ends, ArcCuts& cuts) const {
    const std::size_t count = line.probes.size();
    const auto own = [&](int side) {
        return Event{side == 0 ? 0.0 : line.last(), ends[side].place, false,
                     ends[side].is_dead_end};
    };
    Event begin = own(0), end = own(1);
    if (first > 0) {
        std::size_t k = first - 1;
        for (int ahead = 1; ahead < kJoinAhead && k > 0 && line.probes[k - 1].is_fused; ++ahead)
            --k;
        begin = {line.probes[first].at, line.probes[k].place, true};
    }
    if (last + 1 < count) {
        std::size_t k = last + 1;
        for (int ahead = 1; ahead < kJoinAhead && k + 1 < count && line.probes[k + 1].is_fused;
             ++ahead)
            ++k;
        end = {line.probes[last].at, line.probes[k].place, true};
    }
    std::vector<Event> events = crossings(line, begin.at, end.at);
    const std::vector<Event> touched = touched_dead_ends(line, first, last);
    events.insert(events.end(), touched.begin(), touched.end());
    std::ranges::stable_sort(events, {}, &Event::at);
    events.insert(events.begin(), begin);
    events.push_back(end);
    for (std::size_t k = 1; k < events.size(); ++k) {
        const auto is_holding = [](const Event& e) { return e.place.arc < 0 && !e.is_dead_end; };
        add_piece(line, events[k - 1], events[k],
                  is_holding(events[k - 1]) || is_holding(events[k]), cuts);
    }
}

void ArcCutter::cut_line(const Line& line, const std::array<CutEnd, 2>& ends, ArcCuts& cuts) const {
    const std::size_t count = line.probes.size();
    for (std::size_t k = 0; k < count;) {
        std::size_t next = k;
        while (next < count && line.probes[next].is_fused == line.probes[k].is_fused) ++next;
        if (line.probes[k].is_fused) {
            cuts.fused.emplace_back();
            for (; k < next; ++k) cuts.fused.back().push_back(line.probes[k].place);
        } else {
            add_run(line, k, next - 1, ends, cuts);
        }
        k = next;
    }
}

std::vector<ArcSample> ArcCutter::rotated(const std::vector<ArcSample>& samples, double at) const {
    const auto i = static_cast<std::size_t>(at);
    const double t = at - static_cast<double>(i);
    std::vector<ArcSample> result;
    if (t > 0) result.push_back(lines_.between(samples[i], samples[i + 1], t));
    const std::size_t start = t > 0 ? i + 1 : i;
    const std::size_t count = samples.size() - 1;
    for (std::size_t k = 0; k < count; ++k) result.push_back(samples[(start + k) % count]);
    result.push_back(result.front());
    return result;
}

ArcCuts ArcCutter::cut(const NetworkArc& arc, const std::array<CutEnd, 2>& ends,
                       bool is_ring) const {
    ArcCuts cuts;
    Line line = make_line(arc.samples);
    if (!is_ring) {
        cut_line(line, ends, cuts);
        return cuts;
    }
    // A ring has no ends of its own: it starts where it touches the network first.
    Event start{-1, {}};
    for (const Probe& probe : line.probes) {
        if (probe.is_fused && start.at < 0) start = {probe.at, probe.place};
    }
    if (start.at < 0) {
        std::vector<Event> events = crossings(line, 0, line.last());
        const std::vector<Event> touched = touched_dead_ends(line, 0, line.probes.size() - 1);
        events.insert(events.end(), touched.begin(), touched.end());
        std::ranges::stable_sort(events, {}, &Event::at);
        if (!events.empty()) start = events.front();
    }
    if (start.at < 0) {
        cuts.pieces.push_back({arc.samples, {}});
        return cuts;
    }
    line = make_line(rotated(arc.samples, std::min(start.at, line.last() - kRounding)));
    const CutEnd end{start.place, false};
    cut_line(line, {end, end}, cuts);
    return cuts;
}

}  // namespace fcn
