#pragma once

#include <cstdint>
#include <vector>

#include "labeling/relaxation.h"

namespace labeling {

struct GomoryCutOptions {
    std::size_t max_rows = 1000;  ///< tableau rows tried, the most fractional first
    std::size_t max_cuts = 150;
    std::size_t max_entries = 80;
    int max_multiple = 3;  ///< each row is tried times 1 .. this
    double min_efficacy = 1e-3;
};

/// Gomory mixed-integer cuts from the optimal tableau of the last solve(), derived anew in
/// integers; valid for all integer points of the relaxation that respect its current fixings.
std::vector<Cut> gomory_cuts(Relaxation& relaxation, const GomoryCutOptions& options,
                             std::int64_t& work);

}  // namespace labeling
