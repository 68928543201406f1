#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>

namespace fcn {

/// Walks through a text in memory token by token and knows the line it is on; every failure is an
/// InputError "source:line: what". The text must outlive it. Line ends: of Unix, DOS or old Macs.
class TextCursor {
public:
    /// From `comment` (0 = none) to the end of the line is skipped.
    TextCursor(std::string_view text, std::string source, char comment = '\0');

    /// The next token, on whichever line; empty at the end of the text.
    std::string_view token();
    /// The next token of the current line; empty when the line has no more.
    std::string_view token_on_line();
    /// The rest of the current line without comment and surrounding blanks; leaves the cursor at
    /// the line's end.
    std::string_view rest_of_line();
    /// Skips to the beginning of the next line.
    void skip_line();
    /// Looks at the next token without taking it.
    std::string_view peek();

    /// A finite number; `what` names it in the error message.
    double number(std::string_view what);
    double number_on_line(std::string_view what);
    /// Three numbers, each of which is `what`.
    Eigen::Vector3d point(std::string_view what);
    Eigen::Vector3d point_on_line(std::string_view what);
    std::int64_t integer(std::string_view what);
    std::int64_t integer_on_line(std::string_view what);
    /// A count of items of at least `bytes_each` bytes, checked against the bytes that are left, so
    /// that memory may be set aside for it.
    std::size_t count(std::string_view what, std::size_t bytes_each);
    void expect(std::string_view word);

    double parse_number(std::string_view token, std::string_view what) const;
    std::int64_t parse_integer(std::string_view token, std::string_view what) const;

    std::size_t line() const { return line_; }
    std::size_t offset() const { return position_; }
    std::size_t remaining() const { return text_.size() - position_; }
    std::string_view remaining_text() const { return text_.substr(position_); }
    const std::string& source() const { return source_; }
    [[noreturn]] void fail(const std::string& message) const;

private:
    bool skip_blanks();
    void skip_newline();

    std::string_view text_;
    std::string source_;
    std::size_t position_ = 0;
    std::size_t line_ = 1;
    char comment_;
};

/// Whether a token begins with a letter and is no number (nan, inf).
bool is_word(std::string_view token);

/// A token fit for a message: shortened, in quotes, control characters replaced.
std::string shown(std::string_view token);

}  // namespace fcn
