#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "labeling/lp_engine.h"
#include "labeling/problem.h"
#include "labeling/run_control.h"

namespace labeling {

__extension__ using Int128 = __int128;

/// A valid inequality  sum of terms <= right_hand_side  over the columns of the relaxation.
struct Cut {
    struct Entry {
        std::int32_t column = 0;
        std::int32_t coefficient = 0;
        friend bool operator==(const Entry&, const Entry&) = default;
    };
    std::vector<Entry> entries;  ///< columns ascend
    std::int64_t right_hand_side = 0;

    double activity(std::span<const double> x) const {
        double sum = 0;
        for (const Entry& e : entries) sum += e.coefficient * x[e.column];
        return sum;
    }
};

/// Equal rows hash equal.
std::uint64_t hash_of(const Cut& cut);

/// Linear relaxation with exact rows and columns (labels, then bonuses) and a floating-point solver
/// behind it. Every bound is recomputed in integers from the solver's multipliers, so it holds
/// whatever the solver returned.
class Relaxation {
public:
    Relaxation(const LabelingProblem& problem, const LpFactory& factory);
    /// A copy with a solver of its own. Rows that are added later get ids from a range of their
    /// own, so that a basis saved by one copy can be restored by another. Ranges: 1 to 30.
    Relaxation(const Relaxation& other, const LpFactory& factory, std::uint32_t range);

    std::int32_t column_count() const { return static_cast<std::int32_t>(objective_.size()); }
    std::int32_t row_count() const { return static_cast<std::int32_t>(rows_.size()); }

    /// Leaves bonuses out of the LP: the column stays at 0, and half of the value goes to each of
    /// the two labels, which is no less than the bonus for any labeling. Before any row is added.
    void leave_out(std::span<const std::int32_t> bonuses);
    bool is_left_out(std::int32_t column) const { return !left_out_.empty() && left_out_[column]; }
    /// Gives the bonus its column back; its links to the labels are the caller's.
    void bring_in(std::int32_t bonus);
    /// How much more than the bonus the two labels earn at x, in units.
    double excess_of_left_out(std::int32_t bonus) const;

    /// False when an equal row is there already. Columns that are left out are dropped from it.
    bool add(Cut cut);
    const Cut& row(std::int32_t r) const { return rows_[r].cut; }
    /// Power of two by which the LP's copy of the row is smaller.
    double row_scale(std::int32_t r) const { return rows_[r].scale; }

    void fix(std::int32_t column, bool value);
    void unfix(std::int32_t column);
    bool is_fixed(std::int32_t column) const { return lower_[column] == upper_[column]; }
    bool at_one(std::int32_t column) const { return lower_[column] == 1; }
    bool at_zero(std::int32_t column) const { return upper_[column] == 0; }

    /// Solves and computes the exact bound; spends work on `control`. Stopped when control says so.
    LpEngine::Outcome solve(RunControl& control, std::int64_t max_iterations);
    std::int64_t iterations() const { return iterations_; }  ///< of the last solve()
    std::span<const double> x() const { return engine_->columns(); }
    LpEngine& engine() { return *engine_; }

    /// Exact bound under the fixings at the time of solve(); a very large number when the solver
    /// failed, kNoValue when infeasibility was proven.
    Value bound() const { return bound_; }
    /// What forcing the (free) column away from the side it leans to does to the bound:
    /// fixing to 1 (value) or 0 proves a bound of this or less.
    Value bound_if(std::int32_t column, bool value) const;

    /// Takes rows that were idle in the last `age` solves out of the LP; they are kept aside.
    void drop_idle_rows(int age);
    /// The same with rows that were slack in the last solve, which is cheaper: the basis stays.
    void drop_slack_rows();
    /// Idle is a row that is slack, or (on) one without a multiplier. Most tight rows of these LPs
    /// have none: they hold zeros together and only cost time while cuts are added at the root; in
    /// a tree they would be missed at the next node.
    void set_drops_tight_rows(bool is_on) { drops_tight_rows_ = is_on; }
    /// Puts rows back that were kept aside and that x violates; returns how many. Adds the entries
    /// looked at to `work`.
    std::size_t restore_violated_rows(std::int64_t& work);
    /// Basis with row identities, so that it can be restored after rows came and went.
    struct SavedBasis {
        LpEngine::Basis columns;
        std::vector<std::uint32_t> nonbasic_rows;  ///< row ids, ascending
    };
    SavedBasis save_basis() const;
    /// Puts rows back first that were kept aside and were tight there.
    void restore_basis(const SavedBasis& saved);

private:
    struct Row {
        Cut cut;
        std::uint32_t id = 0;
        int idle_age = 0;
        bool is_slack = false;
        std::uint64_t hash = 0;
        double scale = 1;    ///< the LP holds the row divided by this
        double largest = 1;  ///< largest absolute number in the row
    };

    void choose_scale();
    void reset_engine();
    void pass_to_engine(const Row& row);
    void insert(Row row);
    template <typename Wanted>
    std::size_t put_back(const Wanted& is_wanted);
    template <typename Unwanted>
    void put_aside(const Unwanted& is_unwanted);
    void compute_bound();
    bool prove_infeasible();
    void age_rows();

    static constexpr int kShift = 36;

    std::unique_ptr<LpEngine> engine_;
    std::vector<Bonus> bonuses_;
    std::vector<std::uint8_t> left_out_;  ///< per column; empty: none
    std::vector<Value> objective_;
    std::vector<std::int8_t> lower_, upper_;
    std::vector<Row> rows_;
    std::vector<Row> aside_;
    std::unordered_map<std::uint64_t, int> row_hashes_;
    std::vector<Int128> reduced_;  ///< exact reduced costs, scaled by 2^kShift
    Int128 scaled_bound_ = 0;
    Value bound_ = 0;
    double scale_ = 1;
    std::uint32_t next_id_ = 0;
    std::int64_t iterations_ = 0;
    bool drops_tight_rows_ = false;
};

}  // namespace labeling
