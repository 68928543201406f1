// Problems of small bandwidth. Everything that binds labels binds labels within `reach` places of
// each other, so the best labeling of a prefix depends on its last `reach` labels alone: dynamic
// programming over their 2^reach states gives the optimum, and the choices taken give the solution.
// Weights may be negative: else "none" would never be worth a thought. The rules hold for the empty
// labeling, so a solution exists always.
#include <algorithm>
#include <numeric>

#include "labeling/errors.h"
#include "labeling/generators.h"
#include "labeling/random.h"

namespace labeling {
namespace {

/// What binds place p to the places before it; bit k of a mask is place p - k.
struct Place {
    Value weight = 0;
    std::uint32_t conflicts = 0;                 ///< places that p excludes
    std::vector<std::pair<int, Value>> bonuses;  ///< distance back, value
    struct Limit {
        std::vector<std::pair<int, int>> terms;  ///< distance back, coefficient
        int side = 0;                            ///< sum <= side
    };
    std::vector<Limit> limits;
};

std::vector<Place> random_places(const ChainOptions& options, Random& random) {
    std::vector<Place> places(options.labels);
    for (int p = 0; p < options.labels; ++p) {
        Place& place = places[p];
        place.weight = static_cast<Value>(random.below(1100)) - 100;
        const int reach = std::min(p, options.reach);
        for (int k = 1; k <= reach; ++k) {
            if (random.below(100) < 30) {
                place.conflicts |= 1U << k;
            } else if (random.below(100) < 40) {
                const double most = 500 * options.lambda0;
                place.bonuses.emplace_back(k, static_cast<Value>(most * random.unit()));
            }
        }
        if (reach >= 2 && random.below(100) < 40) {
            // A short segment in the middle needs one of its neighbours.
            place.limits.push_back({{{1, 1}, {0, -1}, {2, -1}}, 0});
        }
        if (reach >= 2 && random.below(100) < 40) {
            Place::Limit limit;
            for (int k = 0; k <= reach; ++k) {
                if (k == 0 || random.below(2) == 0) limit.terms.emplace_back(k, 1);
            }
            limit.side = std::max<int>(1, static_cast<int>(limit.terms.size()) - 1);
            place.limits.push_back(limit);
        }
    }
    return places;
}

class ChainSearch {
public:
    ChainSearch(const std::vector<Place>& places, int reach)
        : places_(places), mask_((std::uint32_t{1} << reach) - 1) {}

    /// Best labeling, by place.
    Solution run() {
        const std::size_t states = std::size_t{mask_} + 1;
        std::vector<Value> best(states, kNever);
        best[0] = 0;
        // The bit that falls out of the window on the best way into each state.
        std::vector<std::vector<std::uint8_t>> lost(places_.size());
        for (std::size_t p = 0; p < places_.size(); ++p) {
            std::vector<Value> next(states, kNever);
            lost[p].assign(states, 0);
            for (std::uint32_t state = 0; state < states; ++state) {
                if (best[state] == kNever) continue;
                for (std::uint32_t on : {0U, 1U}) {
                    const std::uint32_t window = state << 1 | on;
                    const Value gain = this->gain(places_[p], window);
                    if (gain == kNever) continue;
                    Value& value = next[window & mask_];
                    if (best[state] + gain <= value) continue;
                    value = best[state] + gain;
                    lost[p][window & mask_] = window > mask_ ? 1 : 0;
                }
            }
            best = std::move(next);
        }
        return traced(best, lost);
    }

private:
    static constexpr Value kNever = -kMaxTotal - 1;

    /// Bit 0 of the window is the place itself.
    static Value gain(const Place& place, std::uint32_t window) {
        const bool is_on = (window & 1U) != 0;
        if (is_on && (window & place.conflicts) != 0) return kNever;
        for (const auto& limit : place.limits) {
            int sum = 0;
            for (const auto& [back, coefficient] : limit.terms) {
                sum += (window >> back & 1U) != 0 ? coefficient : 0;
            }
            if (sum > limit.side) return kNever;
        }
        if (!is_on) return 0;
        Value value = place.weight;
        for (const auto& [back, bonus] : place.bonuses) {
            if ((window >> back & 1U) != 0) value += bonus;
        }
        return value;
    }

    Solution traced(const std::vector<Value>& best,
                    const std::vector<std::vector<std::uint8_t>>& lost) const {
        Solution solution;
        const auto top = std::max_element(best.begin(), best.end());
        solution.value = *top;
        solution.labels.resize(places_.size());
        auto state = static_cast<std::uint32_t>(top - best.begin());
        const std::uint32_t top_bit = (mask_ + 1) >> 1;
        for (std::size_t p = places_.size(); p-- > 0;) {
            solution.labels[p] = static_cast<std::uint8_t>(state & 1U);
            state = state >> 1 | (lost[p][state] != 0 ? top_bit : 0);
        }
        return solution;
    }

    const std::vector<Place>& places_;
    std::uint32_t mask_;
};

}  // namespace

GeneratedProblem chain(const ChainOptions& options) {
    if (options.labels < 1 || options.reach < 1 || options.reach > 10) {
        throw InputError("a chain needs at least one label and a reach of 1 to 10");
    }
    Random random(options.seed);
    const std::vector<Place> places = random_places(options, random);
    std::vector<Label> label_of(places.size());
    std::iota(label_of.begin(), label_of.end(), 0);
    for (std::size_t k = label_of.size(); k > 1; --k) {
        std::swap(label_of[k - 1], label_of[random.below(static_cast<std::uint32_t>(k))]);
    }
    std::vector<Value> weights(places.size());
    for (std::size_t p = 0; p < places.size(); ++p) weights[label_of[p]] = places[p].weight;
    ProblemBuilder builder;
    for (Value w : weights) builder.add_label(w);
    for (std::size_t p = 0; p < places.size(); ++p) {
        for (int k = 1; k <= options.reach; ++k) {
            if ((places[p].conflicts >> k & 1U) != 0) {
                builder.add_conflict(label_of[p - k], label_of[p]);
            }
        }
        for (const auto& [back, bonus] : places[p].bonuses) {
            builder.add_bonus(label_of[p - back], label_of[p], bonus);
        }
        for (const auto& limit : places[p].limits) {
            Rule rule{Relation::LessEqual, limit.side, {}};
            for (const auto& [back, coefficient] : limit.terms) {
                rule.terms.push_back({coefficient, label_of[p - back]});
            }
            builder.add_rule(std::move(rule));
        }
    }
    const Solution by_place = ChainSearch(places, options.reach).run();
    Solution optimum{std::vector<std::uint8_t>(places.size()), by_place.value};
    for (std::size_t p = 0; p < places.size(); ++p) {
        optimum.labels[label_of[p]] = by_place.labels[p];
    }
    return {builder.build(), std::move(optimum)};
}

}  // namespace labeling
