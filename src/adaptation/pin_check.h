#pragma once

#include <string>
#include <vector>

#include "adaptation/adaptation.h"

namespace fcn {

/// Two pinned arcs that cannot both be kept at the scale, or one that cannot be on its own.
struct PinConflict {
    enum class Kind { Distance, Angle, Length };
    Kind kind = Kind::Distance;
    int first = -1, second = -1;  ///< arcs of the network, first <= second; equal: on its own
    double distance = 0;          ///< between them (Length: of the arc); mesh units
    double angle = 0;             ///< radians, Angle only
    Vec3 place = Vec3::Zero();
    /// Largest scale found at which both fit; 0 = none down to a hundredth of the scale.
    double largest_scale = 0;

    /// One line: arcs, distance in rmin, place, largest scale.
    std::string message(double rmin) const;
};

struct PinCheck {
    /// The closest pairs, at most eight, the one that needs the smallest scale first.
    std::vector<PinConflict> conflicts;
    std::size_t conflict_count = 0;  ///< of all pairs
};

/// Whether the features that a user has pinned (ArcKind::Feature, Pin::Keep) can be kept beside
/// each other and beside pinned borders: what pins force is resampled alone and held to the
/// conditions of the mode. Pairs of borders are not looked at. Near-linear in the pinned length.
PinCheck check_pins(const LoadedMesh& mesh, const FeatureCurveNetwork& network,
                    const AdaptationOptions& options);

}  // namespace fcn
