// Free MPS. Minimises the negated objective: OBJSENSE is not understood everywhere. The header
// reads `NAME x FREE` because CBC takes the file for fixed MPS otherwise.
#include <unordered_map>
#include <unordered_set>

#include "labeling/errors.h"
#include "labeling/formats_detail.h"
#include "labeling/text_file.h"

namespace labeling::detail {
namespace {

class MpsReader {
public:
    MpsReader(std::string_view text, std::string_view source)
        : reader_(text, source), source_(source) {}

    LabelingProblem run() {
        bool has_end = false;
        while (!has_end && reader_.next()) {
            const auto& words = reader_.words();
            if (words.empty() || reader_.line()[0] == '*') continue;
            if (reader_.line()[0] != ' ' && reader_.line()[0] != '\t') {
                section_ = words[0];
                if (section_ == "ENDATA") has_end = true;
                const bool is_known = has_end || section_ == "NAME" || section_ == "ROWS" ||
                                      section_ == "COLUMNS" || section_ == "RHS" ||
                                      section_ == "BOUNDS";
                if (!is_known) reader_.fail("unknown section '" + section_ + "'");
                continue;
            }
            record();
        }
        if (!has_end) throw InputError(source_ + ": no ENDATA: the file is cut short");
        for (std::size_t c = 0; c < model_.columns.size(); ++c) {
            if (!is_bounded_[c]) {
                throw InputError(source_ + ": column " + model_.columns[c].name +
                                 " has no upper bound 1");
            }
        }
        return problem_from_model(model_, source_);
    }

private:
    void record() {
        if (section_ == "ROWS") {
            add_row();
        } else if (section_ == "COLUMNS") {
            add_entries();
        } else if (section_ == "RHS") {
            const auto& words = reader_.words();
            if (words.size() % 2 == 0) reader_.fail("expected '<set> <row> <value> ...'");
            for (std::size_t k = 1; k < words.size(); k += 2) {
                const std::int64_t value = reader_.integer(k + 1, "right-hand side");
                const std::int32_t row = find_row(words[k]);
                if (row < 0) reader_.fail("a constant in the objective is not supported");
                if (!has_side_.insert(row).second) {
                    reader_.fail("row '" + model_.rows[row].name + "' has two right-hand sides");
                }
                model_.rows[row].row.right_hand_side = value;
            }
        } else if (section_ == "BOUNDS") {
            add_bound();
        } else {
            reader_.fail("record outside of a section");
        }
    }

    void add_row() {
        const auto& words = reader_.words();
        if (words.size() != 2) reader_.fail("expected '<N|L|G|E> <row>'");
        if (rows_.contains(std::string(words[1]))) {
            reader_.fail("row '" + std::string(words[1]) + "' is given twice");
        }
        if (words[0] == "N") {
            if (!objective_.empty()) reader_.fail("second objective row");
            objective_ = words[1];
            rows_[objective_] = -1;
            return;
        }
        NamedModel::Row row;
        row.name = words[1];
        row.line = reader_.line_number();
        if (words[0] == "L") {
            row.row.relation = Relation::LessEqual;
        } else if (words[0] == "G") {
            row.row.relation = Relation::GreaterEqual;
        } else if (words[0] == "E") {
            row.row.relation = Relation::Equal;
        } else {
            reader_.fail("row type '" + std::string(words[0]) + "' is not N, L, G or E");
        }
        rows_[row.name] = static_cast<std::int32_t>(model_.rows.size());
        model_.rows.push_back(std::move(row));
    }

    void add_entries() {
        const auto& words = reader_.words();
        if (words.size() == 3 && words[1] == "'MARKER'") {
            is_integer_ = words[2] == "'INTORG'";
            return;
        }
        if (words.size() % 2 == 0 || words.size() < 3) {
            reader_.fail("expected '<column> <row> <value> ...'");
        }
        const std::string name(words[0]);
        if (model_.columns.empty() || model_.columns.back().name != name) {
            if (columns_.contains(name)) reader_.fail("column '" + name + "' is split");
            columns_[name] = static_cast<std::int32_t>(model_.columns.size());
            model_.columns.push_back({name, 0, is_integer_});
            is_bounded_.push_back(0);
            has_objective_ = false;
        }
        const auto column = static_cast<std::int32_t>(model_.columns.size() - 1);
        for (std::size_t k = 1; k < words.size(); k += 2) {
            const std::int64_t value = reader_.integer(k + 1, "coefficient");
            const std::int32_t row = find_row(words[k]);
            if (row >= 0) {
                model_.rows[row].row.terms.push_back({value, column});
            } else if (value < -kMaxTotal || value > kMaxTotal) {
                reader_.fail("the objective coefficient exceeds 2^53");
            } else if (has_objective_) {
                reader_.fail("column '" + name + "' is twice in the objective");
            } else {
                model_.columns[column].objective = -value;
                has_objective_ = true;
            }
        }
    }

    void add_bound() {
        const auto& words = reader_.words();
        if (words.size() < 3) reader_.fail("expected '<type> <set> <column> [<value>]'");
        const auto it = columns_.find(std::string(words[2]));
        if (it == columns_.end()) reader_.fail("unknown column '" + std::string(words[2]) + "'");
        if (words[0] == "BV") {
            model_.columns[it->second].is_binary = true;
        } else if (words[0] != "UP" || reader_.integer(3, "bound") != 1) {
            reader_.fail("only the bounds 'BV' and 'UP ... 1' are supported");
        }
        is_bounded_[it->second] = 1;
    }

    std::int32_t find_row(std::string_view name) const {
        const auto it = rows_.find(std::string(name));
        if (it == rows_.end()) reader_.fail("unknown row '" + std::string(name) + "'");
        return it->second;
    }

    LineReader reader_;
    std::string source_, section_, objective_;
    NamedModel model_;
    std::unordered_map<std::string, std::int32_t> rows_, columns_;
    std::vector<std::uint8_t> is_bounded_;
    std::unordered_set<std::int32_t> has_side_;  ///< rows
    bool is_integer_ = false;
    bool has_objective_ = false;  ///< the current column
};

}  // namespace

LabelingProblem parse_mps(std::string_view text, std::string_view source) {
    return MpsReader(text, source).run();
}

std::string format_mps(const LinearModel& model) {
    std::vector<std::vector<std::pair<std::size_t, std::int64_t>>> entries(model.column_count());
    std::string out = "* minimises the negated value of a labeling problem\nNAME labeling FREE\n";
    out += "ROWS\n N value\n";
    for (std::size_t r = 0; r < model.rows.size(); ++r) {
        const Relation relation = model.rows[r].relation;
        out += relation == Relation::LessEqual ? " L "
               : relation == Relation::Equal   ? " E "
                                               : " G ";
        out += model.row_name(r) + "\n";
        for (const ModelTerm& t : model.rows[r].terms) {
            entries[t.column].emplace_back(r, t.coefficient);
        }
    }
    out += "COLUMNS\n M1 'MARKER' 'INTORG'\n";
    for (std::int32_t c = 0; c < model.column_count(); ++c) {
        if (c == model.label_count) out += " M2 'MARKER' 'INTEND'\n";
        const std::string name = " " + model.column_name(c) + " ";
        out += name + "value ";
        append(out, -model.objective[c]);
        out += '\n';
        for (const auto& [row, coefficient] : entries[c]) {
            out += name + model.row_name(row) + ' ';
            append(out, coefficient);
            out += '\n';
        }
    }
    if (model.column_count() == model.label_count) out += " M2 'MARKER' 'INTEND'\n";
    out += "RHS\n";
    for (std::size_t r = 0; r < model.rows.size(); ++r) {
        if (model.rows[r].right_hand_side == 0) continue;
        out += " RHS " + model.row_name(r) + ' ';
        append(out, model.rows[r].right_hand_side);
        out += '\n';
    }
    out += "BOUNDS\n";
    for (std::int32_t c = 0; c < model.column_count(); ++c) {
        out += c < model.label_count ? " BV BND " + model.column_name(c) + "\n"
                                     : " UP BND " + model.column_name(c) + " 1\n";
    }
    return out + "ENDATA\n";
}

}  // namespace labeling::detail
