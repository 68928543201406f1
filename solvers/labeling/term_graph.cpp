// The conflict graph of literals, by probing (Savelsbergh 1994; Atamturk, Nemhauser & Savelsbergh
// 2000 for conflict graphs of binary programs). Bonuses are nodes of their own, so that cliques of
// this graph give the product-clique rows, the implication rows and the links y <= b at once. Pairs
// of bonuses are quadratic where bonuses run across curves (quads), so heavy ones find theirs first
// and there is a limit: a missing edge makes cliques smaller, not wrong.
#include "labeling/term_graph.h"

#include <algorithm>
#include <numeric>

namespace labeling {
namespace {

constexpr std::int32_t kMatrixLimit = 24000;
constexpr TermGraph::Node kProbesPerLook = 256;

std::uint64_t edge(TermGraph::Node u, TermGraph::Node v) {
    return (static_cast<std::uint64_t>(u) << 32) | static_cast<std::uint32_t>(v);
}

}  // namespace

TermGraph::TermGraph(const LabelingProblem& problem, Propagator& propagator, RunControl* control,
                     std::size_t most_edges)
    : label_count_(problem.label_count()),
      bonus_count_(static_cast<std::int32_t>(problem.bonus_count())),
      most_edges_(most_edges) {
    bonus_begin_.assign(static_cast<std::size_t>(label_count_) + 1, 0);
    for (const Bonus& b : problem.bonuses()) {
        ++bonus_begin_[b.first + 1];
        ++bonus_begin_[b.second + 1];
    }
    for (Label i = 0; i < label_count_; ++i) bonus_begin_[i + 1] += bonus_begin_[i];
    bonuses_at_.resize(bonus_begin_.back());
    std::vector<std::size_t> next(bonus_begin_.begin(), bonus_begin_.end() - 1);
    for (std::int32_t k = 0; k < bonus_count_; ++k) {
        bonuses_at_[next[problem.bonuses()[k].first]++] = k;
        bonuses_at_[next[problem.bonuses()[k].second]++] = k;
    }
    std::vector<std::uint64_t> edges;
    Node probes = 0;
    for (Node v : probing_order(problem)) {
        probe(problem, propagator, v, edges);
        if (control == nullptr || ++probes % kProbesPerLook != 0) continue;
        control->check();
        if (control->is_over()) {
            edges.clear();
            break;
        }
    }
    std::sort(impossible_.begin(), impossible_.end());
    build_adjacency(edges);
    work_ += 8 * static_cast<std::int64_t>(adjacency_.size());
    if (node_count() > kMatrixLimit) return;
    words_per_row_ = (static_cast<std::size_t>(node_count()) + 63) / 64;
    matrix_.assign(words_per_row_ * static_cast<std::size_t>(node_count()), 0);
    for (Node u = 0; u < node_count(); ++u) {
        for (Node v : neighbours(u)) {
            matrix_[static_cast<std::size_t>(u) * words_per_row_ + v / 64] |= std::uint64_t{1}
                                                                              << (v % 64);
        }
    }
}

/// Labels, then bonuses by value.
std::vector<TermGraph::Node> TermGraph::probing_order(const LabelingProblem& problem) const {
    std::vector<Node> order(static_cast<std::size_t>(node_count()));
    std::iota(order.begin(), order.begin() + label_count_, 0);
    std::iota(order.begin() + label_count_, order.begin() + 2 * std::ptrdiff_t{label_count_},
              off_node(0));
    const auto bonuses = order.begin() + 2 * std::ptrdiff_t{label_count_};
    std::iota(bonuses, order.end(), label_count_);
    std::stable_sort(bonuses, order.end(), [&](Node a, Node b) {
        return problem.bonuses()[column(a) - label_count_].value >
               problem.bonuses()[column(b) - label_count_].value;
    });
    return order;
}

/// Both directions of each edge, ascending at each node, none twice.
void TermGraph::build_adjacency(std::span<const std::uint64_t> edges) {
    const auto nodes = static_cast<std::size_t>(node_count());
    begin_.assign(nodes + 1, 0);
    for (std::uint64_t e : edges) {
        ++begin_[(e >> 32) + 1];
        ++begin_[(e & 0xffffffffU) + 1];
    }
    for (std::size_t v = 0; v < nodes; ++v) begin_[v + 1] += begin_[v];
    adjacency_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint64_t e : edges) {
        adjacency_[next[e >> 32]++] = static_cast<Node>(e & 0xffffffffU);
        adjacency_[next[e & 0xffffffffU]++] = static_cast<Node>(e >> 32);
    }
    auto end = adjacency_.begin();
    for (std::size_t v = 0; v < nodes; ++v) {
        const auto first = adjacency_.begin() + static_cast<std::ptrdiff_t>(begin_[v]);
        const auto last = adjacency_.begin() + static_cast<std::ptrdiff_t>(begin_[v + 1]);
        std::sort(first, last);
        begin_[v] = static_cast<std::size_t>(end - adjacency_.begin());
        end = std::move(first, std::unique(first, last), end);
    }
    begin_[nodes] = static_cast<std::size_t>(end - adjacency_.begin());
    adjacency_.erase(end, adjacency_.end());
}

void TermGraph::probe(const LabelingProblem& problem, Propagator& propagator, Node v,
                      std::vector<std::uint64_t>& edges) {
    Label first = 0, second = -1;
    bool value = true;
    if (v < label_count_) {
        first = v;
    } else if (is_off_node(v)) {
        first = column(v);
        value = false;
    } else {
        first = problem.bonuses()[v - label_count_].first;
        second = problem.bonuses()[v - label_count_].second;
    }
    if (!propagator.is_free(first) || (second >= 0 && !propagator.is_free(second))) return;
    const std::size_t size = propagator.trail().size();
    const bool is_possible =
        propagator.assign(first, value) && (second < 0 || propagator.assign(second, true));
    if (!is_possible) {
        impossible_.push_back(v);
    } else {
        const auto trail = propagator.trail();
        for (std::size_t k = size; k < trail.size(); ++k) {
            const Label i = trail[k];
            if (propagator.value(i) == 1) {
                if (v != label_node(i)) edges.push_back(edge(v, off_node(i)));
                continue;
            }
            if (v != off_node(i)) edges.push_back(edge(v, label_node(i)));
            if (second >= 0 && edges.size() >= most_edges_) continue;
            for (std::size_t b = bonus_begin_[i]; b < bonus_begin_[i + 1]; ++b) {
                edges.push_back(edge(v, bonus_node(bonuses_at_[b])));
            }
        }
        work_ += static_cast<std::int64_t>(trail.size() - size) * 4;
    }
    propagator.undo(size);
}

bool TermGraph::adjacent(Node u, Node v) const {
    if (!matrix_.empty()) {
        return (matrix_[static_cast<std::size_t>(u) * words_per_row_ + v / 64] >> (v % 64)) & 1;
    }
    auto a = neighbours(u), b = neighbours(v);
    if (a.size() > b.size()) {
        std::swap(a, b);
        std::swap(u, v);
    }
    return std::binary_search(a.begin(), a.end(), v);
}

}  // namespace labeling
