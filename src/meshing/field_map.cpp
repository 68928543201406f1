// The maps that quads are read from: first with the network's folds on lines of the grid
// (curve_map.h), or with all of it followed softly (Gehre, Lim, Kobbelt 2016, section 6.2).
#include "meshing/field_map.h"

#include "meshing/curve_clearance.h"
#include "meshing/curve_map.h"

namespace fcn {
namespace {

FieldMap make_map(const QuadDomain& domain, const FieldDesign& field,
                  const CurveMapOptions& options) {
    CurveMap made = map_with_curves(domain, field.field, options);
    FieldMap map{std::move(made.result.map), std::move(made.result.fault), {}};
    if (made.found_edges > 0)
        map.kept_share =
            static_cast<double>(made.kept_edges) / static_cast<double>(made.found_edges);
    for (const HardCurve& curve : made.curves)
        map.hard_edges.insert(map.hard_edges.end(), curve.edges.begin(), curve.edges.end());
    return map;
}

}  // namespace

FieldMap map_field(const QuadDomain& domain, const FieldDesign& field, double edge_length) {
    CurveMapOptions options;
    options.edge_length = edge_length;
    return make_map(domain, field, options);
}

FieldMap map_field_softly(const QuadDomain& domain, const FieldDesign& field, double edge_length) {
    CurveMapOptions options;
    options.edge_length = edge_length;
    options.is_hard = false;
    return make_map(domain, field, options);
}

int clear_network(const QuadDomain& domain, FieldDesign& field, double edge_length) {
    if (domain.edge_arc.empty()) return 0;
    HardCurveOptions finding;
    finding.edge_length = edge_length;
    ClearanceOptions options;
    options.edge_length = edge_length;
    return clear_curves(domain, find_hard_curves(domain, field.field, finding), options, field);
}

}  // namespace fcn
