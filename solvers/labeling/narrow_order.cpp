// Minimum-degree elimination that gives labels up where it gets stuck: when every label that is
// left has too many neighbours, one of them is fixed at its present value and leaves the graph.
// What remains is solved exactly by dynamic programming, so the labels that vary together are
// hundreds, where a window of all labels around a place holds some dozens. Rather labels that are
// off are given up, since one that stays on also holds its conflict partners.
#include "labeling/narrow_order.h"

#include <algorithm>

#include "labeling/label_heap.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 16;
constexpr int kTries = 8;

class Narrowing {
public:
    Narrowing(LabelGraph graph, Random& random, RunControl& control)
        : random_(random),
          control_(control),
          is_on_(std::move(graph.is_on)),
          conflicts_(std::move(graph.conflicts)),
          graph_(std::move(graph.neighbours)),
          heap_(static_cast<Label>(is_on_.size())),
          is_given_up_(is_on_.size(), 0) {
        for (Label i = 0; i < static_cast<Label>(graph_.size()); ++i) {
            set(i);
            left_.push_back(i);
        }
    }

    std::optional<EliminationOrder> run(std::size_t most_neighbours) {
        order_.neighbours.resize(graph_.size());
        while (!heap_.is_empty()) {
            const Label i = heap_.top();
            if (graph_[i].size() > most_neighbours) {
                give_up(one_to_give_up());
            } else {
                eliminate(i);
            }
            if (work_ < kEntriesPerTick) continue;
            if (control_.spend(work_ / kEntriesPerTick)) return std::nullopt;
            work_ %= kEntriesPerTick;
        }
        auto is_gone = [&](Label i) { return is_given_up_[i] != 0; };
        std::erase_if(order_.order, is_gone);
        for (Label i : order_.order) std::erase_if(order_.neighbours[i], is_gone);
        return std::move(order_);
    }

private:
    void set(Label i) { heap_.set(i, -static_cast<double>(graph_[i].size())); }

    void eliminate(Label i) {
        heap_.remove(i);
        auto& neighbours = order_.neighbours[i];
        neighbours = std::move(graph_[i]);
        order_.order.push_back(i);
        for (Label j : neighbours) {
            auto& its = graph_[j];
            work_ += static_cast<std::int64_t>(its.size() + neighbours.size());
            joined_.clear();
            std::set_union(its.begin(), its.end(), neighbours.begin(), neighbours.end(),
                           std::back_inserter(joined_));
            std::erase_if(joined_, [i, j](Label k) { return k == i || k == j; });
            its.swap(joined_);
        }
        for (Label j : neighbours) set(j);
    }

    /// Of some labels that are left the one with the most neighbours; rather one that is off.
    Label one_to_give_up() {
        auto rank = [&](Label i) { return is_on_[i] != 0 ? 0 : graph_[i].size(); };
        Label most = -1;
        for (int tries = 0; tries < kTries;) {
            const std::size_t k = random_.below(static_cast<std::uint32_t>(left_.size()));
            const Label i = left_[k];
            if (!heap_.contains(i)) {
                left_[k] = left_.back();
                left_.pop_back();
                continue;
            }
            ++tries;
            if (most < 0 || rank(i) > rank(most)) most = i;
        }
        return most;
    }

    void give_up(Label i) {
        fix(i);
        if (is_on_[i] == 0) return;
        for (Label j : conflicts_[i]) fix(j);
    }

    /// Also labels that have been eliminated: they leave the order.
    void fix(Label i) {
        is_given_up_[i] = 1;
        if (!heap_.contains(i)) return;
        heap_.remove(i);
        for (Label j : graph_[i]) {
            auto& its = graph_[j];
            its.erase(std::lower_bound(its.begin(), its.end(), i));
            set(j);
            work_ += static_cast<std::int64_t>(its.size()) / 4 + 4;
        }
        graph_[i].clear();
    }

    Random& random_;
    RunControl& control_;
    const std::vector<std::uint8_t> is_on_;
    const std::vector<std::vector<Label>> conflicts_;
    std::vector<std::vector<Label>> graph_;  ///< of the labels that are left
    LabelHeap heap_;
    std::vector<std::uint8_t> is_given_up_;
    std::vector<Label> left_, joined_;
    EliminationOrder order_;
    std::int64_t work_ = 0;
};

}  // namespace

std::optional<EliminationOrder> narrow_order(LabelGraph graph, std::size_t most_neighbours,
                                             Random& random, RunControl& control) {
    return Narrowing(std::move(graph), random, control).run(most_neighbours);
}

}  // namespace labeling
