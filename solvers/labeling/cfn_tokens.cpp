#include "labeling/cfn_tokens.h"

#include <algorithm>
#include <charconv>

#include "labeling/errors.h"

namespace labeling::detail {
namespace {

constexpr Value kMostCost = Value{1} << 55;

}  // namespace

std::string_view CfnTokens::word(std::string_view what) {
    if (kind_ != 'w') fail("expected " + std::string(what));
    const std::string_view result = word_;
    advance();
    return result;
}

bool CfnTokens::accept(char bracket) {
    if (kind_ != bracket) return false;
    advance();
    return true;
}

void CfnTokens::expect(char bracket) {
    if (!accept(bracket)) fail(std::string("expected '") + bracket + "'");
}

void CfnTokens::skip() {
    std::size_t depth = 0;
    do {
        if (is_end()) fail("the file is cut short");
        if (kind_ == '{' || kind_ == '[') ++depth;
        if ((kind_ == '}' || kind_ == ']') && depth-- == 0) fail("expected a value");
        advance();
    } while (depth > 0);
}

Value CfnTokens::integer_of(std::string_view text, std::string_view what) const {
    const std::string_view digits = text.substr(0, text.find('.'));
    const std::string_view fraction = text.substr(std::min(text.size(), digits.size() + 1));
    Value value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() ||
        fraction.find_first_not_of('0') != std::string_view::npos) {
        fail(std::string(what) + " '" + std::string(text) + "' is not an integer");
    }
    if (value > kMostCost || value < -kMostCost) {
        fail("the " + std::string(what) + " exceeds 2^55");
    }
    return value;
}

void CfnTokens::fail_at(std::size_t line, const std::string& message) const {
    throw InputError(source_ + ":" + std::to_string(line) + ": " + message);
}

void CfnTokens::advance() {
    constexpr std::string_view kBetween = " \t\r\n,:";
    while (at_ < text_.size() && kBetween.find(text_[at_]) != std::string_view::npos) {
        if (text_[at_++] == '\n') ++line_;
    }
    if (at_ == text_.size()) {
        kind_ = '\0';
        return;
    }
    kind_ = text_[at_];
    if (kind_ == '{' || kind_ == '}' || kind_ == '[' || kind_ == ']') {
        ++at_;
        return;
    }
    const bool is_quoted = kind_ == '"';
    kind_ = 'w';
    if (is_quoted) ++at_;
    const auto end = text_.find_first_of(is_quoted ? "\"\n" : " \t\r\n,:{}[]\"", at_);
    if (is_quoted && (end == std::string_view::npos || text_[end] == '\n')) {
        fail("a quotation has no end");
    }
    word_ = text_.substr(at_, end - at_);
    at_ = end == std::string_view::npos ? text_.size() : end + (is_quoted ? 1 : 0);
}

}  // namespace labeling::detail
