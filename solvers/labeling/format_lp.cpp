// CPLEX LP: Maximize, Subject To, Bounds, Binary, End; lines of at most about 200 characters, since
// some readers have a limit. Every label appears in the objective, also with 0, which fixes the
// order of the columns; a rule without terms is written as 0 times the first label. GLPK takes no
// empty section: a problem without rows gets a trivial one named `none`, which reading drops.
#include <unordered_map>

#include "labeling/errors.h"
#include "labeling/formats_detail.h"
#include "labeling/text_file.h"

namespace labeling::detail {
namespace {

constexpr std::size_t kLineLength = 200;
constexpr std::string_view kNoRow = "none";

enum class Section { None, Objective, Rows, Bounds, Binary, End };

class LpReader {
public:
    LpReader(std::string_view text, std::string_view source)
        : reader_(text, source), source_(source) {}

    LabelingProblem run() {
        while (section_ != Section::End && reader_.next()) {
            const auto& words = reader_.words();
            if (words.empty() || words[0][0] == '\\') continue;
            if (enter_section()) continue;
            for (position_ = 0; position_ < words.size();) word();
        }
        if (section_ != Section::End) throw InputError(source_ + ": no End: the file is cut short");
        std::erase_if(model_.rows, [](const NamedModel::Row& row) {
            return row.name == kNoRow && row.row.terms.empty() && row.row.right_hand_side == 0;
        });
        return problem_from_model(model_, source_);
    }

private:
    bool enter_section() {
        const std::string_view line = reader_.rest(0);
        const Section before = section_;
        if (line == "Maximize") {
            section_ = Section::Objective;
        } else if (line == "Subject To") {
            section_ = Section::Rows;
        } else if (line == "Bounds") {
            section_ = Section::Bounds;
        } else if (line == "Binary") {
            section_ = Section::Binary;
        } else if (line == "End") {
            section_ = Section::End;
        } else {
            if (section_ == Section::None) reader_.fail("expected 'Maximize'");
            return false;
        }
        if (section_ <= before) reader_.fail("section out of order");
        if (is_row_open_) reader_.fail("the row before this line has no right-hand side");
        return true;
    }

    void word() {
        const std::string_view w = reader_.words()[position_];
        switch (section_) {
            case Section::Objective:
            case Section::Rows:
                if (w.back() == ':') {
                    open(w.substr(0, w.size() - 1));
                } else if (w == "<=" || w == ">=" || w == "=") {
                    close(w);
                } else {
                    term();
                }
                return;
            case Section::Bounds:
                if (reader_.words().size() != 3 || reader_.words()[1] != "<=" ||
                    reader_.integer(2, "bound") != 1) {
                    reader_.fail("only bounds of the form '<column> <= 1' are supported");
                }
                known_column(w);
                position_ += 3;
                return;
            case Section::Binary:
                model_.columns[known_column(w)].is_binary = true;
                ++position_;
                return;
            default:
                reader_.fail("unexpected '" + std::string(w) + "'");
        }
    }

    void open(std::string_view name) {
        ++position_;
        if (section_ == Section::Objective) return;
        if (is_row_open_) reader_.fail("the row before this one has no right-hand side");
        model_.rows.push_back({std::string(name), {}, reader_.line_number()});
        is_row_open_ = true;
    }

    void close(std::string_view relation) {
        if (!is_row_open_) reader_.fail("right-hand side without a row");
        ModelRow& row = model_.rows.back().row;
        row.relation = relation == "<="   ? Relation::LessEqual
                       : relation == ">=" ? Relation::GreaterEqual
                                          : Relation::Equal;
        row.right_hand_side = reader_.integer(position_ + 1, "right-hand side");
        is_row_open_ = false;
        position_ += 2;
    }

    /// '[+|-] <coefficient> <column>'
    void term() {
        bool is_negative = false;
        const std::string_view sign = reader_.words()[position_];
        if (sign == "+" || sign == "-") {
            is_negative = sign == "-";
            ++position_;
        }
        std::int64_t coefficient = reader_.integer(position_, "coefficient");
        if (coefficient < -kMaxTotal || coefficient > kMaxTotal) {
            reader_.fail("the coefficient exceeds 2^53");
        }
        if (is_negative) coefficient = -coefficient;
        if (position_ + 1 >= reader_.words().size()) reader_.fail("coefficient without a column");
        const std::string_view name = reader_.words()[position_ + 1];
        position_ += 2;
        if (section_ == Section::Objective) {
            const auto [it, is_new] = columns_.emplace(
                std::string(name), static_cast<std::int32_t>(model_.columns.size()));
            if (!is_new) reader_.fail("column '" + it->first + "' is given twice");
            model_.columns.push_back({std::string(name), coefficient, false});
            return;
        }
        if (!is_row_open_) reader_.fail("term outside of a row");
        const std::int32_t column = known_column(name);
        if (coefficient != 0) model_.rows.back().row.terms.push_back({coefficient, column});
    }

    std::int32_t known_column(std::string_view name) const {
        const auto it = columns_.find(std::string(name));
        if (it == columns_.end()) {
            reader_.fail("column '" + std::string(name) + "' is not in the objective");
        }
        return it->second;
    }

    LineReader reader_;
    std::string source_;
    NamedModel model_;
    std::unordered_map<std::string, std::int32_t> columns_;
    Section section_ = Section::None;
    std::size_t position_ = 0;
    bool is_row_open_ = false;
};

/// Words with line breaks.
class LineWriter {
public:
    void begin(const std::string& text) {
        out_ += text;
        length_ = text.size();
    }
    void word(const std::string& text) {
        if (length_ + text.size() + 1 > kLineLength) {
            out_ += "\n ";
            length_ = 1;
        }
        out_ += ' ' + text;
        length_ += text.size() + 1;
    }
    void term(std::int64_t coefficient, const std::string& column) {
        word((coefficient < 0 ? "- " : "+ ") + std::to_string(std::abs(coefficient)) + " " +
             column);
    }
    void end() { out_ += '\n'; }
    std::string& text() { return out_; }

private:
    std::string out_;
    std::size_t length_ = 0;
};

}  // namespace

LabelingProblem parse_lp(std::string_view text, std::string_view source) {
    return LpReader(text, source).run();
}

std::string format_lp(const LinearModel& model) {
    if (model.label_count == 0) throw InputError("an LP file needs at least one label");
    LineWriter writer;
    writer.begin("Maximize\n value:");
    for (std::int32_t c = 0; c < model.column_count(); ++c) {
        writer.term(model.objective[c], model.column_name(c));
    }
    writer.begin("\nSubject To\n");
    for (std::size_t r = 0; r < model.rows.size(); ++r) {
        const ModelRow& row = model.rows[r];
        writer.begin(" " + model.row_name(r) + ":");
        for (const ModelTerm& t : row.terms)
            writer.term(t.coefficient, model.column_name(t.column));
        if (row.terms.empty()) writer.term(0, model.column_name(0));
        writer.word((row.relation == Relation::LessEqual ? "<= "
                     : row.relation == Relation::Equal   ? "= "
                                                         : ">= ") +
                    std::to_string(row.right_hand_side));
        writer.end();
    }
    if (model.rows.empty()) writer.begin(" none: + 0 b1 <= 0\n");
    if (!model.bonuses.empty()) writer.begin("Bounds\n");
    for (std::int32_t c = model.label_count; c < model.column_count(); ++c) {
        writer.begin(" " + model.column_name(c) + " <= 1\n");
    }
    writer.begin("Binary\n");
    for (std::int32_t c = 0; c < model.label_count; ++c) {
        writer.begin(" " + model.column_name(c) + "\n");
    }
    writer.begin("End\n");
    return std::move(writer.text());
}

}  // namespace labeling::detail
