#pragma once

#include <vector>

#include "meshing/quad_mesh.h"
#include "meshing/reference_surface.h"

namespace fcn {

/// What vertices of a quad mesh may do.
struct QuadConstraints {
    static constexpr int kFree = -1;   ///< anywhere on the surface
    static constexpr int kFixed = -2;  ///< stays
    /// Per vertex; >= 0: on this polyline of `curves`.
    std::vector<int> curve;
    /// A vertex that does not lie on its curve is drawn there. One of a single point draws it to
    /// this point.
    std::vector<std::vector<Vec3>> curves;
    /// Per vertex: a free one does not go farther than `leash`, mesh units, from `home`; both
    /// empty: as far as it likes.
    std::vector<Vec3> home;
    std::vector<double> leash;
};

struct QuadSmoothingOptions {
    double edge_length = 0;   ///< h, mesh units, > 0
    int rounds = 20;          ///< of moving every vertex
    double least_sine = 0.3;  ///< moves make no corner worse than this, unless it was before
};

struct QuadSmoothingResult {
    int inverted_before = 0, inverted_after = 0;  ///< corners
    int off_curve = 0;                            ///< vertices that could not come to their curve
};

/// Moves vertices so that quads become more like squares, and those that are not get untangled:
/// back onto the surface or along their curves with each move. A corner that is not inverted stays
/// so. Deterministic; linear time a round.
QuadSmoothingResult smooth_quads(QuadMesh& mesh, const QuadConstraints& constraints,
                                 const ReferenceSurface& reference,
                                 const QuadSmoothingOptions& options);

/// Inverted corners: scaled Jacobian <= 0 against the area vector's direction.
int count_inverted_corners(const QuadMesh& mesh);

/// The point of a polyline that is nearest; of one point: that one.
Vec3 closest_on_polyline(const std::vector<Vec3>& polyline, const Vec3& point);

}  // namespace fcn
