#include "app/run_quads.h"

#include <algorithm>

#include "meshing/remesh.h"

namespace fcn::app {

QuadRecord make_quads(const ScaleRecord& scale, const MeshRecord& record,
                      const ReferenceSurface& reference) {
    constexpr double kSampleSpacing = 0.005;  // in diagonals, as measure has it
    QuadOptions options;
    options.edge_length = kEdgeLengthFactor * scale.rmin;
    options.reference = &reference;
    QuadRecord quads;
    quads.result = remesh_quads(record.mesh, scale.adaptation.network, options);
    const double spacing =
        std::min(scale.rmin / 2, kSampleSpacing * bounding_box(record.mesh.mesh).diagonal());
    quads.quality = measure_quads(quads.result.mesh, options.edge_length);
    quads.distance =
        measure_distance(triangle_mesh(quads.result.mesh), record.mesh.mesh, reference, spacing);
    quads.alignment = measure_alignment(quads.result.mesh, scale.adaptation.network, spacing);
    return quads;
}

}  // namespace fcn::app
