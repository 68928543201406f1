#pragma once

#include <memory>

#include "labeling/solver.h"

namespace labeling {

/// CBC on the linear model, in a child process that is killed when it overruns. Extra options:
/// `rows` (paper | strengthened), `nodes` (node limit). A work limit becomes a node limit of one
/// node per 10,000 ticks (at least 1). See cbc_solver.cpp for what its bound is worth.
std::shared_ptr<const Solver> make_cbc_solver();

}  // namespace labeling
