// Labels worth more than all that they are in conflict with (neighbourhood removal, Lamm et al.
// 2019), for single labels and for pairs with a bonus (runs of four
// take two percent more labels and twice the time). With S on and its conflict
// partners N(S) off nothing may be lost, whatever is on around: for every part A of S that was on
// before, the rest of S with its bonuses must be worth at least what the partners outside N(A) can
// bring, bonuses to the outside included. That is bounded by covering them with cliques. The rows
// must stand the move as well, so a label never enters at the cost of a support or of a keep-label
// that is needed; for keep-labels the comparison of weights alone would read 0 >= 0.
#include <algorithm>
#include <vector>

#include "labeling/reduction_state.h"

namespace labeling {
namespace {

constexpr std::size_t kLongestRun = 2;
constexpr std::size_t kMostPartners = 100;

class Inclusion {
public:
    explicit Inclusion(ReductionState& state) : state_(state) {}

    bool include(Label i) {
        if (state_.weight(i) < 0) return false;
        run_ = {i};
        for (Label next = i; next >= 0; next = strongest_partner()) {
            if (next != i) run_.push_back(next);
            if (has_too_much_against_it()) {
                if (run_.size() >= kLongestRun) return false;
                continue;
            }
            collect_partners();
            if (partners_.size() > kMostPartners) return false;
            if (is_worth_it() && state_.is_safe({.on = run_, .off = partners_, .known_off = {}})) {
                for (Label j : run_) state_.fix(j, true);
                return true;
            }
            if (run_.size() >= kLongestRun) return false;
        }
        return false;
    }

private:
    /// Of the run's last label or, if that has none, of its first.
    Label strongest_partner() {
        for (Label end : {run_.back(), run_.front()}) {
            Label best = -1;
            Value strongest = 0;
            for (const auto& b : state_.bonuses_of(end)) {
                if (b.value <= strongest || state_.weight(b.label) < 0) continue;
                const bool fits = std::none_of(run_.begin(), run_.end(), [&](Label j) {
                    return j == b.label || state_.in_conflict(j, b.label);
                });
                if (!fits) continue;
                strongest = b.value;
                best = b.label;
            }
            if (best >= 0) return best;
        }
        return -1;
    }

    /// A quick look for a partner that alone brings more than the run.
    bool has_too_much_against_it() {
        const Value most = 2 * value((1U << run_.size()) - 1);
        for (Label j : run_) {
            for (Label k : state_.conflicts_of(j)) {
                ++state_.work;
                if (state_.weight(k) + state_.potential(k) > most) return true;
            }
        }
        return false;
    }

    void collect_partners() {
        partners_.clear();
        for (Label j : run_) {
            const auto conflicts = state_.conflicts_of(j);
            partners_.insert(partners_.end(), conflicts.begin(), conflicts.end());
        }
        std::sort(partners_.begin(), partners_.end());
        partners_.erase(std::unique(partners_.begin(), partners_.end()), partners_.end());
        state_.work += 4 * static_cast<std::int64_t>(partners_.size());
    }

    bool is_worth_it() {
        const unsigned all = (1U << run_.size()) - 1;
        const Value whole = value(all);
        for (unsigned part = 0; part < all; ++part) {
            if (!is_below(part, whole - value(part))) return false;
        }
        return true;
    }

    /// Weights and inner bonuses of a part of the run.
    Value value(unsigned part) const {
        Value sum = 0;
        for (std::size_t k = 0; k < run_.size(); ++k) {
            if ((part >> k & 1U) == 0) continue;
            sum += state_.weight(run_[k]);
            for (std::size_t l = 0; l < k; ++l) {
                if ((part >> l & 1U) != 0) sum += state_.bonus(run_[l], run_[k]);
            }
        }
        return sum;
    }

    /// True when the partners that a part of the run leaves bring at most `limit`.
    bool is_below(unsigned part, Value limit) {
        rest_.clear();
        for (Label j : partners_) {
            bool is_left = true;
            for (std::size_t k = 0; k < run_.size() && is_left; ++k) {
                is_left = (part >> k & 1U) == 0 || !state_.in_conflict(run_[k], j);
            }
            if (is_left) rest_.push_back({0, j});
        }
        Value sum = 0;
        for (Entry& entry : rest_) {
            entry.worth = doubled_worth(entry.label);
            if (entry.worth > 2 * limit) return false;
            sum += std::max(Value{0}, entry.worth);
        }
        state_.work += static_cast<std::int64_t>(rest_.size() * (1 + run_.size()));
        return sum <= 2 * limit || is_covered(2 * limit);
    }

    /// Twice the weight and bonuses; a bonus within the rest is shared by its two labels.
    Value doubled_worth(Label j) const {
        Value worth = 2 * state_.weight(j);
        for (const auto& b : state_.bonuses_of(j)) {
            const auto place = std::lower_bound(
                rest_.begin(), rest_.end(), b.label,
                [](const Entry& entry, Label label) { return entry.label < label; });
            const bool is_inner = place != rest_.end() && place->label == b.label;
            worth += is_inner ? b.value : 2 * b.value;
        }
        return worth;
    }

    /// True when cliques cover the rest whose best labels, the first ones, bring at most `limit`.
    bool is_covered(Value limit) {
        std::sort(rest_.begin(), rest_.end(), [](const Entry& a, const Entry& b) {
            return a.worth != b.worth ? a.worth > b.worth : a.label < b.label;
        });
        std::vector<std::vector<Label>> cliques;
        Value sum = 0;
        for (const Entry& entry : rest_) {
            if (entry.worth <= 0) break;
            const auto clique = std::find_if(cliques.begin(), cliques.end(), [&](const auto& c) {
                state_.work += static_cast<std::int64_t>(c.size());
                return std::all_of(c.begin(), c.end(), [&](Label other) {
                    return state_.in_conflict(other, entry.label);
                });
            });
            if (clique != cliques.end()) {
                clique->push_back(entry.label);
            } else {
                cliques.push_back({entry.label});
                sum += entry.worth;
                if (sum > limit) return false;
            }
        }
        return true;
    }

    struct Entry {
        Value worth;
        Label label;
    };
    ReductionState& state_;
    std::vector<Label> run_, partners_;
    std::vector<Entry> rest_;
};

}  // namespace

bool reduce_neighbourhood(ReductionState& state, Label i) { return Inclusion(state).include(i); }

}  // namespace labeling
