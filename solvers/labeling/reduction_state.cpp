// What is left of a problem while it is reduced. Lists stay sorted and free of labels that are
// gone; taking a label out costs the lists of its neighbours. fix() only gives an order, which
// settle() carries out together with bounds consistency of the rows, so no step has to be
// reentrant. A step queues the labels whose reductions it may have made possible: those whose
// weight, lists or rows changed, and their conflict and bonus partners.
#include "labeling/reduction_state.h"

#include <algorithm>
#include <cstdlib>

namespace labeling {
namespace {

template <class Entry, class Key, class KeyOf>
auto place_of(std::pmr::vector<Entry>& entries, Key key, KeyOf key_of) {
    return std::lower_bound(entries.begin(), entries.end(), key,
                            [&](const Entry& e, Key k) { return key_of(e) < k; });
}

constexpr std::int8_t kMoved = 2;
/// What making and emptying the lists of a label costs, in entries.
constexpr std::int64_t kEntriesPerLabel = 100;
/// What making a row costs the guard, in entries.
constexpr std::int64_t kEntriesPerRow = 25;

const auto kLabelItself = [](Label i) { return i; };
const auto kLabelOf = [](const auto& entry) { return entry.label; };
const auto kRowOf = [](const ReductionState::Use& use) { return use.row; };

template <class Entry, class Key, class KeyOf>
void erase_key(std::pmr::vector<Entry>& entries, Key key, KeyOf key_of) {
    const auto place = place_of(entries, key, key_of);
    if (place != entries.end() && key_of(*place) == key) entries.erase(place);
}

}  // namespace

ReductionState::ReductionState(const LabelingProblem& problem, PassGuard guard)
    : problem_(problem),
      weights_(problem.weights().begin(), problem.weights().end()),
      potentials_(weights_),
      conflicts_(problem.label_count(), &memory_),
      bonuses_(problem.label_count(), &memory_),
      uses_(problem.label_count(), &memory_),
      is_alive_(problem.label_count(), 1),
      is_queued_(problem.label_count(), 0),
      pending_(problem.label_count(), -1),
      marks_(problem.label_count(), -1) {
    for (Label i = 0; i < problem.label_count(); ++i) {
        const auto conflicts = problem.conflicts_of(i);
        const auto bonuses = problem.bonuses_of(i);
        conflicts_[i].assign(conflicts.begin(), conflicts.end());
        bonuses_[i].assign(bonuses.begin(), bonuses.end());
        uses_[i].reserve(problem.rules_of(i).size());
        total_ += std::abs(problem.weight(i));
        guard.step(static_cast<std::int64_t>(conflicts.size()) + kEntriesPerLabel / 4);
    }
    for (const Bonus& b : problem.bonuses()) {
        total_ += b.value;
        potentials_[b.first] += b.value;
        potentials_[b.second] += b.value;
        guard.step(1);
    }
    for (const Rule& rule : problem.rules()) {
        for (int sign : {1, -1}) {
            if (rule.relation == (sign > 0 ? Relation::GreaterEqual : Relation::LessEqual))
                continue;
            const auto r = row_count();
            rows_.push_back({{rule.terms.begin(), rule.terms.end(), &memory_},
                             sign * rule.right_hand_side,
                             true});
            for (Term& t : rows_.back().terms) {
                t.coefficient *= sign;
                uses_[t.label].push_back({r, t.coefficient});
            }
            guard.step(kEntriesPerRow);
        }
    }
    is_row_queued_.assign(rows_.size(), 0);
    is_row_checked_.assign(rows_.size(), 1);
    for (std::int32_t r = 0; r < row_count(); ++r) touch_row(r);
    for (Label i = 0; i < label_count(); ++i) touch(i);
    work += 2 * static_cast<std::int64_t>(problem.conflict_count() + problem.bonus_count()) +
            kEntriesPerLabel * label_count() + row_count();
}

bool ReductionState::in_conflict(Label i, Label j) const {
    const bool is_first = conflicts_[i].size() < conflicts_[j].size();
    const auto& list = conflicts_[is_first ? i : j];
    return std::binary_search(list.begin(), list.end(), is_first ? j : i);
}

Value ReductionState::bonus(Label i, Label j) const {
    for (const Partner& b : bonuses_[i]) {
        if (b.label == j) return b.value;
    }
    return 0;
}

bool ReductionState::can_be_dropped(Label i) const {
    return std::all_of(uses_[i].begin(), uses_[i].end(),
                       [](const Use& use) { return use.coefficient > 0; });
}

bool ReductionState::is_safe(const Move& move) {
    // Marks are odd for what is 1 after the move, at least kMoved for what it changes.
    for (Label i : move.known_off) marks_[i] = 0;
    if (move.known_on >= 0) marks_[move.known_on] = 1;
    for (Label i : move.off) marks_[i] = kMoved;
    for (Label i : move.on) marks_[i] = kMoved + 1;
    bool is_safe = true;
    for (const auto& moved : {move.on, move.off}) {
        for (Label i : moved) {
            for (const Use& use : uses_[i]) {
                const bool is_raised = (use.coefficient > 0) == (marks_[i] > kMoved);
                is_safe = is_safe && (!is_raised || is_row_safe(use.row, move.is_certain));
            }
        }
    }
    for (const auto& marked : {move.on, move.off, move.known_off}) {
        for (Label i : marked) marks_[i] = -1;
    }
    if (move.known_on >= 0) marks_[move.known_on] = -1;
    return is_safe;
}

bool ReductionState::is_row_safe(std::int32_t r, bool is_certain) {
    std::int64_t most = 0, change = 0;
    for (const Term& t : rows_[r].terms) {
        const std::int8_t mark = marks_[t.label];
        if (mark < 0 ? t.coefficient > 0 : mark % 2 == 1) most += t.coefficient;
        if (mark >= kMoved) change += mark % 2 == 1 ? t.coefficient : -t.coefficient;
    }
    work += static_cast<std::int64_t>(rows_[r].terms.size());
    return most <= rows_[r].right_hand_side || (is_certain && change <= 0);
}

bool ReductionState::may_grow(Value amount) {
    if (amount > kMaxTotal - total_) return false;
    total_ += amount;
    return true;
}

void ReductionState::fix(Label i, bool value) {
    const std::int8_t order = value ? 1 : 0;
    if (pending_[i] == order || is_infeasible()) return;
    if (pending_[i] >= 0) {
        result_.is_infeasible_ = true;
        return;
    }
    pending_[i] = order;
    orders_.push_back(i);
}

void ReductionState::settle() {
    while (!is_infeasible()) {
        if (!orders_.empty()) {
            const Label i = orders_.back();
            orders_.pop_back();
            take_out(i, pending_[i] == 1);
        } else if (!unsettled_rows_.empty()) {
            const std::int32_t r = unsettled_rows_.back();
            unsettled_rows_.pop_back();
            is_row_checked_[r] = 1;
            if (rows_[r].is_alive) tighten(r);
        } else {
            return;
        }
    }
}

void ReductionState::tighten(std::int32_t r) {
    const Row& row = rows_[r];
    std::int64_t least = 0, most = 0;
    for (const Term& t : row.terms) {
        (t.coefficient < 0 ? least : most) += t.coefficient;
    }
    work += static_cast<std::int64_t>(row.terms.size());
    const std::int64_t slack = row.right_hand_side - least;
    if (slack < 0) {
        result_.is_infeasible_ = true;
        return;
    }
    if (most <= row.right_hand_side) {
        drop_row(r);
        return;
    }
    for (const Term& t : row.terms) {
        if (t.coefficient > slack) fix(t.label, false);
        if (-static_cast<std::int64_t>(t.coefficient) > slack) fix(t.label, true);
    }
}

void ReductionState::take_out(Label i, bool value) {
    if (value) {
        result_.offset_ += weights_[i];
        for (Label j : conflicts_[i]) fix(j, false);
        for (const Partner& b : bonuses_[i]) {
            weights_[b.label] += b.value;
            potentials_[b.label] += b.value;
        }
        for (const Use& use : uses_[i]) rows_[use.row].right_hand_side -= use.coefficient;
    }
    result_.steps_.push_back({Step::Kind::Fixed, i, value ? 1 : 0, 0, 0});
    remove(i);
}

void ReductionState::remove(Label i) {
    touch_around(i);
    for (const Partner& b : bonuses_[i]) {
        touch_around(b.label);  // its potential changed
        erase_key(bonuses_[b.label], i, kLabelOf);
        potentials_[b.label] -= b.value;
    }
    for (Label j : conflicts_[i]) {
        erase_key(conflicts_[j], i, kLabelItself);
        work += static_cast<std::int64_t>(conflicts_[j].size()) / 8;
    }
    for (const Use& use : uses_[i]) {
        erase_key(rows_[use.row].terms, i, kLabelOf);
        touch_row(use.row);
    }
    work += static_cast<std::int64_t>(conflicts_[i].size() + bonuses_[i].size() + uses_[i].size());
    conflicts_[i].clear();
    bonuses_[i].clear();
    uses_[i].clear();
    is_alive_[i] = 0;
}

void ReductionState::spare(Label i) {
    const std::size_t begin = result_.partners_.size();
    result_.partners_.insert(result_.partners_.end(), conflicts_[i].begin(), conflicts_[i].end());
    result_.steps_.push_back({Step::Kind::Spare, i, 0, begin, result_.partners_.size()});
    remove(i);
}

void ReductionState::grant_bonus(Label i, Label when) {
    result_.steps_.push_back({Step::Kind::Raised, i, when, 0, 0});
    const Value value = bonus(i, when);
    add_bonus(i, when, -value);
    add_weight(when, value);
}

void ReductionState::merge(Label i, Label into) {
    result_.steps_.push_back({Step::Kind::Equal, i, into, 0, 0});
    const Value gain = weights_[i] + bonus(i, into);
    weights_[into] += gain;
    potentials_[into] += gain;
    const std::vector<Partner> bonuses(bonuses_[i].begin(), bonuses_[i].end());
    const std::vector<Label> conflicts(conflicts_[i].begin(), conflicts_[i].end());
    const std::vector<Use> uses(uses_[i].begin(), uses_[i].end());
    remove(i);
    for (Label j : conflicts) {
        if (j == into) {
            fix(into, false);
        } else {
            add_conflict(into, j);
        }
    }
    for (const Partner& b : bonuses) {
        if (b.label != into) add_bonus(into, b.label, b.value);
    }
    for (const Use& use : uses) put_use(into, use.row, use.coefficient);
    touch_around(into);
}

void ReductionState::put_use(Label i, std::int32_t r, std::int32_t coefficient) {
    auto& terms = rows_[r].terms;
    const auto term = place_of(terms, i, kLabelOf);
    const auto use = place_of(uses_[i], r, kRowOf);
    touch_row(r);
    if (term == terms.end() || term->label != i) {
        terms.insert(term, {coefficient, i});
        uses_[i].insert(use, {r, coefficient});
    } else if (term->coefficient + coefficient == 0) {
        terms.erase(term);
        uses_[i].erase(use);
    } else {
        term->coefficient += coefficient;
        use->coefficient += coefficient;
    }
}

void ReductionState::add_weight(Label i, Value change) {
    if (change == 0) return;
    weights_[i] += change;
    potentials_[i] += change;
    touch_around(i);
}

void ReductionState::add_bonus(Label i, Label j, Value change) {
    if (change == 0 || in_conflict(i, j)) return;
    change_bonus(i, j, change);
    change_bonus(j, i, change);
    touch_around(i);
    touch_around(j);
}

void ReductionState::change_bonus(Label i, Label j, Value change) {
    potentials_[i] += change;
    const auto place = place_of(bonuses_[i], j, kLabelOf);
    if (place == bonuses_[i].end() || place->label != j) {
        bonuses_[i].insert(place, {j, change});
    } else if (place->value + change == 0) {
        bonuses_[i].erase(place);
    } else {
        place->value += change;
    }
}

void ReductionState::add_conflict(Label i, Label j) {
    const auto place = place_of(conflicts_[i], j, kLabelItself);
    if (place != conflicts_[i].end() && *place == j) return;
    add_bonus(i, j, -bonus(i, j));
    conflicts_[i].insert(place, j);
    conflicts_[j].insert(place_of(conflicts_[j], i, kLabelItself), i);
    touch_around(i);
    touch_around(j);
}

void ReductionState::drop_row(std::int32_t r) {
    rows_[r].is_alive = false;
    for (const Term& t : rows_[r].terms) {
        erase_key(uses_[t.label], r, kRowOf);
        touch_around(t.label);
    }
    rows_[r].terms.clear();
}

void ReductionState::touch(Label i) {
    if (is_queued_[i] != 0 || is_alive_[i] == 0) return;
    is_queued_[i] = 1;
    queue_.push_back(i);
}

void ReductionState::touch_around(Label i) {
    touch(i);
    for (Label j : conflicts_[i]) touch(j);
    for (const Partner& b : bonuses_[i]) touch(b.label);
    work += static_cast<std::int64_t>(conflicts_[i].size() + bonuses_[i].size());
}

void ReductionState::touch_row(std::int32_t r) {
    if (is_row_checked_[r] != 0) {
        is_row_checked_[r] = 0;
        unsettled_rows_.push_back(r);
    }
    if (is_row_queued_[r] == 0) {
        is_row_queued_[r] = 1;
        row_queue_.push_back(r);
    }
}

Label ReductionState::next_label() {
    while (queue_head_ < queue_.size()) {
        const Label i = queue_[queue_head_++];
        is_queued_[i] = 0;
        if (is_alive_[i] != 0) return i;
    }
    queue_.clear();
    queue_head_ = 0;
    return -1;
}

std::int32_t ReductionState::next_row() {
    while (!row_queue_.empty()) {
        const std::int32_t r = row_queue_.back();
        row_queue_.pop_back();
        is_row_queued_[r] = 0;
        if (rows_[r].is_alive) return r;
    }
    return -1;
}

ReducedProblem ReductionState::take_result(PassGuard guard) {
    ProblemBuilder builder;
    builder.set_units_per_one(problem_.units_per_one());
    if (!is_infeasible()) {
        std::vector<Label> renamed(label_count(), -1);
        for (Label i = 0; i < label_count(); ++i) {
            if (!is_alive(i)) continue;
            renamed[i] = builder.add_label(weights_[i]);
            result_.to_original_.push_back(i);
        }
        for (Label i : result_.to_original_) {
            for (Label j : conflicts_[i]) {
                if (j > i) builder.add_conflict(renamed[i], renamed[j]);
            }
            for (const Partner& b : bonuses_[i]) {
                if (b.label > i) builder.add_bonus(renamed[i], renamed[b.label], b.value);
            }
            guard.step(static_cast<std::int64_t>(conflicts_[i].size() + bonuses_[i].size()));
        }
        for (const Row& row : rows_) {
            if (!row.is_alive) continue;
            Rule rule{
                Relation::LessEqual, row.right_hand_side, {row.terms.begin(), row.terms.end()}};
            for (Term& t : rule.terms) t.label = renamed[t.label];
            builder.add_rule(std::move(rule));
            guard.step(kEntriesPerRow);
        }
    }
    result_.problem_ = builder.build([&] { guard.look(); });
    const auto removed = [](std::size_t before, std::size_t after) {
        return static_cast<std::int64_t>(before) - static_cast<std::int64_t>(after);
    };
    ReductionStatistics& s = result_.statistics_;
    const LabelingProblem& left = result_.problem_;
    s.labels = label_count() - left.label_count();
    s.conflicts = removed(problem_.conflict_count(), left.conflict_count());
    s.bonuses = removed(problem_.bonus_count(), left.bonus_count());
    s.rules = removed(problem_.rule_count(), left.rule_count());
    return std::move(result_);
}

}  // namespace labeling
