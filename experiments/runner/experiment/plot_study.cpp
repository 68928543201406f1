// Plots of the study: a figure for each measure, its difference to the baseline's mesh against the
// difference of the objective gaps.
#include <cmath>

#include "experiment/plot_data.h"

namespace experiment {
namespace {

using nlohmann::json;

json series_of_solver(const CampaignRuns& campaign, const StudyComparison& study,
                      std::size_t solver, std::size_t m) {
    json x = json::array(), y = json::array();
    for (const StudyEntry& entry : study.entries) {
        const StudyEntry* base = study.find(study.baseline, entry.problem);
        if (entry.solver != solver || base == nullptr) continue;
        const double difference = entry.measures[m] - base->measures[m];
        if (std::isnan(difference)) continue;
        x.push_back(100 * (entry.gap - base->gap));
        y.push_back(difference);
    }
    return {{"name", campaign.plan.solvers[solver].name}, {"index", solver}, {"x", x}, {"y", y}};
}

}  // namespace

void add_study_plots(const CampaignRuns& campaign, const StudyComparison& study, PlotData& data) {
    const std::string& baseline = campaign.plan.solvers[study.baseline].name;
    for (std::size_t m = 0; m < study.measures.size(); ++m) {
        json series = json::array();
        for (std::size_t s = 0; s < campaign.plan.solvers.size(); ++s) {
            if (s == study.baseline) continue;
            json entry = series_of_solver(campaign, study, s, m);
            if (!entry["x"].empty()) series.push_back(std::move(entry));
        }
        if (series.empty()) continue;
        const StudyMeasure& measure = study.measures[m];
        const bool is_share = measure.key == "changed_segments";
        const std::string file = "study-" + measure.key;
        json zero{{"x", {0, 0}}, {"y", {0, 0}}};
        double most = 0;
        for (const json& entry : series) {
            for (const json& x : entry["x"]) most = std::max(most, x.get<double>());
        }
        zero["x"] = {0, most};
        data.figures.push_back(
            {{"name", file},
             {"kind", "points"},
             {"title", measure.title},
             {"series", series},
             {"guides", {zero}},
             {"x",
              {{"label", "objective gap over " + baseline + "'s [percentage points]"},
               {"scale", "symlog"},
               {"threshold", 0.01}}},
             {"y",
              {{"label", is_share ? measure.title : measure.title + ", less " + baseline + "'s"},
               {"scale", "linear"}}}});
        data.captions.push_back(
            {"study",
             {file, measure.title + (is_share ? "" : ": difference to " + baseline + "'s mesh") +
                        " against how much further the objective is from the best one; a point "
                        "for each mesh, scale and solver."}});
    }
}

}  // namespace experiment
