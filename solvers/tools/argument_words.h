#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "labeling/errors.h"

namespace labeling {

/// Walks over the words of a command line:  while (words.next()) if (words.is("--seed")) ...
/// Everything throws InputError that names the word.
class ArgumentWords {
public:
    ArgumentWords(int count, char** words) : words_(words + 1, words + count) {}

    /// Moves to the next word; false at the end.
    bool next() { return ++at_ <= words_.size(); }
    std::string_view word() const { return words_[at_ - 1]; }
    bool is(std::string_view name) const { return word() == name; }
    bool is_option() const { return word().starts_with("-") && word() != "-"; }

    /// The word behind the current one, which is taken with it.
    std::string_view value() {
        name_ = word();
        if (at_ >= words_.size()) fail(" needs a value");
        return words_[at_++];
    }
    double real() { return number<double>(" is not a number"); }
    /// Also written as 1e6.
    std::int64_t integer() {
        const double number = real();
        if (!(number > -9e15 && number < 9e15) ||
            number != static_cast<double>(static_cast<std::int64_t>(number))) {
            fail(" needs an integer");
        }
        return static_cast<std::int64_t>(number);
    }
    std::uint64_t seed() { return number<std::uint64_t>(" is not a seed"); }
    std::pair<std::string, std::string> key_and_value() {
        const std::string_view pair = value();
        const std::size_t at = pair.find('=');
        if (at == std::string_view::npos) fail(" needs KEY=VALUE");
        return {std::string(pair.substr(0, at)), std::string(pair.substr(at + 1))};
    }
    /// Parts between commas.
    std::vector<std::string> list() {
        std::vector<std::string> parts;
        const std::string_view text = value();
        for (std::size_t from = 0; from <= text.size();) {
            const std::size_t to = std::min(text.find(',', from), text.size());
            parts.emplace_back(text.substr(from, to - from));
            from = to + 1;
        }
        return parts;
    }

    [[noreturn]] void unknown() const {
        throw InputError("unknown argument '" + std::string(word()) + "'");
    }

private:
    template <class Number>
    Number number(const char* problem) {
        const std::string_view text = value();
        Number number{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error != std::errc() || end != text.data() + text.size()) {
            throw InputError(std::string(name_) + ": '" + std::string(text) + "'" + problem);
        }
        return number;
    }

    [[noreturn]] void fail(const char* problem) const {
        throw InputError(std::string(name_) + problem);
    }

    std::vector<std::string_view> words_;
    std::size_t at_ = 0;
    std::string_view name_;  ///< of the option whose value is taken
};

}  // namespace labeling
