#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fcn {

/// Text as it may stand between tags or in a quoted attribute.
std::string escape_html(std::string_view text);

std::string encode_base64(std::string_view bytes);

/// A number with `digits` after the point; a dash when not finite.
std::string format_number(double value, int digits);
/// Up to `digits` significant ones; a dash when not finite.
std::string format_significant(double value, int digits = 4);
/// A share of [0, 1] in percent; a dash when not finite.
std::string format_percent(double share, int digits = 1);

using HtmlAttributes = std::vector<std::pair<std::string, std::string>>;

/// Writes HTML whose tags balance by construction; every text and attribute is escaped.
class HtmlWriter {
public:
    void open(const std::string& tag, const HtmlAttributes& attributes = {});
    void close();
    void text(std::string_view content) { html_ += escape_html(content); }
    /// An element with text in it.
    void element(const std::string& tag, std::string_view content,
                 const HtmlAttributes& attributes = {});
    /// An element without content: img, br, meta.
    void empty(const std::string& tag, const HtmlAttributes& attributes = {});
    /// Content that is HTML already (style sheet, doctype).
    void raw(std::string_view html) { html_ += html; }
    /// Closes what is open and hands the document over.
    std::string finish();

private:
    void start(const std::string& tag, const HtmlAttributes& attributes);
    std::string html_;
    std::vector<std::string> open_;
};

/// A table of texts. Columns are headed; the first `row_headers` cells of a row head the row.
struct HtmlTable {
    std::string caption;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
    std::size_t row_headers = 1;
    std::size_t text_columns = 1;     ///< leading columns set flush left; the others are numbers
    std::vector<bool> is_emphasized;  ///< per row; may be shorter
};

/// In a frame that scrolls sideways on narrow screens and can be reached by keyboard.
void write_table(HtmlWriter& html, const HtmlTable& table);

}  // namespace fcn
