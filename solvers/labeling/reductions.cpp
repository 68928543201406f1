// The driver: cheap families first, at labels and rules whose surroundings changed, until nothing
// changes any more. Conflict graph reductions are those of weighted independent sets (Lamm et al.
// 2019, Gellner et al. 2021, Grossmann et al. 2023), carried over to bonuses and rules: each file
// says which conditions that takes. Solutions are lifted by replaying the steps backwards.
#include "labeling/reductions.h"

#include <array>

#include "labeling/greedy.h"
#include "labeling/reduction_state.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 16;
constexpr std::int64_t kEntriesPerCheck = 10'000;

struct Family {
    bool ReductionOptions::*option;
    bool (*reduce)(ReductionState&, Label);
    std::int64_t ReductionStatistics::*steps;
};

constexpr std::array kFamilies{
    Family{&ReductionOptions::dual_fixing, reduce_dual, &ReductionStatistics::dual_steps},
    Family{&ReductionOptions::neighbourhoods, reduce_neighbourhood,
           &ReductionStatistics::neighbourhood_steps},
    Family{&ReductionOptions::linked_labels, reduce_linked, &ReductionStatistics::link_steps},
    Family{&ReductionOptions::cliques, reduce_clique, &ReductionStatistics::clique_steps},
    Family{&ReductionOptions::domination, reduce_dominated, &ReductionStatistics::domination_steps},
    Family{&ReductionOptions::folding, reduce_two_conflicts, &ReductionStatistics::folding_steps},
};

class Reducer {
public:
    Reducer(const LabelingProblem& problem, RunControl& control, const ReductionOptions& options,
            PassGuard guard)
        : control_(control), options_(options), guard_(guard), state_(problem, guard) {}

    ReducedProblem run() {
        state_.settle();
        while (!is_over()) {
            if (const std::int32_t r = options_.rules ? state_.next_row() : -1; r >= 0) {
                if (reduce_rule(state_, r)) ++state_.statistics().rule_steps;
            } else if (const Label i = state_.next_label(); i >= 0) {
                reduce_label(i);
            } else {
                break;
            }
            state_.settle();
        }
        control_.spend((state_.work - charged_) / kEntriesPerTick);
        return state_.take_result(guard_);
    }

private:
    void reduce_label(Label i) {
        for (const Family& family : kFamilies) {
            if (!(options_.*family.option) || !family.reduce(state_, i)) continue;
            ++(state_.statistics().*family.steps);
            return;
        }
    }

    bool is_over() {
        if (state_.work - charged_ >= kEntriesPerCheck) {
            control_.spend((state_.work - charged_) / kEntriesPerTick);
            charged_ = state_.work;
        }
        return state_.is_infeasible() || control_.should_stop();
    }

    RunControl& control_;
    const ReductionOptions& options_;
    const PassGuard guard_;
    ReductionState state_;
    std::int64_t charged_ = 0;
};

}  // namespace

Solution ReducedProblem::lift(const LabelingProblem& original, const Solution& reduced) const {
    Solution solution;
    solution.labels.assign(original.label_count(), 0);
    for (std::size_t k = 0; k < to_original_.size(); ++k) {
        solution.labels[to_original_[k]] = reduced.labels[k];
    }
    for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
        auto& label = solution.labels[step->label];
        switch (step->kind) {
            case Step::Kind::Fixed:
                label = static_cast<std::uint8_t>(step->other);
                break;
            case Step::Kind::Equal:
                label = solution.labels[step->other];
                break;
            case Step::Kind::Spare:
                label = 1;
                for (std::size_t k = step->partners_begin; k < step->partners_end; ++k) {
                    if (solution.labels[partners_[k]] != 0) label = 0;
                }
                break;
            case Step::Kind::Raised:
                if (solution.labels[step->other] != 0) label = 1;
                break;
        }
    }
    solution.value = labeling_value(original, solution.labels);
    return solution;
}

std::vector<std::int8_t> ReducedProblem::project(std::span<const std::int8_t> start) const {
    std::vector<std::int8_t> projected;
    if (start.empty()) return projected;
    projected.reserve(to_original_.size());
    for (Label i : to_original_) projected.push_back(start[i]);
    return projected;
}

ReducedProblem reduce_problem(const LabelingProblem& problem, RunControl& control,
                              const ReductionOptions& options, PassGuard guard) {
    guard.look();
    return Reducer(problem, control, options, guard).run();
}

}  // namespace labeling
