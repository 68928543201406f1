#pragma once

#include <iosfwd>
#include <string>
#include <string_view>

namespace fcn {

bool is_gzip(std::string_view content);

/// Throws InputError naming `source` when damaged or truncated.
std::string decompress(std::string_view content, const std::string& source);

/// gzip without a time stamp.
std::string compress(std::string_view content);

/// Everything a stream has to give, decompressed when gzip.
std::string read_content(std::istream& in, const std::string& source);

}  // namespace fcn
