// Neighbour search of the conformity checker: a binary tree of boxes, split at the median of the
// centres along the longest side. A tree rather than a uniform grid, because a network under test
// may be anything: one segment a thousand times longer than the rest would flood a grid's cells.

#include "adaptation/conformity_boxes.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace fcn::conformity {

void Box::add(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
}

void Box::add(const Box& box) {
    low = low.cwiseMin(box.low);
    high = high.cwiseMax(box.high);
}

double Box::distance(const Vec3& point) const {
    return (low - point).cwiseMax(point - high).cwiseMax(0.0).norm();
}

double Box::distance(const Box& box) const {
    return (low - box.high).cwiseMax(box.low - high).cwiseMax(0.0).norm();
}

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    tree_.reserve(boxes_.size() / 2 + 1);
    if (!boxes_.empty()) build(0, static_cast<int>(boxes_.size()));
}

int BoxTree::build(int first, int last) {
    constexpr int kLeafSize = 4;
    const int index = static_cast<int>(tree_.size());
    tree_.push_back({{}, first, last, -1, -1});
    Box box, centres;
    for (int i = first; i < last; ++i) {
        const Box& item = boxes_[order_[i]];
        box.add(item);
        centres.add(Vec3(item.low + item.high));
    }
    tree_[index].box = box;
    if (last - first <= kLeafSize) return index;

    int axis = 0;
    (centres.high - centres.low).maxCoeff(&axis);
    const int middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](int a, int b) {
                         const double centre_a = boxes_[a].low[axis] + boxes_[a].high[axis];
                         const double centre_b = boxes_[b].low[axis] + boxes_[b].high[axis];
                         return centre_a != centre_b ? centre_a < centre_b : a < b;
                     });
    const int left = build(first, middle);
    const int right = build(middle, last);
    tree_[index].left = left;
    tree_[index].right = right;
    return index;
}

void BoxTree::within(const Box& box, double reach, const std::function<void(int)>& visit) const {
    if (tree_.empty()) return;
    std::vector<int> stack{0};
    while (!stack.empty()) {
        const TreeNode& node = tree_[stack.back()];
        stack.pop_back();
        if (node.box.distance(box) > reach) continue;
        if (node.left >= 0) {
            stack.push_back(node.right);
            stack.push_back(node.left);
            continue;
        }
        for (int i = node.first; i < node.last; ++i) {
            if (boxes_[order_[i]].distance(box) <= reach) visit(order_[i]);
        }
    }
}

int BoxTree::closest(const Vec3& point, const std::function<double(int)>& distance) const {
    int best = -1;
    double best_distance = std::numeric_limits<double>::infinity();
    std::vector<std::pair<double, int>> stack;
    if (!tree_.empty()) stack.emplace_back(tree_[0].box.distance(point), 0);
    while (!stack.empty()) {
        const auto [bound, index] = stack.back();
        stack.pop_back();
        if (bound > best_distance) continue;
        const TreeNode& node = tree_[index];
        if (node.left >= 0) {
            std::pair<double, int> near{tree_[node.left].box.distance(point), node.left};
            std::pair<double, int> far{tree_[node.right].box.distance(point), node.right};
            if (far.first < near.first) std::swap(near, far);
            stack.push_back(far);
            stack.push_back(near);
            continue;
        }
        for (int i = node.first; i < node.last; ++i) {
            const double d = distance(order_[i]);
            if (d < best_distance || (d == best_distance && order_[i] < best)) {
                best = order_[i];
                best_distance = d;
            }
        }
    }
    return best;
}

}  // namespace fcn::conformity
