// Solvers against each other, on the problems that both took, and where the baseline loses.
#include <algorithm>
#include <cmath>

#include "experiment/ablation.h"
#include "experiment/report_numbers.h"
#include "experiment/report_sections.h"

namespace experiment {
namespace {

constexpr std::size_t kMostForMatrix = 14;

std::string score(std::size_t wins, std::size_t ties, std::size_t losses) {
    return std::to_string(wins) + " / " + std::to_string(ties) + " / " + std::to_string(losses);
}

TableCell number(std::size_t n) { return {std::to_string(n), static_cast<double>(n)}; }

/// Solvers that took any problem; those with a start have a section of their own.
std::vector<std::size_t> with_problems(const ReportInput& input) {
    std::vector<std::size_t> solvers;
    for (std::size_t s = 0; s < input.comparison.solvers.size(); ++s) {
        const bool has_start = !input.campaign.plan.solvers[s].start.empty();
        if (input.comparison.solvers[s].taken > 0 && !has_start) solvers.push_back(s);
    }
    return solvers;
}

Table against_baseline(const ReportInput& input, bool has_times) {
    const Plan& plan = input.campaign.plan;
    const std::size_t a = baseline_of(plan);
    const std::string& name = plan.solvers[a].name;
    Table table;
    if (has_times) {
        table.caption =
            "Times of exact solvers over the baseline's, on problems that at least one "
            "of the two proves (the other at its limit): above 1, " +
            name + " is faster. Wins, ties and losses are the baseline's.";
        table.columns = {"solver",     "both took",  "both prove",          "only " + name,
                         "only other", "time ratio", "wins / ties / losses"};
    } else {
        table.caption =
            "Median values: wins, ties and losses of the baseline, and the other's gap "
            "to the best known value less the baseline's.";
        table.columns = {"solver", "both took", "wins / ties / losses", "gap difference"};
    }
    for (const std::size_t b : with_problems(input)) {
        if (b == a) continue;
        const bool are_exact =
            input.comparison.solvers[a].is_exact && input.comparison.solvers[b].is_exact;
        if (has_times && !are_exact) continue;
        const PairComparison pair = compare_pair(input.campaign, input.comparison, a, b);
        if (pair.common == 0) continue;
        std::vector<TableCell> row{plan.solvers[b].name, number(pair.common)};
        if (has_times) {
            row.insert(row.end(),
                       {number(pair.both_proven), number(pair.only_a), number(pair.only_b)});
            row.emplace_back(ratio_interval(pair.time_ratio), pair.time_ratio.estimate);
            row.emplace_back(score(pair.faster_a, pair.ties, pair.faster_b),
                             static_cast<double>(pair.faster_a));
        } else {
            row.emplace_back(score(pair.better_a, pair.equal, pair.better_b),
                             static_cast<double>(pair.better_a));
            row.emplace_back(percent_interval(pair.gap_difference), pair.gap_difference.estimate);
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

/// Wins and losses of every solver against every other.
Table matrix(const ReportInput& input, bool has_times) {
    const Plan& plan = input.campaign.plan;
    std::vector<std::size_t> solvers;
    for (const std::size_t s : with_problems(input)) {
        if (!has_times || input.comparison.solvers[s].is_exact) solvers.push_back(s);
    }
    Table table;
    if (solvers.size() < 3 || solvers.size() > kMostForMatrix) return table;
    table.caption = has_times
                        ? "Geometric mean of the column's time over the row's, on problems that "
                          "both took and at least one proves: above 1, the row is faster."
                        : "Problems on which the row's median value is better : worse than the "
                          "column's.";
    table.columns = {"against"};
    for (const std::size_t b : solvers) table.columns.push_back(plan.solvers[b].name);
    for (const std::size_t a : solvers) {
        std::vector<TableCell> row{plan.solvers[a].name};
        for (const std::size_t b : solvers) {
            if (a == b) {
                row.emplace_back("");
                continue;
            }
            const PairComparison pair = compare_pair(input.campaign, input.comparison, a, b);
            if (has_times) {
                row.emplace_back(ratio_text(pair.time_ratio.estimate), pair.time_ratio.estimate);
            } else {
                row.emplace_back(
                    std::to_string(pair.better_a) + " : " + std::to_string(pair.better_b),
                    static_cast<double>(pair.better_a) - static_cast<double>(pair.better_b));
            }
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

/// A problem on which another solver does better than the baseline.
struct Loss {
    double size = 0;
    std::vector<TableCell> row;
};

Table table_of(std::vector<Loss> losses, std::vector<std::string> columns, std::string caption) {
    std::stable_sort(losses.begin(), losses.end(),
                     [](const Loss& a, const Loss& b) { return a.size > b.size; });
    Table table{std::move(columns), {}, std::move(caption), losses.size() > 25};
    for (Loss& loss : losses) table.rows.push_back(std::move(loss.row));
    return table;
}

/// Best other solver without a start on this problem by `is_better`.
template <class Better>
std::optional<std::size_t> best_other(const ReportInput& input, std::size_t problem,
                                      const Better& is_better) {
    const std::size_t a = baseline_of(input.campaign.plan);
    std::optional<std::size_t> best;
    for (std::size_t s = 0; s < input.comparison.cells.size(); ++s) {
        const Cell& cell = input.comparison.cells[s][problem];
        const bool counts = s != a && cell.standing == Standing::Taken &&
                            input.campaign.plan.solvers[s].start.empty();
        if (!counts) continue;
        const Cell& before =
            best ? input.comparison.cells[*best][problem] : input.comparison.cells[a][problem];
        if (is_better(cell, before)) best = s;
    }
    return best;
}

Table lost_values(const ReportInput& input) {
    const Plan& plan = input.campaign.plan;
    const std::size_t a = baseline_of(plan);
    std::vector<Loss> losses;
    for (std::size_t p = 0; p < plan.problems.size(); ++p) {
        const Cell& ours = input.comparison.cells[a][p];
        if (ours.standing != Standing::Taken) continue;
        const auto other = best_other(
            input, p, [](const Cell& x, const Cell& before) { return x.value > before.value; });
        if (!other) continue;
        const Cell& theirs = input.comparison.cells[*other][p];
        const double loss = ours.gap_to_best - theirs.gap_to_best;
        losses.push_back({loss,
                          {plan.problems[p].name,
                           {percent_text(ours.gap_to_best), ours.gap_to_best},
                           plan.solvers[*other].name,
                           {percent_text(theirs.gap_to_best), theirs.gap_to_best}}});
    }
    return table_of(std::move(losses), {"problem", "baseline's gap", "best other", "its gap"},
                    "Problems on which another solver's median value is better");
}

Table lost_times(const ReportInput& input) {
    const Plan& plan = input.campaign.plan;
    const std::size_t a = baseline_of(plan);
    const double floor = plan.report.floor_seconds;
    std::vector<Loss> losses;
    for (std::size_t p = 0; p < plan.problems.size(); ++p) {
        const Cell& ours = input.comparison.cells[a][p];
        if (ours.standing != Standing::Taken) continue;
        const auto other = best_other(input, p, [](const Cell& x, const Cell& before) {
            if (!x.is_proven) return false;
            return !before.is_proven || x.counted < before.counted;
        });
        if (!other) continue;
        const Cell& theirs = input.comparison.cells[*other][p];
        const double ratio = std::max(ours.counted, floor) / std::max(theirs.counted, floor);
        if (ours.is_proven && ratio <= kTieFactor) continue;
        losses.push_back(
            {ratio,
             {plan.problems[p].name,
              {ours.is_proven ? seconds_text(ours.counted) : "not proven", ours.counted},
              plan.solvers[*other].name,
              {seconds_text(theirs.counted), theirs.counted},
              {ratio_text(ratio), ratio}}});
    }
    return table_of(std::move(losses),
                    {"problem", "baseline [s]", "fastest other", "its time [s]", "ratio"},
                    "Problems that another solver proves faster, or that it alone proves");
}

}  // namespace

void add_pairs(const ReportInput& input, Document& document) {
    const Plan& plan = input.campaign.plan;
    if (with_problems(input).size() < 2) return;
    Section section{"Pairs", "pairs", {}};
    section.blocks.emplace_back(
        Paragraph{"The baseline is " + plan.solvers[baseline_of(plan)].name + "."});
    for (const bool has_times : {true, false}) {
        Table table = against_baseline(input, has_times);
        if (!table.rows.empty()) section.blocks.emplace_back(std::move(table));
    }
    for (const bool has_times : {true, false}) {
        Table table = matrix(input, has_times);
        if (!table.rows.empty()) section.blocks.emplace_back(std::move(table));
    }
    for (Block& block : input.plots.of_section("pairs")) section.blocks.push_back(std::move(block));
    add_section(document, std::move(section));
}

void add_losses(const ReportInput& input, Document& document) {
    const std::size_t a = baseline_of(input.campaign.plan);
    if (with_problems(input).size() < 2 || input.comparison.solvers[a].taken == 0) return;
    const std::string& name = input.campaign.plan.solvers[a].name;
    Section section{"Where " + name + " loses", "losses", {}};
    Table values = lost_values(input);
    if (values.rows.empty()) {
        section.blocks.emplace_back(
            Paragraph{"On no problem is another solver's median value better."});
    } else {
        section.blocks.emplace_back(std::move(values));
    }
    if (input.comparison.solvers[a].is_exact) {
        Table times = lost_times(input);
        if (times.rows.empty()) {
            section.blocks.emplace_back(
                Paragraph{"No problem is proven faster by another solver, ties aside."});
        } else {
            section.blocks.emplace_back(std::move(times));
        }
    }
    add_section(document, std::move(section));
}

void add_ablations(const ReportInput& input, Document& document) {
    const Plan& plan = input.campaign.plan;
    Table table;
    table.caption =
        "One thing changed at a time; ratios above 1 and differences above 0 are what "
        "the change costs.";
    table.columns = {"solver", "change",     "problems",      "proven before",
                     "after",  "time ratio", "gap difference"};
    for (const Ablation& ablation : find_ablations(plan)) {
        const PairComparison pair =
            compare_pair(input.campaign, input.comparison, ablation.parent, ablation.variant);
        if (pair.common == 0) continue;
        table.rows.push_back(
            {plan.solvers[ablation.parent].name,
             ablation.change,
             number(pair.common),
             number(pair.both_proven + pair.only_a),
             number(pair.both_proven + pair.only_b),
             {ratio_interval(pair.time_ratio), pair.time_ratio.estimate},
             {percent_interval(pair.gap_difference), pair.gap_difference.estimate}});
    }
    if (table.rows.empty()) return;
    Section section{"Ablations", "ablations", {}};
    section.blocks.emplace_back(std::move(table));
    for (Block& block : input.plots.of_section("ablations")) {
        section.blocks.push_back(std::move(block));
    }
    add_section(document, std::move(section));
}

}  // namespace experiment
