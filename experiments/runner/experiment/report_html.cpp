// The report as one page that can be mailed, archived and read offline: no address of anything
// outside is in it. Pictures are base64, so that nothing of theirs can break the page.
#include "experiment/report_html.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "experiment/report_html_style.h"

namespace experiment {
namespace {

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string sort_number(double number) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", number);
    if (std::isinf(number)) return number > 0 ? "1e300" : "-1e300";
    return text;
}

class HtmlWriter {
public:
    explicit HtmlWriter(const std::map<std::string, std::string>& plots) : plots_(plots) {}

    std::string write(const Document& document) {
        is_alarm_ = document.is_alarm;
        out_ << "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
             << "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
             << "<title>" << escaped(document.title) << "</title>\n<style>" << kReportStyle
             << "</style>\n</head>\n<body>\n<h1>" << escaped(document.title) << "</h1>\n<p class=\""
             << (is_alarm_ ? "alarm" : "lead") << "\">" << escaped(document.lead) << "</p>\n";
        if (document.sections.size() > 2) write_navigation(document);
        for (const Section& section : document.sections) write_section(section);
        out_ << "<script>" << kReportScript << "</script>\n</body>\n</html>\n";
        return out_.str();
    }

private:
    void write_navigation(const Document& document) {
        out_ << "<nav>\n";
        for (const Section& section : document.sections) {
            out_ << "<a href=\"#" << escaped(section.id) << "\">" << escaped(section.title)
                 << "</a>\n";
        }
        out_ << "</nav>\n";
    }

    void write_section(const Section& section) {
        out_ << "<section id=\"" << escaped(section.id) << "\">\n<h2>" << escaped(section.title)
             << "</h2>\n";
        bool is_in_figures = false;
        for (const Block& block : section.blocks) {
            const bool is_figure = std::holds_alternative<Figure>(block);
            if (is_figure != is_in_figures) {
                out_ << (is_figure ? "<div class=\"figures\">\n" : "</div>\n");
                is_in_figures = is_figure;
            }
            std::visit([this](const auto& b) { add(b); }, block);
        }
        out_ << (is_in_figures ? "</div>\n" : "") << "</section>\n";
    }

    void add(const Paragraph& paragraph) { out_ << "<p>" << escaped(paragraph.text) << "</p>\n"; }

    void add(const BulletList& list) {
        out_ << (is_alarm_ ? "<ul class=\"alarm-list\">\n" : "<ul>\n");
        for (const std::string& item : list.items) out_ << "<li>" << escaped(item) << "</li>\n";
        out_ << "</ul>\n";
    }

    void add(const CommandLine& command) { out_ << "<pre>" << escaped(command.text) << "</pre>\n"; }

    void add(const Figure& figure) {
        const auto it = plots_.find(figure.name);
        if (it == plots_.end()) return;
        out_ << "<figure><img src=\"data:image/svg+xml;base64," << base64(it->second) << "\" alt=\""
             << escaped(figure.caption) << "\"><figcaption>" << escaped(figure.caption)
             << "</figcaption></figure>\n";
    }

    void add(const Table& table) {
        if (table.is_long) {
            out_ << "<details>\n<summary>"
                 << escaped(table.caption.empty() ? "Table" : table.caption) << " ("
                 << table.rows.size() << " rows)</summary>\n";
        } else if (!table.caption.empty()) {
            out_ << "<p class=\"caption\">" << escaped(table.caption) << "</p>\n";
        }
        write_rows(table);
        if (table.is_long) out_ << "</details>\n";
    }

    void write_rows(const Table& table) {
        std::vector<bool> is_number(table.columns.size(), false);
        for (const auto& row : table.rows) {
            for (std::size_t k = 0; k < row.size(); ++k) {
                if (row[k].number) is_number[k] = true;
            }
        }
        out_ << "<div class=\"sheet\"><table>\n<thead><tr>";
        for (std::size_t k = 0; k < table.columns.size(); ++k) {
            out_ << (is_number[k] ? "<th class=\"n\">" : "<th>") << escaped(table.columns[k])
                 << "</th>";
        }
        out_ << "</tr></thead>\n<tbody>\n";
        for (const auto& row : table.rows) {
            out_ << "<tr>";
            for (std::size_t k = 0; k < row.size(); ++k) write_cell(row[k], is_number[k]);
            out_ << "</tr>\n";
        }
        out_ << "</tbody>\n</table></div>\n";
    }

    void write_cell(const TableCell& cell, bool is_number) {
        std::string classes = is_number ? "n" : "";
        if (cell.is_best) classes += classes.empty() ? "best" : " best";
        out_ << "<td";
        if (!classes.empty()) out_ << " class=\"" << classes << "\"";
        if (cell.number) out_ << " data-n=\"" << sort_number(*cell.number) << "\"";
        out_ << ">" << escaped(cell.text) << "</td>";
    }

    const std::map<std::string, std::string>& plots_;
    std::ostringstream out_;
    bool is_alarm_ = false;
};

}  // namespace

std::string base64(const std::string& bytes) {
    static const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    result.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        unsigned group = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            group =
                group << 8 | (k + i < bytes.size() ? static_cast<unsigned char>(bytes[k + i]) : 0);
        }
        for (std::size_t i = 0; i < 4; ++i) {
            result += k + i > bytes.size() ? '=' : kDigits[group >> (18 - 6 * i) & 63];
        }
    }
    return result;
}

std::string to_html(const Document& document, const std::map<std::string, std::string>& plots) {
    return HtmlWriter(plots).write(document);
}

}  // namespace experiment
