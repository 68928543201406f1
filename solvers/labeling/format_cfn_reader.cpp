// Reads CFN, the cost function networks of toulbar2, as far as they are labeling problems:
// variables of two values, costs on one or two of them, tables on up to eight that forbid, and the
// linear functions `knapsack` and `clique`. Like toulbar2, the reader takes commas, colons and
// quotes for optional. Value 1 of a variable is its label; a constant part of the costs becomes one
// more label that a rule holds at 1. A table of 0 and "forbidden" does not say which rule it was:
// our writer puts the rule into the function's name, which counts when the table agrees with it;
// any other table becomes a clause for each largest cube of forbidden assignments. The bound
// `mustbe` only says which costs forbid: when allowed costs can add up to it, it is a bound on the
// objective, and the file is refused.
#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "labeling/cfn_tokens.h"
#include "labeling/errors.h"
#include "labeling/formats_detail.h"

namespace labeling::detail {
namespace {

constexpr std::size_t kMostTableLabels = 8;

struct Function {
    std::string_view name, type;
    std::size_t line = 0;
    std::vector<Label> scope;
    std::vector<std::string_view> costs;
    std::optional<Value> default_cost;
    Value side = 0;                           ///< capacity or rhs
    std::vector<std::int64_t> weights;        ///< of a knapsack
    std::vector<std::array<bool, 2>> counts;  ///< of a clique: whether 0 and 1 count
};

bool holds(const Rule& rule, std::uint32_t row) {
    std::int64_t sum = 0;
    for (std::size_t k = 0; k < rule.terms.size(); ++k) {
        // The last label of the scope turns fastest.
        sum += ((row >> (rule.terms.size() - 1 - k)) & 1U) != 0 ? rule.terms[k].coefficient : 0;
    }
    return rule.relation == Relation::LessEqual      ? sum <= rule.right_hand_side
           : rule.relation == Relation::GreaterEqual ? sum >= rule.right_hand_side
                                                     : sum == rule.right_hand_side;
}

/// The rule that a name `r7_le_2_1_1_-1` tells (relation, right-hand side, coefficients).
std::optional<Rule> rule_in_name(std::string_view name, const std::vector<Label>& scope) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0; begin <= name.size();) {
        const std::size_t end = std::min(name.find('_', begin), name.size());
        parts.push_back(name.substr(begin, end - begin));
        begin = end + 1;
    }
    const bool is_empty = parts.size() == 3 && scope.size() == 1;
    if (!is_empty && parts.size() != scope.size() + 3) return std::nullopt;
    Rule rule;
    if (parts[1] == "ge") {
        rule.relation = Relation::GreaterEqual;
    } else if (parts[1] == "eq") {
        rule.relation = Relation::Equal;
    } else if (parts[1] != "le") {
        return std::nullopt;
    }
    for (std::size_t k = 2; k < parts.size(); ++k) {
        std::int64_t number = 0;
        const char* end = parts[k].data() + parts[k].size();
        const auto result = std::from_chars(parts[k].data(), end, number);
        constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
        const bool is_small = number >= -kMost && number <= kMost;
        if (result.ec != std::errc() || result.ptr != end || (k > 2 && !is_small)) {
            return std::nullopt;
        }
        if (k == 2) {
            rule.right_hand_side = number;
        } else {
            rule.terms.push_back({static_cast<std::int32_t>(number), scope[k - 3]});
        }
    }
    return rule;
}

class CfnReader {
public:
    CfnReader(std::string_view text, std::string_view source) : in_(text, source) {}

    LabelingProblem run() {
        in_.expect('{');
        section("problem");
        while (!in_.accept('}')) property();
        if (top_ <= 0) in_.fail("no upper bound 'mustbe' above 0");
        section("variables");
        while (!in_.accept('}')) variable();
        section("functions");
        while (!in_.accept('}')) {
            Function function = read_function();
            if (function.type.empty()) {
                table(function);
            } else {
                linear(function);
            }
        }
        in_.expect('}');
        if (!in_.is_end()) in_.fail("expected the end of the file");
        return build();
    }

private:
    void section(std::string_view name) {
        if (in_.word("'" + std::string(name) + "'") != name) {
            in_.fail("expected '" + std::string(name) + "'");
        }
        in_.expect('{');
    }

    void property() {
        if (in_.word("a property of the problem") != "mustbe") return in_.skip();
        const std::string_view bound = in_.word("an upper bound");
        if (!bound.starts_with('<')) in_.fail("'mustbe' is no upper bound '<number'");
        top_ = in_.integer_of(bound.substr(1), "upper bound");
    }

    void variable() {
        const std::string_view name = in_.word("a variable");
        std::size_t values = 0;
        if (in_.accept('[')) {
            for (; !in_.accept(']'); ++values) {
                const std::string_view value = in_.word("a value");
                if (values < 2) value_names_.push_back(value);
            }
        } else {
            values = static_cast<std::size_t>(in_.integer("number of values"));
            value_names_.insert(value_names_.end(), {"0", "1"});
        }
        if (values != 2) {
            in_.fail("variable '" + std::string(name) + "' does not have two values");
        }
        const auto label = static_cast<Label>(weights_.size());
        if (!labels_.emplace(name, label).second) {
            in_.fail("second variable '" + std::string(name) + "'");
        }
        weights_.push_back(0);
    }

    Label label() {
        const std::string_view name = in_.word("a variable");
        const auto it = labels_.find(name);
        if (it == labels_.end()) in_.fail("unknown variable '" + std::string(name) + "'");
        return it->second;
    }

    Function read_function() {
        Function f;
        f.line = in_.line();
        f.name = in_.word("a function");
        in_.expect('{');
        while (!in_.accept('}')) {
            const std::string_view key = in_.word("a property of a function");
            if (key == "scope") {
                in_.expect('[');
                while (!in_.accept(']')) f.scope.push_back(label());
            } else if (key == "type") {
                f.type = in_.word("a type");
            } else if (key == "defaultcost") {
                f.default_cost = in_.integer("cost");
            } else if (key == "costs") {
                in_.expect('[');
                while (!in_.accept(']')) f.costs.push_back(in_.word("a cost"));
            } else if (key == "params") {
                in_.expect('{');
                while (!in_.accept('}')) parameter(f);
            } else {
                in_.fail("unknown property '" + std::string(key) + "'");
            }
        }
        std::vector<Label> sorted = f.scope;
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
            in_.fail_at(f.line, "a variable is in the scope twice");
        }
        return f;
    }

    void parameter(Function& f) {
        const std::string_view key = in_.word("a parameter");
        if (key == "capacity" || key == "rhs") {
            f.side = in_.integer(key);
        } else if (key == "weights") {
            in_.expect('[');
            while (!in_.accept(']')) f.weights.push_back(in_.integer("weight"));
        } else if (key == "values") {
            in_.expect('[');
            while (!in_.accept(']')) {
                in_.expect('[');
                f.counts.push_back({false, false});
                while (!in_.accept(']')) {
                    const Value value = in_.integer("value");
                    if (value != 0 && value != 1) in_.fail("a value is neither 0 nor 1");
                    f.counts.back()[value == 0 ? 0 : 1] = true;
                }
            }
        } else {
            in_.fail("unknown parameter '" + std::string(key) + "'");
        }
    }

    void linear(const Function& f) {
        const bool is_clique = f.type == "clique";
        if (!is_clique && f.type != "knapsack") {
            in_.fail_at(f.line,
                        "functions of type '" + std::string(f.type) + "' are not supported");
        }
        if ((is_clique ? f.counts.size() : f.weights.size()) != f.scope.size()) {
            in_.fail_at(f.line, "the parameters do not fit the scope");
        }
        Rule rule{is_clique ? Relation::LessEqual : Relation::GreaterEqual, f.side, {}};
        for (std::size_t k = 0; k < f.scope.size(); ++k) {
            std::int64_t weight = is_clique ? 0 : f.weights[k];
            if (is_clique) {
                weight = (f.counts[k][1] ? 1 : 0) - (f.counts[k][0] ? 1 : 0);
                if (f.counts[k][0]) --rule.right_hand_side;
            }
            if (std::abs(weight) > std::numeric_limits<std::int32_t>::max()) {
                in_.fail_at(f.line, "a weight exceeds 2^31 - 1");
            }
            rule.terms.push_back({static_cast<std::int32_t>(weight), f.scope[k]});
        }
        const bool is_half = f.name.ends_with("_eq");
        if (f.name.ends_with("_le") || (is_half && half_rule_)) negate(rule);
        if (is_half && half_rule_ && rules_.back().terms == rule.terms &&
            rules_.back().right_hand_side == rule.right_hand_side) {
            rules_.back().relation = Relation::Equal;
            half_rule_ = false;
            return;
        }
        half_rule_ = is_half && rule.relation == Relation::GreaterEqual;
        rules_.push_back(std::move(rule));
    }

    static void negate(Rule& rule) {
        rule.relation =
            rule.relation == Relation::LessEqual ? Relation::GreaterEqual : Relation::LessEqual;
        rule.right_hand_side *= -1;
        for (Term& t : rule.terms) t.coefficient *= -1;
    }

    void table(const Function& f) {
        half_rule_ = false;
        const std::vector<Value> costs = full_table(f);
        const auto is_allowed = [this](Value cost) { return cost < top_; };
        Value most = std::numeric_limits<Value>::min();
        for (Value cost : costs) most = is_allowed(cost) ? std::max(most, cost) : most;
        if (most > std::numeric_limits<Value>::min()) add(reach_, most, f.line);
        if (const auto rule = rule_in_name(f.name, f.scope)) {
            bool agrees = true;
            for (std::uint32_t row = 0; row < costs.size(); ++row) {
                agrees = agrees && (holds(*rule, row) ? costs[row] == 0 : costs[row] >= top_);
            }
            if (agrees) {
                rules_.push_back(*rule);
                return;
            }
        }
        forbid(f.scope, costs);
        if (f.scope.size() <= 2) {
            small_table(f, costs);
            return;
        }
        for (Value cost : costs) {
            if (is_allowed(cost) && cost != most) {
                in_.fail_at(f.line, "costs that depend on more than two variables");
            }
        }
        if (most > std::numeric_limits<Value>::min()) add(constant_, most, f.line);
    }

    /// Costs of all assignments, the last variable turning fastest.
    std::vector<Value> full_table(const Function& f) const {
        const std::size_t arity = f.scope.size();
        if (arity > kMostTableLabels) {
            in_.fail_at(f.line,
                        "a table of more than " + std::to_string(kMostTableLabels) + " variables");
        }
        std::vector<Value> costs(std::size_t{1} << arity, f.default_cost.value_or(0));
        if (!f.default_cost) {
            if (f.costs.size() != costs.size()) {
                in_.fail_at(f.line, "expected " + std::to_string(costs.size()) + " costs, found " +
                                        std::to_string(f.costs.size()));
            }
            for (std::size_t k = 0; k < costs.size(); ++k) {
                costs[k] = in_.integer_of(f.costs[k], "cost");
            }
            return costs;
        }
        if (f.costs.size() % (arity + 1) != 0) {
            in_.fail_at(f.line, "the costs are no tuples of values with a cost each");
        }
        for (std::size_t k = 0; k < f.costs.size(); k += arity + 1) {
            std::size_t row = 0;
            for (std::size_t v = 0; v < arity; ++v) {
                row = 2 * row + value_index(f, f.scope[v], f.costs[k + v]);
            }
            costs[row] = in_.integer_of(f.costs[k + arity], "cost");
        }
        return costs;
    }

    std::size_t value_index(const Function& f, Label variable, std::string_view value) const {
        for (std::size_t v : {0, 1}) {
            if (value_names_[2 * static_cast<std::size_t>(variable) + v] == value) return v;
        }
        if (value == "0" || value == "1") return value == "1" ? 1 : 0;
        in_.fail_at(f.line, "'" + std::string(value) + "' is no value of its variable");
    }

    /// A clause for each largest cube of forbidden assignments, until all are covered.
    void forbid(const std::vector<Label>& scope, const std::vector<Value>& costs) {
        const auto arity = static_cast<std::uint32_t>(scope.size());
        const auto rows = static_cast<std::uint32_t>(costs.size());
        std::vector<bool> is_covered(rows, false);
        for (std::uint32_t row = 0; row < rows; ++row) {
            if (costs[row] < top_ || is_covered[row]) continue;
            std::uint32_t fixed = rows - 1;
            for (std::uint32_t k = 0; k < arity; ++k) {
                const std::uint32_t freer = fixed & ~(1U << k);
                bool is_forbidden = true;
                for (std::uint32_t other = 0; other < rows; ++other) {
                    if (((other ^ row) & freer) == 0 && costs[other] < top_) is_forbidden = false;
                }
                if (is_forbidden) fixed = freer;
            }
            for (std::uint32_t other = 0; other < rows; ++other) {
                if (((other ^ row) & fixed) == 0) is_covered[other] = true;
            }
            clause(scope, fixed, row);
        }
    }

    void clause(const std::vector<Label>& scope, std::uint32_t fixed, std::uint32_t values) {
        Rule rule{Relation::LessEqual, -1, {}};
        for (std::size_t k = 0; k < scope.size(); ++k) {
            const std::uint32_t bit = 1U << (scope.size() - 1 - k);
            if ((fixed & bit) == 0) continue;
            const bool is_on = (values & bit) != 0;
            rule.terms.push_back({is_on ? 1 : -1, scope[k]});
            if (is_on) ++rule.right_hand_side;
        }
        if (rule.terms.size() == 2 && rule.right_hand_side == 1) {
            conflicts_.push_back({rule.terms[0].label, rule.terms[1].label});
        } else {
            rules_.push_back(std::move(rule));
        }
    }

    /// Takes the costs of up to two labels apart. Forbidden entries are free: they are chosen so
    /// that nothing is left for the pair.
    void small_table(const Function& f, std::vector<Value> costs) {
        constexpr int kSigns[] = {1, -1, -1, 1};
        const bool is_pair = f.scope.size() == 2;
        std::size_t free = costs.size();
        for (std::size_t k = 0; k < costs.size(); ++k) {
            if (costs[k] < top_) continue;
            costs[k] = 0;
            free = k;
        }
        Value both = 0;
        for (std::size_t k = 0; is_pair && k < 4; ++k) both += kSigns[k] * costs[k];
        if (is_pair && free < 4) costs[free] = -kSigns[free] * std::exchange(both, 0);
        if (f.scope.size() == 1 && free < 2) costs[free] = costs[1 - free];
        add(constant_, costs[0], f.line);
        if (f.scope.size() == 1) add(weights_[f.scope[0]], costs[0] - costs[1], f.line);
        if (!is_pair) return;
        add(weights_[f.scope[0]], costs[0] - costs[2], f.line);
        add(weights_[f.scope[1]], costs[0] - costs[1], f.line);
        if (both == 0) return;
        Pair& pair = pairs_[std::minmax(f.scope[0], f.scope[1])];
        pair.line = f.line;
        add(pair.bonus, -both, f.line);
    }

    void add(Value& total, Value value, std::size_t line) const {
        constexpr Value kMost = Value{1} << 60;
        total += value;
        if (total > kMost || total < -kMost)
            in_.fail_at(line, "the costs add up to more than 2^60");
    }

    LabelingProblem build() {
        if (reach_ >= top_) {
            in_.fail("allowed costs add up to " + std::to_string(reach_) + ", but 'mustbe' is " +
                     std::to_string(top_) + ": a bound on the objective is not supported");
        }
        ProblemBuilder builder;
        try {
            for (Value weight : weights_) builder.add_label(weight);
            for (const Conflict& c : conflicts_) builder.add_conflict(c.first, c.second);
            for (const auto& [labels, pair] : pairs_) {
                if (pair.bonus < 0) {
                    in_.fail_at(pair.line,
                                "two values 1 cost more together than apart; a bonus "
                                "cannot be negative");
                }
                builder.add_bonus(labels.first, labels.second, pair.bonus);
            }
            for (Rule& rule : rules_) builder.add_rule(std::move(rule));
            if (constant_ != 0) {
                const Label one = builder.add_label(-constant_);
                builder.add_rule({Relation::GreaterEqual, 1, {{1, one}}});
            }
            return builder.build();
        } catch (const InputError& error) {
            const std::string_view what = error.what();
            if (what.starts_with(in_.source())) throw;
            throw InputError(in_.source() + ": " + std::string(what));
        }
    }

    struct Pair {
        Value bonus = 0;
        std::size_t line = 0;
    };

    CfnTokens in_;
    Value top_ = 0, reach_ = 0, constant_ = 0;
    std::unordered_map<std::string_view, Label> labels_;
    std::vector<std::string_view> value_names_;  ///< two per label
    std::vector<Value> weights_;
    std::vector<Conflict> conflicts_;
    std::map<std::pair<Label, Label>, Pair> pairs_;
    std::vector<Rule> rules_;
    bool half_rule_ = false;  ///< the last rule is the first half of an equation
};

}  // namespace

LabelingProblem parse_cfn(std::string_view text, std::string_view source) {
    return CfnReader(text, source).run();
}

}  // namespace labeling::detail
