// Elimination orders by the two classical greedy rules, minimum degree and minimum fill (see
// Bodlaender & Koster 2010). The labels of a rule are joined pairwise, so that a rule is complete
// in the neighbourhood of the first of them to go. Fill is counted again for the neighbours of an
// eliminated label alone, which may leave old counts two steps away.
#include "labeling/elimination_order.h"

#include <algorithm>
#include <memory_resource>
#include <vector>

#include "labeling/label_heap.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 16;
constexpr std::size_t kLongestRow = 40;
constexpr std::int64_t kEntriesPerLabel = 20, kEntriesPerLook = 300'000;

class Elimination {
public:
    Elimination(const LabelingProblem& problem, RunControl& control, EliminationRule rule)
        : control_(control),
          rule_(rule),
          heap_(problem.label_count()),
          graph_(problem.label_count(), &memory_),
          marks_(problem.label_count(), 0) {}

    /// False: a rule is too long, or the run is over.
    bool join(const LabelingProblem& problem, const RowSystem& rows) {
        const Label n = problem.label_count();
        std::int64_t looked_at = 0;
        for (Label i = 0; i < n; ++i) {
            const auto conflicts = problem.conflicts_of(i);
            graph_[i].assign(conflicts.begin(), conflicts.end());
            for (const auto& b : problem.bonuses_of(i)) graph_[i].push_back(b.label);
            looked_at += static_cast<std::int64_t>(conflicts.size()) + kEntriesPerLabel;
            if (is_over(looked_at)) return false;
        }
        for (std::int32_t row = 0; row < rows.row_count(); ++row) {
            const auto terms = rows.terms(row);
            if (terms.size() > kLongestRow) return false;
            for (const Term& t : terms) {
                for (const Term& other : terms) {
                    if (other.label != t.label) graph_[t.label].push_back(other.label);
                }
            }
            looked_at += kEntriesPerLabel;
            if (is_over(looked_at)) return false;
        }
        for (auto& neighbours : graph_) {
            std::sort(neighbours.begin(), neighbours.end());
            neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
            work_ += 4 * static_cast<std::int64_t>(neighbours.size());
            looked_at += 4 * static_cast<std::int64_t>(neighbours.size());
            if (is_over(looked_at)) return false;
        }
        for (Label i = 0; i < n; ++i) heap_.set(i, score(i));
        return true;
    }

    std::optional<EliminationOrder> run() {
        EliminationOrder result;
        std::vector<Label> joined;
        while (!heap_.is_empty()) {
            const Label i = heap_.top();
            heap_.remove(i);
            const auto& neighbours = graph_[i];
            if (neighbours.size() > EliminationOrder::kMostNeighbours) return std::nullopt;
            for (Label j : neighbours) {
                auto& its = graph_[j];
                work_ += static_cast<std::int64_t>(its.size() + neighbours.size());
                joined.clear();
                std::set_union(its.begin(), its.end(), neighbours.begin(), neighbours.end(),
                               std::back_inserter(joined));
                std::erase_if(joined, [i, j](Label k) { return k == i || k == j; });
                if (joined.size() > its.capacity()) its.reserve(2 * joined.size());
                its.assign(joined.begin(), joined.end());
            }
            for (Label j : neighbours) heap_.set(j, score(j));
            result.order.push_back(i);
            if (work_ < kEntriesPerTick) continue;
            if (control_.spend(work_ / kEntriesPerTick)) return std::nullopt;
            work_ = 0;
        }
        for (const auto& neighbours : graph_) {
            result.neighbours.emplace_back(neighbours.begin(), neighbours.end());
        }
        return result;
    }

private:
    /// Reads the clock once in a while.
    bool is_over(std::int64_t& looked_at) {
        if (looked_at < kEntriesPerLook) return false;
        looked_at = 0;
        control_.check();
        return control_.is_over();
    }

    double score(Label i) {
        const auto& neighbours = graph_[i];
        const auto degree = static_cast<double>(neighbours.size());
        if (rule_ == EliminationRule::Degree) return -degree;
        // So many neighbours are not eliminated before others have gone, which counts them again.
        if (neighbours.size() > EliminationOrder::kMostNeighbours) return -degree * degree;
        ++mark_;
        for (Label j : neighbours) marks_[j] = mark_;
        std::int64_t present = 0;
        for (Label j : neighbours) {
            const auto& its = graph_[j];
            for (Label k : its) present += marks_[k] == mark_ ? 1 : 0;
            work_ += static_cast<std::int64_t>(its.size() + neighbours.size());
        }
        return static_cast<double>(present) / 2 - degree * (degree - 1) / 2;
    }

    RunControl& control_;
    const EliminationRule rule_;
    LabelHeap heap_;
    std::pmr::monotonic_buffer_resource memory_;  ///< of all lists, given back at once
    /// Neighbours among the labels that are left; of a label that is gone, when it went.
    std::pmr::vector<std::pmr::vector<Label>> graph_;
    std::vector<std::int64_t> marks_;  ///< mark_ on the neighbours that are looked at
    std::int64_t mark_ = 0;
    std::int64_t work_ = 0;
};

}  // namespace

std::optional<EliminationOrder> elimination_order(const LabelingProblem& problem,
                                                  const RowSystem& rows, RunControl& control,
                                                  EliminationRule rule) {
    Elimination elimination(problem, control, rule);
    if (!elimination.join(problem, rows)) return std::nullopt;
    return elimination.run();
}

}  // namespace labeling
