#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/problem.h"
#include "labeling/search_model.h"

namespace labeling {

/// A rule that was broken: a row, or a triple of labels that are all on.
struct BrokenRule {
    std::int32_t row = -1;  ///< -1: the triple
    Label label = 0;        ///< of the triple
    SearchModel::Pair others;
};

/// A 0/1 labeling with incremental gains, conflict counts and row activities, and a log that takes
/// flips back. Conflicts and rules may be violated between the flips of one transaction. Labels can
/// be marked as touched until the next transaction.
class SearchState {
public:
    /// May stop in the guard.
    SearchState(const SearchModel& model, std::span<const std::uint8_t> start,
                PassGuard guard = {});

    bool is_on(Label i) const { return labels_[i] != 0; }
    std::span<const std::uint8_t> labels() const { return labels_; }
    Value value() const { return value_; }
    /// Weight of i plus its bonuses to labels that are on (i itself may be on or off).
    Value gain(Label i) const { return nodes_[i].gain; }
    /// How many conflict partners of i are on.
    std::int32_t blocker_count(Label i) const {
        return static_cast<std::int32_t>(nodes_[i].blockers >> kCountShift);
    }
    /// Sum of the indices of the conflict partners of i that are on: names the only one.
    std::int64_t blocker_sum(Label i) const {
        return static_cast<std::int64_t>(nodes_[i].blockers &
                                         ((std::uint64_t{1} << kCountShift) - 1));
    }
    std::int64_t excess(std::int32_t row) const { return excesses_[row]; }
    bool is_broken(const BrokenRule& rule) const {
        if (rule.row >= 0) return excesses_[rule.row] > 0;
        return is_on(rule.label) && is_on(rule.others.first) && is_on(rule.others.second);
    }

    void flip(Label i);

    /// Flips since the last commit(), in order.
    std::span<const Label> log() const { return log_; }
    void commit();
    void roll_back();
    /// Rules that a flip since the last commit() broke; entries may have been mended since. The
    /// caller pops.
    std::vector<BrokenRule>& broken_rules() { return broken_rules_; }
    /// Labels whose last conflict partner was switched off since the last commit(); may have one
    /// again.
    std::span<const Label> freed() const { return freed_; }
    /// Switching i on would break no conflict and no rule.
    bool fits(Label i) const;

    void clear_marks();
    void mark(Label i) { marks_[i] = mark_; }
    bool is_marked(Label i) const { return marks_[i] == mark_; }

    /// Adjacency entries touched so far.
    std::int64_t work() const { return work_; }

private:
    /// Count and sum of indices share a word, so that a flip changes both at once.
    static constexpr int kCountShift = 40;
    /// What moves read together lies together.
    struct Node {
        Value gain = 0;
        std::uint64_t blockers = 0;
    };
    static std::uint64_t as_blocker(Label i) {
        return (std::uint64_t{1} << kCountShift) + static_cast<std::uint64_t>(i);
    }

    /// Without `kNotesBroken` for flips that lead back to what is feasible.
    template <bool kNotesBroken>
    void apply(Label i);
    template <bool kNotesBroken>
    void switch_on(Label i);
    template <bool kNotesBroken>
    void switch_off(Label i);

    const SearchModel& model_;
    std::vector<std::uint8_t> labels_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> marks_;
    std::vector<std::int64_t> excesses_;  ///< activity - right-hand side; violated when > 0
    std::vector<Label> log_;
    std::vector<BrokenRule> broken_rules_;
    std::vector<Label> freed_;
    Value value_ = 0;
    std::int64_t work_ = 0;
    std::uint32_t mark_ = 1;
};

}  // namespace labeling
