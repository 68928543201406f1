// Later iterations change a few places of the network only, and most of the conflict graph falls
// apart into small components; each is solved once. A component is known again by its content.

#include "adaptation/incremental_solver.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "geometry/errors.h"

namespace fcn {

namespace {

using labeling::Label;
using labeling::LabelingProblem;
using labeling::Relation;
using labeling::Rule;
using labeling::SolveResult;
using labeling::SolveStatus;
using labeling::Value;

/// Work for all calls together when neither a work nor a time limit is given (about ten seconds);
/// then a component always gets enough for a good local search.
constexpr std::int64_t kDefaultWork = 100'000'000;
constexpr std::int64_t kLeastWork = 2'000'000;
/// Where limits bind. A heuristic takes whatever it is given, so components share what is left by
/// their size, small ones first: what they do not need goes to the large ones. A call leaves a
/// quarter to those that follow.
constexpr double kShareOfCall = 0.75;
constexpr std::int64_t kSmallestShare = 1000;
constexpr double kSmallestTime = 0.05;

/// Labels whose value single-label rules and conflicts with labels fixed to 1 decide; -1 = free.
/// nullopt when they contradict each other.
std::optional<std::vector<std::int8_t>> fixed_labels(const LabelingProblem& problem) {
    std::vector<std::int8_t> fixed(problem.label_count(), -1);
    for (const Rule& rule : problem.rules()) {
        if (rule.terms.size() != 1) continue;
        const auto [coefficient, label] = rule.terms[0];
        bool allowed[2];
        for (int value = 0; value < 2; ++value) {
            const std::int64_t left = std::int64_t{coefficient} * value;
            allowed[value] = rule.relation == Relation::LessEqual ? left <= rule.right_hand_side
                             : rule.relation == Relation::GreaterEqual
                                 ? left >= rule.right_hand_side
                                 : left == rule.right_hand_side;
        }
        for (int value = 0; value < 2; ++value) {
            if (!allowed[value] && fixed[label] == value) return std::nullopt;
            if (!allowed[value] && allowed[1 - value]) {
                fixed[label] = static_cast<std::int8_t>(1 - value);
            }
        }
        if (!allowed[0] && !allowed[1]) return std::nullopt;
    }
    for (const labeling::Conflict& conflict : problem.conflicts()) {
        for (const auto& [i, j] : {std::pair(conflict.first, conflict.second),
                                   std::pair(conflict.second, conflict.first)}) {
            if (fixed[i] != 1) continue;
            if (fixed[j] == 1) return std::nullopt;
            fixed[j] = 0;
        }
    }
    return fixed;
}

struct Components {
    std::vector<int> of_label;  ///< -1 for fixed labels
    int count = 0;
};

Components find_components(const LabelingProblem& problem, const std::vector<std::int8_t>& fixed) {
    std::vector<int> parent(problem.label_count());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    const auto join = [&](int i, int j) {
        if (fixed[i] >= 0 || fixed[j] >= 0) return;
        i = root(i);
        j = root(j);
        parent[std::max(i, j)] = std::min(i, j);
    };
    for (const auto& conflict : problem.conflicts()) join(conflict.first, conflict.second);
    for (const auto& bonus : problem.bonuses()) join(bonus.first, bonus.second);
    for (const Rule& rule : problem.rules()) {
        int first = -1;
        for (const auto& term : rule.terms) {
            if (fixed[term.label] >= 0) continue;
            if (first >= 0) join(first, term.label);
            first = term.label;
        }
    }
    Components result;
    result.of_label.assign(problem.label_count(), -1);
    for (Label i = 0; i < problem.label_count(); ++i) {
        if (fixed[i] < 0 && root(i) == i) result.of_label[i] = result.count++;
    }
    for (Label i = 0; i < problem.label_count(); ++i) {
        if (fixed[i] < 0) result.of_label[i] = result.of_label[root(i)];
    }
    return result;
}

/// Smallest and largest value that the free terms of a rule can take.
std::pair<std::int64_t, std::int64_t> activity_range(const Rule& rule) {
    std::int64_t low = 0, high = 0;
    for (const auto& term : rule.terms) (term.coefficient < 0 ? low : high) += term.coefficient;
    return {low, high};
}

/// The rule with fixed labels substituted; nullopt when nothing is left to say.
std::optional<Rule> reduced_rule(const Rule& rule, const std::vector<std::int8_t>& fixed) {
    Rule result{rule.relation, rule.right_hand_side, {}};
    for (const auto& term : rule.terms) {
        if (fixed[term.label] < 0) {
            result.terms.push_back(term);
        } else {
            result.right_hand_side -= std::int64_t{term.coefficient} * fixed[term.label];
        }
    }
    const auto [low, high] = activity_range(result);
    const bool holds_above = high <= result.right_hand_side;
    const bool holds_below = low >= result.right_hand_side;
    const bool is_redundant = rule.relation == Relation::LessEqual ? holds_above
                              : rule.relation == Relation::GreaterEqual
                                  ? holds_below
                                  : holds_above && holds_below;
    if (is_redundant) return std::nullopt;
    return result;
}

double size_of(const LabelingProblem& problem) {
    return static_cast<double>(problem.label_count()) +
           static_cast<double>(problem.conflict_count() + problem.bonus_count());
}

}  // namespace

IncrementalSolver::IncrementalSolver(const labeling::Solver& solver, labeling::SolveOptions options)
    : solver_(solver), options_(std::move(options)), start_(std::chrono::steady_clock::now()) {}

const SolveResult* IncrementalSolver::recall(const LabelingProblem& problem) const {
    const auto [first, last] = memory_.equal_range(problem.hash());
    for (auto it = first; it != last; ++it) {
        const LabelingProblem& known = it->second.problem;
        const bool is_equal = std::ranges::equal(known.weights(), problem.weights()) &&
                              std::ranges::equal(known.conflicts(), problem.conflicts()) &&
                              std::ranges::equal(known.bonuses(), problem.bonuses()) &&
                              std::ranges::equal(known.rules(), problem.rules());
        if (is_equal) return &it->second.result;
    }
    return nullptr;
}

SolveResult IncrementalSolver::solve_component(const Component& component,
                                               const std::vector<std::int8_t>& warm_start,
                                               double share) {
    if (const SolveResult* known = recall(component.problem)) {
        ++components_reused_;
        return *known;
    }
    ++components_solved_;
    labeling::SolveOptions options = options_;
    if (options.time_limit) {
        const std::chrono::duration<double> used = std::chrono::steady_clock::now() - start_;
        options.time_limit = std::max(std::chrono::duration<double>(kSmallestTime),
                                      share * (*options.time_limit - used));
    }
    const std::int64_t limit = options.work_limit.value_or(kDefaultWork);
    const auto part = static_cast<std::int64_t>(
        share * static_cast<double>(std::max<std::int64_t>(0, limit - work_used_)));
    if (options.work_limit) {
        options.work_limit = std::max(kSmallestShare, part);
    } else if (!options.time_limit) {
        options.work_limit = std::max(kLeastWork, part);
    }
    options.warm_start.clear();
    if (!warm_start.empty()) {
        for (Label label : component.labels) options.warm_start.push_back(warm_start[label]);
    }
    SolveResult result = solver_.solve(component.problem, options);
    work_used_ += result.work;
    memory_.emplace(component.problem.hash(), Memory{component.problem, result});
    return result;
}

SolveResult IncrementalSolver::solve(const LabelingProblem& problem,
                                     const std::vector<std::int8_t>& warm_start) {
    SolveResult total;
    total.solver = solver_.name();
    const auto fixed = fixed_labels(problem);
    if (!fixed) {
        total.status = SolveStatus::Infeasible;
        return total;
    }
    const Components components = find_components(problem, *fixed);
    std::vector<labeling::ProblemBuilder> builders(components.count);
    std::vector<std::vector<Label>> members(components.count);
    std::vector<Label> local(problem.label_count(), -1);
    Value fixed_value = 0;
    std::vector<Value> weights(problem.weights().begin(), problem.weights().end());
    for (const auto& bonus : problem.bonuses()) {
        const auto i = (*fixed)[bonus.first], j = (*fixed)[bonus.second];
        if (i == 1 && j == 1) fixed_value += bonus.value;
        if (i == 1 && j < 0) weights[bonus.second] += bonus.value;
        if (i < 0 && j == 1) weights[bonus.first] += bonus.value;
    }
    for (Label l = 0; l < problem.label_count(); ++l) {
        if ((*fixed)[l] == 1) fixed_value += problem.weight(l);
        if ((*fixed)[l] >= 0) continue;
        const int c = components.of_label[l];
        local[l] = builders[c].add_label(weights[l]);
        members[c].push_back(l);
    }
    for (const auto& conflict : problem.conflicts()) {
        if (local[conflict.first] < 0 || local[conflict.second] < 0) continue;
        builders[components.of_label[conflict.first]].add_conflict(local[conflict.first],
                                                                   local[conflict.second]);
    }
    for (const auto& bonus : problem.bonuses()) {
        if (local[bonus.first] < 0 || local[bonus.second] < 0) continue;
        builders[components.of_label[bonus.first]].add_bonus(local[bonus.first],
                                                             local[bonus.second], bonus.value);
    }
    for (const Rule& rule : problem.rules()) {
        auto reduced = reduced_rule(rule, *fixed);
        if (!reduced) continue;
        if (reduced->terms.empty()) {
            total.status = SolveStatus::Infeasible;
            return total;
        }
        const int c = components.of_label[reduced->terms.front().label];
        for (auto& term : reduced->terms) term.label = local[term.label];
        builders[c].add_rule(std::move(*reduced));
    }

    labeling::Solution solution;
    solution.labels.assign(problem.label_count(), 0);
    for (Label l = 0; l < problem.label_count(); ++l) solution.labels[l] = (*fixed)[l] == 1;
    Value value = fixed_value, bound = fixed_value;
    bool is_optimal = true, has_bound = true;
    std::vector<Component> parts;
    for (int c = 0; c < components.count; ++c) {
        parts.push_back({builders[c].build(), std::move(members[c])});
    }
    std::stable_sort(parts.begin(), parts.end(), [](const Component& a, const Component& b) {
        return size_of(a.problem) < size_of(b.problem);
    });
    double size_left = 0;
    for (const Component& part : parts) size_left += size_of(part.problem);
    for (const Component& component : parts) {
        const double size = size_of(component.problem);
        const SolveResult result =
            solve_component(component, warm_start, kShareOfCall * size / size_left);
        size_left -= size;
        total.work += result.work;
        if (result.stop_reason != labeling::StopReason::Finished) {
            total.stop_reason = result.stop_reason;
        }
        if (!result.solution) {
            total.status = result.status;
            total.message = result.message;
            return total;
        }
        is_optimal = is_optimal && result.status == SolveStatus::Optimal;
        has_bound = has_bound && result.bound.has_value();
        if (result.bound) bound += *result.bound;
        value += result.solution->value;
        for (std::size_t k = 0; k < component.labels.size(); ++k) {
            solution.labels[component.labels[k]] = result.solution->labels[k];
        }
    }
    solution.value = value;
    const labeling::SolutionCheck check = labeling::check_solution(problem, solution);
    if (!check.is_feasible || !check.value_matches) {
        throw LogicError("components do not add up to the problem: " + check.message);
    }
    total.status = is_optimal ? SolveStatus::Optimal : SolveStatus::Feasible;
    total.solution = std::move(solution);
    if (has_bound) total.bound = bound;
    total.statistics["components"] = components.count;
    total.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    return total;
}

}  // namespace fcn
