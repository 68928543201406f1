#pragma once

#include <string>
#include <vector>

#include "adaptation/adaptation.h"
#include "app/detection.h"
#include "features/pins.h"

namespace CLI {
class App;
}

namespace fcn::app {

/// What a user wants to be kept or dropped.
struct PinArguments {
    std::vector<std::string> keep, drop;              ///< "arc:12", "curve:3"
    std::vector<std::string> keep_boxes, drop_boxes;  ///< "x0,y0,z0,x1,y1,z1"
    std::string importance_path;
    std::string importance_property = "importance";
    double keep_above = 0.5;
    double drop_below = -0.5;
    std::string conflicts = "refuse";

    /// UsageError on what is no arc, curve or box.
    std::vector<PinRule> rules() const;
};
void add_pin_arguments(CLI::App& parser, PinArguments& arguments);

/// Pins the detected network; `rmin` is the largest scale it will be adapted to.
void add_pins(Detection& detection, const LoadedMesh& mesh, const PinArguments& arguments,
              double rmin);

/// InputError that names the pair, its distance and the largest scale at which it fits, if pinned
/// features cannot be kept at the scale; only a message, returned, with --pin-conflicts keep.
std::vector<std::string> require_pins_hold(const FeatureCurveNetwork& network,
                                           const LoadedMesh& mesh, const AdaptationOptions& options,
                                           const PinArguments& arguments);

}  // namespace fcn::app
