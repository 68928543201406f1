// A bound for problems on which everything better takes seconds. Half of a bonus counts with either
// label (y <= (x_i + x_j) / 2), so that labels are all there is; labels that conflict in pairs earn
// at most the largest of their values. Labels come by falling value and join the largest clique all
// of whose members are their neighbours: counting the cliques of earlier neighbours finds it in
// the time that the neighbours take. The cover of labels and bonuses (term_clique_bound.cpp) is
// tighter, since a bonus has more neighbours than a label, and quadratic.
#include "labeling/quick_clique_bound.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "labeling/pass_guard.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 52;
constexpr std::int64_t kEntriesPerLook = 50'000;
constexpr std::int64_t kEntriesPerComparison = 1;

/// What a label earns at most; 0 where its weight is less than its bonuses make good.
std::vector<Value> shared_values(const LabelingProblem& problem) {
    std::vector<Value> values(problem.weights().begin(), problem.weights().end());
    for (const Bonus& b : problem.bonuses()) {
        values[b.first] += b.value / 2;
        values[b.second] += b.value - b.value / 2;
    }
    for (Value& v : values) v = std::max(v, Value{0});
    return values;
}

}  // namespace

Value quick_clique_bound(const LabelingProblem& problem, RunControl& control) {
    const std::vector<Value> values = shared_values(problem);
    std::vector<Label> order(values.size());
    std::iota(order.begin(), order.end(), Label{0});
    PassGuard guard(control);
    try {
        guard.look();
        std::sort(order.begin(), order.end(), [&](Label a, Label b) {
            guard.step(kEntriesPerComparison);
            return values[a] != values[b] ? values[a] > values[b] : a < b;
        });
    } catch (const StoppedInPass&) {
        return std::accumulate(values.begin(), values.end(), Value{0});
    }
    constexpr std::int32_t kNone = -1;
    std::vector<std::int32_t> clique(values.size(), kNone);
    std::vector<std::int32_t> sizes, hits;
    std::vector<std::int32_t> touched;
    Value bound = 0;
    std::int64_t entries = 0;
    for (Label i : order) {
        if (entries >= kEntriesPerLook) {
            control.spend(entries / kEntriesPerTick);
            control.check();
            entries = 0;
        }
        if (control.is_over()) {
            bound += values[i];
            continue;
        }
        std::int32_t best = kNone;
        touched.clear();
        for (Label j : problem.conflicts_of(i)) {
            const std::int32_t c = clique[j];
            if (c == kNone) continue;
            if (hits[c]++ == 0) touched.push_back(c);
            if (hits[c] == sizes[c] && (best == kNone || sizes[c] > sizes[best])) best = c;
        }
        for (std::int32_t c : touched) hits[c] = 0;
        entries += 8 + static_cast<std::int64_t>(problem.conflicts_of(i).size());
        if (best == kNone) {
            bound += values[i];
            best = static_cast<std::int32_t>(sizes.size());
            sizes.push_back(0);
            hits.push_back(0);
        }
        clique[i] = best;
        ++sizes[best];
    }
    control.spend(entries / kEntriesPerTick);
    return bound;
}

}  // namespace labeling
