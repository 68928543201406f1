// The one entry to quads: the best way that is asked for and works.
#include "meshing/remesh_quads.h"

#include <chrono>

#include "meshing/quad_smoothing.h"
#include "meshing/quads_by_field.h"

namespace fcn {

QuadResult remesh_quads(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                        const QuadOptions& options) {
    return remesh_quads(mesh, network, options, QuadSteps{});
}

QuadResult remesh_quads(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                        const QuadOptions& options, const QuadSteps& steps) {
    if (options.best_tier == QuadTier::Pairing) return quads_by_pairing(mesh, network, options);
    const auto start = std::chrono::steady_clock::now();
    FieldQuads quads = quads_by_field(mesh, network, options, steps);
    QuadResult result;
    if (quads.is_done()) {
        result.mesh = std::move(quads.mesh);
        result.field = std::move(quads.field);
        result.tier = QuadTier::Field;
        result.edge_length = quads.attempts.back().edge_length;
        result.inverted_corners = count_inverted_corners(result.mesh);
    } else {
        result = quads_by_pairing(mesh, network, options);
    }
    result.reason = quads.reason();
    result.attempts = std::move(quads.attempts);
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace fcn
