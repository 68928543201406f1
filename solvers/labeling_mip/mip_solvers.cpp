#include "labeling_mip/mip_solvers.h"

#include "labeling/exact_search.h"
#include "labeling/neighbourhood_search.h"
#include "labeling_mip/cbc_solver.h"
#include "labeling_mip/external_solver.h"

namespace labeling {

SolverRegistry linked_solvers() {
    SolverRegistry registry = builtin_solvers();
    registry.add(make_lns_solver(clp_factory()));
    registry.add(make_branch_and_bound_solver(clp_factory()));
    registry.add(make_auto_solver(clp_factory()));
    registry.add(make_cbc_solver());
    return registry;
}

SolverRegistry all_solvers() {
    SolverRegistry registry = linked_solvers();
    add_external_solvers(registry);
    return registry;
}

}  // namespace labeling
