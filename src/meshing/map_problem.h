#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meshing/corner_map.h"
#include "meshing/cut_graph.h"
#include "meshing/integer_elimination.h"

namespace fcn {

struct MapGuidance {
    double edge_length = 0;  ///< > 0: of quads, one unit of the map
    /// Per edge: whether its image has to lie on a grid line; empty: none. Boundaries always have.
    std::vector<std::uint8_t> is_hard;
    std::vector<int> grid_vertices;  ///< to be at grid points besides singular ones; ascending
    /// Per edge, >= 0: how much its image should run along the grid; empty: none.
    std::vector<double> soft_weight;
};

/// A face as the map sees it: lengths in quad edges, x along its combed arm.
struct FaceShape {
    Eigen::Matrix<double, 2, 3> gradients;  ///< of the corners' hat functions
    double area = 0;
};

/// Two unknowns that should be equal.
struct SoftEquality {
    int one = 0, other = 0;
    double weight = 0;
};

/// What a seamless map of a field has to satisfy. The unknowns are u and v of every copy of a
/// vertex (2 copy, 2 copy + 1), and of the translation across every chain of the cut after them.
struct MapProblem {
    CutMesh cut;
    std::vector<FaceShape> shapes;
    EliminatedUnknowns unknowns;  ///< all seams and hard alignments hold whatever is free
    std::vector<SoftEquality> soft;
    std::vector<bool> is_hard;  ///< per edge, boundaries too
    std::string fault;          ///< empty: none
};

MapProblem make_map_problem(const Mesh& mesh, const CrossField& field, const MapGuidance& guidance);

/// The map of the values of all unknowns (basis * free ones).
CornerMap corner_map(const MapProblem& problem, const Eigen::VectorXd& values);

}  // namespace fcn
