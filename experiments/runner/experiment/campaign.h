#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <set>
#include <stop_token>
#include <string>

#include "experiment/plan.h"
#include "experiment/record.h"

namespace experiment {

/// What is told while a campaign runs.
struct CampaignProgress {
    std::size_t done = 0, total = 0;
    std::string last;  ///< the run that has just ended, and how; empty at the start
    /// Seconds that remain, at least and at most as far as one can tell: by the runs of the same
    /// solvers that have ended, and by the limits of those of which none has.
    double least_seconds = 0, most_seconds = 0;
};

struct CampaignOptions {
    int jobs = 1;           ///< runs at the same time; more than one disturb each other's times
    bool is_pinned = true;  ///< each to a processor of its own
    /// Runs that ended so are made again: missing, not-applicable. Others stay as they are: a
    /// failure that is repeated until it passes would be no failure.
    std::set<Outcome> again;
    std::stop_token stop;  ///< runs under way are given up and made again at the next resume
    std::function<void(const CampaignProgress&)> on_progress;
};

struct CampaignOutcome {
    std::size_t done = 0, total = 0;
    bool is_interrupted = false;
};

/// Makes problems, starts and the plan in FOLDER, and checks that solvers exist by name. The plan
/// is written last: a folder without one can be prepared again. Throws InputError when FOLDER holds
/// a campaign, or anything is wrong with the configuration.
void prepare_campaign(const std::filesystem::path& config, const std::filesystem::path& folder,
                      const std::function<void(const std::string&)>& tell);

/// Makes the runs that FOLDER does not hold yet, each in a process of its own. What is complete
/// survives whatever ends this process. Throws InputError when another runner is at work there, or
/// nothing can be written.
CampaignOutcome continue_campaign(const std::filesystem::path& folder,
                                  const CampaignOptions& options);

/// Takes the records' files into the database; what is there already stays. Returns how many are
/// new.
std::size_t merge_records(const Plan& plan, const std::filesystem::path& folder);

}  // namespace experiment
