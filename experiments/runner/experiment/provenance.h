#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace experiment {

/// Where a record comes from: commit and whether the sources had changes, compiler and flags, hash
/// of the program that solves, versions of libraries, system, processor, host. Text throughout;
/// "unknown" where something cannot be found out.
nlohmann::json provenance(const std::filesystem::path& solve_program);

/// Versions of those of the named solvers that are programs, as they state them; "missing" where
/// there is none. Asks each of them, which takes a while.
nlohmann::json solver_versions(const std::set<std::string>& names);

}  // namespace experiment
