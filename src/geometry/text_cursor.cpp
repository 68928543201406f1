#include "geometry/text_cursor.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "geometry/errors.h"

namespace fcn {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0'; }
bool is_newline(char c) { return c == '\n' || c == '\r'; }

}  // namespace

bool is_word(std::string_view token) {
    return !token.empty() && std::isalpha(static_cast<unsigned char>(token.front())) &&
           token != "nan" && token != "inf";
}

std::string shown(std::string_view token) {
    constexpr std::size_t kLongest = 40;
    std::string text(1, '\'');
    for (char c : token.substr(0, kLongest)) text.push_back(c < 32 || c > 126 ? '?' : c);
    if (token.size() > kLongest) text.append(3, '.');
    text.push_back('\'');
    return text;
}

TextCursor::TextCursor(std::string_view text, std::string source, char comment)
    : text_(text), source_(std::move(source)), comment_(comment) {}

void TextCursor::fail(const std::string& message) const {
    throw InputError(source_ + ":" + std::to_string(line_) + ": " + message);
}

void TextCursor::skip_newline() {
    if (text_[position_] == '\r' && position_ + 1 < text_.size() && text_[position_ + 1] == '\n') {
        ++position_;
    }
    ++position_;
    ++line_;
}

/// Skips blanks, comments and (OBJ) lines continued by a backslash; true if a token follows on the
/// current line.
bool TextCursor::skip_blanks() {
    while (position_ < text_.size()) {
        const char c = text_[position_];
        if (is_blank(c)) {
            ++position_;
        } else if (c == comment_ && comment_ != '\0') {
            while (position_ < text_.size() && !is_newline(text_[position_])) ++position_;
        } else if (c == '\\' && position_ + 1 < text_.size() && is_newline(text_[position_ + 1])) {
            ++position_;
            skip_newline();
        } else {
            return !is_newline(c);
        }
    }
    return false;
}

std::string_view TextCursor::token_on_line() {
    if (!skip_blanks()) return {};
    const std::size_t begin = position_;
    while (position_ < text_.size() && !is_blank(text_[position_]) &&
           !is_newline(text_[position_]) && (comment_ == '\0' || text_[position_] != comment_)) {
        ++position_;
    }
    return text_.substr(begin, position_ - begin);
}

std::string_view TextCursor::token() {
    while (!skip_blanks()) {
        if (position_ >= text_.size()) return {};
        skip_newline();
    }
    return token_on_line();
}

std::string_view TextCursor::peek() {
    while (!skip_blanks()) {
        if (position_ >= text_.size()) return {};
        skip_newline();
    }
    const std::size_t begin = position_;
    const std::string_view next = token_on_line();
    position_ = begin;
    return next;
}

std::string_view TextCursor::rest_of_line() {
    if (!skip_blanks()) return {};
    const std::size_t begin = position_;
    std::size_t end = begin;
    while (position_ < text_.size() && !is_newline(text_[position_])) {
        if (comment_ != '\0' && text_[position_] == comment_) break;
        if (!is_blank(text_[position_])) end = position_ + 1;
        ++position_;
    }
    return text_.substr(begin, end - begin);
}

void TextCursor::skip_line() {
    while (position_ < text_.size() && !is_newline(text_[position_])) ++position_;
    if (position_ < text_.size()) skip_newline();
}

double TextCursor::parse_number(std::string_view token, std::string_view what) const {
    if (token.empty()) fail("the file ends or the line breaks off before " + std::string(what));
    std::string_view digits = token;
    if (digits.front() == '+') digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range) {
        // from_chars does not tell overflow from underflow; strtod does.
        value = std::strtod(std::string(digits).c_str(), nullptr);
    } else if (error != std::errc() || end != digits.data() + digits.size()) {
        fail("expected " + std::string(what) + ", a number, found " + shown(token));
    }
    if (!std::isfinite(value)) fail(std::string(what) + " is not finite: " + shown(token));
    return value;
}

std::int64_t TextCursor::parse_integer(std::string_view token, std::string_view what) const {
    if (token.empty()) fail("the file ends or the line breaks off before " + std::string(what));
    std::string_view digits = token;
    if (digits.front() == '+') digits.remove_prefix(1);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size()) {
        fail("expected " + std::string(what) + ", an integer, found " + shown(token));
    }
    return value;
}

double TextCursor::number(std::string_view what) { return parse_number(token(), what); }
double TextCursor::number_on_line(std::string_view what) {
    return parse_number(token_on_line(), what);
}
Eigen::Vector3d TextCursor::point(std::string_view what) {
    const double x = number(what), y = number(what), z = number(what);
    return {x, y, z};
}

Eigen::Vector3d TextCursor::point_on_line(std::string_view what) {
    const double x = number_on_line(what), y = number_on_line(what), z = number_on_line(what);
    return {x, y, z};
}

std::int64_t TextCursor::integer(std::string_view what) { return parse_integer(token(), what); }
std::int64_t TextCursor::integer_on_line(std::string_view what) {
    return parse_integer(token_on_line(), what);
}

std::size_t TextCursor::count(std::string_view what, std::size_t bytes_each) {
    const std::int64_t value = integer(what);
    if (value < 0) fail(std::string(what) + " is negative: " + std::to_string(value));
    if (static_cast<std::uint64_t>(value) > remaining() / bytes_each + 1) {
        fail(std::string(what) + " is " + std::to_string(value) + ", but only " +
             std::to_string(remaining()) + " bytes follow: the file is truncated or damaged");
    }
    return static_cast<std::size_t>(value);
}

void TextCursor::expect(std::string_view word) {
    const std::string_view found = token();
    if (found != word) {
        fail("expected " + shown(word) + ", found " +
             (found.empty() ? std::string("the end of the file") : shown(found)));
    }
}

}  // namespace fcn
