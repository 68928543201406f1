#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory_resource>
#include <span>
#include <vector>

#include "labeling/pass_guard.h"
#include "labeling/problem.h"
#include "labeling/reductions.h"

namespace labeling {

/// A problem that shrinks: labels, conflicts, bonuses and rules (as rows <=) that are left, with a
/// record of every step. What changed is queued, so that reductions look only there again.
class ReductionState {
public:
    using Partner = LabelingProblem::BonusPartner;
    struct Use {
        std::int32_t row = 0;
        std::int32_t coefficient = 0;
    };
    struct Row {
        std::pmr::vector<Term> terms;  ///< ascending labels
        std::int64_t right_hand_side = 0;
        bool is_alive = true;
    };

    /// Both may stop in the guard.
    ReductionState(const LabelingProblem& problem, PassGuard guard);

    Label label_count() const { return static_cast<Label>(weights_.size()); }
    bool is_alive(Label i) const { return is_alive_[i] != 0; }
    Value weight(Label i) const { return weights_[i]; }
    /// Weight and all bonuses: the most that the label can bring.
    Value potential(Label i) const { return potentials_[i]; }
    std::span<const Label> conflicts_of(Label i) const { return conflicts_[i]; }  ///< ascending
    std::span<const Partner> bonuses_of(Label i) const { return bonuses_[i]; }
    std::span<const Use> uses(Label i) const { return uses_[i]; }
    const Row& row(std::int32_t r) const { return rows_[r]; }
    std::int32_t row_count() const { return static_cast<std::int32_t>(rows_.size()); }
    bool in_conflict(Label i, Label j) const;
    Value bonus(Label i, Label j) const;
    /// No row can be violated by switching the label off.
    bool can_be_dropped(Label i) const;

    /// Switching `on` to 1 and `off` to 0 in a labeling in which `known_on` (-1: none) is 1 and
    /// `known_off` are 0.
    struct Move {
        std::span<const Label> on, off;
        Label known_on = -1;
        std::span<const Label> known_off;
        bool is_certain = false;  ///< every label of `on` was 0 and every one of `off` was 1
    };
    /// True when the move cannot violate a row of any labeling that was feasible.
    bool is_safe(const Move& move);
    /// The sums of absolute weights and bonuses may grow by so much; false: they may not any more.
    bool may_grow(Value amount);

    // Steps. Each leaves an equivalent problem; none may follow once is_infeasible().
    void fix(Label i, bool value);
    /// i and `into` have the same value from now on.
    void merge(Label i, Label into);
    /// Takes i out of the problem; it is 1 where none of its conflict partners is.
    void spare(Label i);
    /// Where `when` is 1, i can be 1 too: their bonus becomes weight of `when`.
    void grant_bonus(Label i, Label when);
    void add_weight(Label i, Value change);
    void add_offset(Value change) { result_.offset_ += change; }
    /// Changes a bonus; down to 0 it disappears. Nothing happens on a conflicting pair.
    void add_bonus(Label i, Label j, Value change);
    void add_conflict(Label i, Label j);
    void drop_row(std::int32_t r);

    /// Carries out what fix() and changed rows entail.
    void settle();
    bool is_infeasible() const { return result_.is_infeasible_; }

    /// Next label or row whose surroundings changed; -1: none.
    Label next_label();
    std::int32_t next_row();

    ReducedProblem take_result(PassGuard guard);
    ReductionStatistics& statistics() { return result_.statistics_; }
    std::int64_t work = 0;  ///< adjacency entries touched so far

private:
    using Step = ReducedProblem::Step;

    void touch(Label i);
    void touch_around(Label i);
    void touch_row(std::int32_t r);
    void remove(Label i);
    void take_out(Label i, bool value);
    void tighten(std::int32_t r);
    void put_use(Label i, std::int32_t r, std::int32_t coefficient);
    bool is_row_safe(std::int32_t r, bool is_certain);
    void change_bonus(Label i, Label j, Value change);

    const LabelingProblem& problem_;
    std::vector<Value> weights_, potentials_;
    /// Of all lists: they come in millions, and are given back at once. What a list leaves behind
    /// when it grows stays here, which is little, since most only shrink.
    std::pmr::monotonic_buffer_resource memory_;
    std::pmr::vector<std::pmr::vector<Label>> conflicts_;
    std::pmr::vector<std::pmr::vector<Partner>> bonuses_;
    std::pmr::vector<std::pmr::vector<Use>> uses_;
    std::vector<Row> rows_;
    std::vector<std::uint8_t> is_alive_, is_queued_, is_row_queued_, is_row_checked_;
    std::vector<std::int8_t> pending_;  ///< value that fix() has ordered, or -1
    std::vector<Label> orders_;
    std::vector<Label> queue_;
    std::vector<std::int32_t> row_queue_, unsettled_rows_;
    std::size_t queue_head_ = 0;
    std::vector<std::int8_t> marks_;  ///< of is_safe()
    Value total_ = 0;                 ///< at most this is the sum of absolute weights and bonuses
    ReducedProblem result_;
};

// The families. Each looks at one label (or row) and returns true when it changed anything.
bool reduce_dual(ReductionState& state, Label i);
bool reduce_neighbourhood(ReductionState& state, Label i);
bool reduce_dominated(ReductionState& state, Label i);
bool reduce_linked(ReductionState& state, Label i);
bool reduce_clique(ReductionState& state, Label i);
bool reduce_two_conflicts(ReductionState& state, Label i);
bool reduce_rule(ReductionState& state, std::int32_t row);

}  // namespace labeling
