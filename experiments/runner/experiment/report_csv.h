#pragma once

#include <string>

#include "experiment/comparison.h"
#include "experiment/study_comparison.h"

namespace experiment {

/// RFC 4180, a line for the columns' names first. Empty fields: not known.

/// One row a run of the plan, made or not, with everything that is known of it.
std::string runs_csv(const CampaignRuns& campaign, const Comparison& comparison);
/// One row a problem: sizes, tags, best value and bound and whose they are.
std::string problems_csv(const CampaignRuns& campaign, const Comparison& comparison);
/// One row for each two solvers.
std::string pairs_csv(const CampaignRuns& campaign, const Comparison& comparison);
/// One row for each mesh, scale and solver of the study.
std::string study_csv(const CampaignRuns& campaign, const StudyComparison& study);

}  // namespace experiment
