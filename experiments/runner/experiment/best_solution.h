#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace experiment {

/// The best labels that any run of a campaign found, per problem: FOLDER/best/HASH.sol.gz.
std::filesystem::path best_solution_file(const std::filesystem::path& folder,
                                         const std::string& hash);

/// Value of what is kept there, by its first line; nothing when there is none.
std::optional<std::int64_t> best_solution_value(const std::filesystem::path& folder,
                                                const std::string& hash);

/// Keeps a solution file when it is worth more than what is kept. `value` has been checked.
void keep_if_best(const std::filesystem::path& folder, const std::string& hash,
                  const std::filesystem::path& solution, std::int64_t value);

}  // namespace experiment
