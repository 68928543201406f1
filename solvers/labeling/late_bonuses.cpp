// Where labels have dozens of bonuses (across curves, for quads), most bonuses are tiny and make
// most of the LP. A bonus q y with y <= b_i, y <= b_j is at most q/2 b_i + q/2 b_j, and equal to it
// where both labels agree: so the smallest ones, with 30% of the value of all, begin as halves on
// their labels' weights, without a column. After each LP those for which the halves exceed
// q min(b_i, b_j) most get their column and links, as rows are separated; the bound converges to
// that of the full LP with a part of its columns. Ours. Any fixed split is a valid bound; halves
// need nothing known before. Larger ones must be there at once: clique rows act on them.
#include "labeling/late_bonuses.h"

#include <algorithm>

#include "labeling/clique_cuts.h"

namespace labeling {
namespace {

constexpr double kSmallShare = 0.3;  ///< of the value of all bonuses
constexpr double kHarmless = 0.05;   ///< of the gap
constexpr std::int64_t kBonusesPerTick = 16;

}  // namespace

void LateBonuses::leave_out(const LabelingProblem& problem, Relaxation& relaxation,
                            std::int64_t many) {
    const auto bonuses = problem.bonuses();
    if (static_cast<std::int64_t>(bonuses.size()) < many * problem.label_count()) return;
    double left = 0;
    std::vector<std::int32_t> order;
    for (std::int32_t k = 0; k < static_cast<std::int32_t>(bonuses.size()); ++k) {
        if (relaxation.is_fixed(problem.label_count() + k)) continue;
        order.push_back(k);
        left += static_cast<double>(bonuses[k].value);
    }
    std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
        return bonuses[a].value > bonuses[b].value;
    });
    const double small = kSmallShare * left;
    auto first = order.begin();
    while (first != order.end() && left > small) {
        left -= static_cast<double>(bonuses[*first++].value);
    }
    left_out_.assign(first, order.end());
    relaxation.leave_out(left_out_);
}

std::size_t LateBonuses::bring_in(const LabelingProblem& problem, const TermGraph& graph,
                                  double gap, Relaxation& relaxation, RunControl& control) {
    if (left_out_.empty()) return 0;
    double sum = 0;
    std::vector<std::pair<double, std::int32_t>> excesses;
    for (const std::int32_t k : left_out_) {
        const double excess = relaxation.excess_of_left_out(k);
        if (excess > 0.5) excesses.emplace_back(excess, k);
        sum += excess;
    }
    control.spend(static_cast<std::int64_t>(left_out_.size()) / kBonusesPerTick + 1);
    if (sum < kHarmless * gap) return 0;
    std::stable_sort(excesses.begin(), excesses.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::int32_t> entering;
    for (const auto& [excess, k] : excesses) {
        if (sum < kHarmless / 2 * gap) break;
        sum -= excess;
        entering.push_back(k);
        relaxation.bring_in(k);
    }
    for (Cut& cut : link_clique_cuts(problem, graph, entering, control)) {
        relaxation.add(std::move(cut));
    }
    std::erase_if(left_out_, [&](std::int32_t k) {
        return !relaxation.is_left_out(problem.label_count() + k);
    });
    return entering.size();
}

}  // namespace labeling
