// Branch and bound that leaves a proof behind, in the format of VeriPB 2.0 (cutting planes with
// reverse unit propagation; Bogaerts, Gocht, McCreesh, Nordstroem 2023). A leaf is one line: the
// constraint "better than the best solution" plus multiples of the model's rows. The multipliers
// are the linear program's, rounded to integers; what they prove is computed again in exact
// integers before a line is written, so rounding costs strength, never truth. The sum contradicts
// the leaf's decisions, which gives a clause by propagation; two children's clauses give their
// parent's. At the root clique cuts come first: each pair of a clique's literals is a line, since
// propagation contradicts both together, and adding the literals one by one, dividing after each,
// gives "at most one". Other cuts, reductions and local search stay outside: they are either
// expressible at a price in lines or of no use in a proof, so the tree here is larger than that of
// branch and cut.
#include "labeling/proving_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "labeling/clique_cuts.h"
#include "labeling/errors.h"
#include "labeling/propagation.h"
#include "labeling/rows.h"
#include "labeling/term_graph.h"

namespace labeling {
namespace {

__extension__ using Wide = __int128;

constexpr double kIntegral = 1e-6;
constexpr Value kLargestSum = Value{1} << 50;
constexpr Value kLargestScale = Value{1} << 20;
/// Multipliers of an infeasible program have no scale of their own.
constexpr double kRayScale = 1 << 20;
constexpr int kMostRounds = 40;

/// A row as the linear program has it, sum <= right_hand_side, and its number in the proof.
struct LpRow {
    std::vector<ModelTerm> terms;
    std::int64_t right_hand_side = 0;
    std::int64_t id = 0;
};

/// Rows of the model; an equality is two constraints of the proof, first >=, then <=.
std::vector<LpRow> lp_rows(const LinearModel& model, std::int64_t& last_id) {
    std::vector<LpRow> rows;
    last_id = 0;
    for (const ModelRow& row : model.rows) {
        LpRow at_most{row.terms, row.right_hand_side, 0};
        LpRow at_least{row.terms, -row.right_hand_side, 0};
        for (ModelTerm& t : at_least.terms) t.coefficient = -t.coefficient;
        if (row.relation != Relation::LessEqual) {
            at_least.id = ++last_id;
            rows.push_back(std::move(at_least));
        }
        if (row.relation != Relation::GreaterEqual) {
            at_most.id = ++last_id;
            rows.push_back(std::move(at_most));
        }
    }
    return rows;
}

class ProvingSearch {
public:
    ProvingSearch(const LabelingProblem& problem, const LpFactory& lp, const ProofOptions& options)
        : problem_(problem),
          options_(options),
          model_(linear_model(problem, RowStyle::Strengthened)),
          rows_(lp_rows(model_, last_id_)),
          engine_(lp()),
          fixed_(model_.column_count(), -1) {
        Value sum = 1;
        for (Value c : model_.objective) sum += std::abs(c);
        scale_ = std::clamp<Value>(kLargestSum / sum, 1, kLargestScale);
        const std::vector<double> lower(model_.column_count(), 0), upper(lower.size(), 1);
        const std::vector<double> objective(model_.objective.begin(), model_.objective.end());
        engine_->reset(objective, lower, upper);
        std::vector<LpEngine::Entry> entries;
        for (const LpRow& row : rows_) {
            entries.clear();
            for (const ModelTerm& t : row.terms) {
                entries.push_back({t.column, static_cast<double>(t.coefficient)});
            }
            engine_->add_row(entries, static_cast<double>(row.right_hand_side));
        }
        for (std::int32_t c = 0; c < model_.column_count(); ++c) {
            is_used_.push_back(model_.objective[c] != 0);
        }
        for (const LpRow& row : rows_) {
            for (const ModelTerm& t : row.terms) is_used_[t.column] = true;
            if (row.terms.empty()) is_used_[0] = true;  // OPB has it as 0 x1
        }
        engine_->stop_when([this] { return options_.stop.stop_requested(); });
        out_ = "pseudo-Boolean proof version 2.0\nf " + std::to_string(last_id_) + "\n";
    }

    ProofResult run(const std::optional<Solution>& known) {
        if (known) improve(known->labels);
        cut_root();
        const std::int64_t id = prove();
        ProofResult result;
        result.nodes = nodes_;
        if (id < 0) return result;
        out_ += "output NONE\n";
        if (best_) {
            const std::string value = std::to_string(-best_->value);
            out_ += "conclusion BOUNDS " + value + " " + value + "\n";
        } else {
            out_ += "conclusion BOUNDS INF INF\n";
        }
        out_ += "end pseudo-Boolean proof\n";
        result.proof = std::move(out_);
        result.solution = best_;
        result.is_complete = true;
        return result;
    }

private:
    static std::string literal(std::int32_t column, bool is_true) {
        return (is_true ? "x" : "~x") + std::to_string(column + 1);
    }

    /// Logs a solution; the constraint "better than it" gets the next number.
    void improve(const std::vector<std::uint8_t>& labels) {
        Solution solution{labels, 0};
        const SolutionCheck check = check_solution(problem_, solution);
        if (!check.is_feasible) throw LogicError("proof from a solution that is infeasible");
        solution.value = check.value;
        out_ += "soli";
        for (std::int32_t c = 0; c < model_.column_count(); ++c) {
            if (is_used_[c]) out_ += " " + literal(c, value_of(c, labels));
        }
        out_ += "\n";
        better_id_ = ++last_id_;
        best_ = std::move(solution);
    }

    bool value_of(std::int32_t column, const std::vector<std::uint8_t>& labels) const {
        if (column < model_.label_count) return labels[column] != 0;
        const Bonus& bonus = model_.bonuses[column - model_.label_count];
        return labels[bonus.first] != 0 && labels[bonus.second] != 0;
    }

    bool must_stop() const {
        return options_.stop.stop_requested() || out_.size() > options_.most_bytes ||
               (options_.node_limit && nodes_ >= *options_.node_limit);
    }

    /// Number of a constraint that contradicts the decisions; -1 when stopped.
    std::int64_t prove() {
        if (must_stop()) return -1;
        ++nodes_;
        const LpEngine::Outcome outcome = engine_->solve(1'000'000);
        if (outcome == LpEngine::Outcome::Optimal) {
            if (const auto id = close_by_bound()) return *id;
        } else if (outcome == LpEngine::Outcome::Infeasible) {
            if (const auto id = close_by_ray()) return *id;
        }
        const std::int32_t column = outcome == LpEngine::Outcome::Optimal ? most_fractional() : -1;
        if (column < 0 && outcome == LpEngine::Outcome::Optimal && found_better()) return prove();
        return branch(column >= 0 ? column : first_free());
    }

    // ---- root -------------------------------------------------------------------------------

    /// Columns count from 1; negative: the label is off.
    using Literal = std::int32_t;

    void cut_root() {
        const RowSystem rows(problem_);
        Propagator propagator(problem_, rows);
        if (!propagator.propagate_all()) return;
        const TermGraph graph(problem_, propagator);
        CliqueSeparator separator(problem_, graph);
        double last = std::numeric_limits<double>::infinity();
        for (int round = 0, stalled = 0; round < kMostRounds && stalled < 3; ++round) {
            if (must_stop() || engine_->solve(1'000'000) != LpEngine::Outcome::Optimal) break;
            const auto x = engine_->columns();
            double bound = 0;
            for (std::int32_t c = 0; c < model_.column_count(); ++c) {
                bound += static_cast<double>(model_.objective[c]) * x[c];
            }
            if (best_ && bound < static_cast<double>(best_->value) + 1 - kIntegral) break;
            stalled = last - bound < 1e-5 * std::abs(bound) ? stalled + 1 : 0;
            last = bound;
            const std::vector<Cut> cuts = separator.separate(x, {});
            if (cuts.empty()) break;
            for (const Cut& cut : cuts) derive(cut);
        }
        for (const auto& [pair, id] : pairs_) out_ += "del id " + std::to_string(id) + "\n";
        pairs_.clear();
    }

    /// A clique row: its literals, at most one of which is true.
    void derive(const Cut& cut) {
        std::vector<Literal> literals;
        LpRow row;
        for (const Cut::Entry& e : cut.entries) {
            if (std::abs(e.coefficient) != 1) return;
            literals.push_back(e.coefficient > 0 ? e.column + 1 : -(e.column + 1));
            row.terms.push_back({e.coefficient, e.column});
        }
        if (literals.size() < 2) return;
        row.right_hand_side = cut.right_hand_side;
        std::vector<std::int64_t> ids;  // by the later literal, then the earlier one
        for (std::size_t b = 1; b < literals.size(); ++b) {
            for (std::size_t a = 0; a < b; ++a) ids.push_back(pair_id(literals[a], literals[b]));
        }
        out_ += "pol " + std::to_string(ids[0]);
        for (std::size_t b = 2, k = 1; b < literals.size(); ++b) {
            const std::string count = std::to_string(b);
            if (b > 2) out_ += " " + std::to_string(b - 1) + " *";
            for (std::size_t a = 0; a < b; ++a) out_ += " " + std::to_string(ids[k++]) + " +";
            out_ += " " + count + " d";
        }
        out_ += "\n";
        row.id = ++last_id_;
        std::vector<LpEngine::Entry> entries;
        for (const ModelTerm& t : row.terms) {
            entries.push_back({t.column, static_cast<double>(t.coefficient)});
        }
        engine_->add_row(entries, static_cast<double>(row.right_hand_side));
        rows_.push_back(std::move(row));
    }

    std::int64_t pair_id(Literal a, Literal b) {
        const auto [it, is_new] = pairs_.try_emplace(std::minmax(a, b), last_id_ + 1);
        if (is_new) {
            out_ += "rup 1 " + literal(std::abs(a) - 1, a < 0) + " 1 " +
                    literal(std::abs(b) - 1, b < 0) + " >= 1 ;\n";
            ++last_id_;
        }
        return it->second;
    }

    // ---- tree -------------------------------------------------------------------------------

    std::int64_t branch(std::int32_t column) {
        // Every label decided: the rows themselves, or "better", contradict by propagation.
        if (column < 0) return clause();
        std::int64_t children[2];
        for (const int value : {1, 0}) {
            decide(column, value);
            children[value] = prove();
            undo(column);
            if (children[value] < 0) return -1;
        }
        const std::int64_t id = clause();
        out_ += "del id " + std::to_string(children[1]) + " " + std::to_string(children[0]) + "\n";
        return id;
    }

    void decide(std::int32_t column, int value) {
        fixed_[column] = static_cast<std::int8_t>(value);
        decisions_.push_back(column);
        engine_->set_bounds(column, value, value);
    }

    void undo(std::int32_t column) {
        fixed_[column] = -1;
        decisions_.pop_back();
        engine_->set_bounds(column, 0, 1);
    }

    /// "One of the decisions is wrong", by reverse unit propagation.
    std::int64_t clause() {
        out_ += "rup";
        for (std::int32_t column : decisions_) out_ += " 1 " + literal(column, !fixed_[column]);
        out_ += " >= 1 ;\n";
        return ++last_id_;
    }

    std::optional<std::int64_t> close_by_bound() {
        if (!best_) return std::nullopt;
        std::vector<std::int64_t> multipliers;
        for (double m : engine_->multipliers()) {
            multipliers.push_back(std::llround(std::max(0.0, m) * static_cast<double>(scale_)));
        }
        return close(scale_, multipliers);
    }

    /// The ray's sign is the engine's secret: both are tried.
    std::optional<std::int64_t> close_by_ray() {
        const std::vector<double> ray = engine_->infeasibility_ray();
        double largest = 0;
        for (double r : ray) largest = std::max(largest, std::abs(r));
        if (largest == 0) return std::nullopt;
        for (const double sign : {1.0, -1.0}) {
            std::vector<std::int64_t> multipliers;
            for (double r : ray) {
                multipliers.push_back(std::llround(std::max(0.0, sign * r / largest) * kRayScale));
            }
            if (const auto id = close(0, multipliers)) return id;
        }
        return std::nullopt;
    }

    /// Writes better * "better" + sum of multiplier * row if it contradicts the decisions.
    std::optional<std::int64_t> close(std::int64_t better,
                                      const std::vector<std::int64_t>& multipliers) {
        std::vector<Wide> coefficients(model_.column_count(), 0);
        Wide degree = 0;
        if (better > 0) {
            for (std::int32_t c = 0; c < model_.column_count(); ++c) {
                coefficients[c] = static_cast<Wide>(better) * model_.objective[c];
            }
            degree = static_cast<Wide>(better) * (best_->value + 1);
        }
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            if (multipliers[r] == 0) continue;
            for (const ModelTerm& t : rows_[r].terms) {
                coefficients[t.column] -= static_cast<Wide>(multipliers[r]) * t.coefficient;
            }
            degree -= static_cast<Wide>(multipliers[r]) * rows_[r].right_hand_side;
        }
        Wide most = 0;
        for (std::int32_t c = 0; c < model_.column_count(); ++c) {
            const bool is_counted = fixed_[c] < 0 ? coefficients[c] > 0 : fixed_[c] == 1;
            if (is_counted) most += coefficients[c];
        }
        if (most >= degree) return std::nullopt;
        out_ += "pol";
        bool is_first = true;
        const auto add = [&](std::int64_t id, std::int64_t multiplier) {
            out_ += " " + std::to_string(id) + " " + std::to_string(multiplier) + " *";
            if (!is_first) out_ += " +";
            is_first = false;
        };
        if (better > 0) add(better_id_, better);
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            if (multipliers[r] > 0) add(rows_[r].id, multipliers[r]);
        }
        out_ += "\n";
        const std::int64_t sum = ++last_id_;
        const std::int64_t id = clause();
        out_ += "del id " + std::to_string(sum) + "\n";
        return id;
    }

    std::int32_t most_fractional() const {
        const auto x = engine_->columns();
        std::int32_t best = -1;
        double score = 0;
        for (std::int32_t c = 0; c < model_.label_count; ++c) {
            const double distance = std::min(x[c], 1 - x[c]);
            if (fixed_[c] >= 0 || distance < kIntegral) continue;
            const double s = distance * (1 + static_cast<double>(problem_.conflicts_of(c).size()));
            if (s > score) {
                score = s;
                best = c;
            }
        }
        return best;
    }

    std::int32_t first_free() const {
        for (std::int32_t c = 0; c < model_.label_count; ++c) {
            if (fixed_[c] < 0 && is_used_[c]) return c;
        }
        return -1;
    }

    /// The linear program's solution is integral: logs it if it is feasible and better.
    bool found_better() {
        const auto x = engine_->columns();
        Solution solution;
        for (std::int32_t c = 0; c < model_.label_count; ++c) {
            solution.labels.push_back(x[c] > 0.5 ? 1 : 0);
        }
        const SolutionCheck check = check_solution(problem_, solution);
        if (!check.is_feasible || (best_ && check.value <= best_->value)) return false;
        improve(solution.labels);
        return true;
    }

    const LabelingProblem& problem_;
    const ProofOptions& options_;
    const LinearModel model_;
    std::int64_t last_id_ = 0;
    std::vector<LpRow> rows_;                                    ///< of the model, then cuts
    std::map<std::pair<Literal, Literal>, std::int64_t> pairs_;  ///< numbers of their lines
    std::unique_ptr<LpEngine> engine_;
    std::vector<std::int8_t> fixed_;
    std::vector<bool> is_used_;  ///< columns that the OPB file mentions
    std::vector<std::int32_t> decisions_;
    Value scale_ = 1;
    std::optional<Solution> best_;
    std::int64_t better_id_ = 0;
    std::int64_t nodes_ = 0;
    std::string out_;
};

}  // namespace

ProofResult prove_optimality(const LabelingProblem& problem, const std::optional<Solution>& known,
                             const LpFactory& lp, const ProofOptions& options) {
    if (!lp) throw InputError("a proof needs a linear-programming engine");
    if (problem.label_count() == 0) throw InputError("a proof needs at least one label");
    return ProvingSearch(problem, lp, options).run(known);
}

}  // namespace labeling
