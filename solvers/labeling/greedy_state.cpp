// Scores of greedy construction. Blocked: weight per blocked weight is Sakai, Togasaki & Yamazaki's
// GWMIN2 (2003), with bonuses counted as gain. Gain: what a label brings less a share of what it
// displaces, as a price of its conflicts; the share of 0.3 was measured on problems of curves,
// where the rule finds a few percent more than Blocked, which is better where there are no bonuses.
#include "labeling/greedy_state.h"

#include <algorithm>

namespace labeling {
namespace {

constexpr double kDisplacedShare = 0.3;

}  // namespace

GreedyState::GreedyState(const LabelingProblem& problem, Propagator& propagator, GreedyRule rule,
                         PassGuard guard)
    : problem_(problem),
      propagator_(propagator),
      rule_(rule),
      heap_(problem.label_count()),
      gain_(problem.weights().begin(), problem.weights().end()),
      potential_(problem.label_count(), 0),
      worth_(problem.label_count(), 0),
      blocked_(problem.label_count(), 0),
      is_changed_(problem.label_count(), 0) {
    prepare(guard);
}

void GreedyState::prepare(PassGuard guard) {
    for (Label i = 0; i < problem_.label_count(); ++i) {
        for (const auto& b : problem_.bonuses_of(i)) {
            potential_[i] += 0.5 * static_cast<double>(b.value);
        }
        worth_[i] = std::max(0.0, gain(i));
        guard.step(static_cast<std::int64_t>(problem_.bonuses_of(i).size()) + 4);
    }
    for (const Conflict& c : problem_.conflicts()) {
        blocked_[c.first] += worth_[c.second];
        blocked_[c.second] += worth_[c.first];
        guard.step(1);
    }
    for (Label i = 0; i < problem_.label_count(); ++i) {
        if (is_free(i)) heap_.set(i, score(i));
        guard.step(10);
    }
    work_ += 8 * std::int64_t{problem_.label_count()} +
             static_cast<std::int64_t>(problem_.conflict_count() + problem_.bonus_count());
    update();
}

double GreedyState::score(Label i) const {
    const double blocked = std::max(0.0, blocked_[i]);
    switch (rule_) {
        case GreedyRule::Weight:
            return gain(i);
        case GreedyRule::Blocked:
            return gain(i) / (1.0 + blocked);
        default:
            return gain(i) - kDisplacedShare * blocked;
    }
}

Label GreedyState::best() {
    while (!heap_.is_empty()) {
        const Label i = heap_.top();
        if (gain(i) > 0) return i;
        heap_.remove(i);
    }
    return -1;
}

bool decide(Propagator& propagator, Label i, bool value) {
    if (!propagator.is_free(i)) return true;
    const std::size_t size = propagator.trail().size();
    if (propagator.assign(i, value)) return true;
    propagator.undo(size);
    return propagator.assign(i, !value);
}

void GreedyState::touch(Label i) {
    if (is_changed_[i] != 0) return;
    is_changed_[i] = 1;
    changed_.push_back(i);
}

void GreedyState::set_worth(Label i, double worth) {
    const double change = worth - worth_[i];
    if (change == 0) return;
    worth_[i] = worth;
    const auto neighbours = problem_.conflicts_of(i);
    for (Label j : neighbours) {
        blocked_[j] += change;
        if (is_free(j)) touch(j);
    }
    work_ += static_cast<std::int64_t>(neighbours.size());
}

void GreedyState::update() {
    const auto trail = propagator_.trail();
    const std::size_t first = updated_;
    for (; updated_ < trail.size(); ++updated_) {
        const Label i = trail[updated_];
        heap_.remove(i);
        const bool is_chosen = propagator_.value(i) == 1;
        for (const auto& b : problem_.bonuses_of(i)) {
            potential_[b.label] -= 0.5 * static_cast<double>(b.value);
            if (is_chosen) gain_[b.label] += static_cast<double>(b.value);
            if (is_free(b.label)) touch(b.label);
        }
        const auto neighbours = problem_.conflicts_of(i);
        for (Label j : neighbours) {
            blocked_[j] -= worth_[i];
            if (is_free(j)) touch(j);
        }
        work_ += static_cast<std::int64_t>(neighbours.size());
    }
    for (std::size_t k = first; k < updated_; ++k) {
        for (const auto& b : problem_.bonuses_of(trail[k])) {
            if (is_free(b.label)) set_worth(b.label, std::max(0.0, gain(b.label)));
        }
    }
    for (Label i : changed_) {
        is_changed_[i] = 0;
        heap_.set(i, score(i));
    }
    work_ += 4 * static_cast<std::int64_t>(changed_.size());
    changed_.clear();
}

}  // namespace labeling
