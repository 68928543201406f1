#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace fcn {

/// A triangle with points on its sides and inside, in its plane.
struct FaceSubdivisionInput {
    std::vector<Eigen::Vector2d> points;    ///< boundary first, counter-clockwise, then inner
    int boundary_count = 0;                 ///< >= 3; consecutive ones are joined
    std::vector<std::array<int, 2>> lines;  ///< between points; may cross
};

struct FaceSubdivision {
    std::vector<Eigen::Vector2d> added;         ///< crossings of lines, numbered after the input
    std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise
    std::vector<std::vector<int>> paths;        ///< per line: its points from end to end
    bool is_valid = false;                      ///< covers the polygon, sides unbroken
};

/// Constrained Delaunay triangulation of one face.
FaceSubdivision subdivide_face(const FaceSubdivisionInput& input);

}  // namespace fcn
