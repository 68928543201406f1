#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace fcn {

/// A place in a JSON document that knows the way there, so that a complaint can name its JSON
/// pointer without any place paying for it. Cursors refer to their parent: use them on the stack.
/// Every access throws InputError ("file: /arcs/3/pin: ...") when the value does not fit.
class JsonCursor {
public:
    JsonCursor(const nlohmann::json& root, std::string_view file) : value_(root), file_(file) {}

    /// Throws unless this is an object whose keys are all known.
    void expect_object(std::initializer_list<std::string_view> known_keys) const;
    /// Throws unless this is an array (of `size` elements if given).
    std::size_t expect_array() const;
    void expect_array(std::size_t size) const;

    JsonCursor element(std::size_t index) const { return {value_[index], file_, this, {}, index}; }
    bool has(std::string_view key) const { return value_.contains(key); }
    /// Throws if absent; call on an object.
    JsonCursor at(const char* key) const;

    bool is_null() const { return value_.is_null(); }
    double number() const;
    int integer(int least = std::numeric_limits<int>::min()) const;
    bool boolean() const;
    const std::string& string() const;

    /// "/arcs/3/pin"; empty at the root.
    std::string pointer() const;
    /// Throws InputError: file, pointer, `expected`, and the value found.
    [[noreturn]] void fail(std::string_view expected) const;

private:
    JsonCursor(const nlohmann::json& value, std::string_view file, const JsonCursor* parent,
               std::string_view key, std::size_t index)
        : value_(value), file_(file), parent_(parent), key_(key), index_(index) {}

    const nlohmann::json& value_;
    std::string_view file_;
    const JsonCursor* parent_ = nullptr;
    std::string_view key_;  ///< empty for an array element
    std::size_t index_ = 0;
};

}  // namespace fcn
