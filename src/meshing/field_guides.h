#pragma once

#include <vector>

#include "meshing/quad_domain.h"

namespace fcn {

/// A direction that an arm of a cross field should have.
struct FieldGuide {
    int face = -1;
    double angle = 0;   ///< in the face's frame (cross_field.h), radians, modulo a quarter
    double weight = 0;  ///< > 0, in the unit of FaceLink::stiffness
};

/// Along the network, both sides of each edge: strength * importance * length / edge_length, so
/// that the refinement of the mesh does not matter.
std::vector<FieldGuide> curve_guides(const QuadDomain& domain, double edge_length, double strength);

/// Along boundaries.
std::vector<FieldGuide> boundary_guides(const Mesh& mesh, double edge_length, double strength);

/// Along principal curvature directions averaged over a ball of radius edge_length: strength * area
/// / edge_length^2 * how much the surface bends differently in the two directions, up to 1.
std::vector<FieldGuide> curvature_guides(const Mesh& mesh, double edge_length, double strength);

}  // namespace fcn
