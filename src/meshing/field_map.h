#pragma once

#include <string>
#include <vector>

#include "meshing/corner_map.h"
#include "meshing/field_design.h"

namespace fcn {

/// A map for quads of a domain and a field, or the reason that there is none.
struct FieldMap {
    CornerMap map;
    std::string failure;            ///< empty: there is one
    std::vector<int> hard_edges{};  ///< of the domain, on curves that lie on lines of the grid
    double kept_share = 1;          ///< of the edges that were to be such
};

/// The map whose grid follows the field and the network, with lines on its folds where it can.
FieldMap map_field(const QuadDomain& domain, const FieldDesign& field, double edge_length);

/// The same with lines beside the network's curves alone.
FieldMap map_field_softly(const QuadDomain& domain, const FieldDesign& field, double edge_length);

/// Moves singularities that are too close to the network's folds for lines of the grid on these
/// (curve_clearance.h).
int clear_network(const QuadDomain& domain, FieldDesign& field, double edge_length);

}  // namespace fcn
