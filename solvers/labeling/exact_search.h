#pragma once

#include <memory>
#include <optional>
#include <string>

#include "labeling/lp_engine.h"
#include "labeling/solver.h"

namespace labeling {

struct ExactSearchOptions {
    std::string name;
    std::string description;
    /// Work limit where the caller limits neither work nor time; nullopt = run to the end.
    std::optional<std::int64_t> default_work_limit;
    /// Empty: bounds come from clique covers alone.
    LpFactory lp;
};

/// Greedy and local search for a start, root propagation, independent parts one after the other
/// (small first), each by tree_search or branch-and-cut; value and bound at any time.
std::shared_ptr<const Solver> make_exact_solver(ExactSearchOptions options);

/// Without a limit of its own.
std::shared_ptr<const Solver> make_branch_and_bound_solver(LpFactory lp = {});

/// The same machine stopped by a deterministic default work limit of about 30 s, unless the caller
/// gives a limit.
std::shared_ptr<const Solver> make_auto_solver(LpFactory lp = {});

}  // namespace labeling
