#pragma once

#include <functional>
#include <memory>

#include "labeling/solver.h"

namespace labeling {

/// Called in each child process before CBC starts, with the attempt's number from 0: lets a test
/// see what happens when CBC dies.
using CbcChildHook = std::function<void(int)>;

/// CBC on the linear model, in a child process that is killed when it overruns. Extra options:
/// `rows` (paper | strengthened), `nodes` (node limit). A work limit becomes a node limit of one
/// node per 10,000 ticks (at least 1). When CBC dies it is tried once more with fewer of its own
/// reductions (statistic `attempts`); after that the stop reason is SolverFailed. See
/// cbc_solver.cpp for what its bound is worth.
std::shared_ptr<const Solver> make_cbc_solver(CbcChildHook in_child = {});

}  // namespace labeling
