// Clique rows on the term conflict graph ("product cliques" where bonuses take part). Separation on
// the support of the fractional solution: from every fractional node a depth-first search for a
// clique of large value, cut off after a few hundred steps (greedy alone is clearly worse), then
// lifting by nodes of value zero until the clique is maximal in the whole graph.
#include "labeling/clique_cuts.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "labeling/cliques.h"

namespace labeling {
namespace {

constexpr double kZero = 1e-5;

}  // namespace

Cut clique_cut(const TermGraph& graph, std::span<const TermGraph::Node> clique) {
    Cut cut;
    cut.right_hand_side = 1;
    for (TermGraph::Node v : clique) {
        if (graph.is_off_node(v)) {
            cut.entries.push_back({graph.column(v), -1});
            --cut.right_hand_side;
        } else {
            cut.entries.push_back({graph.column(v), 1});
        }
    }
    std::sort(cut.entries.begin(), cut.entries.end(),
              [](const Cut::Entry& a, const Cut::Entry& b) { return a.column < b.column; });
    return cut;
}

namespace {

/// Adds common neighbours until the clique is maximal, larger worth first.
void make_maximal(const TermGraph& graph, const std::vector<double>& worth,
                  std::vector<TermGraph::Node>& clique, std::int64_t& work) {
    using Node = TermGraph::Node;
    Node narrow = clique[0];
    for (Node v : clique) {
        if (graph.neighbours(v).size() < graph.neighbours(narrow).size()) narrow = v;
    }
    std::vector<Node> common;
    for (Node w : graph.neighbours(narrow)) {
        const bool is_common = std::all_of(clique.begin(), clique.end(), [&](Node v) {
            return v == narrow || (v != w && graph.adjacent(v, w));
        });
        if (is_common) common.push_back(w);
    }
    work += static_cast<std::int64_t>(graph.neighbours(narrow).size()) * 3;
    std::stable_sort(common.begin(), common.end(), [&](Node a, Node b) {
        return worth[graph.column(a)] > worth[graph.column(b)];
    });
    const std::size_t first = clique.size();
    for (Node w : common) {
        const bool fits = std::all_of(clique.begin() + static_cast<std::ptrdiff_t>(first),
                                      clique.end(), [&](Node v) { return graph.adjacent(v, w); });
        if (fits) clique.push_back(w);
        work += static_cast<std::int64_t>(clique.size() - first);
    }
}

/// Looks at clock and stop token now and then.
bool is_over(RunControl& control, std::size_t step) {
    constexpr std::size_t kStepsPerLook = 64;
    if (step % kStepsPerLook == 0) control.check();
    return control.is_over();
}

std::vector<double> column_worth(const LabelingProblem& problem) {
    std::vector<double> worth;
    for (Value w : problem.weights()) worth.push_back(static_cast<double>(w));
    for (const Bonus& b : problem.bonuses()) worth.push_back(static_cast<double>(b.value));
    return worth;
}

}  // namespace

std::vector<Cut> conflict_clique_cuts(const LabelingProblem& problem, const TermGraph& graph,
                                      RunControl& control) {
    using Node = TermGraph::Node;
    const std::vector<double> worth = column_worth(problem);
    std::int64_t work = 0;
    std::vector<Cut> cuts;
    std::vector<Node> clique;
    for (const auto& members : conflict_clique_cover(problem, &control)) {
        if (is_over(control, cuts.size())) return cuts;
        clique.assign(members.begin(), members.end());
        make_maximal(graph, worth, clique, work);
        cuts.push_back(clique_cut(graph, clique));
    }
    return cuts;
}

/// Per label, its bonuses are covered by cliques that contain "label off".
std::vector<Cut> link_clique_cuts(const LabelingProblem& problem, const TermGraph& graph,
                                  std::span<const std::int32_t> bonuses, RunControl& control) {
    using Node = TermGraph::Node;
    const std::vector<double> worth = column_worth(problem);
    std::int64_t work = 0;
    std::vector<Cut> cuts;
    std::vector<Node> clique;
    std::vector<std::vector<std::int32_t>> bonuses_of(problem.label_count());
    for (const std::int32_t k : bonuses) {
        bonuses_of[problem.bonuses()[k].first].push_back(k);
        bonuses_of[problem.bonuses()[k].second].push_back(k);
    }
    for (Label i = 0; i < problem.label_count(); ++i) {
        if (is_over(control, static_cast<std::size_t>(i))) return cuts;
        auto& open = bonuses_of[i];
        while (!open.empty()) {
            clique.assign(1, graph.off_node(i));
            std::vector<std::int32_t> left;
            for (std::int32_t k : open) {
                const Node v = graph.bonus_node(k);
                const bool fits = std::all_of(clique.begin() + 1, clique.end(),
                                              [&](Node u) { return graph.adjacent(u, v); });
                if (fits) {
                    clique.push_back(v);
                } else {
                    left.push_back(k);
                }
            }
            if (clique.size() > 1 && graph.adjacent(clique[0], clique[1])) {
                make_maximal(graph, worth, clique, work);
            }
            cuts.push_back(clique_cut(graph, clique));
            open.swap(left);
        }
    }
    return cuts;
}

std::vector<Cut> initial_clique_cuts(const LabelingProblem& problem, const TermGraph& graph,
                                     RunControl& control) {
    std::vector<std::int32_t> bonuses(problem.bonus_count());
    std::iota(bonuses.begin(), bonuses.end(), 0);
    std::vector<Cut> cuts = conflict_clique_cuts(problem, graph, control);
    for (Cut& cut : link_clique_cuts(problem, graph, bonuses, control)) {
        cuts.push_back(std::move(cut));
    }
    return cuts;
}

CliqueSeparator::CliqueSeparator(const LabelingProblem& problem, const TermGraph& graph)
    : problem_(problem),
      graph_(graph),
      local_(graph.node_count(), -1),
      worth_(column_worth(problem)) {}

void CliqueSeparator::build_support(std::span<const double> x) {
    for (Node v : support_) local_[v] = -1;
    support_.clear();
    std::vector<std::pair<double, Node>> valued;
    for (Node v = 0; v < graph_.node_count(); ++v) {
        if (graph_.neighbours(v).empty()) continue;
        const double column = x[graph_.column(v)];
        const double value = graph_.is_off_node(v) ? 1 - column : column;
        // A node at one helps only where the rows of the LP do not force its neighbours to zero.
        if (value > kZero && value < 1 - kZero) valued.emplace_back(value, v);
    }
    std::stable_sort(valued.begin(), valued.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    values_.clear();
    for (const auto& [value, v] : valued) {
        local_[v] = static_cast<std::int32_t>(support_.size());
        support_.push_back(v);
        values_.push_back(value);
    }
    words_ = (support_.size() + 63) / 64;
    adjacency_.assign(words_ * support_.size(), 0);
    for (std::size_t s = 0; s < support_.size(); ++s) {
        const auto neighbours = graph_.neighbours(support_[s]);
        for (Node w : neighbours) {
            const std::int32_t t = local_[w];
            if (t >= 0) adjacency_[s * words_ + t / 64] |= std::uint64_t{1} << (t % 64);
        }
        work_ += static_cast<std::int64_t>(neighbours.size());
    }
    work_ += graph_.node_count() + static_cast<std::int64_t>(adjacency_.size()) / 4;
}

void CliqueSeparator::search(std::size_t depth, double weight, int& steps_left) {
    if (weight > best_weight_ + 1e-9) {
        best_weight_ = weight;
        best_ = current_;
    }
    if (candidates_.size() <= depth + 1) candidates_.resize(depth + 2);
    candidates_[depth + 1].resize(words_);
    double rest = 0;
    for (std::size_t w = 0; w < words_; ++w) {
        for (std::uint64_t bits = candidates_[depth][w]; bits != 0; bits &= bits - 1) {
            rest += values_[w * 64 + static_cast<std::size_t>(std::countr_zero(bits))];
        }
    }
    work_ += static_cast<std::int64_t>(words_) * 2;
    for (std::size_t w = 0; w < words_; ++w) {
        while (candidates_[depth][w] != 0) {
            if (weight + rest <= best_weight_ + 1e-6 || --steps_left < 0) return;
            const int bit = std::countr_zero(candidates_[depth][w]);
            const std::size_t s = w * 64 + static_cast<std::size_t>(bit);
            candidates_[depth][w] &= candidates_[depth][w] - 1;
            rest -= values_[s];
            for (std::size_t k = 0; k < words_; ++k) {
                candidates_[depth + 1][k] = candidates_[depth][k] & adjacency_[s * words_ + k];
            }
            current_.push_back(static_cast<std::int32_t>(s));
            search(depth + 1, weight + values_[s], steps_left);
            current_.pop_back();
        }
    }
}

std::vector<TermGraph::Node> CliqueSeparator::best_clique(
    std::span<const TermGraph::Node> candidates, double& weight, int max_steps) {
    if (candidates_.empty()) candidates_.resize(1);
    candidates_[0].assign(words_, 0);
    for (Node v : candidates) {
        const std::int32_t s = local_[v];
        if (s >= 0) candidates_[0][s / 64] |= std::uint64_t{1} << (s % 64);
    }
    work_ += static_cast<std::int64_t>(candidates.size());
    current_.clear();
    best_.clear();
    best_weight_ = 0;
    int steps = max_steps;
    search(0, 0, steps);
    weight = best_weight_;
    std::vector<Node> clique;
    for (std::int32_t s : best_) clique.push_back(support_[s]);
    return clique;
}

std::vector<Cut> CliqueSeparator::separate(std::span<const double> x,
                                           const CliqueCutOptions& options) {
    build_support(x);
    std::vector<std::pair<double, Cut>> found;
    std::vector<int> cover(support_.size(), 0);
    if (candidates_.empty()) candidates_.resize(1);
    for (std::size_t s = 0; s < support_.size(); ++s) {
        if (cover[s] > 0) continue;
        candidates_[0].assign(adjacency_.begin() + static_cast<std::ptrdiff_t>(s * words_),
                              adjacency_.begin() + static_cast<std::ptrdiff_t>((s + 1) * words_));
        current_.assign(1, static_cast<std::int32_t>(s));
        best_.clear();
        best_weight_ = 1 + options.min_violation;
        int steps = options.max_steps;
        search(0, values_[s], steps);
        if (best_.empty()) continue;
        std::vector<Node> clique;
        for (std::int32_t t : best_) {
            clique.push_back(support_[t]);
            ++cover[t];
        }
        make_maximal(graph_, worth_, clique, work_);
        Cut cut = clique_cut(graph_, clique);
        const double violation = cut.activity(x) - static_cast<double>(cut.right_hand_side);
        found.emplace_back(violation, std::move(cut));
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (found.size() > options.max_cuts) found.resize(options.max_cuts);
    std::vector<Cut> cuts;
    for (auto& [violation, cut] : found) cuts.push_back(std::move(cut));
    return cuts;
}

}  // namespace labeling
