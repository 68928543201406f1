// Merging of labelings: what they agree on stays, and the best combination of the rest is found
// exactly. This is tour merging (Cook & Seymour 2003: the best tour within the union of good tours,
// by dynamic programming over a branch decomposition), and what partition crossover does for two
// labelings whose differences fall apart: here the differences of many labelings may overlap. They
// do so narrowly, because each good labeling is itself sparse, so the dynamic programming over
// elimination orders of treewidth_search.cpp solves parts of hundreds of labels in milliseconds.
// Departure: where a part is too wide, some labels keep their present value (narrow_order.cpp)
// instead of giving it up, so any number of labelings can be merged.
#include "labeling/solution_merger.h"

#include <algorithm>

#include "labeling/greedy.h"
#include "labeling/treewidth_search.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 16;
/// Tables are narrowed until a part takes no longer.
constexpr std::int64_t kLeastTicks = 100'000, kTicksPerLabel = 100;
constexpr std::size_t kMostNeighbours = 14, kFewestNeighbours = 5, kNarrowing = 3;
/// Larger parts are cut, so that a stop is answered soon.
constexpr std::size_t kLargestPart = 20000;

}  // namespace

SolutionMerger::SolutionMerger(const LabelingProblem& problem, const RowSystem& rows,
                               RunControl& control, std::uint64_t seed)
    : problem_(problem),
      rows_(rows),
      control_(control),
      random_(seed),
      parent_(problem.label_count(), -1),
      local_(problem.label_count(), -1),
      part_of_(problem.label_count(), -1) {}

void SolutionMerger::merge(Solution& best, std::span<const Labels> others) {
    ++statistics.merges;
    std::vector<Label> free;
    for (Label i = 0; i < problem_.label_count(); ++i) {
        const std::uint8_t own = best.labels[i];
        if (std::any_of(others.begin(), others.end(),
                        [&](const Labels& other) { return other[i] != own; })) {
            free.push_back(i);
        }
    }
    work_ += static_cast<std::int64_t>(best.labels.size() * others.size()) / 4;
    merge_freed(best, std::move(free));
}

/// `free` must ascend.
void SolutionMerger::merge_freed(Solution& best, std::vector<Label> free) {
    for (Label i : free) release(i);
    drop_blocked(best, free);
    for (const auto& members : parts(best, free)) {
        if (charge()) break;
        if (members.size() > kLargestPart) {
            for (Label i : members) local_[i] = -1;
            for (std::size_t k = 0; k < members.size() && !charge(); k += kLargestPart) {
                const auto end = std::min(members.size(), k + kLargestPart);
                merge_freed(best, {members.begin() + static_cast<std::ptrdiff_t>(k),
                                   members.begin() + static_cast<std::ptrdiff_t>(end)});
            }
            continue;
        }
        for (std::size_t most = kMostNeighbours; most >= kFewestNeighbours; most -= kNarrowing) {
            if (solve(best, members, most) || charge()) break;
        }
        for (Label i : members) local_[i] = -1;
    }
    for (Label i : free) local_[i] = -1;
    charge();
}

void SolutionMerger::release(Label i) {
    local_[i] = 0;
    parent_[i] = i;
}

/// Labels that cannot be switched on, because a partner stays on.
void SolutionMerger::drop_blocked(const Solution& best, std::vector<Label>& free) {
    std::erase_if(free, [&](Label i) {
        if (best.labels[i] != 0) return false;
        const auto conflicts = problem_.conflicts_of(i);
        work_ += static_cast<std::int64_t>(conflicts.size()) + 2;
        const bool is_blocked = std::any_of(conflicts.begin(), conflicts.end(), [&](Label j) {
            return best.labels[j] != 0 && !is_free(j);
        });
        if (is_blocked) local_[i] = -1;
        return is_blocked;
    });
}

Label SolutionMerger::find(Label i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
}

void SolutionMerger::join(Label i, Label j) {
    i = find(i);
    j = find(j);
    if (i != j) parent_[std::max(i, j)] = std::min(i, j);
}

bool SolutionMerger::is_open(std::int32_t row, const Solution& best) const {
    std::int64_t most = 0;
    for (const Term& t : rows_.terms(row)) {
        const bool may_count = is_free(t.label) ? t.coefficient > 0 : best.labels[t.label] != 0;
        if (may_count) most += t.coefficient;
    }
    return most > rows_.right_hand_side(row);
}

std::vector<std::vector<Label>> SolutionMerger::parts(const Solution& best,
                                                      std::span<const Label> free) {
    for (Label i : free) {
        for (Label j : problem_.conflicts_of(i)) {
            if (j > i && is_free(j)) join(i, j);
        }
        for (const auto& b : problem_.bonuses_of(i)) {
            if (b.label > i && is_free(b.label)) join(i, b.label);
        }
        work_ += static_cast<std::int64_t>(problem_.conflicts_of(i).size()) + 2;
        for (const auto& use : rows_.uses(i)) {
            // The first free label of the row speaks for it.
            const auto terms = rows_.terms(use.row);
            const auto first = std::find_if(terms.begin(), terms.end(),
                                            [&](const Term& t) { return is_free(t.label); });
            work_ += 2;
            if (first->label != i || !is_open(use.row, best)) continue;
            for (const Term& t : terms) {
                if (is_free(t.label)) join(i, t.label);
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

LabelGraph SolutionMerger::graph(const Solution& best, std::span<const Label> members) {
    LabelGraph graph;
    for (std::size_t k = 0; k < members.size(); ++k) local_[members[k]] = static_cast<Label>(k);
    for (Label i : members) {
        graph.is_on.push_back(best.labels[i]);
        auto& conflicts = graph.conflicts.emplace_back();
        for (Label j : problem_.conflicts_of(i)) {
            if (is_free(j)) conflicts.push_back(local_[j]);
        }
        auto& neighbours = graph.neighbours.emplace_back(conflicts);
        for (const auto& b : problem_.bonuses_of(i)) {
            if (is_free(b.label)) neighbours.push_back(local_[b.label]);
        }
        for (const auto& use : rows_.uses(i)) {
            if (!is_open(use.row, best)) continue;
            for (const Term& t : rows_.terms(use.row)) {
                if (t.label != i && is_free(t.label)) neighbours.push_back(local_[t.label]);
            }
        }
        std::sort(neighbours.begin(), neighbours.end());
        neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
        work_ += static_cast<std::int64_t>(problem_.conflicts_of(i).size() +
                                           4 * rows_.uses(i).size() + 4 * neighbours.size());
    }
    return graph;
}

/// What the free labels, which must be `members`, can still decide.
LabelingProblem SolutionMerger::extract(const Solution& best, std::span<const Label> members) {
    ProblemBuilder builder;
    std::vector<std::int32_t> rows;
    for (Label i : members) {
        Value weight = problem_.weight(i);
        for (const auto& b : problem_.bonuses_of(i)) {
            if (!is_free(b.label) && best.labels[b.label] != 0) weight += b.value;
        }
        builder.add_label(weight);
        for (const auto& use : rows_.uses(i)) rows.push_back(use.row);
    }
    for (Label i : members) {
        for (Label j : problem_.conflicts_of(i)) {
            if (j > i && is_free(j)) builder.add_conflict(local_[i], local_[j]);
        }
        for (const auto& b : problem_.bonuses_of(i)) {
            if (b.label > i && is_free(b.label)) {
                builder.add_bonus(local_[i], local_[b.label], b.value);
            }
        }
        work_ += 2 * static_cast<std::int64_t>(problem_.conflicts_of(i).size()) + 10;
    }
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    for (std::int32_t row : rows) {
        if (!is_open(row, best)) continue;
        Rule rule{Relation::LessEqual, rows_.right_hand_side(row), {}};
        for (const Term& t : rows_.terms(row)) {
            if (is_free(t.label)) {
                rule.terms.push_back({t.coefficient, local_[t.label]});
            } else if (best.labels[t.label] != 0) {
                rule.right_hand_side -= t.coefficient;
            }
        }
        work_ += 4 * static_cast<std::int64_t>(rule.terms.size());
        builder.add_rule(std::move(rule));
    }
    work_ += 2 * static_cast<std::int64_t>(rows.size());
    return builder.build();
}

/// False: the tables would take too long.
bool SolutionMerger::solve(Solution& best, std::span<const Label> members,
                           std::size_t most_neighbours) {
    for (Label i : members) local_[i] = 0;
    const auto order = narrow_order(graph(best, members), most_neighbours, random_, control_);
    if (!order) return true;
    std::vector<Label> kept = order->order;
    std::sort(kept.begin(), kept.end());
    for (Label i : members) local_[i] = -1;
    EliminationOrder own;
    own.neighbours.resize(kept.size());
    for (std::size_t k = 0; k < kept.size(); ++k) {
        local_[members[kept[k]]] = static_cast<Label>(k);
    }
    for (Label k : order->order) own.order.push_back(local_[members[k]]);
    for (std::size_t k = 0; k < kept.size(); ++k) {
        for (Label j : order->neighbours[kept[k]]) own.neighbours[k].push_back(local_[members[j]]);
        kept[k] = members[kept[k]];
    }
    const LabelingProblem sub = extract(best, kept);
    std::vector<std::uint8_t> present;
    for (Label i : kept) present.push_back(best.labels[i]);
    const Value value = labeling_value(sub, present);
    TreewidthOptions width;
    width.most_ticks =
        std::max(kLeastTicks, kTicksPerLabel * static_cast<std::int64_t>(kept.size()));
    const auto found = treewidth_search(sub, RowSystem(sub), own, control_, width);
    if (!found) return false;
    ++statistics.parts;
    statistics.given_up += static_cast<std::int64_t>(members.size() - kept.size());
    if (!found->solution || found->solution->value <= value) return true;
    for (std::size_t k = 0; k < kept.size(); ++k) best.labels[kept[k]] = found->solution->labels[k];
    best.value += found->solution->value - value;
    ++statistics.improved;
    return true;
}

bool SolutionMerger::charge() {
    const bool is_over = control_.spend(work_ / kEntriesPerTick);
    work_ %= kEntriesPerTick;
    return is_over;
}

}  // namespace labeling
