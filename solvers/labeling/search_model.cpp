#include "labeling/search_model.h"

#include <algorithm>

namespace labeling {
namespace {

/// What a row and a label cost the guard, in entries.
constexpr std::int64_t kEntriesPerRow = 2, kEntriesPerLabel = 5;

bool is_triple(const RowSystem& rows, std::int32_t row) {
    const auto terms = rows.terms(row);
    return rows.right_hand_side(row) == 2 && terms.size() == 3 &&
           std::all_of(terms.begin(), terms.end(),
                       [](const Term& t) { return t.coefficient == 1; });
}

}  // namespace

SearchModel::SearchModel(const LabelingProblem& problem, const RowSystem& rows, PassGuard guard)
    : problem_(problem), rows_(rows) {
    const Label n = problem.label_count();
    std::vector<std::uint8_t> triple(rows.row_count());
    for (std::int32_t row = 0; row < rows.row_count(); ++row) {
        triple[row] = is_triple(rows, row);
        guard.step(kEntriesPerRow);
    }
    pair_begin_.reserve(n + 1);
    use_begin_.reserve(n + 1);
    for (Label i = 0; i < n; ++i) {
        pair_begin_.push_back(static_cast<std::uint32_t>(pairs_.size()));
        use_begin_.push_back(static_cast<std::uint32_t>(uses_.size()));
        for (const auto& use : rows.uses(i)) {
            if (triple[use.row] == 0) {
                uses_.push_back(use);
                continue;
            }
            const auto t = rows.terms(use.row);
            const int at = t[0].label == i ? 0 : t[1].label == i ? 1 : 2;
            pairs_.push_back({t[at == 0 ? 1 : 0].label, t[at == 2 ? 1 : 2].label});
        }
        if (is_proposed(i)) proposals_.push_back(i);
        guard.step(kEntriesPerLabel + static_cast<std::int64_t>(rows.uses(i).size()));
    }
    pair_begin_.push_back(static_cast<std::uint32_t>(pairs_.size()));
    use_begin_.push_back(static_cast<std::uint32_t>(uses_.size()));
    set_scale();
}

void SearchModel::set_scale() {
    std::vector<double> worths;
    for (Label i : proposals_) {
        double worth = static_cast<double>(problem_.weight(i));
        for (const auto& b : problem_.bonuses_of(i)) worth += 0.5 * static_cast<double>(b.value);
        if (worth > 0) worths.push_back(worth);
    }
    if (worths.empty()) return;
    const auto middle = worths.begin() + static_cast<std::ptrdiff_t>(worths.size() / 2);
    std::nth_element(worths.begin(), middle, worths.end());
    scale_ = std::max(1.0, *middle);
}

}  // namespace labeling
