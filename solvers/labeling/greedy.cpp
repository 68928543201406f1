// Greedy construction: the label that the rule likes best is chosen, and each decision is
// propagated through conflicts and rules, so rules forbid or force labels as soon as they can (a
// third segment at a node pulls its keep-label in, which blocks the neighbouring keep-labels).
// Scores are in greedy_state.cpp. By curves, the chosen label pulls in the run along its strongest
// bonuses for as long as the next label scores at least half of what the first one did. Which rule
// is best depends on the problem, and all are cheap, so the default makes three labelings and keeps
// the best. Propagation can run into a dead end when rules are arbitrary; then another rule is
// tried, and at last a depth-first search with few backtracks.
#include "labeling/greedy.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "labeling/errors.h"
#include "labeling/greedy_state.h"
#include "labeling/propagation.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 16;
/// Up to so many labels the construction takes milliseconds and is finished in any case.
constexpr Label kUninterrupted = 20000;
constexpr std::int64_t kEntriesPerCheck = 100'000;
constexpr double kRunShare = 0.5;

constexpr std::array<std::pair<std::string_view, GreedyRule>, 5> kRules{{
    {"best", GreedyRule::Best},
    {"weight", GreedyRule::Weight},
    {"blocked", GreedyRule::Blocked},
    {"gain", GreedyRule::Gain},
    {"curve", GreedyRule::Curve},
}};

class GreedyBuilder {
public:
    GreedyBuilder(const LabelingProblem& problem, const RowSystem& rows, RunControl& control,
                  const GreedyOptions& options)
        : problem_(problem), control_(control), options_(options), propagator_(problem, rows) {}

    GreedyResult run() {
        if (is_urgent() && is_empty_feasible()) return std::move(result_);
        if (!propagator_.propagate_all()) {
            result_.is_infeasible = true;
            return std::move(result_);
        }
        root_ = propagator_.trail().size();
        if (is_start_complete()) return std::move(result_);
        const GreedyRule rule = options_.rule;
        const bool is_best_of = rule == GreedyRule::Best && options_.start.empty();
        construct(rule == GreedyRule::Best ? GreedyRule::Gain : rule);
        if (!result_.solution || (is_best_of && !stops())) construct(GreedyRule::Blocked);
        if (!result_.solution) search();
        charge(0);
        return std::move(result_);
    }

private:
    /// Clock or stop token have ended the run, and a construction would take a while. (Of a work
    /// limit every construction may overrun a little.)
    bool is_urgent() {
        if (problem_.label_count() <= kUninterrupted) return false;
        control_.check();
        return control_.is_over() && control_.reason() != StopReason::WorkLimit;
    }

    /// Then that is a labeling, too.
    bool is_empty_feasible() {
        Solution empty{std::vector<std::uint8_t>(problem_.label_count(), 0), 0};
        if (!check_solution(problem_, empty).is_feasible) return false;
        result_.solution = std::move(empty);
        return true;
    }

    /// Then nothing is left to choose.
    bool is_start_complete() {
        const auto start = options_.start;
        if (start.empty() || std::count(start.begin(), start.end(), -1) > 0) return false;
        Solution given{{start.begin(), start.end()}, 0};
        given.value = labeling_value(problem_, given.labels);
        control_.spend(static_cast<std::int64_t>(problem_.conflict_count()) / kEntriesPerTick);
        if (!check_solution(problem_, given).is_feasible) return false;
        result_.solution = std::move(given);
        return true;
    }

    Solution solution() const {
        Solution s;
        s.labels.resize(problem_.label_count());
        for (Label i = 0; i < problem_.label_count(); ++i) s.labels[i] = propagator_.value(i) == 1;
        s.value = labeling_value(problem_, s.labels);
        return s;
    }

    /// Keeps the labeling by one rule if it is the best so far.
    void construct(GreedyRule rule) {
        propagator_.undo(root_);
        bool is_complete = false;
        try {
            is_complete = complete(rule);
        } catch (const StoppedInPass&) {
            return;
        }
        if (!is_complete) {
            ++result_.backtracks;
            dead_end_.assign(propagator_.values().begin(), propagator_.values().end());
        } else if (Solution s = solution();
                   !result_.solution || s.value > result_.solution->value) {
            result_.solution = std::move(s);
            result_.rule = rule;
        }
    }

    /// False: a dead end.
    bool complete(GreedyRule rule) {
        const bool may_stop = problem_.label_count() > kUninterrupted && !control_.is_over();
        try {
            if (!choose(rule, may_stop ? PassGuard(control_) : PassGuard())) return false;
        } catch (const StoppedInPass&) {
            // The first labeling is wanted in any case, be it without any choice.
            if (result_.solution) throw;
        }
        for (Label i = 0; i < problem_.label_count(); ++i) {
            if (!decide(propagator_, i, false)) return false;
        }
        return true;
    }

    /// False: a dead end.
    bool follow_start(PassGuard guard) {
        if (options_.start.empty()) return true;
        for (int value : {1, 0}) {
            for (Label i = 0; i < problem_.label_count(); ++i) {
                if (options_.start[i] != value) continue;
                const std::int64_t before = propagator_.work();
                if (!decide(propagator_, i, value == 1)) return false;
                guard.step(1 + propagator_.work() - before);
            }
        }
        return true;
    }

    /// As long as a choice gains; false: a dead end. Throws when it is stopped.
    bool choose(GreedyRule rule, PassGuard guard) {
        GreedyState state(problem_, propagator_, rule, guard);
        if (!follow_start(guard)) return false;
        state.update();
        std::int64_t work = 0;
        for (Label i = state.best(); i >= 0; i = state.best()) {
            const double score = state.score(i);
            if (!decide(propagator_, i, true)) return false;
            ++result_.insertions;
            state.update();
            if (rule == GreedyRule::Curve && propagator_.value(i) == 1 &&
                !(follow(state, i, score) && follow(state, i, score))) {
                return false;
            }
            if (state.work() - work < kEntriesPerCheck) continue;
            charge(state.work() - work);
            work = state.work();
            if (stops()) throw StoppedInPass();
        }
        charge(state.work() - work);
        return true;
    }

    /// Goes on from a chosen label along its strongest bonus to an undecided one; false: dead end.
    bool follow(GreedyState& state, Label i, double first_score) {
        while (true) {
            Label next = -1;
            Value strongest = 0;
            for (const auto& b : problem_.bonuses_of(i)) {
                if (!state.is_free(b.label) || b.value <= strongest) continue;
                strongest = b.value;
                next = b.label;
            }
            if (next < 0 || state.gain(next) <= 0) return true;
            if (state.score(next) < kRunShare * first_score) return true;
            if (!decide(propagator_, next, true)) return false;
            ++result_.insertions;
            state.update();
            if (propagator_.value(next) != 1) return true;
            i = next;
        }
    }

    /// Depth-first search for any solution that tries first what the last construction decided
    /// before its dead end.
    void search() {
        propagator_.undo(root_);
        struct Decision {
            std::size_t place;  ///< in the order; what is before it is decided
            std::size_t trail_size;
            bool is_flipped;
        };
        std::vector<Label> order(problem_.label_count());
        for (Label i = 0; i < problem_.label_count(); ++i) order[i] = i;
        std::stable_sort(order.begin(), order.end(), [&](Label a, Label b) {
            return problem_.rules_of(a).size() > problem_.rules_of(b).size();
        });
        std::vector<Decision> decisions;
        auto preferred = [&](Label i) {
            return dead_end_[i] == Propagator::kFree ? problem_.weight(i) > 0 : dead_end_[i] == 1;
        };
        for (std::size_t at = 0;;) {
            while (at < order.size() && !propagator_.is_free(order[at])) ++at;
            if (at == order.size()) {
                result_.solution = solution();
                return;
            }
            decisions.push_back({at, propagator_.trail().size(), false});
            bool is_consistent = propagator_.assign(order[at], preferred(order[at]));
            while (!is_consistent) {
                charge(0);
                if (++result_.backtracks > options_.max_backtracks || control_.is_over()) return;
                while (!decisions.empty() && decisions.back().is_flipped) {
                    propagator_.undo(decisions.back().trail_size);
                    decisions.pop_back();
                }
                if (decisions.empty()) {
                    result_.is_infeasible = true;
                    return;
                }
                Decision& last = decisions.back();
                propagator_.undo(last.trail_size);
                last.is_flipped = true;
                at = last.place;
                is_consistent = propagator_.assign(order[at], !preferred(order[at]));
            }
        }
    }

    void charge(std::int64_t entries) {
        const std::int64_t propagated = propagator_.work();
        control_.spend((entries + propagated - charged_) / kEntriesPerTick);
        charged_ = propagated;
    }

    bool stops() const { return problem_.label_count() > kUninterrupted && control_.should_stop(); }

    const LabelingProblem& problem_;
    RunControl& control_;
    const GreedyOptions& options_;
    Propagator propagator_;
    GreedyResult result_;
    std::size_t root_ = 0;
    std::vector<std::int8_t> dead_end_;  ///< the partial labeling of the last one
    std::int64_t charged_ = 0;
};

GreedyRule rule_of(const SolveOptions& options) {
    const auto it = options.extra.find("rule");
    if (it == options.extra.end()) return GreedyRule::Best;
    std::string known;
    for (const auto& [name, rule] : kRules) {
        if (it->second == name) return rule;
        known += (known.empty() ? "" : ", ") + std::string(name);
    }
    throw InputError("option rule: '" + it->second + "' is none of " + known);
}

class GreedySolver final : public Solver {
public:
    std::string name() const override { return "greedy"; }
    std::string description() const override {
        return "construction label by label or run by run, near-linear";
    }
    bool is_exact() const override { return false; }
    SolveResult solve(const LabelingProblem& problem, const SolveOptions& options) const override {
        require_valid_options(problem, options);
        require_known_extras(options, name(), {"rule"});
        RunControl control(options);
        const RowSystem rows(problem);
        GreedyOptions greedy;
        greedy.rule = rule_of(options);
        greedy.start = options.warm_start;
        GreedyResult found = greedy_labeling(problem, rows, control, greedy);
        if (found.solution) control.report(found.solution->value, std::nullopt);
        if (!greedy.start.empty() && !control.is_over()) {
            start_afresh(problem, rows, control, greedy, found);
        }
        SolveResult result = finish(problem, name(), control, std::move(found.solution),
                                    std::nullopt, found.is_infeasible);
        result.statistics["insertions"] = static_cast<double>(found.insertions);
        result.statistics["backtracks"] = static_cast<double>(found.backtracks);
        return result;
    }

private:
    /// A start may be worse than what is built without it: the better one counts.
    static void start_afresh(const LabelingProblem& problem, const RowSystem& rows,
                             RunControl& control, GreedyOptions greedy, GreedyResult& found) {
        greedy.start = {};
        GreedyResult afresh = greedy_labeling(problem, rows, control, greedy);
        found.insertions += afresh.insertions;
        found.backtracks += afresh.backtracks;
        const bool is_better =
            afresh.solution && (!found.solution || afresh.solution->value > found.solution->value);
        if (!is_better) return;
        control.report(afresh.solution->value, std::nullopt);
        found.solution = std::move(afresh.solution);
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
