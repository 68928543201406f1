#pragma once

#include "experiment/comparison.h"
#include "experiment/plot_data.h"
#include "experiment/report_document.h"
#include "experiment/study_comparison.h"

namespace experiment {

/// What the sections are made from.
struct ReportInput {
    const CampaignRuns& campaign;
    const Comparison& comparison;
    const StudyComparison& study;
    const PlotData& plots;
    const std::map<std::string, std::string>& versions;  ///< of solvers that are programs
};

/// Adds a section when it has anything to say.
void add_section(Document& document, Section section);

// report_overview.cpp: what was run, and what is missing
void add_overview(const ReportInput& input, Document& document);
void add_gaps_in_the_record(const ReportInput& input, Document& document);
void add_method(const ReportInput& input, Document& document);

// report_solvers.cpp: solvers by themselves
void add_exact_solvers(const ReportInput& input, Document& document);
void add_values(const ReportInput& input, Document& document);
void add_starts(const ReportInput& input, Document& document);
void add_scaling(const ReportInput& input, Document& document);
void add_problems(const ReportInput& input, Document& document);

// report_pairs.cpp: solvers against each other
void add_pairs(const ReportInput& input, Document& document);
void add_losses(const ReportInput& input, Document& document);
void add_ablations(const ReportInput& input, Document& document);

// report_study.cpp
void add_study(const ReportInput& input, Document& document);

}  // namespace experiment
