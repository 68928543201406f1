#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "labeling/problem.h"

namespace labeling {

/// Paper: one row per conflict, every rule. Strengthened: rows of cliques that cover the conflicts;
/// rules that the conflicts imply are left out.
enum class RowStyle { Paper, Strengthened };

enum class RowKind { Conflict, BonusLink, Rule };

struct ModelTerm {
    std::int64_t coefficient = 0;
    std::int32_t column = 0;
};

struct ModelRow {
    RowKind kind = RowKind::Rule;
    Relation relation = Relation::LessEqual;
    std::int64_t right_hand_side = 0;
    std::vector<ModelTerm> terms;
};

/// Mixed-integer program with the problem's optimum (maximised): columns 0 .. n-1 are the labels
/// (binary), column n + k is bonus k (continuous in [0, 1], integral once the labels are).
struct LinearModel {
    Label label_count = 0;
    std::vector<Bonus> bonuses;
    std::vector<Value> objective;  ///< per column
    std::vector<ModelRow> rows;

    std::int32_t column_count() const { return static_cast<std::int32_t>(objective.size()); }
    /// b1, b2, ... for labels, yI_J for the bonus of I and J; numbers from 1.
    std::string column_name(std::int32_t column) const;
    /// x1.. (conflicts and cliques), y1.. (bonus links), r1.. (rules), by position among all rows.
    std::string row_name(std::size_t row) const;
};

LinearModel linear_model(const LabelingProblem& problem, RowStyle style = RowStyle::Strengthened);

/// What a reader of a model file collects; line numbers are for messages.
struct NamedModel {
    struct Column {
        std::string name;
        Value objective = 0;  ///< maximised
        bool is_binary = false;
    };
    struct Row {
        std::string name;
        ModelRow row;
        std::size_t line = 0;
    };
    std::vector<Column> columns;
    std::vector<Row> rows;
};

/// Back to a labeling problem: binary columns become labels in order, continuous ones must be
/// bonuses linked by two rows y - b <= 0. Rows named x... with unit coefficients and right-hand
/// side 1 become conflicts, all others rules. Throws InputError "source:line: ...".
LabelingProblem problem_from_model(const NamedModel& model, const std::string& source);

}  // namespace labeling
