// Strong branching until a label's pseudo costs are known (Achterberg, Koch & Martin 2005). It runs
// its LPs nearly to the end: cut off after 60 iterations they often show no gain at all, and the
// tree chose badly. Candidates are ordered by the value of the relaxation that either decision
// displaces, times what such a value has gained so far; so ordered, few need to be tried.
#include "labeling/branching.h"

#include <algorithm>

namespace labeling {
namespace {

constexpr int kMostStrong = 4;
constexpr int kPatience = 3;
constexpr int kReliable = 1;
constexpr std::int64_t kStrongIterations = 500;

}  // namespace

Brancher::Brancher(const LabelingProblem& problem)
    : problem_(problem), costs_(problem.label_count()) {}

/// Its own and half of its bonuses'.
void Brancher::weigh_labels() {
    masses_.assign(problem_.label_count(), 0.0);
    for (Label i = 0; i < problem_.label_count(); ++i) {
        masses_[i] = x_[i] * static_cast<double>(problem_.weight(i));
    }
    for (std::size_t k = 0; k < problem_.bonus_count(); ++k) {
        const Bonus& b = problem_.bonuses()[k];
        const double mass = x_[problem_.label_count() + k] * static_cast<double>(b.value);
        masses_[b.first] += mass;
        masses_[b.second] += mass;
    }
}

/// What switching the label off (on) displaces: a guess of the gain before anything is known.
double Brancher::displaced(Label i, bool value) const {
    if (!value) return masses_[i];
    double sum = 0;
    for (Label j : problem_.conflicts_of(i)) sum += masses_[j];
    return sum;
}

double Brancher::expected_gain(Label i, bool value) const {
    const PseudoCost& cost = costs_[i];
    if (cost.count[value] > 0) {
        return cost.sum[value] / cost.count[value] * (value ? 1 - x_[i] : x_[i]);
    }
    return gain_per_mass_[value] * displaced(i, value);
}

Brancher::Choice Brancher::choose(CutLane& lane, Value bound, const Relaxation::SavedBasis& basis) {
    Choice choice;
    choice.bounds[0] = choice.bounds[1] = bound;
    x_.assign(lane.relaxation.x().begin(), lane.relaxation.x().end());
    weigh_labels();
    std::vector<std::pair<double, Label>> candidates;
    for (Label i = 0; i < problem_.label_count(); ++i) {
        if (!lane.propagator.is_free(i)) continue;
        if (choice.label < 0) choice.label = i;
        if (x_[i] <= CutLane::kIntegrality || x_[i] >= 1 - CutLane::kIntegrality) continue;
        const double score =
            std::max(1.0, expected_gain(i, false)) * std::max(1.0, expected_gain(i, true));
        candidates.emplace_back(score, i);
    }
    if (choice.label < 0) {
        lane.accept_leaf();  // fixing by bounds decided the last labels
        choice.is_settled = true;
        return choice;
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (!candidates.empty()) {
        choice.label = candidates[0].second;
        if (lane.shared.techniques.strong_branching) {
            strong_branch(lane, bound, basis, candidates, choice);
        }
    }
    if (choice.label >= 0) choice.first = x_[choice.label] > 0.4;
    return choice;
}

void Brancher::strong_branch(CutLane& lane, Value bound, const Relaxation::SavedBasis& basis,
                             std::span<const std::pair<double, Label>> candidates, Choice& choice) {
    double best_score = -1;
    int tried = 0, without_gain = 0;
    for (const auto& [score_now, i] : candidates) {
        if (tried >= kMostStrong || without_gain >= kPatience || lane.control().should_stop()) {
            break;
        }
        const PseudoCost& cost = costs_[i];
        double gains[2];
        Value bounds[2] = {bound, bound};
        if (std::min(cost.count[0], cost.count[1]) >= kReliable) {
            for (int value : {0, 1}) gains[value] = expected_gain(i, value == 1);
        } else {
            ++tried;
            for (int value : {0, 1}) bounds[value] = probe(lane, i, value == 1, bound);
            lane.relaxation.restore_basis(basis);
            const bool no_zero = lane.is_prunable(bounds[0]), no_one = lane.is_prunable(bounds[1]);
            if (no_zero || no_one) {
                if ((no_zero && no_one) || !lane.state.assign(i, no_zero)) {
                    choice.is_settled = true;
                    choice.label = -1;
                    return;
                }
                choice.decided.push_back({i, no_zero});
                if (++without_gain >= 2) break;
                continue;
            }
            for (int value : {0, 1}) {
                gains[value] = static_cast<double>(bound - bounds[value]);
                const double distance = value == 0 ? x_[i] : 1 - x_[i];
                lessons_.push_back({i, value, gains[value], distance, displaced(i, value == 1)});
                learn(lessons_.back());
            }
        }
        const double score = std::max(1.0, gains[0]) * std::max(1.0, gains[1]);
        ++without_gain;
        if (score > best_score) {
            best_score = score;
            choice.label = i;
            std::copy(std::begin(bounds), std::end(bounds), std::begin(choice.bounds));
            without_gain = 0;
        }
    }
    if (!choice.decided.empty()) choice.label = -1;
}

Value Brancher::probe(CutLane& lane, Label i, bool value, Value parent) {
    const std::size_t size = lane.state.size();
    Value bound = kNoValue;
    if (lane.state.assign(i, value)) {
        lane.solve(kStrongIterations);
        bound = std::min(parent, lane.relaxation.bound());
    }
    lane.state.undo(size);
    return bound;
}

void Brancher::learn(const Lesson& lesson) {
    PseudoCost& cost = costs_[lesson.label];
    const int value = lesson.value;
    cost.sum[value] += lesson.gain / std::max(1e-6, lesson.distance);
    ++cost.count[value];
    total_gain_[value] += lesson.gain;
    total_mass_[value] += lesson.mass;
    if (total_mass_[value] > 0) gain_per_mass_[value] = total_gain_[value] / total_mass_[value];
}

}  // namespace labeling
