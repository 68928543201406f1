#pragma once

#include <charconv>
#include <concepts>
#include <string>
#include <string_view>

#include "geometry/mesh.h"

namespace fcn {

/// Builds a text in memory; numbers as short as they can be and still read back the same.
class TextWriter {
public:
    TextWriter& operator<<(std::string_view text) {
        text_ += text;
        return *this;
    }
    TextWriter& operator<<(char c) {
        text_ += c;
        return *this;
    }
    TextWriter& operator<<(double value) { return append(value); }
    template <std::integral Integer>
    TextWriter& operator<<(Integer value) {
        return append(value);
    }
    TextWriter& operator<<(const Vec3& point) {
        return *this << point.x() << ' ' << point.y() << ' ' << point.z();
    }
    std::string take() { return std::move(text_); }

private:
    template <typename Number>
    TextWriter& append(Number value) {
        char buffer[32];
        text_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
        return *this;
    }
    std::string text_;
};

}  // namespace fcn
