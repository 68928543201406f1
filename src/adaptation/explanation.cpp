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
        std::int64_t sum = 0;
        for (const labeling::Term& term : rule.terms) {
            sum += std::int64_t{term.coefficient} * labels[term.label];
        }
        if (rule.relation != labeling::Relation::GreaterEqual && sum > rule.right_hand_side) {
            add_pushing_labels(rule, label, true, labels, blockers);
        }
        if (rule.relation != labeling::Relation::LessEqual && sum < rule.right_hand_side) {
            add_pushing_labels(rule, label, false, labels, blockers);
        }
    }
    return {blockers.begin(), blockers.end()};
}

}  // namespace fcn
