#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meshing/field_design.h"
#include "meshing/quad_extraction.h"
#include "meshing/remesh_quads.h"

namespace fcn {

/// A map for quads of a domain and a field, or the reason that there is none.
struct FieldMap {
    CornerMap map;
    std::string failure;  ///< empty: there is one
};

/// The map whose grid follows the field and, softly, the network.
FieldMap map_field(const QuadDomain& domain, const FieldDesign& field, double edge_length);

/// The steps from a surface to quads. Each can be replaced, so that every failure can be seen.
struct QuadSteps {
    std::function<QuadDomain(const LoadedMesh&, const FeatureCurveNetwork&,
                             const QuadDomainOptions&)>
        domain = make_quad_domain;
    std::function<FieldDesign(const QuadDomain&, const FieldOptions&)> field = design_field;
    std::function<FieldMap(const QuadDomain&, const FieldDesign&, double edge_length)> map =
        map_field;
    std::function<QuadExtraction(const Mesh&, const CornerMap&)> extraction = extract_quads;
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
