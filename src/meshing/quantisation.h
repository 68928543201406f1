#pragma once

#include <string>

#include "meshing/coarse_layout.h"
#include "meshing/seamless_map.h"

namespace fcn {

/// What rounding costs: (y - optimum)' matrix (y - optimum) / 2, y the integers of a map, all other
/// unknowns at their best.
struct IntegerEnergy {
    std::vector<int> unknowns;  ///< of the free ones
    Eigen::MatrixXd matrix;
    Eigen::VectorXd optimum;
};

/// Empty `unknowns` where nothing has to be an integer, or where the energy is not convex.
IntegerEnergy integer_energy(const QuadraticEnergy& energy, const std::vector<bool>& is_integer);

struct Quantisation {
    Eigen::VectorXd integers;    ///< of IntegerEnergy::unknowns
    double cost = 0;             ///< the energy's
    std::vector<int> collapsed;  ///< triangles of the layout that are not positive
    int rounding_steps = 0, moves = 0;
};

/// Integers near the optimum, none of the layout's triangles turned over if that can be found.
Quantisation quantise(const IntegerEnergy& energy, const CoarseLayout& layout);

}  // namespace fcn
