// Compound moves for annealing: one label (or a run of labels along bonuses) is switched on, every
// conflict partner that is on is evicted, and rules that break are mended one after the other by
// the cheapest flip that brings the row closer to its right-hand side. Keep-labels of extraordinary
// nodes need no special case: switching one on is the free way to mend a valence row, and evicting
// one breaks its own row, which then sheds a segment. A flip is rejected early when the loss
// exceeds what the caller accepts (the threshold is drawn before the move is tried).
#include "labeling/compound_move.h"

#include <algorithm>
#include <limits>

namespace labeling {
namespace {

constexpr Value kMost = std::numeric_limits<Value>::max();
/// One rule in so many is mended at random.
constexpr std::uint32_t kRandomMendings = 16;

}  // namespace

CompoundMoves::CompoundMoves(const SearchModel& model, SearchState& state, Random& random)
    : problem_(model.problem()), rows_(model.rows()), state_(state), random_(random) {}

bool CompoundMoves::end(bool is_good, Value threshold, Value before) {
    if (is_good) {
        refill();
        if (state_.value() - before >= threshold) return true;
    }
    state_.roll_back();
    return false;
}

/// Switches on what the evicted kept off, where that is free.
void CompoundMoves::refill() {
    for (std::size_t k = 0; k < state_.freed().size(); ++k) {
        const Label i = state_.freed()[k];
        if (state_.is_on(i) || state_.gain(i) <= 0 || is_touched(i) || !state_.fits(i)) continue;
        state_.mark(i);
        state_.flip(i);
    }
}

bool CompoundMoves::eviction_loss(Label i, Value most, Value& loss) {
    loss = 0;
    evicted_.clear();
    auto evict = [&](Label j) {
        if (is_touched(j)) return false;
        evicted_.push_back(j);
        loss += state_.gain(j);
        return loss <= most;
    };
    std::int32_t left = state_.blocker_count(i);
    std::int64_t sum = state_.blocker_sum(i);
    if (left > 1) {
        for (Label j : problem_.conflicts_of(i)) {
            if (!state_.is_on(j)) continue;
            if (!evict(j)) return false;
            sum -= j;
            if (--left == 1) break;
        }
    }
    return left == 0 || evict(static_cast<Label>(sum));
}

void CompoundMoves::switch_on_evicting(Label i) {
    state_.mark(i);
    for (Label j : evicted_) {
        state_.mark(j);
        state_.flip(j);
    }
    state_.flip(i);
}

bool CompoundMoves::switch_on(Label i) {
    Value loss = 0;
    if (!eviction_loss(i, kMost, loss)) {
        state_.mark(i);
        return false;
    }
    switch_on_evicting(i);
    return true;
}

bool CompoundMoves::flip(Label i, Value threshold) {
    const Value before = state_.value();
    if (state_.is_on(i)) {
        if (-state_.gain(i) < threshold) return false;
        state_.clear_marks();
        if (is_touched(i)) return false;
        state_.mark(i);
        state_.flip(i);
    } else {
        state_.clear_marks();
        if (is_touched(i)) return false;
        Value loss = 0;
        // Bonuses among the evicted are counted twice here, so the estimate is pessimistic.
        const Value most = state_.gain(i) - threshold;
        if (most < 0 || !eviction_loss(i, most, loss)) return false;
        switch_on_evicting(i);
    }
    return end(mend(before + threshold), threshold, before);
}

bool CompoundMoves::insert_run(Label i, int length, Value threshold) {
    state_.clear_marks();
    if (is_touched(i)) return false;
    const Value before = state_.value();
    for (Label at = i;;) {
        if (!state_.is_on(at)) {
            Value loss = 0;
            if (!eviction_loss(at, kMost, loss)) break;
            switch_on_evicting(at);
            --length;
        } else {
            state_.mark(at);
        }
        if (length <= 0) break;
        const auto partners = problem_.bonuses_of(at);
        if (partners.empty()) break;
        const auto count = static_cast<std::uint32_t>(partners.size());
        const std::uint32_t first = random_.below(count);
        Label next = -1;
        for (std::uint32_t k = 0; k < count && next < 0; ++k) {
            const Label candidate = partners[(first + k) % count].label;
            if (!is_touched(candidate)) next = candidate;
        }
        if (next < 0) break;
        at = next;
    }
    return end(mend(before + threshold), threshold, before);
}

bool CompoundMoves::mend(Value floor) {
    auto& broken = state_.broken_rules();
    while (!broken.empty()) {
        const BrokenRule rule = broken.back();
        broken.pop_back();
        while (state_.is_broken(rule)) {
            if (!(rule.row >= 0 ? mend_row(rule.row) : mend_triple(rule))) return false;
            // Mending mostly costs; what it may still win is not worth waiting for.
            if (state_.value() < floor) return false;
        }
    }
    return true;
}

bool CompoundMoves::mend_triple(const BrokenRule& rule) {
    Label best = -1;
    const bool is_random = random_.below(kRandomMendings) == 0;
    for (Label j : {rule.label, rule.others.first, rule.others.second}) {
        if (is_touched(j)) continue;
        const bool is_better =
            best < 0 || (is_random ? random_.below(2) == 0 : state_.gain(j) < state_.gain(best));
        if (is_better) best = j;
    }
    if (best < 0) return false;
    state_.mark(best);
    state_.flip(best);
    return true;
}

bool CompoundMoves::mend_row(std::int32_t row) {
    Label best = -1;
    Value best_cost = kMost;
    std::uint32_t ties = 0;
    const bool is_random = random_.below(kRandomMendings) == 0;
    for (const Term& t : rows_.terms(row)) {
        const Label j = t.label;
        if (state_.is_on(j) != (t.coefficient > 0) || is_touched(j)) continue;
        Value cost = state_.gain(j);
        if (t.coefficient < 0) {
            Value loss = 0;
            if (!eviction_loss(j, kMost, loss)) continue;
            cost = loss - cost;
        }
        if (is_random) cost = 0;
        if (cost < best_cost) {
            best_cost = cost;
            best = j;
            ties = 1;
        } else if (cost == best_cost && random_.below(++ties) == 0) {
            best = j;
        }
    }
    if (best < 0) return false;
    if (!state_.is_on(best)) return switch_on(best);
    state_.mark(best);
    state_.flip(best);
    return true;
}

}  // namespace labeling
