#pragma once

#include "meshing/reference_surface.h"
#include "report/report.h"

namespace fcn::app {

/// Quads of edge length 1.2 rmin on the adapted network of `scale`, and their measures.
QuadRecord make_quads(const ScaleRecord& scale, const MeshRecord& record,
                      const ReferenceSurface& reference);

}  // namespace fcn::app
