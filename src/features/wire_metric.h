#pragma once

#include <cmath>
#include <vector>

#include "features/mesh_arrays.h"

namespace fcn {

struct WireMetricOptions {
    double length = 0;           ///< l: features of this width and above attract; mesh units, > 0
    double attraction = 5;       ///< gamma >= 0; 0 = isotropic
    double max_anisotropy = 15;  ///< >= 1; how much cheaper a step along a feature can be
    int threads = 1;
};

/// What a step on the surface costs: its length, but 1 / gain of it along a feature.
class WireMetric {
public:
    WireMetric(const MeshArrays& arrays, const WireMetricOptions& options);

    /// Cost of a straight step d within a face.
    double across(int face, const Vec3& d) const;
    /// Cost per length of a step along an edge.
    double along(int edge) const { return edge_costs_[edge]; }
    /// Direction in which steps in a face are cheap, unit length; zero where none is.
    const Vec3& direction(int face) const { return directions_[face]; }
    /// How much cheaper, >= 1.
    double gain(int face) const { return gains_[face]; }

private:
    std::vector<Vec3> directions_;
    std::vector<Vec3> pulls_;  ///< the same, as long as makes its square 1 - 1 / gain^2
    std::vector<double> gains_;
    std::vector<double> edge_costs_;
};

inline double WireMetric::across(int face, const Vec3& d) const {
    const double part = d.dot(pulls_[face]);
    const double rest = d.squaredNorm() - part * part;
    return rest > 0 ? std::sqrt(rest) : 0;
}

}  // namespace fcn
