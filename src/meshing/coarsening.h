#pragma once

#include "meshing/marked_mesh.h"

namespace fcn {

struct CoarseningOptions {
    double edge_length = 0;  ///< target L, > 0
    /// Edges below 4/5 L are collapsed, if that makes none longer than 4/3 L.
    int max_rounds = 12;
};

/// Collapses short edges and flips bad ones so that marked chains between fixed vertices become
/// single edges wherever no face turns over; splits marked edges longer than 4/3 L. Chains of
/// features and borders keep their vertices' places; no vertex moves. Deterministic.
MarkedMesh coarsen(const MarkedMesh& input, const CoarseningOptions& options);

}  // namespace fcn
