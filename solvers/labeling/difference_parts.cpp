#include "labeling/difference_parts.h"

#include <algorithm>

namespace labeling {

DifferenceParts::DifferenceParts(const LabelingProblem& problem, const RowSystem& rows)
    : problem_(problem),
      rows_(rows),
      parent_(problem.label_count()),
      row_mark_(rows.row_count(), -1),
      part_of_(problem.label_count(), -1),
      is_different_(problem.label_count(), 0) {}

Label DifferenceParts::find(Label i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
}

void DifferenceParts::join(Label i, Label j) {
    if (!is_different_[j]) return;
    i = find(i);
    j = find(j);
    if (i != j) parent_[std::max(i, j)] = std::min(i, j);
}

std::vector<std::vector<Label>> DifferenceParts::split(std::span<const Label> candidates,
                                                       std::span<const std::uint8_t> a,
                                                       std::span<const std::uint8_t> b) {
    std::vector<Label> differing;
    for (Label i : candidates) {
        if (a[i] == b[i] || is_different_[i]) continue;
        is_different_[i] = 1;
        differing.push_back(i);
        parent_[i] = i;
    }
    for (Label i : differing) {
        for (Label j : problem_.conflicts_of(i)) join(i, j);
        for (const auto& bonus : problem_.bonuses_of(i)) join(i, bonus.label);
        for (const auto& use : rows_.uses(i)) {
            if (row_mark_[use.row] >= 0) join(i, row_mark_[use.row]);
            row_mark_[use.row] = i;
        }
    }
    for (Label i : differing) {
        for (const auto& use : rows_.uses(i)) row_mark_[use.row] = -1;
    }
    std::vector<std::vector<Label>> parts;
    for (Label i : differing) {
        const Label root = find(i);
        if (part_of_[root] < 0) {
            part_of_[root] = static_cast<std::int32_t>(parts.size());
            parts.emplace_back();
        }
        parts[part_of_[root]].push_back(i);
    }
    for (Label i : differing) {
        part_of_[i] = -1;
        is_different_[i] = 0;
    }
    return parts;
}

}  // namespace labeling
