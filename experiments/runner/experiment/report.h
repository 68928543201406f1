#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiment/campaign_runs.h"

namespace experiment {

struct ReportResult {
    /// Claims of two runs that cannot both be true, one line each; the report then holds nothing
    /// else, in red.
    std::vector<std::string> contradictions;
    std::vector<std::filesystem::path> files;
    std::string note;  ///< what is missing, for example plots without matplotlib; may be empty
};

/// Writes report.md, report.html (self-contained), CSV files and plots into `folder`.
ReportResult write_report(const CampaignRuns& campaign, const std::filesystem::path& folder);

}  // namespace experiment
