#include "experiment/config_table.h"

#include <charconv>
#include <cmath>

#include "labeling/errors.h"

namespace experiment {
namespace {

std::string plain(const toml::node& node) {
    if (const auto* text = node.as_string()) return text->get();
    if (const auto* number = node.as_integer()) return std::to_string(number->get());
    if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
    if (const auto* number = node.as_floating_point()) {
        char digits[40];
        const auto [end, error] = std::to_chars(digits, digits + sizeof digits, number->get());
        return {digits, error == std::errc() ? end : digits};
    }
    return {};
}

}  // namespace

void ConfigTable::fail(const toml::node* where, const std::string& message) const {
    const auto line = where != nullptr ? where->source().begin.line : table_.source().begin.line;
    throw labeling::InputError(file_ + ":" + std::to_string(line) + ": " + message);
}

const toml::node* ConfigTable::node(const char* key) {
    known_.insert(key);
    return table_.get(key);
}

std::string ConfigTable::text(const char* key, const std::string& otherwise) {
    const toml::node* value = node(key);
    if (value == nullptr) return otherwise;
    if (!value->is_string()) fail(value, std::string(key) + " is not a text");
    return value->as_string()->get();
}

std::string ConfigTable::required_text(const char* key) {
    const std::string result = text(key, "");
    if (result.empty()) fail(node(key), name_ + " needs " + key);
    return result;
}

bool ConfigTable::flag(const char* key, bool otherwise) {
    const toml::node* value = node(key);
    if (value == nullptr) return otherwise;
    if (!value->is_boolean()) fail(value, std::string(key) + " is not true or false");
    return value->as_boolean()->get();
}

double ConfigTable::real(const char* key, double otherwise, double least, double most) {
    const toml::node* value = node(key);
    if (value == nullptr) return otherwise;
    const std::optional<double> number = value->value<double>();
    if (!number || value->is_boolean()) fail(value, std::string(key) + " is not a number");
    if (!(*number >= least && *number <= most)) {
        fail(value, std::string(key) + ": " + plain(*value) + " is not between " +
                        plain(toml::value(least)) + " and " + plain(toml::value(most)));
    }
    return *number;
}

std::int64_t ConfigTable::integer(const char* key, std::int64_t otherwise, std::int64_t least,
                                  std::int64_t most) {
    const double number = real(key, static_cast<double>(otherwise), static_cast<double>(least),
                               static_cast<double>(most));
    if (number != std::floor(number)) fail(node(key), std::string(key) + " is not an integer");
    return static_cast<std::int64_t>(number);
}

std::int64_t ConfigTable::mebibytes(const char* key, std::int64_t otherwise) {
    constexpr std::int64_t kMost = std::int64_t{1} << 30;
    const toml::node* value = node(key);
    if (value == nullptr || !value->is_string()) return integer(key, otherwise, 1, kMost);
    const std::string words = value->as_string()->get();
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(words.data(), words.data() + words.size(), number);
    const std::string unit(end, words.data() + words.size());
    const std::int64_t factor = unit == "MiB" ? 1 : unit == "GiB" ? 1024 : 0;
    if (error != std::errc() || factor == 0 || number < 1 || number > kMost / factor) {
        fail(value, std::string(key) + ": '" + words + "' is not a size such as 512MiB or 4GiB");
    }
    return number * factor;
}

std::vector<std::string> ConfigTable::texts(const char* key, std::vector<std::string> otherwise) {
    const toml::node* value = node(key);
    if (value == nullptr) return otherwise;
    if (value->is_string()) return {value->as_string()->get()};
    if (!value->is_array()) fail(value, std::string(key) + " is not a list of texts");
    std::vector<std::string> result;
    for (const toml::node& item : *value->as_array()) {
        if (!item.is_string()) fail(&item, std::string(key) + ": not a text");
        result.push_back(item.as_string()->get());
    }
    if (result.empty()) fail(value, std::string(key) + " is empty");
    return result;
}

std::vector<std::uint64_t> ConfigTable::seeds(const char* key,
                                              std::vector<std::uint64_t> otherwise) {
    const toml::node* value = node(key);
    if (value == nullptr) return otherwise;
    if (!value->is_array()) fail(value, std::string(key) + " is not a list of integers");
    std::vector<std::uint64_t> result;
    std::set<std::uint64_t> seen;
    for (const toml::node& item : *value->as_array()) {
        const auto* number = item.as_integer();
        if (number == nullptr || number->get() < 0) {
            fail(&item, std::string(key) + ": not an integer of at least 0");
        }
        result.push_back(static_cast<std::uint64_t>(number->get()));
        if (!seen.insert(result.back()).second) {
            fail(&item, std::string(key) + ": " + plain(item) + " stands there twice");
        }
    }
    if (result.empty()) fail(value, std::string(key) + " is empty");
    return result;
}

std::vector<std::string> ConfigTable::plain_values(const char* key) {
    const toml::node* value = node(key);
    std::vector<std::string> result;
    if (value == nullptr) return result;
    if (const toml::array* list = value->as_array()) {
        for (const toml::node& item : *list) result.push_back(plain(item));
    } else {
        result.push_back(plain(*value));
    }
    for (const std::string& item : result) {
        if (item.empty()) fail(value, std::string(key) + " is neither a number nor a text");
    }
    if (result.empty()) fail(value, std::string(key) + " is empty");
    return result;
}

const toml::table* ConfigTable::table(const char* key) {
    const toml::node* value = node(key);
    if (value == nullptr) return nullptr;
    if (!value->is_table()) fail(value, std::string(key) + " is not a table");
    return value->as_table();
}

std::vector<const toml::table*> ConfigTable::tables(const char* key) {
    const toml::node* value = node(key);
    std::vector<const toml::table*> result;
    if (value == nullptr) return result;
    if (!value->is_array()) fail(value, std::string("write [[") + key + "]]");
    for (const toml::node& item : *value->as_array()) {
        if (!item.is_table()) fail(&item, std::string("write [[") + key + "]]");
        result.push_back(item.as_table());
    }
    return result;
}

std::vector<std::string> ConfigTable::keys() const {
    std::vector<std::string> result;
    for (const auto& [key, value] : table_) result.emplace_back(key.str());
    return result;
}

void ConfigTable::finish() const {
    for (const auto& [key, value] : table_) {
        if (known_.contains(key.str())) continue;
        std::string names;
        for (const std::string& name : known_) names += (names.empty() ? "" : ", ") + name;
        fail(&value,
             "unknown key '" + std::string(key.str()) + "' in " + name_ + "; known: " + names);
    }
}

}  // namespace experiment
