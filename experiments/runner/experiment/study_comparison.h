#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiment/bootstrap.h"
#include "experiment/campaign_runs.h"

namespace experiment {

/// A quality of a remeshed network that the report compares.
struct StudyMeasure {
    std::string key;    ///< in Record::statistics; "changed_segments" is made here
    std::string title;  ///< with its unit
    double factor = 1;  ///< from the statistic to the unit of the title
};

/// The mesh that a solver led to: medians over seeds.
struct StudyEntry {
    std::size_t solver = 0, problem = 0;
    std::size_t runs = 0;
    double value = 0;              ///< of the objective, in real units
    double gap = 0;                ///< of the objective to the best solver's on this problem
    std::vector<double> measures;  ///< per measure of the comparison; NaN where not known
};

/// Does a better objective make a better mesh?
struct StudyComparison {
    std::vector<StudyMeasure> measures;  ///< those of which there is any number
    std::vector<StudyEntry> entries;     ///< by problem, then solver
    std::size_t baseline = 0;
    std::size_t runs_without_result = 0;

    const StudyEntry* find(std::size_t solver, std::size_t problem) const;
};

/// Reads segments of FOLDER/segments/KEY.txt, one a line; equal text is the same segment.
StudyComparison compare_studies(const CampaignRuns& campaign, const std::filesystem::path& home);

/// Share of the segments of either that is not in both: 1 - |common| / |union|, repeated lines
/// counted. 0 of two empty lists.
double changed_share(std::vector<std::string> a, std::vector<std::string> b);

/// Over problems: the mean of measure `m` for a solver, or its mean difference to the baseline on
/// the problems that both have. `m` = measures.size(): the objective gap.
Interval study_mean(const CampaignRuns& campaign, const StudyComparison& study, std::size_t solver,
                    std::size_t m);
Interval study_difference(const CampaignRuns& campaign, const StudyComparison& study,
                          std::size_t solver, std::size_t m);
/// Rank correlation, over all solvers but the baseline, of the difference of the objective gap to
/// the baseline and the difference of a measure to it.
Interval study_correlation(const CampaignRuns& campaign, const StudyComparison& study,
                           std::size_t m);

}  // namespace experiment
