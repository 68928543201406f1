// Renaming by a random permutation (Fisher and Yates), made by hand so that it is the same with
// every standard library.
#include "labeling/renaming.h"

#include <numeric>
#include <random>

namespace labeling {
namespace {

template <class Item>
void shuffle(std::vector<Item>& items, std::mt19937_64& engine) {
    for (std::size_t k = items.size(); k > 1; --k) std::swap(items[k - 1], items[engine() % k]);
}

}  // namespace

RenamedProblem rename_labels(const LabelingProblem& problem, std::uint64_t seed) {
    std::vector<Label> to(static_cast<std::size_t>(problem.label_count()));
    std::iota(to.begin(), to.end(), 0);
    if (seed == 0) return {problem, std::move(to)};
    std::mt19937_64 engine(seed);
    shuffle(to, engine);
    std::vector<Value> weights(to.size());
    for (std::size_t i = 0; i < to.size(); ++i) {
        weights[to[i]] = problem.weight(static_cast<Label>(i));
    }
    ProblemBuilder builder;
    for (Value w : weights) builder.add_label(w);
    for (const Conflict& c : problem.conflicts()) builder.add_conflict(to[c.first], to[c.second]);
    for (const Bonus& b : problem.bonuses()) builder.add_bonus(to[b.first], to[b.second], b.value);
    std::vector<Rule> rules(problem.rules().begin(), problem.rules().end());
    shuffle(rules, engine);
    for (Rule& rule : rules) {
        for (Term& term : rule.terms) term.label = to[term.label];
        builder.add_rule(std::move(rule));
    }
    builder.set_units_per_one(problem.units_per_one());
    return {builder.build(), std::move(to)};
}

Solution original_solution(const RenamedProblem& renamed, const Solution& solution) {
    Solution original{std::vector<std::uint8_t>(renamed.renamed.size()), solution.value};
    for (std::size_t i = 0; i < renamed.renamed.size(); ++i) {
        original.labels[i] = solution.labels[renamed.renamed[i]];
    }
    return original;
}

Solution renamed_solution(const RenamedProblem& renamed, const Solution& solution) {
    Solution told{std::vector<std::uint8_t>(renamed.renamed.size()), solution.value};
    for (std::size_t i = 0; i < renamed.renamed.size(); ++i) {
        told.labels[renamed.renamed[i]] = solution.labels[i];
    }
    return told;
}

std::vector<std::int8_t> renamed_start(const RenamedProblem& renamed,
                                       const std::vector<std::int8_t>& start) {
    std::vector<std::int8_t> told(start.size());
    for (std::size_t i = 0; i < start.size(); ++i) told[renamed.renamed[i]] = start[i];
    return told;
}

}  // namespace labeling
