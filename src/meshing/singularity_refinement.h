#pragma once

#include "meshing/field_design.h"

namespace fcn {

struct RefinedField {
    QuadDomain domain;
    FieldDesign design;
};

/// The same surface and field with twice as many faces around each inner singularity: the edges
/// opposite to it are halved. Vertices keep their numbers, new ones follow. Linear. Deterministic.
RefinedField refine_singularities(const QuadDomain& domain, const FieldDesign& design);

}  // namespace fcn
