#pragma once

#include "meshing/quad_smoothing.h"

namespace fcn {

struct QuadFitOptions {
    QuadSmoothingOptions smoothing;
    double leash = 0.5;           ///< in h: how far free vertices go from where they are, at first
    double tolerance = 0.4;       ///< in h: of the surface from the quads
    double least_jacobian = 0.2;  ///< of quads; worse ones are bad
    int rounds = 4;               ///< of longer and shorter leashes
};

/// Per vertex whether a quad at it has a scaled Jacobian below the least.
std::vector<bool> vertices_of_bad_quads(const QuadMesh& mesh, double least_jacobian);

/// Smooths quads that lie on the surface without leaving parts of it: thin limbs, tips of horns.
/// `samples` are points of the surface. Returns the number of inverted corners. Deterministic.
int fit_quads(QuadMesh& mesh, const QuadConstraints& constraints, const std::vector<Vec3>& samples,
              const ReferenceSurface& reference, const QuadFitOptions& options);

}  // namespace fcn
