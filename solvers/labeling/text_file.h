#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "labeling/errors.h"

namespace labeling {

/// Whole content of a file, decompressed when it is gzip. Throws InputError naming the file when it
/// cannot be read or its gzip data are damaged or cut short.
std::string read_text_file(const std::filesystem::path& file);

/// Writes to a hidden name in the same folder (.NAME, a number, .part) and renames; a pipe or
/// device is written directly, a link stays one. gzip when the name ends in `.gz` (no time stamp
/// inside: equal text gives equal bytes). Throws InputError naming the file.
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// Splits text into lines and lines into words, and knows where it is.
class LineReader {
public:
    LineReader(std::string_view text, std::string_view source) : text_(text), source_(source) {}

    /// Moves to the next line; false at the end.
    bool next();
    const std::vector<std::string_view>& words() const { return words_; }
    std::string_view line() const { return line_; }
    std::size_t line_number() const { return line_number_; }
    /// InputError "source:line: message".
    [[noreturn]] void fail(const std::string& message) const;
    /// Integer in word `index`; fails when missing, malformed or out of 64 bits.
    std::int64_t integer(std::size_t index, std::string_view what) const;
    double real(std::size_t index, std::string_view what) const;
    /// The line from word `index` to its end, blanks at the end removed.
    std::string_view rest(std::size_t index) const;

private:
    std::string_view text_, line_;
    std::string source_;
    std::vector<std::string_view> words_;
    std::size_t position_ = 0, line_number_ = 0;
};

}  // namespace labeling
