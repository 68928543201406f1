#pragma once

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

enum class CrestKind { Both, Ridges, Ravines };

/// A line is kept if it reaches every threshold; see docs/detectors/crest.md for the definitions.
struct CrestOptions {
    CrestKind kind = CrestKind::Both;
    double rings = 0;   ///< radius of the fits in local edge lengths, >= 1.5; 0 = chosen by noise
    double radius = 0;  ///< the same in mesh units, instead of rings where > 0
    double min_significance = 14;     ///< fall of e across a fit over its standard error
    double min_sharpness = 1.2;       ///< curvature's fall across the line over its cube
    double min_ridgeness = 0.5;       ///< integral of |kappa| along the line
    double min_sphericalness = 0.05;  ///< mean window of the shape index, 0 to 1
    double min_cyclideness = 0;       ///< length times integral of sqrt(e_max^2 + e_min^2)
    double min_length = 0;            ///< mesh units
    double min_radii = 2;             ///< length in radii of the fits
    double gap = 3;                   ///< bridged, in local edge lengths; 0 = none
    double snap = 0.05;               ///< of an edge: nearer crossings lie on its vertex
    bool is_sharp_first = true;       ///< sharp edges (detect_sharp's) are arcs, and fits end there
    double sharp_angle = 0.6981317007977318;      ///< radians (40 degrees), as SharpOptions
    double sharp_low_angle = 0.3141592653589793;  ///< radians (18 degrees)
    int threads = 1;
};

/// Ridges and ravines (Yoshizawa, Belyaev, Seidel 2005) and, unless told otherwise, the sharp edges
/// at which they end. Arcs are polylines from mesh edge to mesh edge; `source` is "crest-ridge",
/// "crest-ravine" or "sharp"; the arcs of one line share a patch id, so that its curve is its own.
/// Deterministic on any number of threads. Throws InputError on options out of range.
FeatureCurveNetwork detect_crest(const LoadedMesh& mesh, const CrestOptions& options = {});

}  // namespace fcn
