#include "experiment/report_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace experiment {
namespace {

constexpr const char* kDash = "–";

std::string formatted(const char* format, int digits, double number) {
    char text[64];
    std::snprintf(text, sizeof text, format, digits, number);
    return text;
}

/// Digits after the point that leave three significant ones.
int digits_for(double number) {
    if (number == 0) return 0;
    return std::clamp(2 - static_cast<int>(std::floor(std::log10(std::abs(number)))), 0, 4);
}

template <class Text>
std::string with_brackets(const Interval& interval, const Text& text) {
    std::string result = text(interval.estimate);
    if (interval.is_known) {
        result += " [" + text(interval.low) + ", " + text(interval.high) + "]";
    }
    return result;
}

}  // namespace

std::string decimal_text(double number, int digits) {
    if (std::isnan(number)) return kDash;
    if (std::isinf(number)) return number > 0 ? "∞" : "-∞";
    const std::string text = formatted("%.*f", digits, number);
    // -0.00 is a zero.
    const bool is_zero = text.find_first_of("123456789") == std::string::npos;
    return is_zero && text.front() == '-' ? text.substr(1) : text;
}

std::string seconds_text(double seconds) {
    if (std::isnan(seconds)) return kDash;
    if (seconds > 0 && seconds < 0.0005) return "<0.001";
    return decimal_text(seconds, std::min(3, digits_for(seconds)));
}

std::string percent_text(double share) {
    if (std::isnan(share)) return kDash;
    const double percent = 100 * share;
    if (percent == 0) return "0%";
    if (std::abs(percent) < 0.0005) return percent > 0 ? "<0.001%" : ">-0.001%";
    return decimal_text(percent, std::min(3, digits_for(percent))) + "%";
}

std::string ratio_text(double ratio) {
    if (std::isnan(ratio)) return kDash;
    return decimal_text(ratio, std::clamp(digits_for(ratio), 0, 3));
}

std::string number_text(double number) {
    if (number == 0) return "0";
    if (!std::isfinite(number)) return decimal_text(number, 0);
    return decimal_text(number, std::clamp(digits_for(number) + 1, 0, 3));
}

std::string count_text(double number) {
    if (std::isnan(number)) return kDash;
    std::string digits = decimal_text(std::abs(number), 0);
    for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3) {
        digits.insert(static_cast<std::size_t>(at), ",");
    }
    return (number < 0 ? "-" : "") + digits;
}

std::string percent_interval(const Interval& interval) {
    return with_brackets(interval, percent_text);
}
std::string seconds_interval(const Interval& interval) {
    return with_brackets(interval, seconds_text);
}
std::string ratio_interval(const Interval& interval) { return with_brackets(interval, ratio_text); }

}  // namespace experiment
