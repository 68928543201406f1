#pragma once

#include <cstdint>
#include <vector>

#include "labeling/relaxation.h"

namespace labeling {

struct GomoryCutOptions {
    std::size_t max_rows = 300;  ///< tableau rows tried
    std::size_t max_cuts = 150;
    std::size_t max_entries = 200;
    std::int64_t max_coefficient = 1000;
    int max_denominator = 60;
    double min_violation = 0.01;
};

/// Chvatal-Gomory cuts from the rows of the optimal tableau of the last solve(), derived anew in
/// integers; valid for all integer points of the relaxation that respect its current fixings.
std::vector<Cut> gomory_cuts(Relaxation& relaxation, const GomoryCutOptions& options,
                             std::int64_t& work);

}  // namespace labeling
