// Rows of rank two. Let S be terms (labels and bonuses) of which no three can be true together:
// among any three, two are adjacent in the term graph or a rule "at most two of three" forbids
// them. Then  sum over S of x <= 2,  and terms that exclude all of S and each other may enter with
// coefficient 2 ("off" terms among them). They are to the three-label rules what product cliques
// are to conflicts, and as there bonuses as members are worth more than labels: a bonus stands for
// two labels, so it excludes more. Separation: from every rule whose labels have a large sum, once
// with its labels and once with the largest bonus of each, terms of the support are added by
// falling value while they fit; then the row is lifted over the whole graph.
#include "labeling/rank_two_cuts.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <set>

namespace labeling {
namespace {

constexpr double kZero = 1e-4;
constexpr double kLeastStart = 1.0;  ///< sum over the rule that a search starts from
constexpr double kLeastTotal = 1.5;  ///< before lifting
constexpr double kBonusShare = 0.8;  ///< of its label's value, for a bonus to stand in for it
constexpr int kTries = 2;            ///< per start, by what is added first
constexpr std::int64_t kBlockSize = 64;

}  // namespace

RankTwoSeparator::RankTwoSeparator(const LabelingProblem& problem, const RowSystem& rows,
                                   const TermGraph& graph)
    : graph_(graph),
      table_(rows),
      identity_(problem.label_count()),
      bonus_begin_(static_cast<std::size_t>(problem.label_count()) + 1, 0),
      local_(graph.node_count(), -1) {
    std::iota(identity_.begin(), identity_.end(), 0);
    for (const Bonus& b : problem.bonuses()) {
        ends_.push_back({b.first, b.second});
        ++bonus_begin_[b.first + 1];
        ++bonus_begin_[b.second + 1];
    }
    std::partial_sum(bonus_begin_.begin(), bonus_begin_.end(), bonus_begin_.begin());
    bonuses_at_.resize(bonus_begin_.back());
    std::vector<std::size_t> next(bonus_begin_.begin(), bonus_begin_.end() - 1);
    for (std::size_t k = 0; k < ends_.size(); ++k) {
        for (Label i : ends_[k]) bonuses_at_[next[i]++] = static_cast<std::int32_t>(k);
    }
}

std::span<const Label> RankTwoSeparator::labels_of(Node v) const {
    if (graph_.is_off_node(v)) return {};
    if (v < graph_.label_count()) return {identity_.data() + v, 1};
    return ends_[v - graph_.label_count()];
}

std::span<const std::int32_t> RankTwoSeparator::bonuses_of(Label i) const {
    return {bonuses_at_.data() + bonus_begin_[i], bonus_begin_[i + 1] - bonus_begin_[i]};
}

bool RankTwoSeparator::excludes(Node u, Node v, Node w) const {
    if (graph_.adjacent(u, v) || graph_.adjacent(u, w) || graph_.adjacent(v, w)) return true;
    for (Label a : labels_of(u)) {
        for (Label b : labels_of(v)) {
            const auto thirds = table_.thirds(a, b);
            if (thirds.empty()) continue;
            for (Label c : labels_of(w)) {
                if (std::binary_search(thirds.begin(), thirds.end(), c)) return true;
            }
        }
    }
    return false;
}

/// Terms that rules of three labels exclude once u and v are true.
template <typename Visit>
void RankTwoSeparator::visit_thirds(Node u, Node v, const Visit& visit) const {
    for (Label a : labels_of(u)) {
        for (Label b : labels_of(v)) {
            for (Label c : table_.thirds(a, b)) {
                visit(graph_.label_node(c));
                for (std::int32_t k : bonuses_of(c)) visit(graph_.bonus_node(k));
            }
        }
    }
}

void RankTwoSeparator::build_support(std::span<const double> x) {
    for (Node v : support_) local_[v] = -1;
    support_.clear();
    for (Node v = 0; v < graph_.label_count() + graph_.bonus_count(); ++v) {
        if (x[v] > kZero && x[v] < 1 - kZero) support_.push_back(v);
    }
    std::stable_sort(support_.begin(), support_.end(), [&](Node a, Node b) { return x[a] > x[b]; });
    for (std::size_t s = 0; s < support_.size(); ++s) {
        local_[support_[s]] = static_cast<std::int32_t>(s);
    }
    words_ = (support_.size() + kBlockSize - 1) / kBlockSize;
    adjacency_.assign(words_ * support_.size(), 0);
    for (std::size_t s = 0; s < support_.size(); ++s) {
        const auto neighbours = graph_.neighbours(support_[s]);
        for (Node w : neighbours) {
            const std::int32_t t = local_[w];
            if (t >= 0)
                adjacency_[s * words_ + t / kBlockSize] |= std::uint64_t{1} << t % kBlockSize;
        }
        work_ += static_cast<std::int64_t>(neighbours.size());
    }
    work_ += graph_.node_count() + static_cast<std::int64_t>(adjacency_.size()) / 4;
}

/// Rules with fractional labels, the largest sums first.
std::vector<RankTwoSeparator::Start> RankTwoSeparator::starts(std::span<const double> x,
                                                              std::size_t most) {
    std::vector<std::pair<double, Start>> found;
    for (const auto& triple : table_.triples()) {
        const auto& l = triple.labels;
        const double sum = x[l[0]] + x[l[1]] + x[l[2]];
        if (sum < kLeastStart || local_[l[0]] < 0 || local_[l[1]] < 0 || local_[l[2]] < 0) continue;
        found.push_back({sum, {l[0], l[1], l[2]}});
    }
    work_ += static_cast<std::int64_t>(table_.triples().size());
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (found.size() > most) found.resize(most);
    std::vector<Start> starts;
    for (const auto& [sum, start] : found) starts.push_back(start);
    return starts;
}

/// Puts the largest bonus of each label in its place, where it is nearly as large.
bool RankTwoSeparator::with_bonuses(std::span<const double> x, Start& start) const {
    bool is_new = false;
    for (Node& v : start) {
        Node best = v;
        double value = kBonusShare * x[v];
        for (std::int32_t k : bonuses_of(v)) {
            const Node b = graph_.bonus_node(k);
            if (local_[b] < 0 || x[b] <= value) continue;
            value = x[b];
            best = b;
        }
        is_new = is_new || best != v;
        v = best;
    }
    return is_new && start[0] != start[1] && start[0] != start[2] && start[1] != start[2];
}

void RankTwoSeparator::begin(const Start& start) {
    ones_.clear();
    candidates_.assign(words_, ~std::uint64_t{0});
    if (support_.size() % kBlockSize != 0) {
        candidates_.back() = (std::uint64_t{1} << support_.size() % kBlockSize) - 1;
    }
    for (Node v : start) insert(v);
}

/// Takes v in; candidates that could be true together with it and another member leave.
void RankTwoSeparator::insert(Node v) {
    const auto s = static_cast<std::size_t>(local_[v]);
    candidates_[s / kBlockSize] &= ~(std::uint64_t{1} << s % kBlockSize);
    for (Node u : ones_) {
        const auto t = static_cast<std::size_t>(local_[u]);
        if ((adjacency_[s * words_ + t / kBlockSize] >> t % kBlockSize) & 1) continue;
        excluded_.assign(words_, 0);
        visit_thirds(u, v, [&](Node w) {
            const std::int32_t l = local_[w];
            if (l >= 0) excluded_[l / kBlockSize] |= std::uint64_t{1} << l % kBlockSize;
            ++work_;
        });
        for (std::size_t w = 0; w < words_; ++w) {
            candidates_[w] &=
                adjacency_[s * words_ + w] | adjacency_[t * words_ + w] | excluded_[w];
        }
        work_ += static_cast<std::int64_t>(words_) / 2;
    }
    ones_.push_back(v);
}

/// The candidate of largest value after leaving out `skip` of them; -1 if there is none.
RankTwoSeparator::Node RankTwoSeparator::next_candidate(int skip) const {
    for (std::size_t w = 0; w < words_; ++w) {
        for (std::uint64_t bits = candidates_[w]; bits != 0; bits &= bits - 1) {
            if (skip-- > 0) continue;
            return support_[w * kBlockSize + static_cast<std::size_t>(std::countr_zero(bits))];
        }
    }
    return -1;
}

void RankTwoSeparator::grow(int skip) {
    for (Node v = next_candidate(skip); v >= 0; v = next_candidate(0)) insert(v);
}

void RankTwoSeparator::lift_by_two(std::span<const double> x) {
    twos_.clear();
    const Node narrow = *std::min_element(ones_.begin(), ones_.end(), [&](Node a, Node b) {
        return graph_.neighbours(a).size() < graph_.neighbours(b).size();
    });
    std::vector<Node> common;
    for (Node w : graph_.neighbours(narrow)) {
        const bool is_common = std::all_of(ones_.begin(), ones_.end(), [&](Node v) {
            return v == narrow || (v != w && graph_.adjacent(v, w));
        });
        if (is_common) common.push_back(w);
    }
    work_ += static_cast<std::int64_t>(graph_.neighbours(narrow).size()) * 3;
    const auto value = [&](Node v) {
        return graph_.is_off_node(v) ? 1 - x[graph_.column(v)] : x[v];
    };
    std::stable_sort(common.begin(), common.end(),
                     [&](Node a, Node b) { return value(a) > value(b); });
    for (Node w : common) {
        if (std::all_of(twos_.begin(), twos_.end(),
                        [&](Node v) { return graph_.adjacent(v, w); })) {
            twos_.push_back(w);
        }
    }
}

/// More terms that fit, bonuses first; what two members exclude is all there is to look at.
void RankTwoSeparator::lift_by_one() {
    Node u = -1, v = -1;
    for (std::size_t a = 0; a < ones_.size() && u < 0; ++a) {
        for (std::size_t b = a + 1; b < ones_.size() && u < 0; ++b) {
            if (graph_.adjacent(ones_[a], ones_[b])) continue;
            u = ones_[a];
            v = ones_[b];
        }
    }
    if (u < 0) return;
    std::vector<Node> more(graph_.neighbours(u).begin(), graph_.neighbours(u).end());
    more.insert(more.end(), graph_.neighbours(v).begin(), graph_.neighbours(v).end());
    visit_thirds(u, v, [&](Node w) { more.push_back(w); });
    std::erase_if(more, [&](Node w) { return graph_.is_off_node(w); });
    std::sort(more.begin(), more.end(), std::greater<>());
    more.erase(std::unique(more.begin(), more.end()), more.end());
    for (Node w : more) {
        const auto is_there = [w](const std::vector<Node>& nodes) {
            return std::find(nodes.begin(), nodes.end(), w) != nodes.end();
        };
        if (is_there(ones_) || is_there(twos_)) continue;
        bool fits =
            std::all_of(twos_.begin(), twos_.end(), [&](Node t) { return graph_.adjacent(t, w); });
        for (std::size_t a = 0; a < ones_.size() && fits; ++a) {
            if (graph_.adjacent(ones_[a], w)) continue;
            for (std::size_t b = 0; b < ones_.size() && fits; ++b) {
                fits = a == b || excludes(ones_[a], ones_[b], w);
                work_ += 2;
            }
        }
        if (fits) ones_.push_back(w);
    }
}

Cut RankTwoSeparator::cut() const {
    Cut cut;
    cut.right_hand_side = 2;
    for (Node v : ones_) cut.entries.push_back({graph_.column(v), 1});
    for (Node v : twos_) {
        cut.entries.push_back({graph_.column(v), graph_.is_off_node(v) ? -2 : 2});
        if (graph_.is_off_node(v)) cut.right_hand_side -= 2;
    }
    std::sort(cut.entries.begin(), cut.entries.end(),
              [](const Cut::Entry& a, const Cut::Entry& b) { return a.column < b.column; });
    std::size_t kept = 0;
    for (const Cut::Entry& e : cut.entries) {
        if (kept > 0 && cut.entries[kept - 1].column == e.column) {
            cut.entries[kept - 1].coefficient += e.coefficient;
        } else {
            cut.entries[kept++] = e;
        }
    }
    cut.entries.resize(kept);
    std::erase_if(cut.entries, [](const Cut::Entry& e) { return e.coefficient == 0; });
    return cut;
}

std::vector<Cut> RankTwoSeparator::separate(std::span<const double> x,
                                            const RankTwoCutOptions& options) {
    if (table_.triples().empty()) return {};
    build_support(x);
    std::vector<std::pair<double, Cut>> found;
    std::set<std::uint64_t> seen;
    std::vector<int> uses(graph_.node_count(), 0), tries(graph_.node_count(), 0);
    const auto is_used = [&](Node v) { return uses[v] >= options.max_uses; };
    const auto is_tried = [&](Node v) { return tries[v] >= options.max_tries; };
    for (const Start& rule : starts(x, options.max_starts)) {
        for (const bool is_bonuses : {false, true}) {
            if (std::all_of(rule.begin(), rule.end(), is_tried)) break;
            Start start = rule;
            if (is_bonuses && !with_bonuses(x, start)) continue;
            for (int skip = 0; skip < kTries; ++skip) {
                if (std::all_of(start.begin(), start.end(), is_used)) break;
                begin(start);
                grow(skip);
                for (Node v : rule) ++tries[v];
                double total = 0;
                for (Node v : ones_) total += x[v];
                if (total < kLeastTotal) continue;
                lift_by_two(x);
                lift_by_one();
                Cut row = cut();
                const double violation = row.activity(x) - static_cast<double>(row.right_hand_side);
                if (violation < options.min_violation || !seen.insert(hash_of(row)).second)
                    continue;
                for (Node v : ones_) ++uses[v];
                found.emplace_back(violation, std::move(row));
            }
        }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (found.size() > options.max_cuts) found.resize(options.max_cuts);
    std::vector<Cut> cuts;
    for (auto& [violation, row] : found) cuts.push_back(std::move(row));
    return cuts;
}

}  // namespace labeling
