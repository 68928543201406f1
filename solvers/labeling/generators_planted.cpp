// A problem whose optimum is known without solving it. Labels are dealt into cliques; one member of
// each is chosen, the chosen ones are free of conflicts. Every bonus between two chosen labels is
// earned by all of them together; every other bonus is charged to an end that is not chosen, and a
// label's weight plus its charges stays within the weight of the chosen member of its clique. A
// labeling takes at most one member of each clique, so it earns at most the sum over cliques of the
// chosen weight plus the bonuses between chosen labels, which is what the chosen ones earn. Rules
// only take labelings away; each holds for the chosen ones, half of them with equality. Labels are
// dealt at random, so nothing shows which are chosen.
#include <algorithm>
#include <numeric>

#include "labeling/errors.h"
#include "labeling/generators.h"
#include "labeling/random.h"

namespace labeling {
namespace {

class Planting {
public:
    explicit Planting(const PlantedOptions& options)
        : options_(options),
          count_(options.cliques * options.clique_size),
          random_(options.seed),
          chosen_(count_),
          weights_(count_),
          room_(count_) {}

    GeneratedProblem run() {
        deal();
        const auto times = [this](double per_label) {
            return static_cast<std::int64_t>(per_label * static_cast<double>(count_));
        };
        for (auto k = times(options_.bonuses); k > 0; --k) add_bonus();
        // A conflict may fall on a bonus, which it kills: only ends that are not chosen lose.
        for (auto k = times(options_.conflicts); k > 0; --k) add_conflict(any(), any());
        for (auto k = times(options_.rules); k > 0; --k) add_rule();
        for (Value w : weights_) builder_.add_label(w);
        for (const auto& [i, j] : conflicts_) builder_.add_conflict(i, j);
        for (const Bonus& b : bonuses_) builder_.add_bonus(b.first, b.second, b.value);
        for (Rule& rule : rules_) builder_.add_rule(std::move(rule));
        Solution optimum{chosen_, 0};
        GeneratedProblem made{builder_.build(), std::nullopt};
        const SolutionCheck check = check_solution(made.problem, optimum);
        if (!check.is_feasible) throw LogicError("the planted solution breaks a rule");
        optimum.value = check.value;
        made.optimum = std::move(optimum);
        return made;
    }

private:
    Label any() { return static_cast<Label>(random_.below(static_cast<std::uint32_t>(count_))); }

    void deal() {
        std::vector<Label> order(count_);
        std::iota(order.begin(), order.end(), 0);
        for (std::size_t k = order.size(); k > 1; --k) {
            std::swap(order[k - 1], order[random_.below(static_cast<std::uint32_t>(k))]);
        }
        for (int c = 0; c < options_.cliques; ++c) {
            const Label* members = order.data() + std::ptrdiff_t{c} * options_.clique_size;
            const Value most = 500 + random_.below(500);
            for (int a = 0; a < options_.clique_size; ++a) {
                const bool is_chosen = a == 0;
                chosen_[members[a]] = is_chosen ? 1 : 0;
                weights_[members[a]] = is_chosen ? most : random_.below(900);
                weights_[members[a]] = std::min(weights_[members[a]], most);
                room_[members[a]] = is_chosen ? 0 : most - weights_[members[a]];
                for (int b = 0; b < a; ++b) conflicts_.emplace_back(members[b], members[a]);
            }
        }
    }

    void add_bonus() {
        const Label i = any(), j = any();
        if (i == j) return;
        Value value = 1 + random_.below(500);
        if (chosen_[i] == 0 || chosen_[j] == 0) {
            const Label payer = chosen_[i] == 0 ? i : j;
            value = std::min(value, room_[payer]);
            room_[payer] -= value;
        }
        if (value > 0) bonuses_.push_back({i, j, value});
    }

    void add_conflict(Label i, Label j) {
        if (i != j && !(chosen_[i] != 0 && chosen_[j] != 0)) conflicts_.emplace_back(i, j);
    }

    void add_rule() {
        Rule rule;
        std::int64_t activity = 0;
        std::vector<Label> members;
        for (std::uint32_t k = 2 + random_.below(4); k > 0; --k) {
            const Label i = any();
            if (std::find(members.begin(), members.end(), i) != members.end()) continue;
            members.push_back(i);
            const std::int32_t coefficient = random_.below(3) == 0 ? -1 : 1;
            rule.terms.push_back({coefficient, i});
            activity += chosen_[i] != 0 ? coefficient : 0;
        }
        const std::int64_t slack = random_.below(2);
        const bool is_upper = random_.below(3) > 0;
        rule.relation = is_upper ? Relation::LessEqual : Relation::GreaterEqual;
        rule.right_hand_side = is_upper ? activity + slack : activity - slack;
        rules_.push_back(std::move(rule));
    }

    const PlantedOptions& options_;
    int count_;
    Random random_;
    std::vector<std::uint8_t> chosen_;
    std::vector<Value> weights_, room_;
    std::vector<std::pair<Label, Label>> conflicts_;
    std::vector<Bonus> bonuses_;
    std::vector<Rule> rules_;
    ProblemBuilder builder_;
};

}  // namespace

GeneratedProblem planted(const PlantedOptions& options) {
    if (options.cliques < 1 || options.clique_size < 1) {
        throw InputError("planted needs at least one clique of at least one label");
    }
    return Planting(options).run();
}

}  // namespace labeling
