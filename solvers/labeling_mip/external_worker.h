#pragma once

#include <string>

#include "labeling/solver.h"

namespace labeling {

/// Text of solvers/python/labeling_worker.py, compiled in: it is found wherever the library is.
const char* worker_text();

/// Python interpreter for the worker: the option `python`, the environment variable
/// LABELING_PYTHON, the environment that scripts/setup_solvers.sh made in the source tree, or
/// `python3`.
std::string worker_python(const SolveOptions& options);

}  // namespace labeling
