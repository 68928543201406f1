#pragma once

#include <vector>

#include "adaptation/working_network.h"

namespace fcn {

/// Kept segments that hang together but are too little to show.
struct Crumb {
    std::vector<int> segments;
    std::vector<int> neighbours;  ///< dropped segments that share a node with it
};

struct CrumbOptions {
    double min_length = 0;                ///< of the segments together, mesh units
    std::vector<int> curve_of_origin;     ///< initial arc -> initial curve
    std::vector<double> length_of_curve;  ///< initial curve -> length at the start
    std::vector<int> component_of_curve;  ///< initial curve -> component of the initial network
    std::vector<double> length_of_component;
};

/// Connected pieces of the kept network shorter than min_length. Not crumbs: pieces with a pinned
/// segment, pieces that a cluster of short segments may still join to others, whole components of
/// the initial network, and whole curves of it that are creases (20 degrees and more).
std::vector<Crumb> find_crumbs(const WorkingNetwork& network, const NetworkGraph& graph,
                               const std::vector<bool>& kept, const CrumbOptions& options);

}  // namespace fcn
