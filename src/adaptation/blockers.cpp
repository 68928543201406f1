#include "adaptation/blockers.h"

#include <algorithm>

namespace fcn {

namespace {

const Conflict* find_conflict(const std::vector<Conflict>& conflicts, int a, int b) {
    const auto [first, second] = std::minmax(a, b);
    const auto at =
        std::ranges::lower_bound(conflicts, std::pair(first, second), {},
                                 [](const Conflict& c) { return std::pair(c.first, c.second); });
    const bool is_found = at != conflicts.end() && at->first == first && at->second == second;
    return is_found ? &*at : nullptr;
}

}  // namespace

std::vector<Blocker> describe_blockers(const std::vector<int>& labels, int segment,
                                       const LabelingBridge& bridge,
                                       const ConflictResult& conflicts,
                                       const labeling::LabelingProblem& problem,
                                       const std::function<int(int)>& origin_of) {
    const std::vector<int>& own = bridge.segments_of_label(bridge.label_of_segment(segment));
    std::vector<Blocker> blockers;
    for (const int label : labels) {
        Blocker blocker;
        blocker.label = label;
        blocker.weight = static_cast<double>(problem.weight(label)) / problem.units_per_one();
        blocker.conflict = "rule";
        const std::vector<int>& others = bridge.segments_of_label(label);
        if (!others.empty()) blocker.origin_arc = origin_of(others.front());
        for (const int mine : own) {
            for (const int other : others) {
                const Conflict* conflict = find_conflict(conflicts.conflicts, mine, other);
                if (conflict == nullptr) continue;
                blocker.conflict = to_string(conflict->kind);
                blocker.measured =
                    conflict->kind == ConflictKind::Angle ? conflict->angle : conflict->distance;
                blocker.origin_arc = origin_of(other);
            }
        }
        blockers.push_back(std::move(blocker));
    }
    return blockers;
}

}  // namespace fcn
