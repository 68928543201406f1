#include "labeling/search_state.h"

#include <algorithm>

namespace labeling {

SearchState::SearchState(const SearchModel& model, std::span<const std::uint8_t> start,
                         PassGuard guard)
    : model_(model),
      labels_(model.label_count(), 0),
      nodes_(model.label_count()),
      marks_(model.label_count(), 0) {
    const RowSystem& rows = model.rows();
    excesses_.reserve(rows.row_count());
    for (std::int32_t row = 0; row < rows.row_count(); ++row) {
        excesses_.push_back(-rows.right_hand_side(row));
    }
    for (Label i = 0; i < model.label_count(); ++i) nodes_[i].gain = model.problem().weight(i);
    for (Label i = 0; i < model.label_count(); ++i) {
        if (start[i] == 0) continue;
        const std::int64_t before = work_;
        switch_on<false>(i);
        guard.step(work_ - before);
    }
}

template <bool kNotesBroken>
void SearchState::switch_on(Label i) {
    const auto neighbours = model_.problem().conflicts_of(i);
    const auto partners = model_.problem().bonuses_of(i);
    const auto uses = model_.uses(i);
    work_ += static_cast<std::int64_t>(neighbours.size() + 2 * partners.size() + 2 * uses.size());
    labels_[i] = 1;
    value_ += nodes_[i].gain;
    const std::uint64_t blocker = as_blocker(i);
    for (Label j : neighbours) nodes_[j].blockers += blocker;
    for (const auto& b : partners) nodes_[b.label].gain += b.value;
    for (const auto& use : uses) {
        excesses_[use.row] += use.coefficient;
        if (kNotesBroken && use.coefficient > 0 && excesses_[use.row] > 0)
            broken_rules_.push_back({use.row, i, {}});
    }
    if (!kNotesBroken) return;
    const auto triples = model_.triples(i);
    work_ += static_cast<std::int64_t>(triples.size());
    for (const auto& pair : triples) {
        if ((labels_[pair.first] & labels_[pair.second]) != 0)
            broken_rules_.push_back({-1, i, pair});
    }
}

template <bool kNotesBroken>
void SearchState::switch_off(Label i) {
    const auto neighbours = model_.problem().conflicts_of(i);
    const auto partners = model_.problem().bonuses_of(i);
    const auto uses = model_.uses(i);
    work_ += static_cast<std::int64_t>(neighbours.size() + 2 * partners.size() + 2 * uses.size());
    labels_[i] = 0;
    value_ -= nodes_[i].gain;
    const std::uint64_t blocker = as_blocker(i);
    for (Label j : neighbours) {
        nodes_[j].blockers -= blocker;
        if (kNotesBroken && nodes_[j].blockers == 0) freed_.push_back(j);
    }
    for (const auto& b : partners) nodes_[b.label].gain -= b.value;
    for (const auto& use : uses) {
        excesses_[use.row] -= use.coefficient;
        if (kNotesBroken && use.coefficient < 0 && excesses_[use.row] > 0)
            broken_rules_.push_back({use.row, i, {}});
    }
}

template <bool kNotesBroken>
void SearchState::apply(Label i) {
    is_on(i) ? switch_off<kNotesBroken>(i) : switch_on<kNotesBroken>(i);
}

void SearchState::flip(Label i) {
    apply<true>(i);
    log_.push_back(i);
}

bool SearchState::fits(Label i) const {
    if (nodes_[i].blockers != 0) return false;
    for (const auto& use : model_.uses(i)) {
        if (use.coefficient > 0 && excesses_[use.row] + use.coefficient > 0) return false;
    }
    for (const auto& pair : model_.triples(i)) {
        if ((labels_[pair.first] & labels_[pair.second]) != 0) return false;
    }
    return true;
}

void SearchState::commit() {
    log_.clear();
    broken_rules_.clear();
    freed_.clear();
}

void SearchState::roll_back() {
    while (!log_.empty()) {
        apply<false>(log_.back());
        log_.pop_back();
    }
    broken_rules_.clear();
    freed_.clear();
}

void SearchState::clear_marks() {
    if (++mark_ != 0) return;
    std::fill(marks_.begin(), marks_.end(), 0);
    mark_ = 1;
}

}  // namespace labeling
