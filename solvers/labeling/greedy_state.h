#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/greedy.h"
#include "labeling/label_heap.h"
#include "labeling/pass_guard.h"
#include "labeling/problem.h"
#include "labeling/propagation.h"

namespace labeling {

/// A propagated partial labeling under construction, with every undecided label's gain and blocked
/// gain, and a heap of the labels by the score of the rule. Keeping it up to date costs each
/// label's adjacency once, and once more for each partner it has a bonus with.
class GreedyState {
public:
    /// May stop in the guard.
    GreedyState(const LabelingProblem& problem, Propagator& propagator, GreedyRule rule,
                PassGuard guard);

    bool is_free(Label i) const { return propagator_.is_free(i); }
    /// Weight, bonuses to chosen partners, half the bonuses to undecided ones.
    double gain(Label i) const { return gain_[i] + potential_[i]; }
    double score(Label i) const;

    /// Undecided label of the best score, or -1 when none has a gain.
    Label best();
    /// Brings scores up to date with what has been decided.
    void update();

    /// Adjacency entries touched so far.
    std::int64_t work() const { return work_; }

private:
    void prepare(PassGuard guard);
    void touch(Label i);
    void set_worth(Label i, double worth);

    const LabelingProblem& problem_;
    Propagator& propagator_;
    const GreedyRule rule_;
    LabelHeap heap_;
    std::size_t updated_ = 0;        ///< trail entries that the scores know of
    std::vector<double> gain_;       ///< weight and bonuses to chosen labels
    std::vector<double> potential_;  ///< half the bonuses to undecided labels
    std::vector<double> worth_;      ///< what a label counts for where it is blocked
    std::vector<double> blocked_;    ///< worth of undecided conflict partners
    std::vector<Label> changed_;
    std::vector<std::uint8_t> is_changed_;
    std::int64_t work_ = 0;
};

/// Assigns a free label; where that contradicts, assigns the opposite. False: a dead end.
bool decide(Propagator& propagator, Label i, bool value);

}  // namespace labeling
