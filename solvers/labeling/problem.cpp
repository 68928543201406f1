#include "labeling/problem.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "labeling/errors.h"

namespace labeling {
namespace {

const std::string kNoName;

std::string pair_text(Label i, Label j) {
    return "(" + std::to_string(i + 1) + ", " + std::to_string(j + 1) + ")";
}

void require_label(Label i, Label count, const char* where) {
    if (i < 0 || i >= count) {
        throw InputError(std::string(where) + ": label " + std::to_string(std::int64_t{i} + 1) +
                         " is out of range 1.." + std::to_string(count));
    }
}

std::uint64_t absolute(Value v) {
    return v < 0 ? ~static_cast<std::uint64_t>(v) + 1 : static_cast<std::uint64_t>(v);
}

/// begin[i] .. begin[i + 1] for the entries of i, from the number of entries per label.
std::vector<std::size_t> offsets(const std::vector<std::size_t>& counts) {
    std::vector<std::size_t> begin(counts.size() + 1, 0);
    for (std::size_t i = 0; i < counts.size(); ++i) begin[i + 1] = begin[i] + counts[i];
    return begin;
}

/// 64-bit FNV-1a over 8-byte words in a fixed byte order.
class Fnv1a {
public:
    void add(std::uint64_t word) {
        for (int byte = 0; byte < 8; ++byte) {
            state_ ^= (word >> (8 * byte)) & 0xffU;
            state_ *= 0x100000001b3ULL;
        }
    }
    void add(std::int64_t word) { add(static_cast<std::uint64_t>(word)); }
    std::uint64_t state() const { return state_; }

private:
    std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

}  // namespace

const std::string& LabelingProblem::name(Label i) const {
    return names_.empty() ? kNoName : names_[i];
}

bool LabelingProblem::in_conflict(Label i, Label j) const {
    auto a = conflicts_of(i);
    auto b = conflicts_of(j);
    if (a.size() > b.size()) {
        std::swap(a, b);
        std::swap(i, j);
    }
    return std::binary_search(a.begin(), a.end(), j);
}

std::uint64_t LabelingProblem::hash() const {
    Fnv1a fnv;
    fnv.add(std::uint64_t{weights_.size()});
    for (Value w : weights_) fnv.add(w);
    fnv.add(std::uint64_t{conflicts_.size()});
    for (const Conflict& c : conflicts_) {
        fnv.add(std::int64_t{c.first});
        fnv.add(std::int64_t{c.second});
    }
    fnv.add(std::uint64_t{bonuses_.size()});
    for (const Bonus& b : bonuses_) {
        fnv.add(std::int64_t{b.first});
        fnv.add(std::int64_t{b.second});
        fnv.add(b.value);
    }
    fnv.add(std::uint64_t{rules_.size()});
    for (const Rule& rule : rules_) {
        fnv.add(static_cast<std::int64_t>(rule.relation));
        fnv.add(rule.right_hand_side);
        fnv.add(std::uint64_t{rule.terms.size()});
        for (const Term& t : rule.terms) {
            fnv.add(std::int64_t{t.coefficient});
            fnv.add(std::int64_t{t.label});
        }
    }
    return fnv.state();
}

Label ProblemBuilder::add_label(Value weight, std::string name) {
    if (absolute(weight) > static_cast<std::uint64_t>(kMaxTotal)) {
        throw InputError("label " + std::to_string(weights_.size() + 1) + ": weight " +
                         std::to_string(weight) + " exceeds 2^53");
    }
    if (weights_.size() >= static_cast<std::size_t>(std::numeric_limits<Label>::max())) {
        throw InputError("more than 2^31 - 1 labels");
    }
    if (name.find_first_of("\r\n") != std::string::npos) {
        throw InputError("label " + std::to_string(weights_.size() + 1) +
                         ": the name contains a line break");
    }
    weights_.push_back(weight);
    if (!name.empty() || !names_.empty()) {
        names_.resize(weights_.size());
        names_.back() = std::move(name);
    }
    return static_cast<Label>(weights_.size() - 1);
}

void ProblemBuilder::add_conflict(Label i, Label j) {
    require_label(i, label_count(), "conflict");
    require_label(j, label_count(), "conflict");
    if (i == j) throw InputError("conflict of label " + std::to_string(i + 1) + " with itself");
    conflicts_.push_back({std::min(i, j), std::max(i, j)});
}

void ProblemBuilder::add_bonus(Label i, Label j, Value value) {
    require_label(i, label_count(), "bonus");
    require_label(j, label_count(), "bonus");
    if (i == j) throw InputError("bonus of label " + std::to_string(i + 1) + " with itself");
    if (value < 0) {
        throw InputError("bonus " + pair_text(i, j) + ": negative value " + std::to_string(value));
    }
    if (value > kMaxTotal) {
        throw InputError("bonus " + pair_text(i, j) + ": value " + std::to_string(value) +
                         " exceeds 2^53");
    }
    bonuses_.push_back({std::min(i, j), std::max(i, j), value});
}

void ProblemBuilder::add_rule(Rule rule) {
    for (const Term& t : rule.terms) require_label(t.label, label_count(), "rule");
    if (absolute(rule.right_hand_side) > static_cast<std::uint64_t>(kMaxTotal)) {
        throw InputError("rule: right-hand side " + std::to_string(rule.right_hand_side) +
                         " exceeds 2^53");
    }
    auto& terms = rule.terms;
    std::stable_sort(terms.begin(), terms.end(),
                     [](const Term& a, const Term& b) { return a.label < b.label; });
    std::size_t kept = 0;
    for (std::size_t k = 0; k < terms.size();) {
        const Label label = terms[k].label;
        std::int64_t sum = 0;
        for (; k < terms.size() && terms[k].label == label; ++k) sum += terms[k].coefficient;
        if (sum < -std::numeric_limits<std::int32_t>::max() ||
            sum > std::numeric_limits<std::int32_t>::max()) {
            throw InputError("rule: the coefficient of label " + std::to_string(label + 1) +
                             " exceeds 2^31 - 1");
        }
        if (sum != 0) terms[kept++] = {static_cast<std::int32_t>(sum), label};
    }
    terms.resize(kept);
    rules_.push_back(std::move(rule));
}

void ProblemBuilder::set_units_per_one(double units) {
    if (!(units > 0) || units > std::numeric_limits<double>::max()) {
        throw InputError("units per 1.0 must be positive and finite");
    }
    units_per_one_ = units;
}

LabelingProblem ProblemBuilder::build(const std::function<void()>& between) {
    ProblemBuilder input;
    std::swap(input, *this);
    auto pause = [&] {
        if (between) between();
    };
    LabelingProblem p;
    const std::size_t n = input.weights_.size();
    std::uint64_t total = 0;
    auto add_to_total = [&total](Value v) {
        total += absolute(v);
        if (total > static_cast<std::uint64_t>(kMaxTotal)) {
            throw InputError("the absolute weights and bonuses sum to more than 2^53");
        }
    };
    for (Value w : input.weights_) add_to_total(w);
    for (const Bonus& b : input.bonuses_) add_to_total(b.value);

    p.weights_ = std::move(input.weights_);
    p.names_ = std::move(input.names_);
    p.rules_ = std::move(input.rules_);
    p.units_per_one_ = input.units_per_one_;

    p.conflicts_ = std::move(input.conflicts_);
    auto by_pair = [](const auto& a, const auto& b) {
        return std::pair(a.first, a.second) < std::pair(b.first, b.second);
    };
    // Parts of a problem come in order.
    if (!std::is_sorted(p.conflicts_.begin(), p.conflicts_.end(), by_pair)) {
        std::sort(p.conflicts_.begin(), p.conflicts_.end(), by_pair);
    }
    pause();
    p.conflicts_.erase(std::unique(p.conflicts_.begin(), p.conflicts_.end()), p.conflicts_.end());

    std::vector<std::size_t> counts(n, 0);
    pause();
    for (const Conflict& c : p.conflicts_) {
        ++counts[c.first];
        ++counts[c.second];
    }
    pause();
    p.conflict_begin_ = offsets(counts);
    p.conflict_adjacency_.resize(2 * p.conflicts_.size());
    std::vector<std::size_t> next(p.conflict_begin_.begin(), p.conflict_begin_.end() - 1);
    // Sorted by (first, second): smaller partners arrive before larger ones, so lists ascend.
    for (const Conflict& c : p.conflicts_) p.conflict_adjacency_[next[c.second]++] = c.first;
    pause();
    for (const Conflict& c : p.conflicts_) p.conflict_adjacency_[next[c.first]++] = c.second;

    pause();
    if (!std::is_sorted(input.bonuses_.begin(), input.bonuses_.end(), by_pair)) {
        std::stable_sort(input.bonuses_.begin(), input.bonuses_.end(), by_pair);
    }
    for (std::size_t k = 0; k < input.bonuses_.size();) {
        Bonus sum{input.bonuses_[k].first, input.bonuses_[k].second, 0};
        std::size_t entries = 0;
        for (; k < input.bonuses_.size() && input.bonuses_[k].first == sum.first &&
               input.bonuses_[k].second == sum.second;
             ++k, ++entries) {
            sum.value += input.bonuses_[k].value;
        }
        if (p.in_conflict(sum.first, sum.second)) {
            p.dropped_bonus_count_ += entries;
        } else if (sum.value > 0) {
            p.bonuses_.push_back(sum);
        }
    }
    counts.assign(n, 0);
    for (const Bonus& b : p.bonuses_) {
        ++counts[b.first];
        ++counts[b.second];
    }
    pause();
    p.bonus_begin_ = offsets(counts);
    p.bonus_adjacency_.resize(2 * p.bonuses_.size());
    next.assign(p.bonus_begin_.begin(), p.bonus_begin_.end() - 1);
    for (const Bonus& b : p.bonuses_) p.bonus_adjacency_[next[b.second]++] = {b.first, b.value};
    for (const Bonus& b : p.bonuses_) p.bonus_adjacency_[next[b.first]++] = {b.second, b.value};

    counts.assign(n, 0);
    for (const Rule& rule : p.rules_) {
        for (const Term& t : rule.terms) ++counts[t.label];
    }
    p.rule_begin_ = offsets(counts);
    p.rule_adjacency_.resize(p.rule_begin_.back());
    next.assign(p.rule_begin_.begin(), p.rule_begin_.end() - 1);
    for (std::size_t r = 0; r < p.rules_.size(); ++r) {
        for (const Term& t : p.rules_[r].terms) {
            p.rule_adjacency_[next[t.label]++] = {static_cast<std::int32_t>(r), t.coefficient};
        }
    }
    return p;
}

}  // namespace labeling
