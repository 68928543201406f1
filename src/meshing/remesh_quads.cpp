// The one entry to quads: the best way that is asked for and works.
#include "meshing/remesh_quads.h"

namespace fcn {

QuadResult remesh_quads(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                        const QuadOptions& options) {
    return quads_by_pairing(mesh, network, options);
}

}  // namespace fcn
