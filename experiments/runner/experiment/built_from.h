#pragma once

namespace experiment {

/// Of the sources at the time when this program was built, which may lie behind what stands in the
/// folder now: commit, and "yes" or "no"; "unknown" where git could not tell. See built_from.cmake.
extern const char* const kBuiltFromCommit;
extern const char* const kBuiltFromChangedSources;

}  // namespace experiment
