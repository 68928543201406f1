#include "labeling/problems.h"

#include <algorithm>
#include <set>
#include <vector>

#include "labeling/solution.h"

namespace labeling_test {

using labeling::Bonus;
using labeling::Conflict;
using labeling::Label;
using labeling::ProblemBuilder;
using labeling::Relation;
using labeling::Rule;
using labeling::Term;

std::int64_t pick(std::mt19937_64& engine, std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine() % static_cast<std::uint64_t>(high - low + 1));
}

namespace {

Rule random_rule(std::mt19937_64& engine, Label n) {
    Rule rule;
    rule.relation = static_cast<Relation>(pick(engine, 0, 2));
    std::set<Label> members;
    const std::int64_t size = pick(engine, 0, std::min<std::int64_t>(n, 5));
    while (static_cast<std::int64_t>(members.size()) < size) {
        members.insert(static_cast<Label>(pick(engine, 0, n - 1)));
    }
    const bool is_unit = pick(engine, 0, 1) == 0;
    for (Label i : members) {
        std::int64_t c = pick(engine, -1, 1);
        if (!is_unit) c = pick(engine, -4, 4);
        rule.terms.push_back({static_cast<std::int32_t>(c), i});
    }
    rule.right_hand_side = pick(engine, -2, 3);
    if (rule.relation == Relation::Equal && pick(engine, 0, 1) == 0) rule.right_hand_side = 0;
    return rule;
}

}  // namespace

LabelingProblem random_problem(std::mt19937_64& engine, int most_labels) {
    ProblemBuilder builder;
    const auto n = static_cast<Label>(pick(engine, 1, most_labels));
    const std::int64_t negative_percent = pick(engine, 0, 2) * 20;
    const Value scale = pick(engine, 0, 3) == 0 ? 1'000'000'007 : pick(engine, 1, 30);
    for (Label i = 0; i < n; ++i) {
        Value weight = pick(engine, 0, 5) == 0 ? 0 : pick(engine, 0, 10) * scale;
        if (pick(engine, 0, 99) < negative_percent) weight = -weight;
        builder.add_label(weight);
    }
    const std::int64_t density = pick(engine, 0, 50);
    const std::int64_t bonus_density = pick(engine, 0, 40);
    for (Label i = 0; i < n; ++i) {
        for (Label j = i + 1; j < n; ++j) {
            if (pick(engine, 0, 99) < density) builder.add_conflict(i, j);
            if (pick(engine, 0, 99) < bonus_density) {
                builder.add_bonus(i, j, pick(engine, 0, 20) * scale);
            }
        }
    }
    const std::int64_t rules = pick(engine, 0, 4) == 0 ? 0 : pick(engine, 0, n);
    for (std::int64_t r = 0; r < rules; ++r) builder.add_rule(random_rule(engine, n));
    return builder.build();
}

LabelingProblem frustrated_problem(std::mt19937_64& engine, int labels) {
    ProblemBuilder builder;
    const auto n = static_cast<Label>(labels);
    for (Label i = 0; i < n; ++i) builder.add_label(pick(engine, 5, 9));
    const std::int64_t density = pick(engine, 15, 50);
    const std::int64_t bonus_density = pick(engine, 20, 90);
    const Value bonus = pick(engine, 0, 1) == 0 ? 6 : 40;
    for (Label i = 0; i < n; ++i) {
        for (Label j = i + 1; j < n; ++j) {
            if (pick(engine, 0, 99) < density) {
                builder.add_conflict(i, j);
            } else if (pick(engine, 0, 99) < bonus_density) {
                builder.add_bonus(i, j, pick(engine, bonus - 2, bonus));
            }
        }
    }
    const auto some_labels = [&](std::size_t count) {
        std::set<Label> members;
        while (members.size() < count) members.insert(static_cast<Label>(pick(engine, 0, n - 1)));
        return members;
    };
    for (std::int64_t k = pick(engine, 0, n); k > 0; --k) {
        Rule triple{Relation::LessEqual, 2, {}};
        for (Label i : some_labels(3)) triple.terms.push_back({1, i});
        builder.add_rule(triple);
    }
    for (std::int64_t k = pick(engine, 0, 2); k > 0; --k) {
        const std::size_t size = pick(engine, 0, 2) == 0 ? 4 : 3;
        Rule star{Relation::LessEqual, 2, {}};
        for (Label i : some_labels(size)) star.terms.push_back({1, i});
        const Label keep = builder.add_label(-pick(engine, 0, 10));
        star.terms.push_back({-static_cast<std::int32_t>(size - 2), keep});
        builder.add_rule(star);
        builder.add_conflict(keep, static_cast<Label>(pick(engine, 0, n - 1)));
    }
    return builder.build();
}

LabelingProblem curve_bundle(std::mt19937_64& engine, const BundleOptions& options) {
    ProblemBuilder builder;
    auto at = [&](int curve, int segment) {
        return static_cast<Label>(curve * options.segments + segment);
    };
    for (int k = 0; k < options.curves * options.segments; ++k) {
        builder.add_label(pick(engine, 1, 100));
    }
    std::set<std::pair<Label, Label>> conflicts;
    auto add_conflict = [&](Label a, Label b) {
        if (a == b || !conflicts.insert(std::minmax(a, b)).second) return;
        builder.add_conflict(a, b);
    };
    for (int c = 0; c < options.curves; ++c) {
        for (int s = 0; s < options.segments; ++s) {
            for (int other = c + 1; other <= std::min(c + options.reach, options.curves - 1);
                 ++other) {
                for (int t = std::max(0, s - 1); t <= std::min(s + 1, options.segments - 1); ++t) {
                    if (pick(engine, 0, 99) < 45) add_conflict(at(c, s), at(other, t));
                }
            }
            if (s + 1 < options.segments) {
                builder.add_bonus(at(c, s), at(c, s + 1),
                                  pick(engine, options.bonus / 2, options.bonus));
            }
        }
    }
    std::vector<Label> keeps;
    for (int k = 0; k < options.crossings; ++k) {
        // A node on one curve that the neighbouring curve ends in.
        const auto c = static_cast<int>(pick(engine, 0, options.curves - 2));
        const auto s = static_cast<int>(pick(engine, 0, options.segments - 2));
        const Label keep = builder.add_label(0);
        Rule valence{Relation::LessEqual, 2, {}};
        std::vector<Label> star{at(c, s), at(c, s + 1), at(c + 1, s)};
        if (pick(engine, 0, 2) == 0) star.push_back(at(c + 1, s + 1));
        for (Label i : star) valence.terms.push_back({1, i});
        valence.terms.push_back({-static_cast<std::int32_t>(star.size() - 2), keep});
        builder.add_rule(valence);
        builder.add_bonus(at(c, s), at(c + 1, s), pick(engine, 0, options.bonus));
        keeps.push_back(keep);
    }
    for (std::size_t a = 0; a < keeps.size(); ++a) {
        for (std::size_t b = a + 1; b < keeps.size(); ++b) {
            if (pick(engine, 0, 99) < 30) add_conflict(keeps[a], keeps[b]);
        }
    }
    const std::vector<std::pair<Label, Label>> pairs(conflicts.begin(), conflicts.end());
    for (int c = 0; c < options.curves; ++c) {
        for (int s = 1; s + 1 < options.segments; ++s) {
            if (pick(engine, 0, 99) >= options.short_percent) continue;
            const Label e = at(c, s), before = at(c, s - 1), after = at(c, s + 1);
            builder.add_rule({Relation::LessEqual, 0, {{1, e}, {-1, before}, {-1, after}}});
            for (const auto& [i, j] : pairs) {
                const Label other = i == e ? j : j == e ? i : -1;
                if (other < 0 || other == before || other == after) continue;
                builder.add_rule({Relation::LessEqual, 2, {{1, before}, {1, after}, {1, other}}});
            }
        }
    }
    return builder.build();
}

std::optional<labeling::Solution> enumerate_best(const LabelingProblem& problem) {
    const Label n = problem.label_count();
    std::optional<Value> best;
    std::uint32_t best_set = 0;
    for (std::uint32_t set = 0; set < (std::uint32_t{1} << n); ++set) {
        auto is_on = [set](Label i) { return ((set >> i) & 1U) != 0; };
        bool is_feasible = true;
        for (const Conflict& c : problem.conflicts()) {
            is_feasible = is_feasible && !(is_on(c.first) && is_on(c.second));
        }
        for (const Rule& rule : problem.rules()) {
            if (!is_feasible) break;
            std::int64_t sum = 0;
            for (const Term& t : rule.terms) sum += is_on(t.label) ? t.coefficient : 0;
            const std::int64_t side = rule.right_hand_side;
            is_feasible = rule.relation == Relation::LessEqual      ? sum <= side
                          : rule.relation == Relation::GreaterEqual ? sum >= side
                                                                    : sum == side;
        }
        if (!is_feasible) continue;
        Value value = 0;
        for (Label i = 0; i < n; ++i) value += is_on(i) ? problem.weight(i) : 0;
        for (const Bonus& b : problem.bonuses()) {
            value += is_on(b.first) && is_on(b.second) ? b.value : 0;
        }
        if (best && value <= *best) continue;
        best = value;
        best_set = set;
    }
    if (!best) return std::nullopt;
    labeling::Solution solution{{}, *best};
    for (Label i = 0; i < n; ++i) solution.labels.push_back((best_set >> i) & 1U);
    return solution;
}

std::optional<Value> enumerate_optimum(const LabelingProblem& problem) {
    const auto best = enumerate_best(problem);
    return best ? std::optional(best->value) : std::nullopt;
}

std::vector<std::optional<Value>> all_values(const LabelingProblem& problem) {
    std::vector<std::optional<Value>> values;
    labeling::Solution solution;
    solution.labels.resize(problem.label_count());
    for (std::uint32_t set = 0; set < (1U << problem.label_count()); ++set) {
        for (std::size_t i = 0; i < solution.labels.size(); ++i) solution.labels[i] = set >> i & 1U;
        const auto check = labeling::check_solution(problem, solution);
        values.push_back(check.is_feasible ? std::optional(check.value) : std::nullopt);
    }
    return values;
}

LabelingProblem permuted(const LabelingProblem& problem, const std::vector<Label>& order) {
    ProblemBuilder builder;
    std::vector<Value> weights(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        weights[order[i]] = problem.weight(static_cast<Label>(i));
    }
    for (Value w : weights) builder.add_label(w);
    for (const Conflict& c : problem.conflicts()) {
        builder.add_conflict(order[c.first], order[c.second]);
    }
    for (const Bonus& b : problem.bonuses()) {
        builder.add_bonus(order[b.first], order[b.second], b.value);
    }
    for (Rule rule : problem.rules()) {
        for (Term& t : rule.terms) t.label = order[t.label];
        builder.add_rule(std::move(rule));
    }
    return builder.build();
}

}  // namespace labeling_test
