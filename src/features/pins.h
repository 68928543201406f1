#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

/// A user's word on arcs, by number or by place.
struct PinRule {
    enum class Target { Arc, Curve, Box };
    Target target = Target::Arc;
    Pin pin = Pin::Keep;
    int index = -1;           ///< of the arc or curve
    Eigen::AlignedBox3d box;  ///< mesh units
    std::string name;         ///< as typed, for messages: "--keep arc:12"
};

/// Painted importance: features are kept where it is high and dropped where it is low.
struct PaintedImportance {
    std::vector<double> of_vertex;  ///< per vertex of the mesh; empty = nothing painted
    double keep_above = 0.5;
    double drop_below = -0.5;
    std::string name;  ///< for messages: the file
};

struct PinOptions {
    /// Stretches of an arc that a box or importance would pin or leave free and that are shorter
    /// than this join what is beside them; mesh units.
    double min_length = 0;
};

/// Numbers stand for arcs and curves of `network` (curves are those of find_curves() where it has
/// none); they go before boxes, boxes before importance. Boxes and importance speak of features
/// only, not of borders, and cut arcs where they end; cut arcs keep their number for the first
/// part, further parts come behind all others. Orbits and curves of cut arcs are left out. Throws
/// InputError on numbers that do not exist, boxes that meet no feature, and on what is both to be
/// kept and to be dropped.
FeatureCurveNetwork apply_pins(const FeatureCurveNetwork& network, const LoadedMesh& mesh,
                               const std::vector<PinRule>& rules,
                               const PaintedImportance& importance = {},
                               const PinOptions& options = {});

}  // namespace fcn
