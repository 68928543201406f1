// Dynamic programming over an elimination order (nonserial dynamic programming, Bertele & Brioschi
// 1972; bucket elimination, Dechter 1999). A label's table holds, for every assignment of the
// labels it is joined with when it is eliminated, the best value of it and all that was eliminated
// into it. Ours differs from the textbook in the index: the joined labels are covered with cliques
// of conflicts, of each of which at most one label is on, so the index is a number with one digit
// per clique, and a table has the product of (clique size + 1) entries instead of a power of two.
// Index contributions of labels add up, so the tables of the children are read without decoding.
// Rules are checked where the first of their labels goes. Values are freed once they have been
// read; what remains is one bit per entry, the label's choice, to trace the solution back.
#include "labeling/treewidth_search.h"

#include <algorithm>
#include <array>
#include <vector>

#include "labeling/greedy.h"
#include "labeling/rows.h"

namespace labeling {
namespace {

constexpr std::int64_t kEntriesPerTick = 16;
constexpr std::int64_t kLargestTable = std::int64_t{1} << 24;
constexpr std::int64_t kStepsPerCheck = 100'000;
/// Tables by minimum fill are smaller than by minimum degree, seldom more than so many times.
constexpr double kFillGain = 40;
constexpr double kQuickTicksPerLabel = 100;

using Set = std::uint64_t;
constexpr Set bit(std::size_t k) { return Set{1} << k; }

/// What is eliminated at one label.
struct Table {
    std::vector<std::vector<std::uint8_t>> cliques;  ///< positions in the label's neighbours
    std::vector<std::int32_t> contributions;         ///< to the index, per neighbour that is on
    std::vector<Label> children;                     ///< labels whose tables are read here
    std::vector<std::int32_t> rows;                  ///< rules that are checked here
    std::int64_t size = 1;
    std::vector<Value> values;
    std::vector<bool> choices;
};

class TreewidthSearch {
public:
    TreewidthSearch(const LabelingProblem& problem, const RowSystem& rows, RunControl& control,
                    const EliminationOrder& order)
        : problem_(problem),
          rows_(rows),
          control_(control),
          order_(order),
          place_(problem.label_count()),
          tables_(problem.label_count()) {
        for (std::size_t k = 0; k < order.order.size(); ++k) {
            place_[order.order[k]] = static_cast<std::int32_t>(k);
        }
    }

    /// Chooses the tables; estimated ticks to fill them. A table beyond the largest counts as that.
    double plan(const TreewidthOptions& options) {
        double entries = 0;
        std::size_t bytes = 0, live = 0;
        for (std::int32_t row = 0; row < rows_.row_count(); ++row) assign_row(row);
        for (Label i : order_.order) {
            Table& table = tables_[i];
            const auto& neighbours = order_.neighbours[i];
            if (!neighbours.empty()) tables_[first_of(neighbours)].children.push_back(i);
            cover(i);
            std::size_t terms = 0;
            for (std::int32_t row : table.rows) terms += rows_.terms(row).size();
            const auto cost = static_cast<double>(4 + 4 * table.children.size() + terms);
            entries += cost * static_cast<double>(table.size) + 20;
            bytes += static_cast<std::size_t>(table.size) / 8 + sizeof(Table) + 64;
            live += static_cast<std::size_t>(table.size) * sizeof(Value);
            if (table.size > kLargestTable || bytes + live > options.most_bytes) is_small_ = false;
            for (Label child : table.children) {
                live -= static_cast<std::size_t>(tables_[child].size) * sizeof(Value);
            }
        }
        return entries / static_cast<double>(kEntriesPerTick);
    }
    bool is_small() const { return is_small_; }

    std::optional<TreeResult> run(TreewidthStatistics* statistics) {
        Value total = 0;
        for (Label i : order_.order) {
            if (!fill(i)) return std::nullopt;
            if (!order_.neighbours[i].empty()) continue;
            const Value value = tables_[i].values[0];
            if (value < kImpossible) return TreeResult{};
            total += value;
        }
        if (statistics != nullptr) {
            ++statistics->solved;
            for (Label i : order_.order) {
                statistics->entries += tables_[i].size;
                statistics->width = std::max(
                    statistics->width, static_cast<std::int64_t>(order_.neighbours[i].size()));
            }
        }
        TreeResult result;
        result.solution = trace();
        result.bound = total;
        return result;
    }

private:
    static constexpr Value kImpossible = kNoValue / 2;

    Label first_of(const std::vector<Label>& labels) const {
        return *std::min_element(labels.begin(), labels.end(),
                                 [&](Label a, Label b) { return place_[a] < place_[b]; });
    }

    void assign_row(std::int32_t row) {
        const auto terms = rows_.terms(row);
        if (terms.empty()) return;
        const auto first = std::min_element(
            terms.begin(), terms.end(),
            [&](const Term& a, const Term& b) { return place_[a.label] < place_[b.label]; });
        tables_[first->label].rows.push_back(row);
    }

    /// Greedy cover of the neighbours with cliques; index contributions.
    void cover(Label i) {
        Table& table = tables_[i];
        const auto& neighbours = order_.neighbours[i];
        table.contributions.resize(neighbours.size());
        for (std::size_t k = 0; k < neighbours.size(); ++k) {
            const auto clique =
                std::find_if(table.cliques.begin(), table.cliques.end(), [&](const auto& members) {
                    return std::all_of(members.begin(), members.end(), [&](std::uint8_t m) {
                        return problem_.in_conflict(neighbours[m], neighbours[k]);
                    });
                });
            if (clique == table.cliques.end()) {
                table.cliques.push_back({static_cast<std::uint8_t>(k)});
            } else {
                clique->push_back(static_cast<std::uint8_t>(k));
            }
        }
        for (const auto& members : table.cliques) {
            for (std::size_t m = 0; m < members.size(); ++m) {
                const std::int64_t digit = static_cast<std::int64_t>(m) + 1;
                table.contributions[members[m]] = static_cast<std::int32_t>(digit * table.size);
            }
            table.size *= static_cast<std::int64_t>(members.size()) + 1;
            if (table.size > kLargestTable) {
                table.size = 2 * kLargestTable;
                return;
            }
        }
    }

    /// Everything about the label at hand that enumerate() needs, by position of its neighbours.
    struct Child {
        const Value* values;
        std::int32_t index, contribution;  ///< without and of the label itself
    };
    struct Place {
        Set enemies = 0;
        Value bonus = 0;
        std::vector<std::pair<std::int32_t, std::int32_t>> children;  ///< child, contribution
        std::vector<std::pair<std::int32_t, std::int64_t>> rows;      ///< row slot, coefficient
    };
    struct Slot {
        std::int64_t slack, coefficient;  ///< right-hand side less what is on; of the label itself
    };

    bool fill(Label i) {
        Table& table = tables_[i];
        prepare(i);
        table.values.assign(static_cast<std::size_t>(table.size), kNoValue);
        table.choices.assign(static_cast<std::size_t>(table.size), false);
        const bool is_done = enumerate(table, 0, 0, 0, problem_.weight(i));
        for (Label child : table.children) tables_[child].values = {};
        steps_ += 20;
        return is_done && !charge();
    }

    void prepare(Label i) {
        const Table& table = tables_[i];
        const auto& neighbours = order_.neighbours[i];
        own_enemies_ = 0;
        children_.clear();
        slots_.clear();
        for (std::size_t k = 0; k < neighbours.size(); ++k) {
            Place& place = places_[k];
            place.children.clear();
            place.rows.clear();
            place.bonus = 0;
            place.enemies = 0;
            for (std::size_t l = 0; l < k; ++l) {
                if (!problem_.in_conflict(neighbours[l], neighbours[k])) continue;
                place.enemies |= bit(l);
                places_[l].enemies |= bit(k);
            }
            if (problem_.in_conflict(i, neighbours[k])) own_enemies_ |= bit(k);
        }
        for (const auto& b : problem_.bonuses_of(i)) {
            const std::size_t k = position(neighbours, b.label);
            if (k < neighbours.size()) places_[k].bonus = b.value;
        }
        for (Label child : table.children) {
            const auto c = static_cast<std::int32_t>(children_.size());
            children_.push_back({tables_[child].values.data(), 0, 0});
            const auto& its = order_.neighbours[child];
            for (std::size_t m = 0; m < its.size(); ++m) {
                const std::int32_t contribution = tables_[child].contributions[m];
                if (its[m] == i) {
                    children_.back().contribution = contribution;
                } else {
                    places_[position(neighbours, its[m])].children.emplace_back(c, contribution);
                }
            }
        }
        for (std::int32_t row : table.rows) {
            const auto s = static_cast<std::int32_t>(slots_.size());
            slots_.push_back({rows_.right_hand_side(row), 0});
            for (const Term& t : rows_.terms(row)) {
                if (t.label == i) {
                    slots_.back().coefficient = t.coefficient;
                } else {
                    places_[position(neighbours, t.label)].rows.emplace_back(s, t.coefficient);
                }
            }
        }
        steps_ += static_cast<std::int64_t>(neighbours.size() * neighbours.size());
    }

    static std::size_t position(const std::vector<Label>& neighbours, Label i) {
        const auto place = std::lower_bound(neighbours.begin(), neighbours.end(), i);
        if (place == neighbours.end() || *place != i) return neighbours.size();
        return static_cast<std::size_t>(place - neighbours.begin());
    }

    /// Goes through the cliques, in each of which none or one label is on; false: stopped.
    bool enumerate(Table& table, std::size_t clique, Set on, std::int32_t index, Value gain) {
        if (clique == table.cliques.size()) {
            settle(table, on, index, gain);
            steps_ += static_cast<std::int64_t>(4 + 2 * children_.size() + slots_.size());
            return steps_ < kStepsPerCheck || !charge();
        }
        if (!enumerate(table, clique + 1, on, index, gain)) return false;
        for (std::uint8_t k : table.cliques[clique]) {
            const Place& place = places_[k];
            if ((place.enemies & on) != 0) continue;
            for (const auto& [c, contribution] : place.children) children_[c].index += contribution;
            for (const auto& [s, coefficient] : place.rows) slots_[s].slack -= coefficient;
            const bool is_done = enumerate(table, clique + 1, on | bit(k),
                                           index + table.contributions[k], gain + place.bonus);
            for (const auto& [c, contribution] : place.children) children_[c].index -= contribution;
            for (const auto& [s, coefficient] : place.rows) slots_[s].slack += coefficient;
            if (!is_done) return false;
        }
        return true;
    }

    /// One entry: the label at 0 or at 1, whichever is better.
    void settle(Table& table, Set on, std::int32_t index, Value gain) {
        Value without = 0, with = (own_enemies_ & on) != 0 ? kNoValue : gain;
        for (const Slot& slot : slots_) {
            if (slot.slack < 0) without = kNoValue;
            if (slot.slack < slot.coefficient) with = kNoValue;
        }
        for (const Child& child : children_) {
            without = sum(without, child.values[child.index]);
            // Beside an enemy the sum of the digits would be no index.
            if (with > kImpossible) with += child.values[child.index + child.contribution];
            if (with < kImpossible) with = kNoValue;
        }
        table.values[static_cast<std::size_t>(index)] = std::max(with, without);
        table.choices[static_cast<std::size_t>(index)] = with > without;
    }

    static Value sum(Value a, Value b) {
        return a < kImpossible || b < kImpossible ? kNoValue : a + b;
    }

    Solution trace() const {
        Solution solution;
        solution.labels.assign(problem_.label_count(), 0);
        for (auto i = order_.order.rbegin(); i != order_.order.rend(); ++i) {
            const Table& table = tables_[*i];
            const auto& neighbours = order_.neighbours[*i];
            std::size_t index = 0;
            for (std::size_t k = 0; k < neighbours.size(); ++k) {
                if (solution.labels[neighbours[k]] != 0) index += table.contributions[k];
            }
            solution.labels[*i] = table.choices[index] ? 1 : 0;
        }
        solution.value = labeling_value(problem_, solution.labels);
        return solution;
    }

    bool charge() {
        const std::int64_t ticks = steps_ / kEntriesPerTick;
        steps_ -= ticks * kEntriesPerTick;
        return control_.spend(ticks);
    }

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    RunControl& control_;
    const EliminationOrder& order_;
    std::vector<std::int32_t> place_;
    std::vector<Table> tables_;
    bool is_small_ = true;  ///< all tables fit into memory
    Set own_enemies_ = 0;
    std::array<Place, EliminationOrder::kMostNeighbours> places_;
    std::vector<Child> children_;
    std::vector<Slot> slots_;
    std::int64_t steps_ = 0;
};

/// nullopt also when the order takes much longer than those of narrow problems do.
std::optional<EliminationOrder> short_order(const LabelingProblem& problem, const RowSystem& rows,
                                            RunControl& control, EliminationRule rule) {
    const std::int64_t per_label = rule == EliminationRule::Degree ? 30 : 500;
    RunControl::Cap cap(control, 1000 + per_label * problem.label_count());
    return elimination_order(problem, rows, control, rule);
}

}  // namespace

std::optional<TreeResult> treewidth_search(const LabelingProblem& problem, RunControl& control,
                                           const TreewidthOptions& options,
                                           TreewidthStatistics* statistics) {
    const RowSystem rows(problem);
    for (std::int32_t row = 0; row < rows.row_count(); ++row) {
        if (rows.terms(row).empty() && rows.right_hand_side(row) < 0) return TreeResult{};
    }
    RunControl::Cap cap(control, options.most_ticks + options.most_ticks / 2);
    const auto most = static_cast<double>(options.most_ticks);
    for (EliminationRule rule : {EliminationRule::Degree, EliminationRule::Fill}) {
        const auto order = short_order(problem, rows, control, rule);
        if (!order) break;
        TreewidthSearch search(problem, rows, control, *order);
        const double ticks = search.plan(options);
        if (ticks > kFillGain * most) break;
        // A better order costs about as much as this.
        const bool is_quick = ticks < kQuickTicksPerLabel * problem.label_count();
        const bool is_last = rule == EliminationRule::Fill;
        if (search.is_small() && (is_quick || (is_last && ticks <= most))) {
            return search.run(statistics);
        }
    }
    return std::nullopt;
}

std::optional<TreeResult> treewidth_search(const LabelingProblem& problem, const RowSystem& rows,
                                           const EliminationOrder& order, RunControl& control,
                                           const TreewidthOptions& options) {
    TreewidthSearch search(problem, rows, control, order);
    const double ticks = search.plan(options);
    if (!search.is_small() || ticks > static_cast<double>(options.most_ticks)) return std::nullopt;
    return search.run(nullptr);
}

}  // namespace labeling
