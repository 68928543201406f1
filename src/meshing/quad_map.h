#pragma once

#include <string>

#include "meshing/cross_field.h"
#include "meshing/map_problem.h"

namespace fcn {

struct QuadMapOptions : MapGuidance {};

struct QuadMapStatistics {
    int singular_vertices = 0, integers = 0, layout_triangles = 0;
    std::size_t collapsed_triangles = 0;  ///< of the layout, by the integers chosen
    /// Faces turned over: of the seamless map, before and after untangling, and with integers.
    std::size_t seamless_before = 0, seamless_after = 0, quantised_before = 0, quantised_after = 0;
    /// Vertices around which the seamless map winds otherwise than the field.
    std::size_t seamless_windings = 0;
    int newton_steps = 0;
    int integer_steps = 0;  ///< in which the integers were reached from the seamless map
    double cutting = 0, solving = 0, untangling = 0, quantising = 0;  ///< seconds
};

struct QuadMapResult {
    CornerMap map;                    ///< quads can be read from it unless there is a fault
    std::string fault;                ///< why there is none; empty: there is one
    std::vector<int> fault_vertices;  ///< where that is, ascending; may be empty
    QuadMapStatistics statistics;
};

/// The map of a mesh to the plane whose unit grid follows the field: seamless and integral without
/// rounding, keeping orientation, boundaries and hard edges on grid lines; around each vertex as
/// many quads as the field's index asks for. With hard edges inside it is given up earlier.
/// Deterministic.
QuadMapResult make_quad_map(const Mesh& mesh, const CrossField& field,
                            const QuadMapOptions& options);

}  // namespace fcn
