// Tables of the solvers by themselves, and of the problems.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "experiment/report_numbers.h"
#include "experiment/report_sections.h"

namespace experiment {
namespace {

TableCell number(std::size_t n) { return {std::to_string(n), static_cast<double>(n)}; }

/// Marks the smallest or largest number of a column, unless all are equal.
void mark_best(Table& table, std::size_t column, bool is_smallest, std::size_t rows) {
    double best = is_smallest ? std::numeric_limits<double>::infinity()
                              : -std::numeric_limits<double>::infinity();
    double worst = -best;
    for (std::size_t r = 0; r < rows; ++r) {
        const auto& value = table.rows[r][column].number;
        if (!value) continue;
        best = is_smallest ? std::min(best, *value) : std::max(best, *value);
        worst = is_smallest ? std::max(worst, *value) : std::min(worst, *value);
    }
    if (best == worst) return;
    for (std::size_t r = 0; r < rows; ++r) {
        TableCell& cell = table.rows[r][column];
        // What is printed alike is as good.
        cell.is_best = cell.number && std::abs(*cell.number - best) <= 0.005 * std::abs(best);
    }
}

std::string proof_range(const SolverSummary& sum) {
    if (std::isnan(sum.longest_proof)) return "–";
    return seconds_text(sum.shortest_proof) + " to " + seconds_text(sum.longest_proof);
}

std::string instruction_text(double instructions) {
    return std::isnan(instructions) ? "–" : decimal_text(instructions / 1e9, 3);
}

class SolverTables {
public:
    explicit SolverTables(const ReportInput& input)
        : input_(input), plan_(input.campaign.plan), comparison_(input.comparison) {}

    template <class Chosen>
    std::vector<std::size_t> chosen(const Chosen& is_chosen) const {
        std::vector<std::size_t> solvers;
        for (std::size_t s = 0; s < plan_.solvers.size(); ++s) {
            if (comparison_.solvers[s].taken > 0 && is_chosen(s)) solvers.push_back(s);
        }
        return solvers;
    }

    Table exact(const std::vector<std::size_t>& solvers, bool has_virtual_best) const {
        Table table;
        table.columns = {
            "solver",    "problems",   "proven",           "shifted geometric mean [s]",
            "PAR10 [s]", "fastest on", "a proof takes [s]"};
        if (comparison_.has_instructions) {
            table.columns.push_back("instructions, geometric mean [10^9]");
        }
        if (has_spread()) table.columns.push_back("slowest over fastest run");
        for (const std::size_t s : solvers) {
            table.rows.push_back(exact_row(plan_.solvers[s].name, comparison_.solvers[s]));
        }
        const auto count = [&](std::size_t s) { return comparison_.solvers[s].taken; };
        const bool is_fair =
            !solvers.empty() && std::all_of(solvers.begin(), solvers.end(), [&](std::size_t s) {
                return count(s) == count(solvers[0]);
            });
        if (is_fair) {
            mark_best(table, 2, false, table.rows.size());
            mark_best(table, 3, true, table.rows.size());
            mark_best(table, 4, true, table.rows.size());
        }
        if (has_virtual_best && solvers.size() > 1) {
            table.rows.push_back(exact_row("virtual best", comparison_.virtual_best));
            table.rows.back()[5] = "";
            table.rows.back()[6] = "";
            if (has_spread()) table.rows.back().back() = "";
        }
        return table;
    }

    Table values(const std::vector<std::size_t>& solvers) const {
        Table table;
        table.columns = {"solver",
                         "problems",
                         "with a solution",
                         "best known value",
                         "mean gap to best known",
                         "mean gap to best bound",
                         "primal integral [s]",
                         "reach 1%",
                         "reach 0.1%"};
        for (const std::size_t s : solvers) {
            const SolverSummary& sum = comparison_.solvers[s];
            table.rows.push_back(
                {plan_.solvers[s].name,
                 number(sum.taken),
                 number(sum.with_value),
                 number(sum.at_best),
                 {percent_interval(sum.gap_to_best), sum.gap_to_best.estimate},
                 {percent_interval(sum.gap_to_bound), sum.gap_to_bound.estimate},
                 {seconds_interval(sum.primal_integral), sum.primal_integral.estimate},
                 number(sum.reached[0]),
                 number(sum.reached[1])});
        }
        const bool is_fair =
            !solvers.empty() && std::all_of(solvers.begin(), solvers.end(), [&](std::size_t s) {
                return comparison_.solvers[s].taken == comparison_.solvers[solvers[0]].taken;
            });
        for (const std::size_t column : {3, 7, 8}) {
            if (is_fair) mark_best(table, column, false, table.rows.size());
        }
        for (const std::size_t column : {4, 5, 6}) {
            if (is_fair) mark_best(table, column, true, table.rows.size());
        }
        return table;
    }

    /// Time to each target: shifted geometric means where it was reached by the median run.
    Table targets(const std::vector<std::size_t>& solvers) const {
        Table table;
        table.caption =
            "Median time, by the solver's own clock, to reach a value within a gap of "
            "the best known one, over the problems on which the median run gets there "
            "(their number in brackets).";
        table.columns = {"solver", "1%", "0.1%", "best known"};
        for (const std::size_t s : solvers) {
            std::vector<TableCell> row{plan_.solvers[s].name};
            for (std::size_t t = 0; t < kTargets.size(); ++t) {
                std::vector<double> times;
                for (const Cell& cell : comparison_.cells[s]) {
                    const bool counts =
                        cell.standing == Standing::Taken && std::isfinite(cell.target_seconds[t]);
                    if (counts) times.push_back(cell.target_seconds[t]);
                }
                const double time = median(times);
                row.emplace_back(times.empty() ? "never"
                                               : seconds_text(time) + " s (" +
                                                     std::to_string(times.size()) + ")",
                                 time);
            }
            table.rows.push_back(std::move(row));
        }
        return table;
    }

private:
    std::vector<TableCell> exact_row(const std::string& name, const SolverSummary& sum) const {
        std::vector<TableCell> row{name,
                                   number(sum.taken),
                                   number(sum.proven),
                                   {seconds_interval(sum.time), sum.time.estimate},
                                   {seconds_interval(sum.par10), sum.par10.estimate},
                                   number(sum.fastest),
                                   {proof_range(sum), sum.longest_proof}};
        if (comparison_.has_instructions) {
            row.emplace_back(instruction_text(sum.instructions), sum.instructions);
        }
        if (has_spread()) row.emplace_back(ratio_text(sum.spread), sum.spread);
        return row;
    }

    bool has_spread() const {
        return std::any_of(comparison_.solvers.begin(), comparison_.solvers.end(),
                           [](const SolverSummary& sum) { return !std::isnan(sum.spread); });
    }

    const ReportInput& input_;
    const Plan& plan_;
    const Comparison& comparison_;
};

/// The same solver with nothing to start from, if it was run.
std::optional<std::size_t> cold_twin(const Plan& plan, std::size_t warm) {
    const SolverConfig& w = plan.solvers[warm];
    for (std::size_t s = 0; s < plan.solvers.size(); ++s) {
        const SolverConfig& c = plan.solvers[s];
        if (c.start.empty() && c.solver == w.solver && c.program == w.program &&
            c.options == w.options && c.threads == w.threads && c.limits.gap == w.limits.gap) {
            return s;
        }
    }
    return std::nullopt;
}

/// What the start is worth: each solver with it against itself without it.
Table gains_by_start(const ReportInput& input, const std::vector<std::size_t>& warm) {
    Table table;
    table.caption =
        "With the start over without it, on the problems that both took: ratios below 1 "
        "and differences below 0 are what the start gains.";
    table.columns = {"solver", "problems",   "proven without",
                     "with",   "time ratio", "gap difference"};
    for (const std::size_t s : warm) {
        const auto cold = cold_twin(input.campaign.plan, s);
        if (!cold) continue;
        const PairComparison pair = compare_pair(input.campaign, input.comparison, *cold, s);
        if (pair.common == 0) continue;
        table.rows.push_back(
            {input.campaign.plan.solvers[s].name,
             number(pair.common),
             number(pair.both_proven + pair.only_a),
             number(pair.both_proven + pair.only_b),
             {ratio_interval(pair.time_ratio), pair.time_ratio.estimate},
             {percent_interval(pair.gap_difference), pair.gap_difference.estimate}});
    }
    return table;
}

const Cell* best_cell(const Comparison& comparison, std::size_t problem, std::size_t& solver) {
    const Cell* best = nullptr;
    for (std::size_t s = 0; s < comparison.cells.size(); ++s) {
        const Cell& cell = comparison.cells[s][problem];
        if (cell.standing != Standing::Taken || !cell.is_proven) continue;
        if (best == nullptr || cell.counted < best->counted) {
            best = &cell;
            solver = s;
        }
    }
    return best;
}

std::string real_value(std::optional<std::int64_t> value, double units) {
    return value ? decimal_text(static_cast<double>(*value) / units, units > 1 ? 4 : 0) : "–";
}

double real_number(std::optional<std::int64_t> value, double units) {
    return value ? static_cast<double>(*value) / units : std::nan("");
}

/// An exact solver that ends by itself, and proves nothing to us: a reader must know why.
std::string ended_without_proof(const ReportInput& input, std::size_t solver) {
    const std::size_t count = input.comparison.solvers[solver].ended_unproven;
    if (count == 0) return "";
    std::set<std::string> messages;
    for (std::size_t j = 0; j < input.campaign.plan.jobs.size(); ++j) {
        const auto& record = input.campaign.records[j];
        if (input.campaign.plan.jobs[j].solver != solver || !record) continue;
        const bool is_stopped =
            record->stop_reason == "time-limit" || record->stop_reason == "work-limit";
        const bool counts = record->outcome == Outcome::Feasible && !is_stopped;
        if (counts && !record->message.empty()) messages.insert(record->message);
    }
    std::string text = input.campaign.plan.solvers[solver].name + ": " + std::to_string(count) +
                       (count == 1 ? " run" : " runs") +
                       " ended before any limit, without an exact proof, and count as unsolved.";
    if (!messages.empty()) text += " It says: " + *messages.begin() + ".";
    return text;
}

}  // namespace

void add_exact_solvers(const ReportInput& input, Document& document) {
    const SolverTables tables(input);
    const auto solvers = tables.chosen([&](std::size_t s) {
        return input.comparison.solvers[s].is_exact && input.campaign.plan.solvers[s].start.empty();
    });
    Section section{"Exact solvers", "exact", {}};
    if (!solvers.empty()) {
        Table table = tables.exact(solvers, true);
        table.caption =
            "Solvers that claim bounds. Means are over the problems that each one took; "
            "where these differ, rows cannot be compared, see the pairs. The best "
            "number of a column is bold where all took as many problems. Times hold a program's "
            "start: its shortest proof says how long that is, at most.";
        if (!std::isnan(input.comparison.solvers[solvers[0]].spread)) {
            table.caption +=
                " The last column is what seeds and renamings alone change: the "
                "geometric mean of slowest over fastest run of a problem.";
        }
        section.blocks.emplace_back(std::move(table));
        BulletList list;
        for (const std::size_t s : solvers) {
            const std::string text = ended_without_proof(input, s);
            if (!text.empty()) list.items.push_back(text);
        }
        if (!list.items.empty()) section.blocks.emplace_back(std::move(list));
    }
    add_section(document, std::move(section));
    add_section(document, {"Plots", "plots", input.plots.of_section("plots")});
}

void add_values(const ReportInput& input, Document& document) {
    const SolverTables tables(input);
    const auto solvers =
        tables.chosen([&](std::size_t s) { return input.campaign.plan.solvers[s].start.empty(); });
    if (solvers.empty()) return;
    Table table = tables.values(solvers);
    table.caption =
        "Values of all solvers: how far they are from the best value that any run found "
        "and from the best bound that any run proved; the primal integral is the area "
        "under the gap over time.";
    Section section{"Values", "values", {}};
    section.blocks.emplace_back(std::move(table));
    section.blocks.emplace_back(tables.targets(solvers));
    add_section(document, std::move(section));
}

void add_starts(const ReportInput& input, Document& document) {
    const SolverTables tables(input);
    const Plan& plan = input.campaign.plan;
    auto warm = tables.chosen([&](std::size_t s) { return !plan.solvers[s].start.empty(); });
    if (warm.empty()) return;
    std::vector<std::size_t> both;
    for (const std::size_t s : warm) {
        if (const auto cold = cold_twin(plan, s)) {
            if (std::find(both.begin(), both.end(), *cold) == both.end()) both.push_back(*cold);
        }
        both.push_back(s);
    }
    Section section{"With our start", "starts", {}};
    section.blocks.emplace_back(Paragraph{
        "Solvers that start from what a short local search finds, beside the same solver without "
        "it. The search's own time is not in theirs. They are in no other comparison."});
    section.blocks.emplace_back(tables.exact(both, false));
    section.blocks.emplace_back(tables.values(both));
    Table gains = gains_by_start(input, warm);
    if (!gains.rows.empty()) section.blocks.emplace_back(std::move(gains));
    add_section(document, std::move(section));
}

void add_scaling(const ReportInput& input, Document& document) {
    Section section{"Time against size", "scaling", input.plots.of_section("scaling")};
    Table table{{"solver", "problems", "exponent", "seconds at 1,000 labels", "R²"}, {}, "", false};
    table.caption =
        "Least squares of log time against log labels: time = factor * labels^exponent.";
    for (const Scaling& scaling : scalings(input.campaign, input.comparison)) {
        if (!scaling.law) continue;
        const PowerLaw& law = *scaling.law;
        const double at_thousand = law.factor * std::pow(1000.0, law.exponent);
        table.rows.push_back({input.campaign.plan.solvers[scaling.solver].name,
                              number(law.points),
                              {decimal_text(law.exponent, 2), law.exponent},
                              {seconds_text(at_thousand), at_thousand},
                              {decimal_text(law.r_squared, 2), law.r_squared}});
    }
    if (!table.rows.empty()) section.blocks.emplace_back(std::move(table));
    add_section(document, std::move(section));
}

void add_problems(const ReportInput& input, Document& document) {
    const Plan& plan = input.campaign.plan;
    const Comparison& comparison = input.comparison;
    Table table;
    table.caption = "The problems";
    table.columns = {"problem",    "group",      "labels", "conflicts",     "rules",
                     "best value", "best bound", "gap",    "fastest proof", "its seconds"};
    for (std::size_t p = 0; p < plan.problems.size(); ++p) {
        const PlannedProblem& problem = plan.problems[p];
        if (problem.is_study) continue;
        const ProblemKnowledge& known = comparison.check.problems[p];
        const auto size = [](std::int64_t n) {
            return TableCell(count_text(static_cast<double>(n)), static_cast<double>(n));
        };
        const double gap = known.best_value && known.best_bound
                               ? primal_gap(known.best_value, *known.best_bound)
                               : std::nan("");
        const double units = problem.units_per_one;
        std::size_t solver = 0;
        const Cell* fastest = best_cell(comparison, p, solver);
        table.rows.push_back(
            {problem.name,
             problem.group,
             size(problem.labels),
             size(problem.conflicts),
             size(problem.rules),
             {known.is_proven_infeasible ? "infeasible" : real_value(known.best_value, units),
              real_number(known.best_value, units)},
             {real_value(known.best_bound, units), real_number(known.best_bound, units)},
             {percent_text(gap), gap},
             fastest ? plan.solvers[solver].name : "open",
             {fastest ? seconds_text(fastest->counted) : "–",
              fastest ? fastest->counted : std::nan("")}});
    }
    if (table.rows.empty()) return;
    table.is_long = table.rows.size() > 25;
    Section section{"Problems", "problems", {}};
    section.blocks.emplace_back(std::move(table));
    add_section(document, std::move(section));
}

}  // namespace experiment
