#include "labeling/solution.h"

#include "labeling/errors.h"

namespace labeling {
namespace {

bool holds(const Rule& rule, const std::vector<std::uint8_t>& labels) {
    std::int64_t activity = 0;
    for (const Term& t : rule.terms) {
        if (labels[t.label] != 0) activity += t.coefficient;
    }
    switch (rule.relation) {
        case Relation::LessEqual:
            return activity <= rule.right_hand_side;
        case Relation::GreaterEqual:
            return activity >= rule.right_hand_side;
        case Relation::Equal:
            return activity == rule.right_hand_side;
    }
    throw LogicError("rule with an unknown relation");
}

std::string describe(const SolutionCheck& check, const Solution& solution) {
    std::string text;
    if (!check.violated_conflicts.empty()) {
        const Conflict& c = check.violated_conflicts.front();
        text = std::to_string(check.violated_conflicts.size()) + " violated conflict(s), first (" +
               std::to_string(c.first + 1) + ", " + std::to_string(c.second + 1) + ")";
    }
    if (!check.violated_rules.empty()) {
        if (!text.empty()) text += "; ";
        text += std::to_string(check.violated_rules.size()) + " violated rule(s), first rule " +
                std::to_string(check.violated_rules.front() + 1);
    }
    if (!check.value_matches) {
        if (!text.empty()) text += "; ";
        text += "claimed value " + std::to_string(solution.value) + ", recomputed " +
                std::to_string(check.value);
    }
    return text;
}

}  // namespace

SolutionCheck check_solution(const LabelingProblem& problem, const Solution& solution) {
    const auto& labels = solution.labels;
    if (labels.size() != static_cast<std::size_t>(problem.label_count())) {
        throw InputError("the solution has " + std::to_string(labels.size()) +
                         " labels, the problem " + std::to_string(problem.label_count()));
    }
    SolutionCheck check;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (labels[i] > 1) {
            throw InputError("label " + std::to_string(i + 1) + " has the value " +
                             std::to_string(labels[i]) + ", expected 0 or 1");
        }
        if (labels[i] == 1) check.value += problem.weight(static_cast<Label>(i));
    }
    for (const Bonus& b : problem.bonuses()) {
        if (labels[b.first] == 1 && labels[b.second] == 1) check.value += b.value;
    }
    for (const Conflict& c : problem.conflicts()) {
        if (labels[c.first] == 1 && labels[c.second] == 1) check.violated_conflicts.push_back(c);
    }
    const auto rules = problem.rules();
    for (std::size_t r = 0; r < rules.size(); ++r) {
        if (!holds(rules[r], labels)) check.violated_rules.push_back(static_cast<std::int32_t>(r));
    }
    check.is_feasible = check.violated_conflicts.empty() && check.violated_rules.empty();
    check.value_matches = solution.value == check.value;
    check.message = describe(check, solution);
    return check;
}

}  // namespace labeling
