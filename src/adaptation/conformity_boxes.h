#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "geometry/mesh.h"

namespace fcn::conformity {

/// Axis-parallel box, empty by default.
struct Box {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

    void add(const Vec3& point);
    void add(const Box& box);
    /// Distance to a point or box, 0 when they meet.
    double distance(const Vec3& point) const;
    double distance(const Box& box) const;
};

/// Static tree of boxes halved at the median centre: the checker's own neighbour search. A query
/// visits O(log n + answers) nodes for boxes of similar size, however large the longest is.
class BoxTree {
public:
    explicit BoxTree(std::vector<Box> boxes);

    /// Calls `visit(item)` for every item whose box lies within `reach` of `box`.
    void within(const Box& box, double reach, const std::function<void(int)>& visit) const;

    /// Item of least `distance(item)`, the lowest index among equals; -1 when empty. `distance`
    /// must be at least the distance of `point` to the item's box.
    int closest(const Vec3& point, const std::function<double(int)>& distance) const;

private:
    struct TreeNode {
        Box box;
        int first = 0, last = 0;    ///< range in order_
        int left = -1, right = -1;  ///< children; -1 in a leaf
    };
    int build(int first, int last);

    std::vector<Box> boxes_;
    std::vector<int> order_;
    std::vector<TreeNode> tree_;
};

}  // namespace fcn::conformity
