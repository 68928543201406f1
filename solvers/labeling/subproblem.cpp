#include "labeling/subproblem.h"

#include <algorithm>

namespace labeling {
namespace {

/// What making a rule costs the guard, in entries.
constexpr std::int64_t kEntriesPerRow = 25;

}  // namespace

Decomposer::Decomposer(const LabelingProblem& problem, const RowSystem& rows)
    : problem_(problem),
      rows_(rows),
      parent_(problem.label_count(), -1),
      local_(problem.label_count(), -1),
      part_of_(problem.label_count(), -1) {}

bool Decomposer::is_open(const Propagator& propagator, std::int32_t row) const {
    std::int64_t slack = propagator.activity_slack(row);
    for (const Term& t : rows_.terms(row)) {
        if (!propagator.is_free(t.label)) continue;
        slack -= t.coefficient > 0 ? t.coefficient : -static_cast<std::int64_t>(t.coefficient);
        if (slack < 0) return true;
    }
    return false;
}

Label Decomposer::find(Label i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
}

void Decomposer::join(Label i, Label j) {
    i = find(i);
    j = find(j);
    if (i != j) parent_[std::max(i, j)] = std::min(i, j);
}

std::vector<std::vector<Label>> Decomposer::parts(const Propagator& propagator) {
    std::vector<Label> free;
    for (Label i = 0; i < problem_.label_count(); ++i) {
        if (!propagator.is_free(i)) continue;
        free.push_back(i);
        parent_[i] = i;
    }
    work_ += problem_.label_count() / 4;
    for (Label i : free) {
        const auto neighbours = problem_.conflicts_of(i);
        for (Label j : neighbours) {
            if (j > i && propagator.is_free(j)) join(i, j);
        }
        for (const auto& b : problem_.bonuses_of(i)) {
            if (b.label > i && propagator.is_free(b.label)) join(i, b.label);
        }
        work_ += static_cast<std::int64_t>(neighbours.size()) + 1;
        guard_.step(static_cast<std::int64_t>(neighbours.size()) + 10);
        for (const auto& use : rows_.uses(i)) {
            // The first free label of the row speaks for it.
            const auto terms = rows_.terms(use.row);
            const auto first = std::find_if(terms.begin(), terms.end(), [&](const Term& t) {
                return propagator.is_free(t.label);
            });
            ++work_;
            if (first->label != i || !is_open(propagator, use.row)) continue;
            for (const Term& t : terms) {
                if (propagator.is_free(t.label)) join(i, t.label);
            }
            work_ += static_cast<std::int64_t>(terms.size());
        }
    }
    std::vector<std::vector<Label>> parts;
    for (Label i : free) {
        const Label root = find(i);
        if (root == i) {
            part_of_[i] = static_cast<std::int32_t>(parts.size());
            parts.emplace_back();
        }
        parts[part_of_[root]].push_back(i);
    }
    return parts;
}

Subproblem Decomposer::extract(const Propagator& propagator, std::span<const Label> members) {
    Subproblem sub;
    sub.to_parent.assign(members.begin(), members.end());
    for (std::size_t k = 0; k < members.size(); ++k) local_[members[k]] = static_cast<Label>(k);
    ProblemBuilder builder;
    for (Label i : members) {
        Value weight = problem_.weight(i);
        for (const auto& b : problem_.bonuses_of(i)) {
            if (propagator.value(b.label) == 1) weight += b.value;
        }
        builder.add_label(weight);
    }
    for (Label i : members) {
        for (Label j : problem_.conflicts_of(i)) {
            if (j > i && propagator.is_free(j)) builder.add_conflict(local_[i], local_[j]);
        }
        for (const auto& b : problem_.bonuses_of(i)) {
            if (b.label > i && propagator.is_free(b.label)) {
                builder.add_bonus(local_[i], local_[b.label], b.value);
            }
        }
        work_ += static_cast<std::int64_t>(problem_.conflicts_of(i).size());
        guard_.step(static_cast<std::int64_t>(problem_.conflicts_of(i).size()) + 10);
    }
    std::vector<std::int32_t> open;
    for (Label i : members) {
        for (const auto& use : rows_.uses(i)) open.push_back(use.row);
        guard_.step(static_cast<std::int64_t>(rows_.uses(i).size()) + 1);
    }
    std::sort(open.begin(), open.end(), [this](std::int32_t a, std::int32_t b) {
        guard_.step(1);
        return a < b;
    });
    open.erase(std::unique(open.begin(), open.end()), open.end());
    guard_.look();
    for (std::int32_t row : open) {
        guard_.step(kEntriesPerRow);
        if (!is_open(propagator, row)) continue;
        Rule rule{Relation::LessEqual, rows_.right_hand_side(row), {}};
        for (const Term& t : rows_.terms(row)) {
            if (propagator.is_free(t.label)) {
                rule.terms.push_back({t.coefficient, local_[t.label]});
            } else if (propagator.value(t.label) == 1) {
                rule.right_hand_side -= t.coefficient;
            }
        }
        work_ += static_cast<std::int64_t>(rule.terms.size());
        builder.add_rule(std::move(rule));
    }
    sub.problem = builder.build([this] { guard_.look(); });
    return sub;
}

Value decided_value(const LabelingProblem& problem, std::span<const std::int8_t> values) {
    Value value = 0;
    for (Label i = 0; i < problem.label_count(); ++i) {
        if (values[i] != 1) continue;
        value += problem.weight(i);
        for (const auto& b : problem.bonuses_of(i)) {
            if (b.label > i && values[b.label] == 1) value += b.value;
        }
    }
    return value;
}

Value sum_of_gains(const LabelingProblem& problem) {
    Value sum = 0;
    for (Value w : problem.weights()) sum += std::max(Value{0}, w);
    for (const Bonus& b : problem.bonuses()) sum += b.value;
    return sum;
}

}  // namespace labeling
