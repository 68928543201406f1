#include "app/length.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/command.h"
#include "meshing/remesh.h"

namespace fcn::app {

double Length::resolve(double diagonal) const {
    if (!is_percent) return value;
    if (!(diagonal > 0))
        throw UsageError(fmt::format(
            "{} is a share of the bounding-box diagonal, which is not known here: give the mesh, "
            "or a length in mesh units",
            text));
    return value / 100 * diagonal;
}

Length parse_length(const std::string& text, const std::string& option) {
    Length length{text, 0, !text.empty() && text.back() == '%'};
    const char* begin = text.data();
    const char* end = begin + text.size() - (length.is_percent ? 1 : 0);
    const auto [stop, error] = std::from_chars(begin, end, length.value);
    if (error != std::errc{} || stop != end || !std::isfinite(length.value))
        throw UsageError(fmt::format(
            "{}: '{}' is not a length (examples: 0.5 in mesh units, 2% of the diagonal)", option,
            text));
    if (!(length.value > 0))
        throw UsageError(fmt::format("{}: {} must be greater than 0", option, text));
    return length;
}

std::vector<std::string> split_list(const std::string& text, const std::string& option) {
    std::vector<std::string> entries{""};
    for (const char c : text) {
        if (c == ',')
            entries.emplace_back();
        else if (c != ' ')
            entries.back().push_back(c);
    }
    if (std::any_of(entries.begin(), entries.end(), [](const auto& e) { return e.empty(); }))
        throw UsageError(fmt::format("{}: empty entry in '{}'", option, text));
    return entries;
}

std::string ScaleRequest::label() const {
    return is_edge_length ? "edge " + length.text : length.text;
}

std::string ScaleRequest::folder() const {
    std::string name = length.text;
    if (length.is_percent) name.replace(name.size() - 1, 1, "pct");
    return is_edge_length ? "edge-" + name : name;
}

double resolve_scale(const ScaleRequest& request, double diagonal) {
    const double length = request.length.resolve(diagonal);
    const double rmin = request.is_edge_length ? length / kEdgeLengthFactor : length;
    if (diagonal > 0 && rmin > diagonal)
        throw UsageError(
            fmt::format("scale {} is {:.6g} mesh units, more than the bounding-box diagonal {:.6g}",
                        request.label(), rmin, diagonal));
    return rmin;
}

}  // namespace fcn::app
