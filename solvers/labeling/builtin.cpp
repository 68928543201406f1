#include "labeling/exact_search.h"
#include "labeling/greedy.h"
#include "labeling/local_search.h"
#include "labeling/neighbourhood_search.h"
#include "labeling/solver.h"

namespace labeling {

SolverRegistry builtin_solvers() {
    SolverRegistry registry;
    registry.add(make_greedy_solver());
    registry.add(make_local_search_solver());
    registry.add(make_lns_solver());
    registry.add(make_branch_and_bound_solver());
    registry.add(make_auto_solver());
    return registry;
}

}  // namespace labeling
