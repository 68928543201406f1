// The section on what the objective is worth.
#include <cmath>

#include "experiment/report_numbers.h"
#include "experiment/report_sections.h"

namespace experiment {
namespace {

std::string plain_interval(const Interval& interval) {
    std::string result = number_text(interval.estimate);
    if (interval.is_known) {
        result += " [" + number_text(interval.low) + ", " + number_text(interval.high) + "]";
    }
    return result;
}

std::vector<std::string> columns_with_measures(std::vector<std::string> columns,
                                               const StudyComparison& study) {
    for (const StudyMeasure& measure : study.measures) columns.push_back(measure.title);
    return columns;
}

std::vector<std::size_t> solvers_of(const StudyComparison& study, const Plan& plan) {
    std::vector<std::size_t> solvers;
    for (std::size_t s = 0; s < plan.solvers.size(); ++s) {
        for (const StudyEntry& entry : study.entries) {
            if (entry.solver != s) continue;
            solvers.push_back(s);
            break;
        }
    }
    return solvers;
}

std::size_t problems_of(const StudyComparison& study, std::size_t solver) {
    std::size_t count = 0;
    for (const StudyEntry& entry : study.entries) count += entry.solver == solver;
    return count;
}

/// Means, or mean differences to the baseline.
Table means(const ReportInput& input, bool are_differences) {
    const StudyComparison& study = input.study;
    const Plan& plan = input.campaign.plan;
    Table table;
    table.caption = are_differences
                        ? "Mean differences to " + plan.solvers[study.baseline].name +
                              "'s meshes on the same mesh and scale, with 95% intervals by mesh: "
                              "one that holds 0 "
                              "shows no difference, nor that there is none; and of so many, one in "
                              "twenty misses "
                              "0 by chance."
                        : "Means over all meshes and scales that each solver has a result for.";
    table.columns = columns_with_measures(
        {"solver", "meshes × scales",
         are_differences ? "objective gap [percentage points]" : "objective gap [%]"},
        study);
    for (const std::size_t s : solvers_of(study, plan)) {
        if (are_differences && s == study.baseline) continue;
        const std::size_t count = problems_of(study, s);
        std::vector<TableCell> row{plan.solvers[s].name,
                                   {std::to_string(count), static_cast<double>(count)}};
        const auto add = [&](std::size_t m) {
            const Interval interval = are_differences
                                          ? study_difference(input.campaign, study, s, m)
                                          : study_mean(input.campaign, study, s, m);
            row.emplace_back(plain_interval(interval), interval.estimate);
        };
        add(study.measures.size());
        for (std::size_t m = 0; m < study.measures.size(); ++m) add(m);
        table.rows.push_back(std::move(row));
    }
    return table;
}

Table correlations(const ReportInput& input) {
    Table table;
    table.caption =
        "Spearman's rank correlation between how much further the objective is from "
        "the best one than the baseline's and how the mesh differs from the "
        "baseline's; 0: the objective says nothing about it.";
    table.columns = {"measure", "rank correlation"};
    for (std::size_t m = 0; m < input.study.measures.size(); ++m) {
        const Interval interval = study_correlation(input.campaign, input.study, m);
        if (std::isnan(interval.estimate)) continue;
        table.rows.push_back(
            {input.study.measures[m].title, {plain_interval(interval), interval.estimate}});
    }
    return table;
}

Table each_mesh(const ReportInput& input) {
    const StudyComparison& study = input.study;
    const Plan& plan = input.campaign.plan;
    Table table;
    table.caption = "Each mesh and scale";
    table.columns = columns_with_measures(
        {"problem", "mesh", "scale", "solver", "objective", "gap to the best"}, study);
    for (const StudyEntry& entry : study.entries) {
        const PlannedProblem& problem = plan.problems[entry.problem];
        const auto tag = [&](const char* key) {
            const auto it = problem.tags.find(key);
            return it == problem.tags.end() ? std::string("–") : it->second;
        };
        std::vector<TableCell> row{problem.name, tag("mesh"), tag("scale"),
                                   plan.solvers[entry.solver].name};
        row.emplace_back(decimal_text(entry.value, 3), entry.value);
        row.emplace_back(percent_text(entry.gap), entry.gap);
        for (const double number : entry.measures) {
            row.emplace_back(number_text(number), number);
        }
        table.rows.push_back(std::move(row));
    }
    table.is_long = table.rows.size() > 30;
    return table;
}

}  // namespace

void add_study(const ReportInput& input, Document& document) {
    if (input.study.entries.empty()) return;
    Section section{"Does the objective matter?", "study", {}};
    section.blocks.emplace_back(Paragraph{
        "Each solver's network was remeshed, and the meshes are set beside the objective, of which "
        "the adaptation's own word is taken: each solver leads it to other problems. The baseline "
        "is " +
        input.campaign.plan.solvers[input.study.baseline].name + "."});
    section.blocks.emplace_back(means(input, false));
    Table differences = means(input, true);
    if (!differences.rows.empty()) section.blocks.emplace_back(std::move(differences));
    Table ranks = correlations(input);
    if (!ranks.rows.empty()) section.blocks.emplace_back(std::move(ranks));
    for (Block& block : input.plots.of_section("study")) section.blocks.push_back(std::move(block));
    section.blocks.emplace_back(each_mesh(input));
    add_section(document, std::move(section));
}

}  // namespace experiment
