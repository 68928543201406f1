#pragma once

#include "labeling/solver.h"
#ifdef LABELING_WITH_MIP
#include "labeling_mip/mip_solvers.h"
#endif

namespace labeling_test {

/// Every solver that this build has linked.
inline labeling::SolverRegistry every_solver() {
#ifdef LABELING_WITH_MIP
    return labeling::linked_solvers();
#else
    return labeling::builtin_solvers();
#endif
}

}  // namespace labeling_test
