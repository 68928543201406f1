#pragma once

#include "geometry/mesh.h"

namespace fcn {

/// Triangle quality, angles in degrees (a person reads them).
struct TriangleQuality {
    std::size_t vertices = 0, faces = 0;
    double min_angle_degrees = 0, mean_min_angle_degrees = 0;
    double share_under_15 = 0;  ///< share of faces whose smallest angle is under 15 degrees, [0, 1]
    double share_under_30 = 0;
    double min_edge = 0, mean_edge = 0, max_edge = 0;  ///< mesh units
};
TriangleQuality measure_triangles(const Mesh& mesh);

/// Two-sided sampled Hausdorff distance and means, mesh units.
struct MeshDistance {
    double hausdorff = 0, forward = 0, backward = 0, mean_forward = 0, mean_backward = 0;
    std::size_t samples = 0;
    double diagonal = 0;  ///< of the reference
};
MeshDistance measure_distance(const Mesh& mesh, const Mesh& reference, double sample_spacing);

}  // namespace fcn
