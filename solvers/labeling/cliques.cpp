// Greedy edge clique cover: take the first uncovered conflict, extend it to a maximal clique, mark
// its conflicts as covered, repeat. Kou, Stockmeyer & Wong (1978) study the problem (NP-hard);
// greedy covers of geometric conflict graphs are small because neighbourhoods are nearly cliques.
#include "labeling/cliques.h"

#include <algorithm>

namespace labeling {
namespace {

class CoverBuilder {
public:
    CoverBuilder(const LabelingProblem& problem, RunControl* control)
        : problem_(problem),
          control_(control),
          begin_(problem.label_count() + 1, 0),
          hits_(problem.label_count(), 0) {
        for (Label i = 0; i < problem.label_count(); ++i) {
            begin_[i + 1] = begin_[i] + problem.conflicts_of(i).size();
        }
        is_covered_.assign(begin_.back(), 0);
    }

    std::vector<std::vector<Label>> run() {
        std::vector<std::vector<Label>> cover;
        for (Label i = 0; i < problem_.label_count(); ++i) {
            if (is_stopped(i)) break;
            const auto neighbours = problem_.conflicts_of(i);
            for (std::size_t k = 0; k < neighbours.size(); ++k) {
                if (neighbours[k] > i && !is_covered_[begin_[i] + k]) {
                    cover.push_back(grow(i, neighbours[k]));
                }
            }
        }
        return cover;
    }

private:
    bool is_stopped(Label i) const {
        constexpr Label kLabelsPerLook = 64;
        if (control_ == nullptr || i % kLabelsPerLook != 0) return false;
        control_->check();
        return control_->is_over();
    }

    std::size_t edge_index(Label i, Label j) const {
        const auto neighbours = problem_.conflicts_of(i);
        const auto it = std::lower_bound(neighbours.begin(), neighbours.end(), j);
        return begin_[i] + static_cast<std::size_t>(it - neighbours.begin());
    }

    std::vector<Label> grow(Label i, Label j) {
        std::vector<Label> clique{i, j}, candidates, kept;
        const auto a = problem_.conflicts_of(i), b = problem_.conflicts_of(j);
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(),
                              std::back_inserter(candidates));
        for (Label k : candidates) {
            hits_[k] = !is_covered_[edge_index(k, i)] + !is_covered_[edge_index(k, j)];
        }
        while (!candidates.empty()) {
            Label best = candidates[0];
            for (Label k : candidates) {
                if (hits_[k] > hits_[best]) best = k;
            }
            clique.push_back(best);
            const auto neighbours = problem_.conflicts_of(best);
            kept.clear();
            auto it = neighbours.begin();
            for (Label k : candidates) {
                it = std::lower_bound(it, neighbours.end(), k);
                if (it == neighbours.end()) break;
                if (*it != k) continue;
                const auto position = static_cast<std::size_t>(it - neighbours.begin());
                hits_[k] += !is_covered_[begin_[best] + position];
                kept.push_back(k);
            }
            candidates.swap(kept);
        }
        std::sort(clique.begin(), clique.end());
        for (Label u : clique) {
            for (Label v : clique) {
                if (u != v) is_covered_[edge_index(u, v)] = 1;
            }
        }
        return clique;
    }

    const LabelingProblem& problem_;
    RunControl* control_;
    std::vector<std::size_t> begin_;
    std::vector<std::uint8_t> is_covered_;  ///< per directed conflict
    std::vector<int> hits_;
};

}  // namespace

std::vector<std::vector<Label>> conflict_clique_cover(const LabelingProblem& problem,
                                                      RunControl* control) {
    return CoverBuilder(problem, control).run();
}

}  // namespace labeling
