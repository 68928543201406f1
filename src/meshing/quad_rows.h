#pragma once

#include <array>
#include <vector>

#include "meshing/grid_vertices.h"

namespace fcn {

struct RowOptions {
    /// Where sides or middles of quads are farther than this from the surface, mesh units, rows are
    /// divided; 0: nowhere.
    double tolerance = 0;
    std::size_t most_quads = 0;  ///< no more of them than this by that
};

/// Quads with rows of them divided.
struct DividedRows {
    std::vector<std::array<int, 4>> faces;  ///< counter-clockwise
    std::vector<SurfacePoint> places;       ///< per vertex; those of the grid first
    int divided = 0;                        ///< rows
};

/// Quads by the ports at which their sides begin, counter-clockwise; `owners` are the ports'
/// vertices, `arrivals` where lines arrive. Rows of quads are divided lengthwise, into up to four,
/// until no two edges have the same ends and no quad has a corner twice, as far as that goes; the
/// shortest rows first. Deterministic.
DividedRows divide_rows(const GridMap& map, const GridVertices& vertices,
                        const std::vector<int>& owners, const std::vector<int>& arrivals,
                        const std::vector<std::array<int, 4>>& sides, const Mesh& domain,
                        const RowOptions& options);

}  // namespace fcn
