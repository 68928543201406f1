// CFN, the JSON format of toulbar2 (cost function networks): one variable b<i> of two values per
// label, costs are negated weights and bonuses. What is forbidden costs as much as the upper bound
// `mustbe`, which no labeling reaches: twice the sum of all absolute weights and bonuses, plus one.
// Rules of at most six labels are cost tables, longer ones linear constraints (`knapsack`, a sum >=
// capacity): toulbar2 1.1.1 answers wrongly on some knapsacks of two labels. A rule without labels
// is a table on the first label. The name of a rule's function tells the rule, for our reader.
#include "labeling/errors.h"
#include "labeling/formats_detail.h"

namespace labeling::detail {
namespace {

constexpr std::size_t kMostTableLabels = 6;

class CfnWriter {
public:
    explicit CfnWriter(const LabelingProblem& problem) : problem_(problem) {
        for (Value w : problem.weights()) top_ += 2 * std::abs(w);
        for (const Bonus& b : problem.bonuses()) top_ += 2 * b.value;
        ++top_;
    }

    std::string run() {
        out_ = "{\n\"problem\": {\"name\": \"labeling\", \"mustbe\": \"<" + std::to_string(top_) +
               "\"},\n\"variables\": {";
        for (Label i = 0; i < problem_.label_count(); ++i) {
            out_ += (i == 0 ? "\n" : ",\n") + quoted(i) + ": 2";
        }
        out_ += "\n},\n\"functions\": {";
        for (Label i = 0; i < problem_.label_count(); ++i) {
            if (problem_.weight(i) != 0) table('l', {i}, {0, -problem_.weight(i)});
        }
        for (const Conflict& c : problem_.conflicts()) {
            table('x', {c.first, c.second}, {0, 0, 0, top_});
        }
        for (const Bonus& b : problem_.bonuses()) {
            table('q', {b.first, b.second}, {0, 0, 0, -b.value});
        }
        for (const Rule& rule : problem_.rules()) this->rule(rule);
        out_ += "\n}\n}\n";
        return std::move(out_);
    }

private:
    static std::string quoted(Label i) { return "\"b" + std::to_string(i + 1) + "\""; }

    void begin(char kind, const std::vector<Label>& scope, const std::string& suffix = {}) {
        out_ += count_ == 0 ? "\n\"" : ",\n\"";
        ++count_;
        out_ += kind + std::to_string(count_) + suffix + "\": {\"scope\": [";
        for (std::size_t k = 0; k < scope.size(); ++k) {
            out_ += (k == 0 ? "" : ", ") + quoted(scope[k]);
        }
        out_ += ']';
    }

    template <class Numbers>
    void list(const char* key, const Numbers& numbers) {
        out_ += std::string("\"") + key + "\": [";
        bool is_first = true;
        for (auto number : numbers) {
            if (!is_first) out_ += ", ";
            append(out_, number);
            is_first = false;
        }
        out_ += ']';
    }

    void table(char kind, const std::vector<Label>& scope, const std::vector<Value>& costs,
               const std::string& suffix = {}) {
        begin(kind, scope, suffix);
        out_ += ", ";
        list("costs", costs);
        out_ += '}';
    }

    void rule(const Rule& rule) {
        std::vector<Label> scope;
        for (const Term& t : rule.terms) scope.push_back(t.label);
        std::string told = relation_suffix(rule);
        if (scope.size() > kMostTableLabels) {
            if (rule.relation != Relation::LessEqual) knapsack(rule, scope, 1);
            if (rule.relation != Relation::GreaterEqual) knapsack(rule, scope, -1);
            return;
        }
        told += '_' + std::to_string(rule.right_hand_side);
        for (const Term& t : rule.terms) told += '_' + std::to_string(t.coefficient);
        if (scope.empty()) scope.push_back(0);
        std::vector<Value> costs;
        for (std::int64_t row = 0; row < (std::int64_t{1} << scope.size()); ++row) {
            // The last label of the scope turns fastest.
            std::int64_t sum = 0;
            for (std::size_t k = 0; k < rule.terms.size(); ++k) {
                const bool is_on = ((row >> (scope.size() - 1 - k)) & 1) != 0;
                sum += is_on ? rule.terms[k].coefficient : 0;
            }
            costs.push_back(holds(rule, sum) ? 0 : top_);
        }
        table('r', scope, costs, told);
    }

    static std::string relation_suffix(const Rule& rule) {
        return rule.relation == Relation::LessEqual      ? "_le"
               : rule.relation == Relation::GreaterEqual ? "_ge"
                                                         : "_eq";
    }

    static bool holds(const Rule& rule, std::int64_t sum) {
        return rule.relation == Relation::LessEqual      ? sum <= rule.right_hand_side
               : rule.relation == Relation::GreaterEqual ? sum >= rule.right_hand_side
                                                         : sum == rule.right_hand_side;
    }

    void knapsack(const Rule& rule, const std::vector<Label>& scope, std::int64_t sign) {
        begin('r', scope, relation_suffix(rule));
        out_ += ", \"type\": \"knapsack\", \"params\": {\"capacity\": ";
        append(out_, sign * rule.right_hand_side);
        out_ += ", ";
        std::vector<std::int64_t> weights;
        for (const Term& t : rule.terms) weights.push_back(sign * t.coefficient);
        list("weights", weights);
        out_ += "}}";
    }

    const LabelingProblem& problem_;
    std::string out_;
    Value top_ = 0;
    std::int64_t count_ = 0;
};

}  // namespace

std::string format_cfn(const LabelingProblem& problem) {
    if (problem.label_count() == 0) throw InputError("a CFN file needs at least one label");
    return CfnWriter(problem).run();
}

}  // namespace labeling::detail
