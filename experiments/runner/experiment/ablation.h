#pragma once

#include <string>
#include <vector>

#include "experiment/plan.h"

namespace experiment {

/// A solver that differs from another in one thing.
struct Ablation {
    std::size_t parent = 0, variant = 0;
    std::string change;  ///< "key=value", "without key", or what follows the parent's name
};

/// The first solver listed of each kind is the parent of those that differ from it in one option,
/// or that are named PARENT:...; same start, threads and limits.
std::vector<Ablation> find_ablations(const Plan& plan);

}  // namespace experiment
