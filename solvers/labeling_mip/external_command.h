#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace labeling {

/// Words of a command template (see ExternalProgram::command) with `values` in place of the
/// placeholders; a known placeholder without a value is one with an empty text. Throws InputError
/// on an unknown placeholder, an open quote or bracket, and a placeholder without value outside [
/// ].
std::vector<std::string> command_words(std::string_view command,
                                       const std::map<std::string, std::string>& values);

}  // namespace labeling
