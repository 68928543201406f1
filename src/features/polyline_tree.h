#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "network/network.h"

namespace fcn {

/// A place on an arc of a network: in an interval between two samples.
struct PolylinePlace {
    int arc = -1;  ///< -1 = nothing found
    int interval = 0;
    double t = 0;  ///< in [0, 1] within the interval
    Vec3 position = Vec3::Zero();
    double distance = 0;  ///< from the point asked for
};

/// The sample intervals of a network's arcs in a tree of boxes. Keeps a reference to the network.
/// Building takes O(n log n); queries do not depend on the order of arcs but where arcs coincide.
class PolylineTree {
public:
    struct Interval {
        int arc = -1;
        int interval = 0;
    };

    explicit PolylineTree(const FeatureCurveNetwork& network);

    /// The closest place within `reach` of a point; ties go to the smaller position, then arc.
    PolylinePlace closest(const Vec3& point, double reach) const;
    /// Intervals whose boxes meet `box`.
    std::vector<Interval> meeting(const Eigen::AlignedBox3d& box) const;
    const Vec3& from(const Interval& i) const;
    const Vec3& to(const Interval& i) const;

private:
    struct Node {
        Eigen::AlignedBox3d box;
        int first = 0, last = 0;  ///< intervals, of a leaf
        int right = -1;           ///< second child; the first is the next node; -1 = leaf
    };
    int build(int first, int last);

    const FeatureCurveNetwork& network_;
    std::vector<Interval> intervals_;
    std::vector<Vec3> centers_;
    std::vector<Node> nodes_;
};

}  // namespace fcn
