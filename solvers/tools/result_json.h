#pragma once

#include <string>

#include "labeling/solver.h"

namespace labeling {

/// What a solver answered, but for the labels, as one JSON object: solver, status, stop_reason,
/// value and bound (integers or null), work, seconds, message, statistics (an object of numbers)
/// and trace (a list of [seconds, work, value or null, bound or null]).
std::string result_json(const SolveResult& result);

}  // namespace labeling
