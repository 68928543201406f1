#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace experiment {

template <class Number>
nlohmann::json or_null(const std::optional<Number>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
}

}  // namespace experiment
