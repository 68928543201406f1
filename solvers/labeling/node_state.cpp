#include "labeling/node_state.h"

namespace labeling {

NodeState::NodeState(const LabelingProblem& problem, Propagator& propagator, Relaxation& relaxation)
    : problem_(problem),
      propagator_(propagator),
      relaxation_(relaxation),
      bonus_begin_(static_cast<std::size_t>(problem.label_count()) + 1, 0) {
    for (const Bonus& b : problem.bonuses()) {
        ++bonus_begin_[b.first + 1];
        ++bonus_begin_[b.second + 1];
    }
    for (std::size_t i = 1; i < bonus_begin_.size(); ++i) bonus_begin_[i] += bonus_begin_[i - 1];
    bonuses_at_.resize(bonus_begin_.back());
    std::vector<std::size_t> next(bonus_begin_.begin(), bonus_begin_.end() - 1);
    for (std::size_t k = 0; k < problem.bonus_count(); ++k) {
        bonuses_at_[next[problem.bonuses()[k].first]++] = static_cast<std::int32_t>(k);
        bonuses_at_[next[problem.bonuses()[k].second]++] = static_cast<std::int32_t>(k);
    }
    synchronize();
}

NodeState::NodeState(const NodeState& other, Propagator& propagator, Relaxation& relaxation)
    : problem_(other.problem_),
      propagator_(propagator),
      relaxation_(relaxation),
      bonus_begin_(other.bonus_begin_),
      bonuses_at_(other.bonuses_at_),
      fixed_(other.fixed_),
      fixed_before_(other.fixed_before_) {}

void NodeState::synchronize() {
    const auto trail = propagator_.trail();
    while (fixed_before_.size() < trail.size()) {
        const Label i = trail[fixed_before_.size()];
        fixed_before_.push_back(fixed_.size());
        const bool value = propagator_.value(i) == 1;
        relaxation_.fix(i, value);
        fixed_.push_back(i);
        if (value) continue;
        for (std::size_t b = bonus_begin_[i]; b < bonus_begin_[i + 1]; ++b) {
            const std::int32_t column = problem_.label_count() + bonuses_at_[b];
            if (relaxation_.is_fixed(column)) continue;
            relaxation_.fix(column, false);
            fixed_.push_back(column);
        }
    }
}

bool NodeState::assign(Label i, bool value) {
    const bool is_consistent = propagator_.assign(i, value);
    if (is_consistent) synchronize();
    return is_consistent;
}

void NodeState::undo(std::size_t size) {
    propagator_.undo(size);
    if (fixed_before_.size() <= size) return;
    const std::size_t kept = fixed_before_[size];
    for (std::size_t k = kept; k < fixed_.size(); ++k) relaxation_.unfix(fixed_[k]);
    fixed_.resize(kept);
    fixed_before_.resize(size);
}

void NodeState::forbid_bonus(std::int32_t bonus) {
    const std::int32_t column = problem_.label_count() + bonus;
    relaxation_.bring_in(bonus);
    if (!relaxation_.is_fixed(column)) relaxation_.fix(column, false);
}

}  // namespace labeling
