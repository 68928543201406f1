// OPB, the pseudo-Boolean format: minimises the negated objective over x1, x2, ...; labels come
// first, then one variable per bonus, linked as in the linear model. Only >= and = exist, so <= is
// written negated and comes back as >=: the same labelings with the same values, not the same
// bytes. Comments say what OPB cannot: `* labels N`, and `* conflicts`, `* links`, `* rules` before
// the rows of each kind. Without them every variable is a label, and rows "at most one" are
// conflicts. One statement per line.
#include <algorithm>
#include <limits>

#include "labeling/errors.h"
#include "labeling/formats_detail.h"
#include "labeling/text_file.h"

namespace labeling::detail {
namespace {

class OpbReader {
public:
    OpbReader(std::string_view text, std::string_view source)
        : reader_(text, source), source_(source), most_variables_(text.size()) {}

    LabelingProblem run() {
        while (reader_.next()) {
            const auto& words = reader_.words();
            if (words.empty()) continue;
            if (words[0].starts_with('*')) {
                comment();
                continue;
            }
            for (std::string_view word : words) {
                const bool is_last = word.ends_with(';');
                if (is_last) word.remove_suffix(1);
                if (!word.empty()) statement_.push_back(word);
                if (is_last) end_statement();
            }
        }
        if (!statement_.empty()) throw InputError(source_ + ": no ';': the file is cut short");
        if (label_count_ > static_cast<std::int64_t>(most_variables_)) {
            throw InputError(source_ + ": " + std::to_string(label_count_) +
                             " labels exceed the file's length");
        }
        if (label_count_ > 0) know(label_count_);
        for (std::size_t c = 0; c < model_.columns.size(); ++c) {
            model_.columns[c].name = "x" + std::to_string(c + 1);
            model_.columns[c].is_binary =
                label_count_ < 0 || c < static_cast<std::size_t>(label_count_);
        }
        return problem_from_model(model_, source_);
    }

private:
    enum class Section { Unknown, Conflicts, Links, Rules };

    void comment() {
        const auto& words = reader_.words();
        if (words.size() < 2) return;
        if (words[1] == "labels") {
            if (label_count_ >= 0) reader_.fail("second comment 'labels'");
            label_count_ = reader_.integer(2, "number of labels");
            if (label_count_ < 0) reader_.fail("negative number of labels");
        } else if (words[1] == "conflicts") {
            section_ = Section::Conflicts;
        } else if (words[1] == "links") {
            section_ = Section::Links;
        } else if (words[1] == "rules") {
            section_ = Section::Rules;
        }
    }

    void know(std::int64_t variable) {
        if (static_cast<std::size_t>(variable) > model_.columns.size()) {
            model_.columns.resize(static_cast<std::size_t>(variable));
        }
    }

    std::int64_t integer(std::string_view word, std::string_view what) const {
        std::int64_t value = 0;
        const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (error != std::errc() || end != digits.data() + digits.size()) {
            reader_.fail(std::string(what) + " '" + std::string(word) + "' is not an integer");
        }
        if (value > kMaxTotal || value < -kMaxTotal) {
            reader_.fail("the " + std::string(what) + " exceeds 2^53");
        }
        return value;
    }

    std::int32_t variable(std::string_view word) {
        if (word.starts_with('~')) reader_.fail("negated variables are not supported");
        if (!word.starts_with('x')) reader_.fail("'" + std::string(word) + "' is no variable");
        const std::int64_t number = integer(word.substr(1), "variable");
        if (number < 1 || number > static_cast<std::int64_t>(most_variables_)) {
            reader_.fail("variable '" + std::string(word) + "' is out of range");
        }
        know(number);
        return static_cast<std::int32_t>(number - 1);
    }

    void end_statement() {
        if (statement_.empty()) reader_.fail("empty statement");
        if (statement_[0] == "min:") {
            objective();
        } else {
            row();
        }
        statement_.clear();
    }

    void objective() {
        if (has_objective_ || !model_.rows.empty()) reader_.fail("'min:' must come first and once");
        has_objective_ = true;
        if (statement_.size() % 2 == 0) reader_.fail("coefficient without a variable");
        for (std::size_t k = 1; k < statement_.size(); k += 2) {
            const std::int64_t coefficient = integer(statement_[k], "coefficient");
            const std::int32_t column = variable(statement_[k + 1]);
            Value& weight = model_.columns[column].objective;
            if (weight != 0) {
                reader_.fail("variable '" + std::string(statement_[k + 1]) + "' is given twice");
            }
            weight = -coefficient;
        }
    }

    void row() {
        if (statement_.size() < 2 || statement_.size() % 2 != 0) {
            reader_.fail("expected '<coefficient> <variable> ... >= <number> ;'");
        }
        const std::string_view relation = statement_[statement_.size() - 2];
        if (relation != ">=" && relation != "=") {
            reader_.fail("relation '" + std::string(relation) + "' is not >= or =");
        }
        ModelRow row;
        row.right_hand_side = integer(statement_.back(), "right-hand side");
        row.relation = relation == "=" ? Relation::Equal : Relation::GreaterEqual;
        bool is_all_minus_one = true;
        for (std::size_t k = 0; k + 2 < statement_.size(); k += 2) {
            const std::int64_t coefficient = integer(statement_[k], "coefficient");
            const std::int32_t column = variable(statement_[k + 1]);
            if (coefficient != 0) row.terms.push_back({coefficient, column});
            is_all_minus_one = is_all_minus_one && coefficient == -1;
        }
        const bool is_at_most_one = relation == ">=" && row.terms.size() >= 2 &&
                                    row.right_hand_side == -1 && is_all_minus_one;
        const bool is_conflict =
            is_at_most_one && (section_ == Section::Conflicts || section_ == Section::Unknown);
        if (section_ == Section::Conflicts && !is_conflict) {
            reader_.fail("a row under 'conflicts' is not of the form -1 x -1 x >= -1");
        }
        if (is_conflict || section_ == Section::Links) {
            row.relation = Relation::LessEqual;
            row.right_hand_side = -row.right_hand_side;
            for (ModelTerm& t : row.terms) t.coefficient = -t.coefficient;
        }
        const std::string name = (is_conflict ? "x" : "r") + std::to_string(model_.rows.size() + 1);
        model_.rows.push_back({name, std::move(row), reader_.line_number()});
    }

    LineReader reader_;
    std::string source_;
    std::size_t most_variables_;  ///< a variable that is used takes bytes: bounds what we allocate
    NamedModel model_;
    std::vector<std::string_view> statement_;
    std::int64_t label_count_ = -1;
    Section section_ = Section::Unknown;
    bool has_objective_ = false;
};

void append_term(std::string& out, std::int64_t coefficient, std::int32_t column) {
    if (coefficient >= 0) out += '+';
    append(out, coefficient);
    out += " x";
    append(out, column + 1);
    out += ' ';
}

const char* section_name(RowKind kind) {
    return kind == RowKind::Conflict    ? "* conflicts\n"
           : kind == RowKind::BonusLink ? "* links\n"
                                        : "* rules\n";
}

}  // namespace

LabelingProblem parse_opb(std::string_view text, std::string_view source) {
    return OpbReader(text, source).run();
}

std::string format_opb(const LinearModel& model) {
    if (model.label_count == 0) throw InputError("an OPB file needs at least one label");
    std::string out = "* #variable= " + std::to_string(model.column_count()) +
                      " #constraint= " + std::to_string(model.rows.size()) + "\n* labels " +
                      std::to_string(model.label_count) + "\nmin: ";
    for (std::int32_t c = 0; c < model.column_count(); ++c) {
        if (model.objective[c] != 0) append_term(out, -model.objective[c], c);
    }
    out += ";\n";
    for (std::size_t r = 0; r < model.rows.size(); ++r) {
        const ModelRow& row = model.rows[r];
        if (r == 0 || row.kind != model.rows[r - 1].kind) out += section_name(row.kind);
        const std::int64_t sign = row.relation == Relation::LessEqual ? -1 : 1;
        for (const ModelTerm& t : row.terms) append_term(out, sign * t.coefficient, t.column);
        if (row.terms.empty()) append_term(out, 0, 0);
        out += row.relation == Relation::Equal ? "= " : ">= ";
        append(out, sign * row.right_hand_side);
        out += " ;\n";
    }
    return out;
}

}  // namespace labeling::detail
