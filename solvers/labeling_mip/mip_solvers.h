#pragma once

#include "labeling/lp_engine.h"
#include "labeling/solver.h"

namespace labeling {

/// Dual simplex of Clp behind LpEngine.
LpFactory clp_factory();

/// greedy, local-search, branch-and-bound and auto with LP bounds, and cbc.
SolverRegistry all_solvers();

}  // namespace labeling
