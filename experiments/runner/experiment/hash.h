#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace experiment {

inline std::string hexadecimal(std::uint64_t number) {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(number));
    return digits;
}

/// FNV-1a of 64 bits, as 16 hexadecimal digits: names content, protects against nothing.
inline std::string content_hash(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char c : text) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 0x100000001b3ULL;
    }
    return hexadecimal(hash);
}

}  // namespace experiment
