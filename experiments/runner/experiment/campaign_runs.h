#pragma once

#include <optional>
#include <vector>

#include "experiment/plan.h"
#include "experiment/record.h"

namespace experiment {

/// A campaign as far as it has come.
struct CampaignRuns {
    Plan plan;
    std::vector<std::optional<Record>> records;  ///< per job of the plan; nothing: not run yet
};

}  // namespace experiment
