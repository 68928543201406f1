// Greedy construction by gain per blocked gain: the next label is the one with the largest
//   (w_i + sum of bonuses to chosen partners + half the bonuses to undecided partners)
//   / (1 + potential of its undecided conflict partners),
// kept in a lazy heap; each decision is propagated through conflicts and rules, so rules forbid or
// force labels as soon as they can (a third segment at a node pulls its keep-label in, which blocks
// the neighbouring keep-labels). The weight-per-blocked-weight rule is Sakai, Togasaki & Yamazaki's
// GWMIN2 (2003); bonuses as marginal gain and the rules are ours. Propagation can run into a dead
// end when rules are arbitrary; then a depth-first search with few backtracks repeats the job.
#include "labeling/greedy.h"

#include <algorithm>
#include <queue>
#include <vector>

#include "labeling/propagation.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 16;
/// Up to so many labels the construction takes milliseconds and is finished in any case.
constexpr Label kUninterrupted = 20000;

class GreedyBuilder {
public:
    GreedyBuilder(const LabelingProblem& problem, const RowSystem& rows, RunControl& control,
                  const GreedyOptions& options)
        : problem_(problem), control_(control), options_(options), propagator_(problem, rows) {}

    GreedyResult run() {
        GreedyResult result;
        if (!propagator_.propagate_all()) {
            result.is_infeasible = true;
            return result;
        }
        root_ = propagator_.trail().size();
        if (construct(result)) {
            result.solution = solution();
        } else {
            propagator_.undo(root_);
            search(result);
        }
        control_.spend((propagator_.work() + work_) / kEntriesPerTick);
        return result;
    }

private:
    struct Candidate {
        double score;
        Label label;
        bool operator<(const Candidate& other) const {
            return score != other.score ? score < other.score : label > other.label;
        }
    };

    Solution solution() const {
        Solution s;
        s.labels.resize(problem_.label_count());
        for (Label i = 0; i < problem_.label_count(); ++i) s.labels[i] = propagator_.value(i) == 1;
        s.value = labeling_value(problem_, s.labels);
        return s;
    }

    /// Assigns; where that contradicts, assigns the opposite. False: a dead end.
    bool decide(Label i, bool value) {
        if (!propagator_.is_free(i)) return true;
        const std::size_t size = propagator_.trail().size();
        if (propagator_.assign(i, value)) return true;
        propagator_.undo(size);
        return propagator_.assign(i, !value);
    }

    bool construct(GreedyResult& result) {
        const Label n = problem_.label_count();
        if (!options_.start.empty()) {
            for (int value : {1, 0}) {
                for (Label i = 0; i < n; ++i) {
                    if (options_.start[i] == value && !decide(i, value == 1)) return false;
                }
            }
        }
        prepare();
        while (!heap_.empty()) {
            const Candidate top = heap_.top();
            heap_.pop();
            if (!propagator_.is_free(top.label) || top.score != score(top.label)) continue;
            if (gain_[top.label] + potential_[top.label] <= 0) continue;
            if (!decide(top.label, true)) return false;
            ++result.insertions;
            absorb();
            if (n > kUninterrupted && control_.spend(0)) break;
        }
        for (Label i = 0; i < n; ++i) {
            if (!decide(i, false)) return false;
        }
        return true;
    }

    void prepare() {
        const Label n = problem_.label_count();
        gain_.resize(n);
        potential_.assign(n, 0);
        worth_.resize(n);
        blocked_.assign(n, 0);
        for (Label i = 0; i < n; ++i) {
            gain_[i] = static_cast<double>(problem_.weight(i));
            for (const auto& b : problem_.bonuses_of(i)) {
                potential_[i] += 0.5 * static_cast<double>(b.value);
            }
            worth_[i] = std::max(0.0, gain_[i] + potential_[i]);
        }
        for (const Conflict& c : problem_.conflicts()) {
            blocked_[c.first] += worth_[c.second];
            blocked_[c.second] += worth_[c.first];
        }
        absorb();
        for (Label i = 0; i < n; ++i) push(i);
    }

    /// Brings gains and blocked gains up to date with the trail.
    void absorb() {
        changed_.clear();
        const auto trail = propagator_.trail();
        for (; absorbed_ < trail.size(); ++absorbed_) {
            const Label i = trail[absorbed_];
            const bool is_chosen = propagator_.value(i) == 1;
            for (const auto& b : problem_.bonuses_of(i)) {
                potential_[b.label] -= 0.5 * static_cast<double>(b.value);
                if (is_chosen) gain_[b.label] += static_cast<double>(b.value);
                changed_.push_back(b.label);
            }
            for (Label j : problem_.conflicts_of(i)) {
                blocked_[j] -= worth_[i];
                changed_.push_back(j);
            }
            work_ += static_cast<std::int64_t>(problem_.conflicts_of(i).size());
        }
        std::sort(changed_.begin(), changed_.end());
        changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
        for (Label i : changed_) push(i);
        work_ += 8 * static_cast<std::int64_t>(changed_.size());
    }

    double score(Label i) const {
        return (gain_[i] + potential_[i]) / (1.0 + std::max(0.0, blocked_[i]));
    }

    void push(Label i) {
        if (propagator_.is_free(i)) heap_.push({score(i), i});
    }

    /// Depth-first search for any solution: labels with gain first at 1, the others at 0.
    void search(GreedyResult& result) {
        struct Decision {
            Label label;
            std::size_t trail_size;
            bool is_flipped;
        };
        std::vector<Label> order(problem_.label_count());
        for (Label i = 0; i < problem_.label_count(); ++i) order[i] = i;
        std::stable_sort(order.begin(), order.end(), [&](Label a, Label b) {
            return problem_.rules_of(a).size() > problem_.rules_of(b).size();
        });
        std::vector<Decision> decisions;
        auto preferred = [&](Label i) { return problem_.weight(i) > 0; };
        for (std::size_t at = 0;;) {
            while (at < order.size() && !propagator_.is_free(order[at])) ++at;
            if (at == order.size()) {
                result.solution = solution();
                return;
            }
            decisions.push_back({order[at], propagator_.trail().size(), false});
            bool is_consistent = propagator_.assign(order[at], preferred(order[at]));
            while (!is_consistent) {
                if (++result.backtracks > options_.max_backtracks || control_.is_over()) return;
                while (!decisions.empty() && decisions.back().is_flipped) {
                    propagator_.undo(decisions.back().trail_size);
                    decisions.pop_back();
                }
                if (decisions.empty()) {
                    result.is_infeasible = true;
                    return;
                }
                Decision& last = decisions.back();
                propagator_.undo(last.trail_size);
                last.is_flipped = true;
                is_consistent = propagator_.assign(last.label, !preferred(last.label));
                at = 0;
            }
        }
    }

    const LabelingProblem& problem_;
    RunControl& control_;
    const GreedyOptions& options_;
    Propagator propagator_;
    std::size_t root_ = 0, absorbed_ = 0;
    std::vector<double> gain_;       ///< weight and bonuses to chosen labels
    std::vector<double> potential_;  ///< half the bonuses to undecided labels
    std::vector<double> worth_;      ///< what a label counts for where it is blocked
    std::vector<double> blocked_;    ///< worth of undecided conflict partners
    std::vector<Label> changed_;
    std::priority_queue<Candidate> heap_;
    std::int64_t work_ = 0;
};

class GreedySolver final : public Solver {
public:
    std::string name() const override { return "greedy"; }
    std::string description() const override {
        return "construction by gain per blocked gain, near-linear";
    }
    bool is_exact() const override { return false; }
    SolveResult solve(const LabelingProblem& problem, const SolveOptions& options) const override {
        require_valid_options(problem, options);
        require_known_extras(options, name(), {});
        RunControl control(options);
        const RowSystem rows(problem);
        GreedyOptions greedy;
        greedy.start = options.warm_start;
        GreedyResult found = greedy_labeling(problem, rows, control, greedy);
        if (found.solution) control.report(found.solution->value, std::nullopt);
        SolveResult result = finish(problem, name(), control, std::move(found.solution),
                                    std::nullopt, found.is_infeasible);
        result.statistics["insertions"] = static_cast<double>(found.insertions);
        result.statistics["backtracks"] = static_cast<double>(found.backtracks);
        return result;
    }
};

}  // namespace

Value labeling_value(const LabelingProblem& problem, std::span<const std::uint8_t> labels) {
    Value value = 0;
    for (Label i = 0; i < problem.label_count(); ++i) {
        if (labels[i] == 0) continue;
        value += problem.weight(i);
        for (const auto& b : problem.bonuses_of(i)) {
            if (b.label > i && labels[b.label] != 0) value += b.value;
        }
    }
    return value;
}

GreedyResult greedy_labeling(const LabelingProblem& problem, const RowSystem& rows,
                             RunControl& control, const GreedyOptions& options) {
    return GreedyBuilder(problem, rows, control, options).run();
}

std::shared_ptr<const Solver> make_greedy_solver() { return std::make_shared<GreedySolver>(); }

}  // namespace labeling
