#pragma once

#include <optional>

#include "meshing/field_design.h"
#include "meshing/remesh_quads.h"

namespace fcn {

/// What a result keeps of the field that its quads follow; nothing if the design has no field.
std::optional<QuadField> quad_field(const QuadDomain& domain, const FieldDesign& design);

/// The field as seen from another mesh of the same surface: per face of `mesh` the unit vector, in
/// the face's plane, of an arm at the point nearest to its centre. Linear times logarithm.
std::vector<Vec3> arms_on_faces(const QuadField& field, const Mesh& mesh);

}  // namespace fcn
