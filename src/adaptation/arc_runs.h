#pragma once

#include <vector>

#include "adaptation/working_network.h"

namespace fcn {

/// Replaces an arc by its runs of kept segments (one flag per segment of its chain, not all true);
/// the runs keep their parts of the chain or are to be resampled.
void keep_runs(WorkingNetwork& network, int arc, const std::vector<bool>& kept, bool keeps_chains);

/// Takes out those of `given_up` (short arcs) that lead nowhere; the others stay in the list.
void remove_dangling(WorkingNetwork& network, std::vector<int>& given_up);

/// Gives a closed arc that is too small for its scale a chain of three segments.
void chain_small_loop(WorkingArc& arc);

}  // namespace fcn
