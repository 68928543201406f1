// Cuts from three-label rules. Let z stand for "labels a and b are on": the bonus y_ab where there
// is one, or the expression b_a + b_b - 1, which is never larger than that product.
//  - Rule b_a + b_b + b_d <= 2: z excludes d, so for a clique K of the term graph all of whose
//  nodes
//    exclude z (d among them):  z + sum_K x <= 1.
//  - Valence rule with keep-label c: z excludes the star's other labels d, and bonuses that reach
//    one, only while c = 0; a clique Q of nodes that exclude both z and t (t a label d of the star
//    or a bonus with it) holds always, so  z + t + sum_Q x <= 1 + c:  with c = 1 at most z and t
//    are one.
// Candidates for Q and K come from the support of x through the clique separator; what a pair of
// labels excludes is found by probing both at once, and remembered.
#include "labeling/triple_cuts.h"

#include <algorithm>

namespace labeling {
namespace {

constexpr double kMinViolation = 0.005;
constexpr std::size_t kLargestStar = 12;

std::uint64_t key(Label a, Label b) {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) |
           static_cast<std::uint32_t>(std::max(a, b));
}

}  // namespace

TripleSeparator::TripleSeparator(const LabelingProblem& problem, const RowSystem& rows,
                                 const TermGraph& graph)
    : problem_(problem), rows_(rows), graph_(graph), mark_(graph.node_count(), 0) {
    for (std::size_t k = 0; k < problem.bonus_count(); ++k) {
        const Bonus& b = problem.bonuses()[k];
        bonus_of_[key(b.first, b.second)] = static_cast<std::int32_t>(k);
    }
    for (std::int32_t row = 0; row < rows.row_count(); ++row) {
        if (rows.right_hand_side(row) != 2) continue;
        Star star;
        std::int64_t keep_coefficient = 0;
        int keeps = 0;
        bool is_star = true;
        for (const Term& t : rows.terms(row)) {
            if (t.coefficient == 1) {
                star.labels.push_back(t.label);
            } else if (t.coefficient < 0) {
                star.keep = t.label;
                keep_coefficient = -t.coefficient;
                ++keeps;
            } else {
                is_star = false;
            }
        }
        const std::size_t size = star.labels.size();
        if (!is_star || size < 3 || size > kLargestStar) continue;
        if (keeps == 0 && size == 3) triples_.push_back(row);
        // With c = 1 the rule must leave the star free, or the coefficient of c would be wrong.
        if (keeps == 1 && keep_coefficient >= static_cast<std::int64_t>(size) - 2) {
            stars_.push_back(std::move(star));
        }
    }
}

const std::vector<TermGraph::Node>& TripleSeparator::excluded(Label a, Label b,
                                                              Propagator& propagator) {
    const auto [it, is_new] = excluded_.try_emplace(key(a, b));
    std::vector<Node>& nodes = it->second;
    if (!is_new || !propagator.is_free(a) || !propagator.is_free(b)) return nodes;
    const std::size_t size = propagator.trail().size();
    if (propagator.assign(a, true) && propagator.assign(b, true)) {
        for (std::size_t k = size; k < propagator.trail().size(); ++k) {
            const Label i = propagator.trail()[k];
            if (i == a || i == b) continue;
            if (propagator.value(i) == 1) {
                nodes.push_back(graph_.off_node(i));
                continue;
            }
            nodes.push_back(graph_.label_node(i));
            for (const auto& partner : problem_.bonuses_of(i)) {
                nodes.push_back(graph_.bonus_node(bonus_of_.at(key(i, partner.label))));
            }
        }
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    }
    propagator.undo(size);
    work_ += 50 + 4 * static_cast<std::int64_t>(nodes.size());
    return nodes;
}

double TripleSeparator::value(const Pair& pair, std::span<const double> x) const {
    return pair.bonus >= 0 ? x[pair.bonus] : x[pair.a] + x[pair.b] - 1;
}

void TripleSeparator::add_cut(const Pair& pair, std::vector<Node> clique,
                              const std::vector<Node>& allowed, Label keep,
                              std::span<const double> x) {
    // Lift by nodes of value zero that fit everything in the clique.
    for (Node v : allowed) {
        const bool fits = std::all_of(clique.begin(), clique.end(),
                                      [&](Node u) { return u != v && graph_.adjacent(u, v); });
        if (fits) clique.push_back(v);
        work_ += 2;
    }
    std::vector<std::pair<std::int32_t, std::int32_t>> terms;
    std::int64_t side = 1;
    if (pair.bonus >= 0) {
        terms.emplace_back(pair.bonus, 1);
    } else {
        terms.emplace_back(pair.a, 1);
        terms.emplace_back(pair.b, 1);
        ++side;
    }
    for (Node v : clique) {
        terms.emplace_back(graph_.column(v), graph_.is_off_node(v) ? -1 : 1);
        if (graph_.is_off_node(v)) --side;
    }
    if (keep >= 0) terms.emplace_back(keep, -1);
    std::sort(terms.begin(), terms.end());
    Cut cut;
    cut.right_hand_side = side;
    for (const auto& [column, coefficient] : terms) {
        if (!cut.entries.empty() && cut.entries.back().column == column) {
            cut.entries.back().coefficient += coefficient;
        } else {
            cut.entries.push_back({column, coefficient});
        }
    }
    std::erase_if(cut.entries, [](const Cut::Entry& e) { return e.coefficient == 0; });
    const double violation = cut.activity(x) - static_cast<double>(cut.right_hand_side);
    if (violation > kMinViolation) found_.emplace_back(violation, std::move(cut));
}

void TripleSeparator::separate_star(const Star& star, std::span<const double> x,
                                    CliqueSeparator& cliques, Propagator& propagator) {
    const double keep = x[star.keep];
    if (keep > 0.95) return;
    // What stands for "two of the star are on" ...
    std::vector<Pair> pairs;
    for (std::size_t a = 0; a < star.labels.size(); ++a) {
        for (std::size_t b = a + 1; b < star.labels.size(); ++b) {
            Pair pair{star.labels[a], star.labels[b], -1};
            const auto it = bonus_of_.find(key(pair.a, pair.b));
            if (it != bonus_of_.end()) {
                pair.bonus = graph_.bonus_node(it->second);
                if (value(pair, x) > keep + kMinViolation) pairs.push_back(pair);
                pair.bonus = -1;
            }
            if (value(pair, x) > keep + kMinViolation) pairs.push_back(pair);
        }
    }
    // ... and what then needs the keep-label: a third label, or a bonus that brings one in.
    std::vector<std::pair<Node, std::pair<Label, Label>>> thirds;
    for (Label d : star.labels) {
        if (x[d] > keep + kMinViolation) thirds.push_back({graph_.label_node(d), {d, d}});
        for (Label e : star.labels) {
            if (e <= d) continue;
            const auto it = bonus_of_.find(key(d, e));
            if (it == bonus_of_.end()) continue;
            const Node v = graph_.bonus_node(it->second);
            if (x[v] > keep + kMinViolation) thirds.push_back({v, {d, e}});
        }
    }
    for (const Pair& pair : pairs) {
        for (const auto& [third, labels] : thirds) {
            const auto is_new = [&](Label i) { return i != pair.a && i != pair.b; };
            if (!is_new(labels.first) && !is_new(labels.second)) continue;
            // Two bonuses: keep one order of the two.
            if (pair.bonus >= 0 && third >= graph_.label_count() && third < pair.bonus) continue;
            const double base = value(pair, x) + x[third] - 1 - keep;
            if (base < -0.6) continue;
            const auto& first = excluded(pair.a, pair.b, propagator);
            std::vector<Node> allowed;
            for (Node v : graph_.neighbours(third)) {
                if (std::binary_search(first.begin(), first.end(), v)) allowed.push_back(v);
            }
            work_ += static_cast<std::int64_t>(graph_.neighbours(third).size());
            double weight = 0;
            const std::vector<Node> clique = cliques.best_clique(allowed, weight);
            if (base + weight < kMinViolation) continue;
            // `third` is adjacent to all of `allowed`, so it may sit in the clique itself.
            std::vector<Node> members = clique;
            members.push_back(third);
            add_cut(pair, std::move(members), allowed, star.keep, x);
        }
    }
}

void TripleSeparator::separate_triple(std::int32_t row, std::span<const double> x,
                                      CliqueSeparator& cliques, Propagator& propagator) {
    const auto terms = rows_.terms(row);
    double sum = 0;
    for (const Term& t : terms) sum += x[t.label];
    if (sum < 1.4) return;
    for (std::size_t k = 0; k < 3; ++k) {
        const Label third = terms[k].label;
        Pair pair{terms[(k + 1) % 3].label, terms[(k + 2) % 3].label, -1};
        const double base = value(pair, x) - 1;
        if (base < -0.9 || x[third] < 1e-5) continue;
        const auto& allowed = excluded(pair.a, pair.b, propagator);
        double weight = 0;
        const std::vector<Node> clique = cliques.best_clique(allowed, weight);
        if (base + weight < kMinViolation) continue;
        add_cut(pair, clique, allowed, -1, x);
    }
}

std::vector<Cut> TripleSeparator::separate(std::span<const double> x, CliqueSeparator& cliques,
                                           Propagator& propagator, std::size_t max_cuts) {
    found_.clear();
    for (const Star& star : stars_) separate_star(star, x, cliques, propagator);
    for (std::int32_t row : triples_) separate_triple(row, x, cliques, propagator);
    work_ += static_cast<std::int64_t>(stars_.size() + triples_.size()) * 4;
    std::stable_sort(found_.begin(), found_.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (found_.size() > max_cuts) found_.resize(max_cuts);
    std::vector<Cut> cuts;
    for (auto& [violation, cut] : found_) cuts.push_back(std::move(cut));
    return cuts;
}

}  // namespace labeling
