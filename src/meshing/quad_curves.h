#pragma once

#include <vector>

#include "meshing/lines_on_curves.h"
#include "meshing/quad_mesh.h"
#include "meshing/quad_smoothing.h"
#include "network/network.h"

namespace fcn {

struct QuadCurveOptions {
    double edge_length = 0;         ///< of the quads, > 0, mesh units
    double reach = 0.75;            ///< in edge lengths: farther vertices do not move to a curve
    double corner_degrees = 40;     ///< boundaries that turn by more have a corner there
    std::vector<bool> is_left_out;  ///< per arc: no lines are moved onto it; empty: none
    LinesOnCurves lines;            ///< that lie on arcs already; empty: none
    std::vector<bool> is_free;      ///< per arc: these lines need not stay on it; empty: none
};

/// Moves lines of edges of a quad mesh onto those of the network's arcs, or parts of them, on which
/// no line lies yet, where there are such lines. All these lines become the mesh's feature edges.
/// Returns what vertices may do from then on: slide along their arc, those at nodes stay there, and
/// boundary vertices stay on the boundary of `surface`, whose corners get a vertex each. Corners of
/// quads may be inverted. Deterministic.
QuadConstraints move_to_curves(QuadMesh& mesh, const Mesh& surface,
                               const FeatureCurveNetwork& network, const QuadCurveOptions& options);

}  // namespace fcn
