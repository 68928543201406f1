#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fcn {

/// Encodes 8-bit RGB rows (3 * width * height bytes, top row first) as a PNG file. Same bytes for
/// the same pixels. Throws LogicError if libpng fails.
std::string encode_png(const std::vector<std::uint8_t>& rgb, int width, int height);

}  // namespace fcn
