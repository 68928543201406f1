#pragma once

#include <string_view>

#include "labeling/problem.h"
#include "labeling/solver.h"

namespace labeling {

/// What the exact solvers use. Every field is an extra option of the same name with '-' for '_':
/// switches take on or off. Whatever is off, answers stay exact.
struct Techniques {
    /// Parts of up to this many labels are left to the depth-first tree; parts of up to 2.5 times
    /// as many get a small allowance of it before branch-and-cut. 0: branch-and-cut for all.
    Label tree_size = 24;
    /// Dives of branch-and-cut's tree side by side, 1 to 16: as many threads can work on it.
    int tree_lanes = 2;
    /// Bonuses per label from which on small ones enter the LP late.
    std::int64_t many_bonuses = 4;
    /// Greedy and local search before and inside of branch-and-cut; a warm start needs them.
    bool heuristics = true;
    bool reductions = true;        ///< reductions.h, before anything else
    bool treewidth = true;         ///< treewidth_search.h, for narrow parts
    bool clique_cuts = true;       ///< separated ones; those that make the model complete stay
    bool triple_cuts = true;       ///< triple_cuts.h
    bool rank_two_cuts = true;     ///< rank_two_cuts.h
    bool gomory_cuts = true;       ///< gomory_cuts.h
    bool late_bonuses = true;      ///< late_bonuses.h
    bool fixing = true;            ///< of labels by the bounds of their reduced costs
    bool restarts = true;          ///< after fixing at the root
    bool strong_branching = true;  ///< off: by a guess from the relaxation alone
};

/// Throws InputError naming a value that is not allowed, or an extra option that is none of these.
Techniques techniques_of(const SolveOptions& options, std::string_view solver);

}  // namespace labeling
