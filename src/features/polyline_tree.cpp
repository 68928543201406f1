// A tree of boxes over sample intervals, cut at the median of the longer side. Boxes rather than a
// grid: one long straight interval would flood a grid of small cells.

#include "features/polyline_tree.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace fcn {
namespace {

constexpr int kLeafSize = 4;

auto rank(const PolylinePlace& p) {
    return std::tuple(p.distance, p.position.x(), p.position.y(), p.position.z(), p.arc,
                      p.interval);
}

}  // namespace

const Vec3& PolylineTree::from(const Interval& i) const {
    return network_.arcs[i.arc].samples[i.interval].position;
}

const Vec3& PolylineTree::to(const Interval& i) const {
    return network_.arcs[i.arc].samples[i.interval + 1].position;
}

PolylineTree::PolylineTree(const FeatureCurveNetwork& network) : network_(network) {
    std::vector<Interval> given;
    for (int a = 0; a < static_cast<int>(network.arcs.size()); ++a) {
        const int count = static_cast<int>(network.arcs[a].samples.size());
        for (int i = 0; i + 1 < count; ++i) given.push_back({a, i});
    }
    intervals_ = given;
    for (const Interval& i : intervals_) centers_.push_back((from(i) + to(i)) / 2);
    if (!intervals_.empty()) build(0, static_cast<int>(intervals_.size()));
}

int PolylineTree::build(int first, int last) {
    const int index = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    Eigen::AlignedBox3d box, centers;
    for (int k = first; k < last; ++k) {
        box.extend(from(intervals_[k]));
        box.extend(to(intervals_[k]));
        centers.extend(centers_[k]);
    }
    nodes_[index].box = box;
    nodes_[index].first = first;
    nodes_[index].last = last;
    if (last - first <= kLeafSize) return index;
    Eigen::Index axis = 0;
    centers.sizes().maxCoeff(&axis);
    std::vector<int> order(last - first);
    std::iota(order.begin(), order.end(), first);
    const int middle = (last - first) / 2;
    std::nth_element(order.begin(), order.begin() + middle, order.end(), [&](int a, int b) {
        return std::pair(centers_[a][axis], a) < std::pair(centers_[b][axis], b);
    });
    std::vector<Interval> intervals;
    std::vector<Vec3> moved;
    for (int k : order) {
        intervals.push_back(intervals_[k]);
        moved.push_back(centers_[k]);
    }
    std::ranges::copy(intervals, intervals_.begin() + first);
    std::ranges::copy(moved, centers_.begin() + first);
    build(first, first + middle);
    const int right = build(first + middle, last);
    nodes_[index].right = right;
    return index;
}

PolylinePlace PolylineTree::closest(const Vec3& point, double reach) const {
    PolylinePlace best;
    best.distance = reach;
    std::vector<int> stack;
    if (!nodes_.empty()) stack.push_back(0);
    while (!stack.empty()) {
        const int index = stack.back();
        stack.pop_back();
        const Node& node = nodes_[index];
        if (node.box.exteriorDistance(point) > best.distance) continue;
        if (node.right >= 0) {
            const int left = index + 1;
            const bool is_left_first = nodes_[left].box.squaredExteriorDistance(point) <=
                                       nodes_[node.right].box.squaredExteriorDistance(point);
            stack.push_back(is_left_first ? node.right : left);
            stack.push_back(is_left_first ? left : node.right);
            continue;
        }
        for (int k = node.first; k < node.last; ++k) {
            const Interval& i = intervals_[k];
            const Vec3 u = to(i) - from(i);
            PolylinePlace place{i.arc, i.interval, 0, {}, 0};
            place.t = std::clamp((point - from(i)).dot(u) / u.squaredNorm(), 0.0, 1.0);
            place.position = place.t == 1 ? to(i) : Vec3(from(i) + place.t * u);
            place.distance = (point - place.position).norm();
            if (place.distance > reach) continue;
            if (best.arc < 0 || rank(place) < rank(best)) best = place;
        }
    }
    return best;
}

std::vector<PolylineTree::Interval> PolylineTree::meeting(const Eigen::AlignedBox3d& box) const {
    std::vector<Interval> found;
    std::vector<int> stack;
    if (!nodes_.empty()) stack.push_back(0);
    while (!stack.empty()) {
        const int index = stack.back();
        stack.pop_back();
        const Node& node = nodes_[index];
        if (!node.box.intersects(box)) continue;
        if (node.right >= 0) {
            stack.push_back(node.right);
            stack.push_back(index + 1);
            continue;
        }
        for (int k = node.first; k < node.last; ++k) {
            Eigen::AlignedBox3d own(from(intervals_[k]));
            own.extend(to(intervals_[k]));
            if (own.intersects(box)) found.push_back(intervals_[k]);
        }
    }
    return found;
}

}  // namespace fcn
