// Written by hand, since the solvers need no JSON library for anything else.
#include "tools/result_json.h"

#include <cmath>
#include <cstdio>
#include <optional>

namespace labeling {
namespace {

std::string quoted(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) {
            result += '?';  // messages may quote what a program printed, in any encoding
        } else {
            result += c;
        }
    }
    return result + '"';
}

std::string number(double value) {
    if (!std::isfinite(value)) return "null";
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

std::string number(const std::optional<Value>& value) {
    return value ? std::to_string(*value) : "null";
}

}  // namespace

std::string result_json(const SolveResult& result) {
    std::string text =
        "{\"solver\": " + quoted(result.solver) +
        ", \"status\": " + quoted(to_string(result.status)) +
        ", \"stop_reason\": " + quoted(to_string(result.stop_reason)) + ", \"value\": " +
        number(result.solution ? std::optional(result.solution->value) : std::nullopt) +
        ", \"bound\": " + number(result.bound) + ", \"work\": " + std::to_string(result.work) +
        ", \"seconds\": " + number(result.seconds) + ", \"message\": " + quoted(result.message) +
        ",\n\"statistics\": {";
    const char* separator = "";
    for (const auto& [key, value] : result.statistics) {
        text += separator + quoted(key) + ": " + number(value);
        separator = ", ";
    }
    text += "},\n\"trace\": [";
    separator = "";
    for (const TracePoint& p : result.trace) {
        text += separator + ("[" + number(p.seconds)) + ", " + std::to_string(p.work) + ", " +
                number(p.value) + ", " + number(p.bound) + "]";
        separator = ",\n";
    }
    return text + "]}\n";
}

}  // namespace labeling
