#pragma once

#include <functional>

#include "labeling/cut_lane.h"

namespace labeling {

struct CutTreeOptions {
    int lanes = 2;  ///< dives side by side, 1 to 16; decides the answer's bytes, threads do not
    int threads = 1;
    /// A lane works this long, in ticks, before all exchange what they have found.
    std::int64_t round = 1'000'000;
    /// Called between rounds with what is known of the whole; may be empty. The solution is new, or
    /// absent.
    std::function<void(std::optional<Solution>, Value bound)> report;
    /// Called between rounds: may return a better solution. Spends on the same control.
    std::function<std::optional<Solution>()> improve;
};

/// Branch and cut below a root that `root` stands at, with the bound given; better solutions go to
/// `report`. Spends on root.control(), until it stops. Returns a bound on what was left open;
/// kNoValue when nothing was. Statistics are added to root's.
Value search_cut_tree(CutLane& root, Value root_bound, const CutTreeOptions& options);

}  // namespace labeling
