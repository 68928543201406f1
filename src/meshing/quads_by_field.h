#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meshing/field_map.h"
#include "meshing/quad_extraction.h"
#include "meshing/remesh_quads.h"

namespace fcn {

/// The steps from a surface to quads. Each can be replaced, so that every failure can be seen.
struct QuadSteps {
    std::function<QuadDomain(const LoadedMesh&, const FeatureCurveNetwork&,
                             const QuadDomainOptions&)>
        domain = make_quad_domain;
    std::function<FieldDesign(const QuadDomain&, const FieldOptions&)> field = design_field;
    std::function<FieldMap(const QuadDomain&, const FieldDesign&, double edge_length)> map =
        map_field;
    /// Where quads of the first map fail that has lines on curves.
    std::function<FieldMap(const QuadDomain&, const FieldDesign&, double edge_length)> soft_map =
        map_field_softly;
    /// Moves singularities away from curves; returns how many. Asked where curves gave way.
    std::function<int(const QuadDomain&, FieldDesign&, double edge_length)> clearance =
        clear_network;
    std::function<QuadExtraction(const Mesh&, const CornerMap&, const RowOptions&)> extraction =
        extract_quads;
    std::function<int(QuadMesh&)> smoothing;  ///< returns the number of inverted corners
};

struct FieldQuads {
    QuadMesh mesh;  ///< empty if no attempt succeeded
    std::vector<QuadAttempt> attempts;
    std::optional<QuadField> field;      ///< of the attempt that succeeded
    double curve_deviation_degrees = 0;  ///< of the field from the network
    bool is_done() const { return !attempts.empty() && attempts.back().reason.empty(); }
    /// Of the attempts that failed, one line; empty: none.
    std::string reason() const;
};

/// remesh_quads (remesh_quads.h) with other steps.
QuadResult remesh_quads(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                        const QuadOptions& options, const QuadSteps& steps);

/// Quads along a cross field, by a map to the plane: with edges as long as asked for or, where that
/// fails, shorter by a tenth each time. Deterministic.
FieldQuads quads_by_field(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                          const QuadOptions& options, const QuadSteps& steps = {});

}  // namespace fcn
