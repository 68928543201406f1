// The exact solvers' common frame. Reductions, root propagation and decomposition first; then part
// by part, small parts first, because thousands of them close at once, and in passes of growing
// allowance. A part of a few labels goes straight to the depth-first tree; a larger one gets a
// local search as long as its size justifies, then branch-and-cut where an LP is linked. Value and
// bound of the whole are the sums over the parts, so both are known at any time; until a part's
// turn comes its bound is that of a clique cover. Large problems have a quick one of the whole
// before anything else is done.
#include "labeling/exact_search.h"

#include <algorithm>
#include <limits>

#include "labeling/errors.h"
#include "labeling/greedy.h"
#include "labeling/part_search.h"
#include "labeling/propagation.h"
#include "labeling/quick_clique_bound.h"
#include "labeling/reduced_search.h"
#include "labeling/reductions.h"
#include "labeling/rows.h"
#include "labeling/run_control.h"
#include "labeling/subproblem.h"
#include "labeling/term_clique_bound.h"

namespace labeling {
namespace {

constexpr std::int64_t kDefaultWork = 300'000'000;
constexpr std::int64_t kPairsPerTick = 16;
constexpr std::int64_t kReductionTicks = 100;      ///< per label
constexpr std::int64_t kReductionShare = 8;        ///< of work or time, at most,
constexpr std::int64_t kLeastReduction = 2000000;  ///< but so many ticks
constexpr std::int64_t kFirstAllowance = 100'000;  ///< ticks per label of a part

class ExactSearch {
public:
    /// `given` and `bound` are set to what is known before anything else is done, also if a pass
    /// is stopped.
    ExactSearch(const LabelingProblem& problem, const SolveOptions& options,
                const ExactSearchOptions& exact, RunControl& control,
                std::optional<Solution>& given, Value& bound)
        : original_(problem),
          options_(options),
          exact_(exact),
          techniques_(techniques_of(options, exact.name)),
          control_(control),
          given_(given = first_solution()),
          first_bound_(bound = first_bound()),
          reduced_(techniques_.reductions ? std::optional(reduced_problem()) : std::nullopt),
          problem_(reduced_ ? reduced_->problem() : original_),
          warm_start_(start_of_rest()),
          rows_(problem_),
          propagator_(problem_, rows_),
          decomposer_(problem_, rows_) {}

    SolveResult run() {
        if (reduced_ && reduced_->is_infeasible()) return infeasible();
        guard().look();
        decomposer_.set_guard(guard());
        if (!propagator_.propagate_all()) return infeasible();
        guard().look();
        decided_ = decided_value(problem_, propagator_.values());
        labels_.assign(problem_.label_count(), 0);
        for (Label i = 0; i < problem_.label_count(); ++i) labels_[i] = propagator_.value(i) == 1;
        const auto members = decomposer_.parts(propagator_);
        for (const auto& m : members) {
            Part part;
            part.sub = decomposer_.extract(propagator_, m);
            part.bound = quick_clique_bound(part.sub.problem, control_);
            parts_.push_back(std::move(part));
        }
        decomposer_.set_guard({});
        std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
            return a.sub.problem.label_count() < b.sub.problem.label_count();
        });
        control_.spend(decomposer_.work() / 16 + problem_.label_count() / 8);
        report();
        for (Part& part : parts_) {
            if (!start(part)) return infeasible();
        }
        report();
        return prove_all() ? result() : infeasible();
    }

private:
    struct Part {
        Subproblem sub;
        std::optional<Solution> solution;
        Value value = kNoValue;  ///< best known, kNoValue: none
        Value bound = 0;

        bool is_given_up = false;

        bool is_open() const { return !is_given_up && !(solution && bound <= solution->value); }
    };

    SolveResult infeasible() {
        return finish(original_, exact_.name, control_, std::nullopt, std::nullopt, true);
    }

    SolveResult result() {
        std::optional<Solution> solution;
        Value bound = decided_;
        bool is_complete = true;
        Solution whole{labels_, decided_};
        for (const Part& part : parts_) {
            bound += part.bound;
            is_complete = is_complete && part.solution.has_value();
            if (!part.solution) continue;
            whole.value += part.solution->value;
            for (std::size_t k = 0; k < part.sub.to_parent.size(); ++k) {
                whole.labels[part.sub.to_parent[k]] = part.solution->labels[k];
            }
        }
        if (is_complete) {
            solution = reduced_ ? reduced_->lift(original_, whole) : std::move(whole);
        }
        if (given_ && (!solution || given_->value > solution->value)) solution = given_;
        SolveResult result = finish(original_, exact_.name, control_, std::move(solution),
                                    std::min(first_bound_, bound + offset()));
        add_reductions(result);
        result.statistics["parts"] = static_cast<double>(parts_.size());
        result.statistics["narrow-parts"] = static_cast<double>(treewidth_.solved);
        result.statistics["nodes"] = static_cast<double>(statistics_.nodes);
        result.statistics["lp-iterations"] = static_cast<double>(statistics_.lp_iterations);
        result.statistics["clique-cuts"] = static_cast<double>(statistics_.clique_cuts);
        result.statistics["triple-cuts"] = static_cast<double>(statistics_.triple_cuts);
        result.statistics["tree-work"] = static_cast<double>(statistics_.tree_work);
        result.statistics["tree-path"] = static_cast<double>(statistics_.tree_path);
        result.statistics["rank-two-cuts"] = static_cast<double>(statistics_.rank_two_cuts);
        result.statistics["gomory-cuts"] = static_cast<double>(statistics_.gomory_cuts);
        return result;
    }

    /// A complete feasible start counts as it is: reductions may have no place for it. A large
    /// problem gets a greedy labeling at once, because even reducing it takes seconds.
    std::optional<Solution> first_solution() {
        const auto& start = options_.warm_start;
        std::optional<Solution> first;
        if (takes_long_to_reduce(original_) && techniques_.heuristics) {
            GreedyOptions greedy;
            greedy.start = start;
            first = greedy_labeling(original_, RowSystem(original_), control_, greedy).solution;
        } else if (!start.empty() && std::count(start.begin(), start.end(), -1) == 0) {
            first.emplace(Solution{{start.begin(), start.end()}, 0});
            first->value = labeling_value(original_, first->labels);
            if (!check_solution(original_, *first).is_feasible) first.reset();
        }
        if (first) control_.report(first->value, std::nullopt);
        return first;
    }

    /// Of a large problem, before reductions.
    Value first_bound() {
        if (!takes_long_to_reduce(original_)) return sum_of_gains(original_);
        const Value bound = quick_clique_bound(original_, control_);
        control_.report(std::nullopt, bound);
        return bound;
    }

    /// Where labels have many neighbours, reductions take long and find little: they get no more
    /// work than what a sparse problem needs, and on the largest problems no more than a share of
    /// what there is.
    ReducedProblem reduced_problem() {
        const std::int64_t share =
            std::max(kLeastReduction, control_.ticks_left() / kReductionShare);
        RunControl::Cap cap(control_, std::min(kReductionTicks * original_.label_count(), share));
        return reduce_problem(original_, control_, {}, guard());
    }

    /// Without any labeling passes go on to the end.
    PassGuard guard() { return given_ ? PassGuard(control_) : PassGuard(); }

    std::vector<std::int8_t> start_of_rest() const {
        std::vector<std::int8_t> start = options_.warm_start;
        if (start.empty() && given_) start.assign(given_->labels.begin(), given_->labels.end());
        return reduced_ ? reduced_->project(start) : start;
    }

    Value offset() const { return reduced_ ? reduced_->offset() : 0; }

    void add_reductions(SolveResult& result) const {
        if (!reduced_) return;
        const ReductionStatistics& s = reduced_->statistics();
        result.statistics["reduced-labels"] = static_cast<double>(s.labels);
        result.statistics["reduced-conflicts"] = static_cast<double>(s.conflicts);
        result.statistics["reduced-bonuses"] = static_cast<double>(s.bonuses);
        result.statistics["reduced-rules"] = static_cast<double>(s.rules);
    }

    void report() {
        Value value = decided_ + offset(), bound = decided_ + offset();
        bool is_complete = true;
        for (const Part& part : parts_) {
            bound += part.bound;
            if (part.value != kNoValue) value += part.value;
            is_complete = is_complete && part.value != kNoValue;
        }
        control_.report(is_complete ? std::optional(value) : std::nullopt,
                        std::min(bound, first_bound_));
    }

    PartSearchOptions part_options(Part& part) {
        PartSearchOptions search;
        search.lp = exact_.lp;
        search.seed = options_.seed;
        search.threads = options_.threads;
        search.techniques = techniques_;
        search.has_labeling = given_.has_value();
        search.treewidth = &treewidth_;
        search.report = [&part, this](std::optional<Value> value, std::optional<Value> bound) {
            if (value) part.value = std::max(part.value, *value);
            if (bound) part.bound = std::min(part.bound, *bound);
            report();
        };
        return search;
    }

    /// False: the part has no solution.
    bool start(Part& part) {
        std::vector<std::int8_t> labels;
        if (!warm_start_.empty()) {
            for (Label i : part.sub.to_parent) labels.push_back(warm_start_[i]);
        }
        PartStart found = start_part(part.sub.problem, labels, control_, part_options(part));
        part.solution = std::move(found.solution);
        if (part.solution) part.value = part.solution->value;
        if (found.is_optimal) part.bound = part.value;
        return found.is_infeasible ? false : found.is_optimal || bound_by_cliques(part);
    }

    /// A first bound for a part that others may keep waiting. False: the part has no solution.
    bool bound_by_cliques(Part& part) {
        const LabelingProblem& problem = part.sub.problem;
        if (problem.label_count() <= techniques_.tree_size || control_.should_stop()) return true;
        const RowSystem rows(problem);
        Propagator propagator(problem, rows);
        if (!propagator.propagate_all()) return false;
        TermCliqueBound bound(problem, control_);
        part.bound = std::min(part.bound, bound(propagator, std::numeric_limits<Value>::max()));
        control_.spend(bound.work() / kPairsPerTick);
        return true;
    }

    /// Passes over the open parts, each with four times the allowance of the one before, so that
    /// one hard part does not keep the others from being solved. False: a part has no solution.
    bool prove_all() {
        std::int64_t allowance = kFirstAllowance;
        while (true) {
            std::vector<Part*> open;
            for (Part& part : parts_) {
                if (part.is_open()) open.push_back(&part);
            }
            for (Part* part : open) {
                const bool is_only = open.size() == 1;
                const std::int64_t ticks = allowance * part->sub.problem.label_count();
                RunControl::Cap cap(control_, is_only ? control_.work_left() : ticks);
                if (!prove(*part)) return false;
                // Neither closed nor stopped: the tree had to forget nodes to save memory.
                part->is_given_up = !control_.should_stop();
                report();
            }
            if (open.empty() || control_.is_over()) return true;
            allowance *= 4;
        }
    }

    /// False: the part has no solution.
    bool prove(Part& part) {
        PartSearchOptions search = part_options(part);
        search.is_wide = true;  // start() would have solved it
        TreeResult tree =
            prove_part(part.sub.problem, part.solution, control_, search, &statistics_);
        if (tree.solution) part.solution = std::move(tree.solution);
        if (part.solution) part.value = part.solution->value;
        if (tree.bound == kNoValue) return false;
        part.bound = std::min(part.bound, tree.bound);
        return true;
    }

    const LabelingProblem& original_;
    const SolveOptions& options_;
    const ExactSearchOptions& exact_;
    const Techniques techniques_;
    RunControl& control_;
    const std::optional<Solution>& given_;  ///< known before anything else is done
    const Value first_bound_;
    const std::optional<ReducedProblem> reduced_;
    const LabelingProblem& problem_;  ///< what is left after reductions
    const std::vector<std::int8_t> warm_start_;
    const RowSystem rows_;
    Propagator propagator_;
    Decomposer decomposer_;
    std::vector<Part> parts_;
    std::vector<std::uint8_t> labels_;
    Value decided_ = 0;
    BranchAndCutStatistics statistics_;
    TreewidthStatistics treewidth_;
};

class ExactSolver final : public Solver {
public:
    explicit ExactSolver(ExactSearchOptions options) : options_(std::move(options)) {}
    std::string name() const override { return options_.name; }
    std::string description() const override { return options_.description; }
    bool is_exact() const override { return true; }
    SolveResult solve(const LabelingProblem& problem, const SolveOptions& options) const override {
        require_valid_options(problem, options);
        // Who gives a time wants it used.
        RunControl control(options,
                           options.time_limit ? std::nullopt : options_.default_work_limit);
        std::optional<Solution> given;
        Value bound = 0;
        try {
            return ExactSearch(problem, options, options_, control, given, bound).run();
        } catch (const StoppedInPass&) {
            return finish(problem, name(), control, std::move(given), bound);
        }
    }

private:
    ExactSearchOptions options_;
};

}  // namespace

std::shared_ptr<const Solver> make_exact_solver(ExactSearchOptions options) {
    return std::make_shared<ExactSolver>(std::move(options));
}

std::shared_ptr<const Solver> make_branch_and_bound_solver(LpFactory lp) {
    ExactSearchOptions options;
    options.name = "branch-and-bound";
    options.description = lp ? "exact: parts, local search start, branch-and-cut with exact bounds"
                             : "exact: parts, local search start, tree with clique cover bounds";
    options.lp = std::move(lp);
    return make_exact_solver(std::move(options));
}

std::shared_ptr<const Solver> make_auto_solver(LpFactory lp) {
    ExactSearchOptions options;
    options.name = "auto";
    options.description = "local search start, then exact, stopped by a deterministic work limit";
    options.default_work_limit = kDefaultWork;
    options.lp = std::move(lp);
    return make_exact_solver(std::move(options));
}

}  // namespace labeling
