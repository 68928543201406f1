#pragma once

#include <cstdint>
#include <vector>

#include "meshing/face_connection.h"
#include "meshing/field_guides.h"

namespace fcn {

struct FieldSmoothingOptions {
    double edge_length = 0;  ///< of quads, > 0, mesh units
    int start_rounds = 8;    ///< solves for the first field, where no guide gives one
    int rounds = 4;          ///< diffusions for each of the times
    std::uint64_t seed = 1;  ///< of the first field
};

/// Angles per face of a smooth cross field that follows the guides. Deterministic; a few sparse
/// factorisations with one complex unknown a face. Empty if the system cannot be solved.
std::vector<double> smooth_field(const FaceConnection& connection,
                                 const std::vector<FieldGuide>& guides,
                                 const FieldSmoothingOptions& options);

}  // namespace fcn
