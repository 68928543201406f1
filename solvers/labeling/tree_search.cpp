// Depth-first branch and bound for small problems and for builds without an LP. At a node:
// propagate conflicts and rules; bound by a clique cover of the term conflict graph; split what is
// open into independent parts and solve each as a problem of its own, with the lower limit that the
// others' bounds leave for it; otherwise branch on the label with the largest potential (weight +
// half its bonuses), 1 first. Decomposition during the search follows the idea of AND/OR search
// (Dechter & Mateescu 2007): the parts' trees are added, not multiplied.
#include "labeling/tree_search.h"

#include <algorithm>
#include <vector>

#include "labeling/greedy.h"
#include "labeling/propagation.h"
#include "labeling/rows.h"
#include "labeling/subproblem.h"
#include "labeling/term_clique_bound.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 16;
constexpr std::int64_t kTicksPerNode = 2;
constexpr std::int64_t kTicksPerPart = 10;

class Tree {
public:
    Tree(const LabelingProblem& problem, Value lower, RunControl& control)
        : problem_(problem),
          best_(lower),
          control_(control),
          rows_(problem),
          propagator_(problem, rows_),
          bound_(problem, control),
          decomposer_(problem, rows_) {}

    TreeResult run() {
        if (propagator_.propagate_all()) {
            search();
        }
        charge(0);
        result_.bound = std::max(best_, open_bound_);
        return std::move(result_);
    }

private:
    struct Frame {
        Label label;
        std::size_t trail_size;
        Value bound;
        bool second_value;
        bool is_second_done;
    };

    void search() {
        bool is_consistent = true;
        while (true) {
            if (is_consistent && !descend()) {
                // Stopped: everything that is still open counts.
                for (const Frame& frame : frames_) {
                    if (!frame.is_second_done) open(frame.bound);
                }
                return;
            }
            while (!frames_.empty() && frames_.back().is_second_done) frames_.pop_back();
            if (frames_.empty()) return;
            Frame& frame = frames_.back();
            propagator_.undo(frame.trail_size);
            frame.is_second_done = true;
            is_consistent =
                frame.bound > best_ && propagator_.assign(frame.label, frame.second_value);
        }
    }

    /// Goes down from the current node until it is settled; false when the search must stop.
    bool descend() {
        while (true) {
            ++result_.nodes;
            const Value bound = bound_(propagator_, kNoLimit);
            if (bound <= best_) return true;
            if (propagator_.free_count() == 0) {
                accept(bound);
                return true;
            }
            if (charge(kTicksPerNode)) {
                open(bound);
                return false;
            }
            const auto parts = decomposer_.parts(propagator_);
            if (parts.size() > 1) {
                const bool is_settled = solve_parts(parts);
                if (!is_settled) open(std::min(bound, parts_bound_));
                return is_settled || !control_.should_stop();
            }
            const Label label = choose(parts[0]);
            const bool value = first_value(label);
            frames_.push_back({label, propagator_.trail().size(), bound, !value, false});
            if (!propagator_.assign(label, value)) return true;
        }
    }

    /// A complete, consistent assignment; its bound is its value.
    void accept(Value value) {
        Solution solution;
        solution.labels.resize(problem_.label_count());
        for (Label i = 0; i < problem_.label_count(); ++i) {
            solution.labels[i] = propagator_.value(i) == 1;
        }
        solution.value = value;
        best_ = value;
        result_.solution = std::move(solution);
    }

    Label choose(const std::vector<Label>& free) const {
        Label best = free[0];
        Value best_score = -1;
        for (Label i : free) {
            Value score = 2 * std::max(Value{0}, problem_.weight(i));
            for (const auto& b : problem_.bonuses_of(i)) {
                if (propagator_.value(b.label) == 1) score += 2 * b.value;
                if (propagator_.is_free(b.label)) score += b.value;
            }
            if (score > best_score) {
                best_score = score;
                best = i;
            }
        }
        return best;
    }

    bool first_value(Label i) const {
        Value gain = problem_.weight(i);
        for (const auto& b : problem_.bonuses_of(i)) {
            if (propagator_.value(b.label) != 0) gain += b.value;
        }
        return gain > 0;
    }

    /// Solves the parts one after the other; false when the node stays open with parts_bound_.
    bool solve_parts(const std::vector<std::vector<Label>>& parts) {
        const Value decided = decided_value(problem_, propagator_.values());
        std::vector<Subproblem> subs;
        std::vector<Value> bounds;
        parts_bound_ = decided;
        for (const auto& part : parts) {
            subs.push_back(decomposer_.extract(propagator_, part));
            bounds.push_back(sum_of_gains(subs.back().problem));
            parts_bound_ += bounds.back();
        }
        if (charge(kTicksPerPart * static_cast<std::int64_t>(parts.size()))) return false;
        std::vector<std::size_t> order(parts.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return parts[a].size() < parts[b].size();
        });
        Solution solution;
        solution.labels.resize(problem_.label_count());
        for (Label i = 0; i < problem_.label_count(); ++i) {
            solution.labels[i] = propagator_.value(i) == 1;
        }
        for (std::size_t k : order) {
            // The part must bring more than what the others leave up to the best value.
            const Value lower = best_ == kNoValue ? kNoValue : best_ - (parts_bound_ - bounds[k]);
            TreeResult part = tree_search(subs[k].problem, lower, control_);
            result_.nodes += part.nodes;
            if (!part.is_closed(lower)) {
                parts_bound_ += std::min(part.bound, bounds[k]) - bounds[k];
                return false;
            }
            if (!part.solution) return true;
            parts_bound_ += part.solution->value - bounds[k];
            for (std::size_t local = 0; local < part.solution->labels.size(); ++local) {
                solution.labels[subs[k].to_parent[local]] = part.solution->labels[local];
            }
        }
        solution.value = parts_bound_;
        best_ = parts_bound_;
        result_.solution = std::move(solution);
        return true;
    }

    void open(Value bound) { open_bound_ = std::max(open_bound_, bound); }

    bool charge(std::int64_t ticks) {
        const std::int64_t entries = propagator_.work() + bound_.work() + decomposer_.work();
        const std::int64_t news = entries / kEntriesPerTick - charged_;
        charged_ += news;
        return control_.spend(ticks + news);
    }

    static constexpr Value kNoLimit = std::numeric_limits<Value>::max();

    const LabelingProblem& problem_;
    Value best_;
    RunControl& control_;
    const RowSystem rows_;
    Propagator propagator_;
    TermCliqueBound bound_;
    Decomposer decomposer_;
    std::vector<Frame> frames_;
    TreeResult result_;
    Value open_bound_ = kNoValue, parts_bound_ = 0;
    std::int64_t charged_ = 0;
};

}  // namespace

TreeResult tree_search(const LabelingProblem& problem, Value lower, RunControl& control) {
    return Tree(problem, lower, control).run();
}

}  // namespace labeling
