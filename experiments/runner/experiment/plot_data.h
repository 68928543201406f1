#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiment/comparison.h"
#include "experiment/report_document.h"
#include "experiment/statistics.h"
#include "experiment/study_comparison.h"

namespace experiment {

/// What plots.py draws: {"figures": [...]}, and what the report says below each figure.
struct PlotData {
    nlohmann::json figures = nlohmann::json::array();
    std::vector<std::pair<std::string, Figure>> captions;  ///< section's id and figure

    std::vector<Block> of_section(const std::string& id) const;
};

/// Times against sizes of a solver: proven runs of exact solvers; of others, runs that no limit
/// ended.
struct Scaling {
    std::size_t solver = 0;
    Points points;  ///< labels and seconds, one a problem
    std::optional<PowerLaw> law;
};

/// Solvers with at least one point, in the plan's order.
std::vector<Scaling> scalings(const CampaignRuns& campaign, const Comparison& comparison);

/// Adds the figures of everything but studies.
void add_solver_plots(const CampaignRuns& campaign, const Comparison& comparison, PlotData& data);
/// Each measure against the objective gap.
void add_study_plots(const CampaignRuns& campaign, const StudyComparison& study, PlotData& data);

}  // namespace experiment
