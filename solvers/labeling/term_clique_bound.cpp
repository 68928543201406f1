// Clique cover bound. Without rules the problem is a maximum weight independent set over terms: one
// node per label (its weight) and one per bonus (its value), two nodes adjacent when any of their
// labels conflict. At most one node of a clique counts, so a partition of the nodes into cliques
// bounds the value by the sum of the cliques' largest weights. The partition is first-fit by
// falling weight: whatever joins an existing clique is free. Negative weights count as 0.
#include "labeling/term_clique_bound.h"

#include <algorithm>

namespace labeling {
namespace {

constexpr Label kMatrixLimit = 4096;
constexpr std::size_t kCliqueTrials = 200;
constexpr std::size_t kTermsPerLook = 1024;

}  // namespace

TermCliqueBound::TermCliqueBound(const LabelingProblem& problem, RunControl& control)
    : problem_(problem), control_(control) {
    if (problem.label_count() > kMatrixLimit) return;
    words_per_row_ = (static_cast<std::size_t>(problem.label_count()) + 63) / 64;
    matrix_.assign(words_per_row_ * static_cast<std::size_t>(problem.label_count()), 0);
    for (Label i = 0; i < problem.label_count(); ++i) {
        for (Label j : problem.conflicts_of(i)) {
            matrix_[static_cast<std::size_t>(i) * words_per_row_ + j / 64] |= std::uint64_t{1}
                                                                              << (j % 64);
        }
    }
}

bool TermCliqueBound::labels_conflict(Label i, Label j) const {
    if (matrix_.empty()) return i != j && problem_.in_conflict(i, j);
    return (matrix_[static_cast<std::size_t>(i) * words_per_row_ + j / 64] >> (j % 64)) & 1;
}

bool TermCliqueBound::terms_conflict(const TermNode& a, const TermNode& b) {
    ++work_;
    return labels_conflict(a.first, b.first) ||
           (b.first != b.second && labels_conflict(a.first, b.second)) ||
           (a.first != a.second && (labels_conflict(a.second, b.first) ||
                                    (b.first != b.second && labels_conflict(a.second, b.second))));
}

Value TermCliqueBound::operator()(const Propagator& propagator, Value enough) {
    Value bound = 0;
    terms_.clear();
    for (Label i = 0; i < problem_.label_count(); ++i) {
        if (propagator.value(i) == 0) continue;
        const bool is_on = propagator.value(i) == 1;
        Value weight = problem_.weight(i);
        for (const auto& b : problem_.bonuses_of(i)) {
            const std::int8_t partner = propagator.value(b.label);
            if (partner == 1 && (!is_on || b.label > i)) weight += b.value;
            if (!is_on && partner == Propagator::kFree && b.label > i) {
                terms_.push_back({b.value, i, b.label});
            }
        }
        if (is_on) {
            bound += weight;
        } else if (weight > 0) {
            terms_.push_back({weight, i, i});
        }
    }
    work_ += problem_.label_count();
    std::sort(terms_.begin(), terms_.end(), [](const TermNode& a, const TermNode& b) {
        if (a.value != b.value) return a.value > b.value;
        return a.first != b.first ? a.first < b.first : a.second < b.second;
    });
    std::size_t used = 0, placed = 0;
    for (const TermNode& t : terms_) {
        // On large problems this takes seconds; without a place a term counts in full.
        if (++placed % kTermsPerLook == 0) control_.check();
        if (placed >= kTermsPerLook && control_.is_over()) {
            bound += t.value;
            continue;
        }
        bool is_placed = false;
        // Late cliques hold terms of similar size and are the likelier ones to be open.
        for (std::size_t k = 0; k < std::min(used, kCliqueTrials) && !is_placed; ++k) {
            auto& clique = cliques_[used - 1 - k];
            is_placed = std::all_of(clique.begin(), clique.end(),
                                    [&](const TermNode& u) { return terms_conflict(t, u); });
            if (is_placed) clique.push_back(t);
        }
        if (is_placed) continue;
        bound += t.value;
        if (bound > enough) return bound;
        if (used == cliques_.size()) cliques_.emplace_back();
        cliques_[used].clear();
        cliques_[used++].push_back(t);
    }
    return bound;
}

}  // namespace labeling
