#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "labeling/problem.h"

namespace labeling::detail {

/// The brackets and words of a CFN file; blanks, commas and colons between them are skipped.
class CfnTokens {
public:
    CfnTokens(std::string_view text, std::string_view source) : text_(text), source_(source) {
        advance();
    }

    bool is_end() const { return kind_ == '\0'; }
    /// Line of the next token, from 1.
    std::size_t line() const { return line_; }
    const std::string& source() const { return source_; }

    /// Takes the next token; fails "expected <what>" when it is no word.
    std::string_view word(std::string_view what);
    /// Takes the next token if it is that bracket.
    bool accept(char bracket);
    void expect(char bracket);
    /// Takes a word, or a bracket with all that it holds.
    void skip();
    /// Takes a whole number of at most 2^55.
    Value integer(std::string_view what) { return integer_of(word(what), what); }
    /// A fraction of zeros is allowed.
    Value integer_of(std::string_view text, std::string_view what) const;

    /// InputError "source:line: message", of the next token's line or another.
    [[noreturn]] void fail(const std::string& message) const { fail_at(line_, message); }
    [[noreturn]] void fail_at(std::size_t line, const std::string& message) const;

private:
    void advance();

    std::string_view text_, word_;
    std::string source_;
    std::size_t at_ = 0, line_ = 1;
    char kind_ = '\0';  ///< a bracket, 'w' for a word, 0 at the end
};

}  // namespace labeling::detail
