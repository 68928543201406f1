#pragma once

#include <cstdint>
#include <vector>

#include "labeling/random.h"
#include "labeling/search_state.h"

namespace labeling {

/// Moves that keep a labeling feasible: switch labels on or off, evict what conflicts, mend every
/// rule that breaks, as one transaction. Labels touched once are not touched again in a move, so a
/// move ends after at most n flips.
class CompoundMoves {
public:
    CompoundMoves(const SearchModel& model, SearchState& state, Random& random);

    /// Labels a move may touch; empty = all. Ownership stays with the caller.
    void restrict_to(const std::vector<std::uint8_t>* allowed) { allowed_ = allowed; }

    /// Tries to flip label i so that the value changes by at least `threshold`; false: nothing has
    /// changed. On success the flips are in state.log(), to be committed by the caller.
    bool flip(Label i, Value threshold);
    /// Tries to switch on a run of up to `length` labels along bonuses, beginning at i.
    bool insert_run(Label i, int length, Value threshold);

private:
    bool switch_on(Label i);
    bool mend(Value floor);
    bool mend_row(std::int32_t row);
    bool mend_triple(const BrokenRule& rule);
    bool is_touched(Label i) const {
        return state_.is_marked(i) || (allowed_ != nullptr && (*allowed_)[i] == 0);
    }
    void refill();
    bool end(bool is_good, Value threshold, Value before);
    /// Loss of switching i on by evictions, given up beyond `most`. False: given up, or a touched
    /// label is in the way. Else evicted_ is what has to go.
    bool eviction_loss(Label i, Value most, Value& loss);
    /// After eviction_loss.
    void switch_on_evicting(Label i);

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    SearchState& state_;
    Random& random_;
    const std::vector<std::uint8_t>* allowed_ = nullptr;
    std::vector<Label> evicted_;
};

}  // namespace labeling
