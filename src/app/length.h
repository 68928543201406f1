#pragma once

#include <string>
#include <vector>

namespace fcn::app {

/// A length as typed: mesh units ("0.5") or a share of the bounding-box diagonal ("2%").
struct Length {
    std::string text;
    double value = 0;  ///< mesh units, or percent
    bool is_percent = false;

    /// Mesh units. Throws UsageError for a percentage of an unknown (zero) diagonal.
    double resolve(double diagonal) const;
};

/// Throws UsageError naming `option` unless text is a positive finite number, or one with '%'.
Length parse_length(const std::string& text, const std::string& option);

/// Splits at commas; throws UsageError on an empty list or entry.
std::vector<std::string> split_list(const std::string& text, const std::string& option);

/// What the user asked a mesh to be adapted to, before the mesh is known.
struct ScaleRequest {
    Length length;
    bool is_edge_length = false;  ///< length is the remesher's L, rmin = L / 1.2

    std::string label() const;   ///< "2%", or "edge 2.4%"
    std::string folder() const;  ///< "2pct", or "edge-2.4pct"
};

/// rmin in mesh units. Throws UsageError when it exceeds the (known) diagonal.
double resolve_scale(const ScaleRequest& request, double diagonal);

}  // namespace fcn::app
