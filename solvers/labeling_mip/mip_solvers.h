#pragma once

#include "labeling/lp_engine.h"
#include "labeling/solver.h"

namespace labeling {

/// Dual simplex of Clp behind LpEngine.
LpFactory clp_factory();

/// greedy, local-search, lns, branch-and-bound and auto with LP bounds, and cbc.
SolverRegistry linked_solvers();

/// The same and all external programs (see external_solver.h), installed or not.
SolverRegistry all_solvers();

}  // namespace labeling
