#pragma once

#include "meshing/field_design.h"
#include "meshing/hard_curves.h"

namespace fcn {

struct ClearanceOptions {
    double edge_length = 0;          ///< h of the quads, > 0, mesh units
    double near = 0.5;               ///< in h: singularities nearer to a curve than that are moved
    double away = 0.7;               ///< in h: at least so far from curves and from each other
    double farthest = 1.2;           ///< in h: the way that one of them moves
    double curve_strength = 20;      ///< as FieldOptions::curve_strength
    double boundary_strength = 1e4;  ///< as FieldOptions::boundary_strength
};

/// Moves singularities beside curves that are to be lines of the grid away from them or, those with
/// five quads and more, onto them. Updates the angles; returns how many moved. If the new angles
/// cannot be solved for, nothing changes. Deterministic.
int clear_curves(const QuadDomain& domain, const std::vector<HardCurve>& curves,
                 const ClearanceOptions& options, FieldDesign& design);

}  // namespace fcn
