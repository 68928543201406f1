#pragma once

#include <array>
#include <vector>

#include "features/local_fit.h"
#include "features/mesh_arrays.h"

namespace fcn {

/// Where a crest line crosses a mesh edge, runs through a vertex, or forks inside a face. For
/// ravines all curvatures are those of the surface turned inside out.
struct CrestPoint {
    Vec3 position = Vec3::Zero();
    SurfacePoint surface;
    int vertex = -1;         ///< mesh vertex it lies on; -1 none
    int edge = -1;           ///< mesh edge whose crossing it is; -1 inside a face
    double kappa = 0;        ///< the extremal curvature, > 0, 1/length
    double kappa_other = 0;  ///< the other principal curvature, |kappa_other| < kappa
    double cyclideness = 0;  ///< sqrt(e_max^2 + e_min^2), 1/length^2
    double drop = 0;         ///< by how much e falls along the edge, 1/length^2
    double run = 0;          ///< length of the edge across the line
    double e_error = 0;      ///< standard error of e
    double radius = 0;       ///< of the neighbourhoods fitted
};

/// Points and the pieces between them, each inside one face.
struct CrestGraph {
    std::vector<CrestPoint> points;
    std::vector<std::array<int, 2>> pieces;
    std::vector<int> piece_faces;  ///< -1: bridges a gap
};

/// Ridges (or ravines) of the fitted surface. Linear time, deterministic.
CrestGraph find_crests(const MeshArrays& arrays, const std::vector<VertexFit>& fits,
                       bool is_ravine);

}  // namespace fcn
