#pragma once

#include <optional>

#include "meshing/grid_map.h"

namespace fcn {

/// A point of a closed face and a direction of the grid there, in the face's chart.
struct GridPlace {
    int face = -1;
    GridPoint image;
    int direction = 0;  ///< 0 .. 3
};

/// Walks straight along the directions of the grid, over faces and transitions, exactly.
class GridWalk {
public:
    explicit GridWalk(const GridMap& map) : map_(map) {}

    /// The place at a distance > 0; none: the way leaves the surface.
    std::optional<GridPlace> go(const GridPlace& from, std::int64_t distance) const;

private:
    struct Step;
    bool is_at_goal(const Step& step) const;
    void cross(Step& step, int h) const;
    bool leave_face(Step& step) const;
    bool pass_vertex(Step& step, int h) const;

    const GridMap& map_;
};

}  // namespace fcn
