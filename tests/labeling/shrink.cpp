#include "labeling/shrink.h"

#include <type_traits>

#include "labeling/formats.h"

namespace labeling_test {

using labeling::Label;
using labeling::LabelingProblem;
using labeling::ProblemBuilder;
using labeling::Term;
using labeling::Value;

ProblemParts::ProblemParts(const LabelingProblem& problem)
    : weights(problem.weights().begin(), problem.weights().end()),
      conflicts(problem.conflicts().begin(), problem.conflicts().end()),
      bonuses(problem.bonuses().begin(), problem.bonuses().end()),
      rules(problem.rules().begin(), problem.rules().end()) {}

LabelingProblem ProblemParts::build() const {
    ProblemBuilder builder;
    for (Value w : weights) builder.add_label(w);
    for (const auto& c : conflicts) builder.add_conflict(c.first, c.second);
    for (const auto& b : bonuses) builder.add_bonus(b.first, b.second, b.value);
    for (const auto& rule : rules) builder.add_rule(rule);
    return builder.build();
}

void ProblemParts::remove_label(Label label) {
    const auto has = [label](const auto& pair) {
        return pair.first == label || pair.second == label;
    };
    const auto rename = [label](Label& i) { i -= i > label ? 1 : 0; };
    weights.erase(weights.begin() + label);
    std::erase_if(conflicts, has);
    std::erase_if(bonuses, has);
    for (auto& c : conflicts) rename(c.first), rename(c.second);
    for (auto& b : bonuses) rename(b.first), rename(b.second);
    for (auto& rule : rules) {
        std::erase_if(rule.terms, [label](const Term& t) { return t.label == label; });
        for (Term& t : rule.terms) rename(t.label);
    }
}

namespace {

class Shrinker {
public:
    Shrinker(const LabelingProblem& problem,
             const std::function<bool(const LabelingProblem&)>& fails)
        : parts_(problem), fails_(fails) {}

    LabelingProblem run() {
        do {
            is_smaller_ = false;
            for (Label i = 0; i < std::ssize(parts_.weights);) {
                if (!attempt([i](ProblemParts& p) { p.remove_label(i); })) ++i;
            }
            drop_each(&ProblemParts::rules);
            drop_each(&ProblemParts::conflicts);
            drop_each(&ProblemParts::bonuses);
            for (std::size_t r = 0; r < parts_.rules.size(); ++r) shrink_rule(r);
            for (std::size_t i = 0; i < parts_.weights.size(); ++i) {
                shrink_number([i](ProblemParts& p) -> Value& { return p.weights[i]; });
            }
            for (std::size_t k = 0; k < parts_.bonuses.size(); ++k) {
                shrink_number([k](ProblemParts& p) -> Value& { return p.bonuses[k].value; });
            }
        } while (is_smaller_);
        return parts_.build();
    }

private:
    template <class Change>
    bool attempt(const Change& change) {
        ProblemParts candidate = parts_;
        change(candidate);
        if (!fails_(candidate.build())) return false;
        parts_ = std::move(candidate);
        return is_smaller_ = true;
    }

    template <class List>
    void drop_each(List list) {
        for (std::size_t k = 0; k < (parts_.*list).size();) {
            const auto at = static_cast<std::ptrdiff_t>(k);
            const auto drop = [&](ProblemParts& p) { (p.*list).erase((p.*list).begin() + at); };
            if (!attempt(drop)) ++k;
        }
    }

    void shrink_rule(std::size_t r) {
        for (std::size_t k = 0; k < parts_.rules[r].terms.size();) {
            const auto at = static_cast<std::ptrdiff_t>(k);
            const auto drop = [&](ProblemParts& p) {
                p.rules[r].terms.erase(p.rules[r].terms.begin() + at);
            };
            if (!attempt(drop)) ++k;
        }
        for (std::size_t k = 0; k < parts_.rules[r].terms.size(); ++k) {
            shrink_number(
                [&](ProblemParts& p) -> std::int32_t& { return p.rules[r].terms[k].coefficient; });
        }
        shrink_number([&](ProblemParts& p) -> std::int64_t& { return p.rules[r].right_hand_side; });
    }

    /// `number` gives a reference into the parts it is given.
    template <class Number>
    void shrink_number(const Number& number) {
        using Integer = std::remove_cvref_t<decltype(number(parts_))>;
        constexpr Integer kMostSteps = 64;
        while (true) {
            const Integer now = number(parts_);
            if (now == 0) return;
            const Integer one = now > 0 ? 1 : -1;
            const auto set = [&](Integer value) {
                return attempt([&](ProblemParts& p) { number(p) = value; });
            };
            if (set(0) || now == one) return;
            if (set(one) || set(now / 2)) continue;
            if (now > kMostSteps || now < -kMostSteps || !set(now - one)) return;
        }
    }

    ProblemParts parts_;
    const std::function<bool(const LabelingProblem&)>& fails_;
    bool is_smaller_ = false;
};

}  // namespace

std::string shrunk(const LabelingProblem& problem,
                   const std::function<bool(const LabelingProblem&)>& fails) {
    return labeling::format_problem(Shrinker(problem, fails).run(), labeling::ProblemFormat::Lab);
}

}  // namespace labeling_test
