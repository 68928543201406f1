#include "report/html.h"

#include <cmath>
#include <cstdio>

#include "geometry/errors.h"

namespace fcn {

std::string escape_html(std::string_view text) {
    std::string escaped;
    escaped.reserve(text.size());
    for (const char c : text) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                // Control characters are not allowed in HTML at all.
                escaped += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? ' ' : c;
        }
    }
    return escaped;
}

std::string encode_base64(std::string_view bytes) {
    static constexpr char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string encoded;
    encoded.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) {
            return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
        };
        const unsigned group = byte(0) << 16 | byte(1) << 8 | byte(2);
        encoded += kDigits[group >> 18];
        encoded += kDigits[group >> 12 & 63];
        encoded += i + 1 < bytes.size() ? kDigits[group >> 6 & 63] : '=';
        encoded += i + 2 < bytes.size() ? kDigits[group & 63] : '=';
    }
    return encoded;
}

namespace {

const std::string kDash = "\u2013";

std::string print(const char* format, int digits, double value) {
    char buffer[400];
    const int size = std::snprintf(buffer, sizeof buffer, format, digits, value);
    return std::string(buffer, static_cast<std::size_t>(size));
}

}  // namespace

std::string format_number(double value, int digits) {
    return std::isfinite(value) ? print("%.*f", digits, value) : kDash;
}

std::string format_significant(double value, int digits) {
    return std::isfinite(value) ? print("%.*g", digits, value) : kDash;
}

std::string format_percent(double share, int digits) {
    return std::isfinite(share) ? print("%.*f", digits, 100 * share) + "\u00a0%" : kDash;
}

void HtmlWriter::start(const std::string& tag, const HtmlAttributes& attributes) {
    html_ += "<" + tag;
    for (const auto& [name, value] : attributes) {
        html_ += " ";
        html_ += name;
        html_ += "=\"";
        html_ += escape_html(value);
        html_ += "\"";
    }
    html_ += ">";
}

void HtmlWriter::open(const std::string& tag, const HtmlAttributes& attributes) {
    start(tag, attributes);
    open_.push_back(tag);
}

void HtmlWriter::close() {
    if (open_.empty()) throw LogicError("report: no element is open");
    html_ += "</" + open_.back() + ">\n";
    open_.pop_back();
}

void HtmlWriter::element(const std::string& tag, std::string_view content,
                         const HtmlAttributes& attributes) {
    open(tag, attributes);
    text(content);
    close();
}

void HtmlWriter::empty(const std::string& tag, const HtmlAttributes& attributes) {
    start(tag, attributes);
    html_ += "\n";
}

std::string HtmlWriter::finish() {
    while (!open_.empty()) close();
    return std::move(html_);
}

void write_table(HtmlWriter& html, const HtmlTable& table) {
    html.open("div", {{"class", "scroll"},
                      {"role", "region"},
                      {"tabindex", "0"},
                      {"aria-label", table.caption}});
    html.open("table");
    html.element("caption", table.caption);
    html.open("thead");
    html.open("tr");
    for (std::size_t i = 0; i < table.header.size(); ++i)
        html.element("th", table.header[i],
                     {{"scope", "col"}, {"class", i < table.text_columns ? "text" : "number"}});
    html.close();
    html.close();
    html.open("tbody");
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        const bool is_emphasized = r < table.is_emphasized.size() && table.is_emphasized[r];
        html.open("tr", is_emphasized ? HtmlAttributes{{"class", "emphasized"}} : HtmlAttributes{});
        for (std::size_t i = 0; i < table.rows[r].size(); ++i) {
            HtmlAttributes attributes{{"class", i < table.text_columns ? "text" : "number"}};
            if (i < table.row_headers) attributes.emplace_back("scope", "row");
            html.element(i < table.row_headers ? "th" : "td", table.rows[r][i], attributes);
        }
        html.close();
    }
    html.close();
    html.close();
    html.close();
}

}  // namespace fcn
