#include "network/json_cursor.h"

#include <algorithm>

#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr std::size_t kShownValue = 60;

/// A value short enough for one line of complaint; containers by kind and size alone.
std::string shown(const nlohmann::json& value) {
    if (value.is_array()) return "an array of " + std::to_string(value.size());
    if (value.is_object()) return "an object of " + std::to_string(value.size());
    std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    if (text.size() > kShownValue) text = text.substr(0, kShownValue) + "...";
    return text;
}

}  // namespace

std::string JsonCursor::pointer() const {
    if (!parent_) return "";
    std::string token = key_.empty() ? std::to_string(index_) : std::string(key_);
    return parent_->pointer() + "/" + token;
}

void JsonCursor::fail(std::string_view expected) const {
    const std::string where = pointer();
    throw InputError(std::string(file_) + ": " + (where.empty() ? "document" : where) +
                     ": expected " + std::string(expected) + ", found " + shown(value_));
}

void JsonCursor::expect_object(std::initializer_list<std::string_view> known_keys) const {
    if (!value_.is_object()) fail("an object");
    for (auto item = value_.begin(); item != value_.end(); ++item) {
        if (std::find(known_keys.begin(), known_keys.end(), item.key()) != known_keys.end())
            continue;
        throw InputError(std::string(file_) + ": " + pointer() + "/" +
                         item.key().substr(0, kShownValue) + ": unknown key");
    }
}

std::size_t JsonCursor::expect_array() const {
    if (!value_.is_array()) fail("an array");
    return value_.size();
}

void JsonCursor::expect_array(std::size_t size) const {
    if (!value_.is_array() || value_.size() != size) fail("an array of " + std::to_string(size));
}

JsonCursor JsonCursor::at(const char* key) const {
    const auto found = value_.find(key);
    if (found == value_.end())
        throw InputError(std::string(file_) + ": " + pointer() + "/" + key + ": missing");
    return {*found, file_, this, key, 0};
}

double JsonCursor::number() const {
    if (!value_.is_number()) fail("a number");
    return value_.get<double>();
}

int JsonCursor::integer(int least) const {
    const bool is_integer = value_.is_number_integer();
    const bool fits =
        is_integer && (!value_.is_number_unsigned() ||
                       value_.get<std::uint64_t>() <= std::numeric_limits<int>::max());
    if (!fits || value_.get<std::int64_t>() < least ||
        value_.get<std::int64_t>() < std::numeric_limits<int>::min())
        fail(least == std::numeric_limits<int>::min() ? std::string("an integer")
                                                      : "an integer >= " + std::to_string(least));
    return value_.get<int>();
}

bool JsonCursor::boolean() const {
    if (!value_.is_boolean()) fail("true or false");
    return value_.get<bool>();
}

const std::string& JsonCursor::string() const {
    if (!value_.is_string()) fail("a string");
    return value_.get_ref<const std::string&>();
}

}  // namespace fcn
