// The labeling problem as a mixed-integer linear program: paper, section 5.3.2, equations (1)-(3)
// and (8)-(9), with one column per bonus instead of the paper's a_ij, and cliques instead of pairs
// in the strengthened form. Extraordinary nodes need no pseudo variables here: their rules arrive
// aggregated.
#include "labeling/linear_model.h"

#include <algorithm>
#include <limits>
#include <map>

#include "labeling/cliques.h"
#include "labeling/errors.h"

namespace labeling {
namespace {

/// A row of three or more unit terms <= k - 1 in which two labels are in conflict never binds.
bool is_implied_by_conflicts(const LabelingProblem& problem, const Rule& rule) {
    if (rule.relation != Relation::LessEqual || rule.terms.size() > 8) return false;
    for (const Term& t : rule.terms) {
        if (t.coefficient != 1) return false;
    }
    if (rule.right_hand_side < static_cast<std::int64_t>(rule.terms.size()) - 1) return false;
    for (std::size_t a = 0; a < rule.terms.size(); ++a) {
        for (std::size_t b = a + 1; b < rule.terms.size(); ++b) {
            if (problem.in_conflict(rule.terms[a].label, rule.terms[b].label)) return true;
        }
    }
    return false;
}

ModelRow clique_row(const std::vector<Label>& members) {
    ModelRow row{RowKind::Conflict, Relation::LessEqual, 1, {}};
    for (Label i : members) row.terms.push_back({1, i});
    return row;
}

}  // namespace

std::string LinearModel::column_name(std::int32_t column) const {
    if (column < label_count) return "b" + std::to_string(column + 1);
    const Bonus& b = bonuses[column - label_count];
    return "y" + std::to_string(b.first + 1) + "_" + std::to_string(b.second + 1);
}

std::string LinearModel::row_name(std::size_t row) const {
    const char* prefix = rows[row].kind == RowKind::Conflict    ? "x"
                         : rows[row].kind == RowKind::BonusLink ? "y"
                                                                : "r";
    return prefix + std::to_string(row + 1);
}

LinearModel linear_model(const LabelingProblem& problem, RowStyle style) {
    LinearModel model;
    model.label_count = problem.label_count();
    model.bonuses.assign(problem.bonuses().begin(), problem.bonuses().end());
    if (problem.bonus_count() >
        static_cast<std::size_t>(std::numeric_limits<Label>::max() - problem.label_count())) {
        throw InputError("the linear model would have more than 2^31 - 1 columns");
    }
    model.objective.assign(problem.weights().begin(), problem.weights().end());
    for (const Bonus& b : problem.bonuses()) model.objective.push_back(b.value);

    if (style == RowStyle::Paper) {
        for (const Conflict& c : problem.conflicts()) {
            model.rows.push_back(clique_row({c.first, c.second}));
        }
    } else {
        for (const auto& clique : conflict_clique_cover(problem)) {
            model.rows.push_back(clique_row(clique));
        }
    }
    for (std::size_t k = 0; k < model.bonuses.size(); ++k) {
        const auto column = static_cast<std::int32_t>(model.label_count + k);
        for (Label end : {model.bonuses[k].first, model.bonuses[k].second}) {
            model.rows.push_back(
                {RowKind::BonusLink, Relation::LessEqual, 0, {{1, column}, {-1, end}}});
        }
    }
    for (const Rule& rule : problem.rules()) {
        if (style == RowStyle::Strengthened && is_implied_by_conflicts(problem, rule)) continue;
        ModelRow row{RowKind::Rule, rule.relation, rule.right_hand_side, {}};
        for (const Term& t : rule.terms) row.terms.push_back({t.coefficient, t.label});
        model.rows.push_back(std::move(row));
    }
    return model;
}

namespace {

class ModelReader {
public:
    ModelReader(const NamedModel& model, const std::string& source)
        : model_(model),
          source_(source),
          label_of_(model.columns.size(), -1),
          links_(model.columns.size()) {}

    LabelingProblem run() {
        for (std::size_t c = 0; c < model_.columns.size(); ++c) {
            if (model_.columns[c].is_binary) {
                label_of_[c] = builder_.add_label(model_.columns[c].objective);
            }
        }
        for (const auto& row : model_.rows) {
            try {
                add(row);
            } catch (const InputError& error) {
                const std::string message = error.what();
                if (message.starts_with(source_)) throw;
                fail(row.line, message);
            }
        }
        add_bonuses();
        try {
            return builder_.build();
        } catch (const InputError& error) {
            throw InputError(source_ + ": " + error.what());
        }
    }

private:
    [[noreturn]] void fail(std::size_t line, const std::string& message) const {
        throw InputError(source_ + ":" + std::to_string(line) + ": " + message);
    }

    void add(const NamedModel::Row& named) {
        const ModelRow& row = named.row;
        std::vector<std::int32_t> continuous;
        for (const ModelTerm& t : row.terms) {
            if (label_of_[t.column] < 0) continuous.push_back(t.column);
        }
        if (!continuous.empty()) {
            add_link(named, continuous[0]);
        } else if (is_conflict(named)) {
            for (std::size_t a = 0; a < row.terms.size(); ++a) {
                for (std::size_t b = a + 1; b < row.terms.size(); ++b) {
                    builder_.add_conflict(label_of_[row.terms[a].column],
                                          label_of_[row.terms[b].column]);
                }
            }
        } else {
            add_rule(named);
        }
    }

    static bool is_conflict(const NamedModel::Row& named) {
        const ModelRow& row = named.row;
        return !named.name.empty() && named.name[0] == 'x' && row.terms.size() >= 2 &&
               row.relation == Relation::LessEqual && row.right_hand_side == 1 &&
               std::all_of(row.terms.begin(), row.terms.end(),
                           [](const ModelTerm& t) { return t.coefficient == 1; });
    }

    void add_link(const NamedModel::Row& named, std::int32_t bonus) {
        const ModelRow& row = named.row;
        const bool is_link = row.terms.size() == 2 && row.relation == Relation::LessEqual &&
                             row.right_hand_side == 0;
        if (is_link) {
            const std::size_t at = row.terms[0].column == bonus ? 0 : 1;
            const ModelTerm &y = row.terms[at], &b = row.terms[1 - at];
            if (y.coefficient == 1 && b.coefficient == -1 && label_of_[b.column] >= 0) {
                links_[bonus].push_back(label_of_[b.column]);
                return;
            }
        }
        fail(named.line, "row " + named.name + " uses the continuous column " +
                             model_.columns[bonus].name + " but is not of the form y - b <= 0");
    }

    void add_rule(const NamedModel::Row& named) {
        constexpr std::int64_t kLargest = std::numeric_limits<std::int32_t>::max();
        Rule rule{named.row.relation, named.row.right_hand_side, {}};
        for (const ModelTerm& t : named.row.terms) {
            if (t.coefficient < -kLargest || t.coefficient > kLargest) {
                fail(named.line,
                     "coefficient " + std::to_string(t.coefficient) + " exceeds 2^31 - 1");
            }
            rule.terms.push_back({static_cast<std::int32_t>(t.coefficient), label_of_[t.column]});
        }
        builder_.add_rule(std::move(rule));
    }

    void add_bonuses() {
        for (std::size_t c = 0; c < model_.columns.size(); ++c) {
            if (label_of_[c] >= 0) continue;
            const auto& column = model_.columns[c];
            if (links_[c].size() != 2) {
                throw InputError(source_ + ": continuous column " + column.name + " has " +
                                 std::to_string(links_[c].size()) +
                                 " rows y - b <= 0, a bonus has 2");
            }
            try {
                builder_.add_bonus(links_[c][0], links_[c][1], column.objective);
            } catch (const InputError& error) {
                throw InputError(source_ + ": column " + column.name + ": " + error.what());
            }
        }
    }

    const NamedModel& model_;
    const std::string& source_;
    std::vector<Label> label_of_;            ///< per column, -1 for bonuses
    std::vector<std::vector<Label>> links_;  ///< per column: the labels it is bounded by
    ProblemBuilder builder_;
};

}  // namespace

LabelingProblem problem_from_model(const NamedModel& model, const std::string& source) {
    return ModelReader(model, source).run();
}

}  // namespace labeling
