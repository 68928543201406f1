#pragma once

#include <functional>
#include <vector>

#include "adaptation/scale.h"
#include "adaptation/working_network.h"

namespace fcn {

struct RefillInput {
    const WorkingNetwork* network = nullptr;
    const NetworkGraph* graph = nullptr;  ///< of `network`
    /// Arcs of the initial network, densely sampled; dead ones are skipped.
    const std::vector<WorkingArc>* initial = nullptr;
    ScaleInterval scale;
    /// Worth of the dense samples [first, last] of an initial arc, >= 0.
    std::function<double(const WorkingArc&, int first, int last)> worth;
    double min_length = 0;  ///< shorter pieces that are not attached are left out; mesh units
    int threads = 1;
};

/// New arcs, sampled and conforming with the network as it is (not among each other): runs of the
/// initial arcs that fit between what was kept, found by a best path over the samples in which
/// every segment is tested against the network. An end that continues an existing node names it;
/// nodes[k] = -1 asks for a new node. Sorted by initial arc.
std::vector<WorkingArc> find_refills(const RefillInput& input);

}  // namespace fcn
