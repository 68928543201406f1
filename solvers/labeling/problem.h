#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace labeling {

/// Index of a label, 0-based; files count from 1.
using Label = std::int32_t;

/// Objective values: exact integers, |value| <= kMaxTotal.
using Value = std::int64_t;

inline constexpr Value kMaxTotal = Value{1} << 53;

/// Two labels of which at most one may be 1; first < second.
struct Conflict {
    Label first = 0;
    Label second = 0;
    friend bool operator==(const Conflict&, const Conflict&) = default;
};

/// `value` >= 0 is earned when both labels are 1; first < second.
struct Bonus {
    Label first = 0;
    Label second = 0;
    Value value = 0;
    friend bool operator==(const Bonus&, const Bonus&) = default;
};

enum class Relation { LessEqual, GreaterEqual, Equal };

struct Term {
    std::int32_t coefficient = 0;
    Label label = 0;
    friend bool operator==(const Term&, const Term&) = default;
};

/// Small linear constraint: sum of terms (relation) right_hand_side.
struct Rule {
    Relation relation = Relation::LessEqual;
    std::int64_t right_hand_side = 0;
    std::vector<Term> terms;
    friend bool operator==(const Rule&, const Rule&) = default;
};

/// Binary labeling on a conflict graph, maximised: sum of weights of labels that are 1 plus the
/// bonuses of pairs that are both 1, subject to conflicts and rules. Immutable; made by
/// ProblemBuilder. Adjacency is stored as CSR, neighbours ascending.
class LabelingProblem {
public:
    Label label_count() const { return static_cast<Label>(weights_.size()); }
    std::size_t conflict_count() const { return conflicts_.size(); }
    std::size_t bonus_count() const { return bonuses_.size(); }
    std::size_t rule_count() const { return rules_.size(); }

    Value weight(Label i) const { return weights_[i]; }
    std::span<const Value> weights() const { return weights_; }
    /// Optional; empty string when the label has no name.
    const std::string& name(Label i) const;
    bool has_names() const { return !names_.empty(); }

    /// All conflicts, sorted by (first, second), no duplicates.
    std::span<const Conflict> conflicts() const { return conflicts_; }
    /// All bonuses, sorted, duplicates summed, zero ones dropped, none on a conflicting pair.
    std::span<const Bonus> bonuses() const { return bonuses_; }
    std::span<const Rule> rules() const { return rules_; }

    /// Labels in conflict with i, ascending.
    std::span<const Label> conflicts_of(Label i) const {
        return {conflict_adjacency_.data() + conflict_begin_[i],
                conflict_begin_[i + 1] - conflict_begin_[i]};
    }
    struct BonusPartner {
        Label label = 0;
        Value value = 0;
    };
    /// Bonus partners of i, ascending by label.
    std::span<const BonusPartner> bonuses_of(Label i) const {
        return {bonus_adjacency_.data() + bonus_begin_[i], bonus_begin_[i + 1] - bonus_begin_[i]};
    }
    struct RuleUse {
        std::int32_t rule = 0;
        std::int32_t coefficient = 0;
    };
    /// Rules that contain i, ascending by rule index.
    std::span<const RuleUse> rules_of(Label i) const {
        return {rule_adjacency_.data() + rule_begin_[i], rule_begin_[i + 1] - rule_begin_[i]};
    }

    bool in_conflict(Label i, Label j) const;  ///< O(log degree)

    /// Integer units per 1.0 of the real objective (1 if unknown).
    double units_per_one() const { return units_per_one_; }
    /// Bonuses that the builder dropped because their pair is in conflict.
    std::size_t dropped_bonus_count() const { return dropped_bonus_count_; }

    /// FNV-1a over the canonical content (names and units excluded); equal problems hash equal.
    std::uint64_t hash() const;

private:
    friend class ProblemBuilder;
    std::vector<Value> weights_;
    std::vector<std::string> names_;
    std::vector<Conflict> conflicts_;
    std::vector<Bonus> bonuses_;
    std::vector<Rule> rules_;
    std::vector<std::size_t> conflict_begin_, bonus_begin_, rule_begin_;
    std::vector<Label> conflict_adjacency_;
    std::vector<BonusPartner> bonus_adjacency_;
    std::vector<RuleUse> rule_adjacency_;
    double units_per_one_ = 1.0;
    std::size_t dropped_bonus_count_ = 0;
};

/// Collects and validates. Every add_* throws InputError on an index out of range, a self
/// conflict, a self bonus or a negative bonus; build() throws InputError when the sum of absolute
/// weights and bonuses exceeds kMaxTotal. Terms of a rule on the same label are summed, zero
/// coefficients dropped.
class ProblemBuilder {
public:
    Label add_label(Value weight, std::string name = {});
    void add_conflict(Label i, Label j);
    void add_bonus(Label i, Label j, Value value);
    void add_rule(Rule rule);
    void set_units_per_one(double units);
    Label label_count() const { return static_cast<Label>(weights_.size()); }
    /// Leaves the builder empty. `between` (may be empty) is called between its passes and may
    /// throw.
    LabelingProblem build(const std::function<void()>& between = {});

private:
    std::vector<Value> weights_;
    std::vector<std::string> names_;
    std::vector<Conflict> conflicts_;
    std::vector<Bonus> bonuses_;
    std::vector<Rule> rules_;
    double units_per_one_ = 1.0;
};

}  // namespace labeling
