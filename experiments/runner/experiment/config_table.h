#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace experiment {

/// A table of a TOML file that remembers what was asked for, so that whatever nobody asked for is
/// an error: a misspelt key must not pass. All functions throw InputError "file:line: ...".
class ConfigTable {
public:
    ConfigTable(const toml::table& table, std::string file, std::string name)
        : table_(table), file_(std::move(file)), name_(std::move(name)) {}

    bool has(const char* key) { return node(key) != nullptr; }
    std::string text(const char* key, const std::string& otherwise);
    std::string required_text(const char* key);
    bool flag(const char* key, bool otherwise);
    double real(const char* key, double otherwise, double least, double most);
    std::int64_t integer(const char* key, std::int64_t otherwise, std::int64_t least,
                         std::int64_t most);
    /// An integer, or a text such as "4GiB"; in MiB.
    std::int64_t mebibytes(const char* key, std::int64_t otherwise);
    /// A list of texts, or one text.
    std::vector<std::string> texts(const char* key, std::vector<std::string> otherwise);
    /// Non-negative integers, not empty, none twice.
    std::vector<std::uint64_t> seeds(const char* key, std::vector<std::uint64_t> otherwise);
    /// The value, or each value of a list, as text.
    std::vector<std::string> plain_values(const char* key);
    const toml::table* table(const char* key);
    /// Tables of a list [[key]].
    std::vector<const toml::table*> tables(const char* key);
    std::vector<std::string> keys() const;

    /// Throws on the first key that nobody asked for.
    void finish() const;
    int line() const { return static_cast<int>(table_.source().begin.line); }
    [[noreturn]] void fail(const toml::node* where, const std::string& message) const;
    const toml::node* node(const char* key);

private:
    const toml::table& table_;
    std::string file_, name_;
    std::set<std::string, std::less<>> known_;
};

}  // namespace experiment
