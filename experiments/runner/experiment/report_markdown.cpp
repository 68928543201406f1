// GitHub-flavoured Markdown of a report's document. Solvers say what they like, so every text is
// escaped.
#include "experiment/report_markdown.h"

#include <algorithm>
#include <sstream>

namespace experiment {
namespace {

constexpr std::size_t kLongRows = 60;

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (std::string_view("\\`*_[]<>|#~").find(c) != std::string_view::npos) result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result;
}

class MarkdownWriter {
public:
    explicit MarkdownWriter(const std::set<std::string>& plots) : plots_(plots) {}

    std::string write(const Document& document) {
        out_ << "# " << escaped(document.title) << "\n\n";
        if (document.is_alarm) out_ << "> 🔴 **";
        out_ << escaped(document.lead) << (document.is_alarm ? "**\n\n" : "\n\n");
        for (const Section& section : document.sections) {
            out_ << "## " << escaped(section.title) << "\n\n";
            for (const Block& block : section.blocks) {
                std::visit([this](const auto& b) { add(b); }, block);
            }
        }
        std::string text = out_.str();
        while (text.ends_with("\n\n")) text.pop_back();
        return text;
    }

private:
    void add(const Paragraph& paragraph) { out_ << escaped(paragraph.text) << "\n\n"; }

    void add(const BulletList& list) {
        for (const std::string& item : list.items) out_ << "- " << escaped(item) << "\n";
        out_ << "\n";
    }

    void add(const CommandLine& command) { out_ << "```\n" << command.text << "\n```\n\n"; }

    void add(const Figure& figure) {
        if (!plots_.contains(figure.name)) return;
        out_ << "![" << escaped(figure.name) << "](plots/" << figure.name << ".svg)\n\n";
        out_ << "*" << escaped(figure.caption) << "*\n\n";
    }

    void add(const Table& table) {
        if (!table.caption.empty()) out_ << "*" << escaped(table.caption) << "*\n\n";
        for (const std::string& column : table.columns) out_ << "| " << escaped(column) << " ";
        out_ << "|\n";
        for (std::size_t k = 0; k < table.columns.size(); ++k) {
            out_ << (is_number_column(table, k) ? "|---:" : "|---");
        }
        out_ << "|\n";
        const std::size_t shown =
            table.is_long ? std::min(kLongRows, table.rows.size()) : table.rows.size();
        for (std::size_t r = 0; r < shown; ++r) {
            for (const TableCell& cell : table.rows[r]) {
                const std::string text = escaped(cell.text);
                out_ << "| " << (cell.is_best ? "**" + text + "**" : text) << " ";
            }
            out_ << "|\n";
        }
        out_ << "\n";
        if (shown < table.rows.size()) {
            out_ << table.rows.size() - shown << " more rows are in report.html and the CSV "
                 << "files.\n\n";
        }
    }

    static bool is_number_column(const Table& table, std::size_t column) {
        return std::any_of(table.rows.begin(), table.rows.end(),
                           [&](const auto& row) { return row[column].number.has_value(); });
    }

    const std::set<std::string>& plots_;
    std::ostringstream out_;
};

}  // namespace

std::string to_markdown(const Document& document, const std::set<std::string>& plots) {
    return MarkdownWriter(plots).write(document);
}

}  // namespace experiment
