#include "adaptation/explanation.h"

#include <algorithm>
#include <set>

namespace fcn {

namespace {

/// Labels other than `label` that are 1 and push the rule's sum towards its violation.
void add_pushing_labels(const labeling::Rule& rule, int label, bool is_sum_too_large,
                        const std::vector<std::uint8_t>& labels, std::set<int>& blockers) {
    for (const labeling::Term& term : rule.terms) {
        if (term.label == label || labels[term.label] == 0) continue;
        if ((term.coefficient > 0) == is_sum_too_large) blockers.insert(term.label);
    }
}

std::int64_t sum_of(const labeling::Rule& rule, const std::vector<std::uint8_t>& labels) {
    std::int64_t sum = 0;
    for (const labeling::Term& term : rule.terms)
        sum += std::int64_t{term.coefficient} * labels[term.label];
    return sum;
}

bool holds(const labeling::Rule& rule, const std::vector<std::uint8_t>& labels) {
    const std::int64_t sum = sum_of(rule, labels);
    if (rule.relation != labeling::Relation::GreaterEqual && sum > rule.right_hand_side)
        return false;
    return rule.relation == labeling::Relation::LessEqual || sum >= rule.right_hand_side;
}

/// Bonuses of a label with the kept ones, itself aside.
labeling::Value bonus_sum(const labeling::LabelingProblem& problem,
                          const std::vector<std::uint8_t>& labels, int label) {
    labeling::Value sum = 0;
    for (const auto& partner : problem.bonuses_of(label))
        if (labels[partner.label] == 1) sum += partner.value;
    return sum;
}

}  // namespace

std::vector<int> find_blockers(const labeling::LabelingProblem& problem,
                               const labeling::Solution& solution, int label) {
    std::set<int> blockers;
    for (labeling::Label other : problem.conflicts_of(label)) {
        if (solution.labels[other] == 1) blockers.insert(other);
    }
    std::vector<std::uint8_t> labels = solution.labels;
    labels[label] = 1;
    for (int other : blockers) labels[other] = 0;
    for (const auto& use : problem.rules_of(label)) {
        const labeling::Rule& rule = problem.rules()[use.rule];
        const std::int64_t sum = sum_of(rule, labels);
        if (rule.relation != labeling::Relation::GreaterEqual && sum > rule.right_hand_side) {
            add_pushing_labels(rule, label, true, labels, blockers);
        }
        if (rule.relation != labeling::Relation::LessEqual && sum < rule.right_hand_side) {
            add_pushing_labels(rule, label, false, labels, blockers);
        }
    }
    return {blockers.begin(), blockers.end()};
}

std::optional<labeling::Value> swap_margin(const labeling::LabelingProblem& problem,
                                           const labeling::Solution& solution, int label,
                                           const std::vector<int>& blockers) {
    std::vector<std::uint8_t> labels = solution.labels;
    labeling::Value loss = 0;
    // Each blocker leaves with the bonuses to those that are still there, so no pair counts twice.
    for (const int blocker : blockers) {
        loss += problem.weight(blocker) + bonus_sum(problem, labels, blocker);
        labels[blocker] = 0;
    }
    loss -= problem.weight(label) + bonus_sum(problem, labels, label);
    labels[label] = 1;
    const auto is_kept = [&](labeling::Label other) { return labels[other] == 1; };
    if (std::ranges::any_of(problem.conflicts_of(label), is_kept)) return {};
    std::vector<int> changed = blockers;
    changed.push_back(label);
    for (const int change : changed) {
        for (const auto& use : problem.rules_of(change))
            if (!holds(problem.rules()[use.rule], labels)) return {};
    }
    return loss;
}

}  // namespace fcn
