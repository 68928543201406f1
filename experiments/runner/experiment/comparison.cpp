// Tables of solvers. Every problem counts once for a solver, by the median over seeds and
// renamings; problems that a solver did not take are left out of its means and, between two
// solvers, out of both. Intervals draw groups of problems, see bootstrap.h.
#include "experiment/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiment/statistics.h"

namespace experiment {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kNever = std::numeric_limits<double>::infinity();

template <class Measure>
double median_over(const std::vector<RunReading>& readings, const Measure& measure) {
    std::vector<double> values;
    for (const RunReading& reading : readings) values.push_back(measure(reading));
    // Unknown for one is unknown for all: it depends on the problem.
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) {
        return kUnknown;
    }
    return median(values);
}

std::optional<std::int64_t> median_value(const std::vector<RunReading>& readings) {
    std::vector<std::optional<std::int64_t>> values;
    for (const RunReading& reading : readings) values.push_back(reading.value);
    std::sort(values.begin(), values.end());  // nothing comes before every value
    return values[(values.size() - 1) / 2];
}

/// Slowest over fastest of several runs that all found a proof: what names and seeds alone change.
double spread_of(const std::vector<RunReading>& readings, double floor_seconds) {
    const bool all_proven = std::all_of(readings.begin(), readings.end(),
                                        [](const RunReading& r) { return r.is_proven; });
    if (readings.size() < 2 || !all_proven) return kUnknown;
    const auto [fastest, slowest] = std::minmax_element(
        readings.begin(), readings.end(),
        [](const RunReading& a, const RunReading& b) { return a.seconds < b.seconds; });
    return std::max(slowest->seconds, floor_seconds) / std::max(fastest->seconds, floor_seconds);
}

class Comparer {
public:
    explicit Comparer(const CampaignRuns& campaign) : campaign_(campaign), plan_(campaign.plan) {}

    Comparison compare() {
        result_.check = cross_check(campaign_);
        const RunReader reader(campaign_, result_.check);
        result_.horizon = reader.horizon();
        result_.uses_largest_time = reader.uses_largest_time();
        result_.solvers.resize(plan_.solvers.size());
        fill_cells(reader);
        for (std::size_t s = 0; s < plan_.solvers.size(); ++s) {
            count_problems(s);
            fill_means(result_.solvers[s], result_.cells[s]);
        }
        fill_virtual_best();
        return std::move(result_);
    }

private:
    void fill_cells(const RunReader& reader) {
        std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> jobs;
        for (std::size_t j = 0; j < plan_.jobs.size(); ++j) {
            if (plan_.problems[plan_.jobs[j].problem].is_study) continue;
            count_run(j, reader);
            jobs[{plan_.jobs[j].solver, plan_.jobs[j].problem}].push_back(j);
        }
        result_.cells.assign(plan_.solvers.size(), std::vector<Cell>(plan_.problems.size()));
        for (const auto& [where, of_cell] : jobs) {
            result_.cells[where.first][where.second] = cell_of(of_cell, reader);
        }
    }

    void count_run(std::size_t j, const RunReader& reader) {
        SolverSummary& summary = result_.solvers[plan_.jobs[j].solver];
        ++summary.runs_planned;
        const auto& record = campaign_.records[j];
        if (!record) return;
        ++summary.runs_made;
        ++summary.outcomes[record->outcome];
        const SolverConfig& solver = plan_.solvers[plan_.jobs[j].solver];
        if (claimed_bound(*record, solver)) summary.is_exact = true;
        const RunReading reading = reader.read(j);
        if (reading.standing != Standing::Taken) return;
        if (solver.limits.seconds && reading.seconds > reading.limit) ++summary.runs_over_limit;
        summary.ended_unproven += reading.has_value && !reading.is_proven && !reading.was_stopped;
        if (!reading.is_proven) return;
        summary.shortest_proof = std::fmin(summary.shortest_proof, reading.seconds);
        summary.longest_proof = std::fmax(summary.longest_proof, reading.seconds);
    }

    Cell cell_of(const std::vector<std::size_t>& jobs, const RunReader& reader) {
        std::vector<RunReading> taken;
        std::vector<double> instructions;
        Standing standing = Standing::NotRun;
        for (const std::size_t j : jobs) {
            const RunReading reading = reader.read(j);
            standing = std::max(standing, reading.standing);
            if (reading.standing != Standing::Taken) continue;
            taken.push_back(reading);
            const Measures& m = campaign_.records[j]->measures;
            if (m.instructions) instructions.push_back(static_cast<double>(*m.instructions));
        }
        Cell cell;
        if (!taken.empty()) cell = summarise(taken, result_.horizon, plan_.report.floor_seconds);
        cell.standing = standing;
        cell.is_planned = true;
        cell.instructions = median(instructions);
        if (!instructions.empty()) result_.has_instructions = true;
        return cell;
    }

    void count_problems(std::size_t s) {
        SolverSummary& summary = result_.solvers[s];
        for (std::size_t p = 0; p < plan_.problems.size(); ++p) {
            const Cell& cell = result_.cells[s][p];
            if (!cell.is_planned) continue;
            switch (cell.standing) {
                case Standing::NotRun:
                    ++summary.not_run;
                    break;
                case Standing::NotApplicable:
                    ++summary.not_applicable;
                    break;
                case Standing::Missing:
                    ++summary.missing;
                    break;
                case Standing::Taken:
                    count_taken(summary, cell, p);
                    break;
            }
        }
    }

    void count_taken(SolverSummary& summary, const Cell& cell, std::size_t p) const {
        ++summary.taken;
        summary.proven += cell.is_proven;
        summary.with_value += cell.value.has_value();
        const auto& best = result_.check.problems[p].best_value;
        summary.at_best += best && cell.value == best;
        for (std::size_t t = 0; t < kTargets.size(); ++t) {
            summary.reached[t] += std::isfinite(cell.target_seconds[t]);
        }
    }

    Interval interval(const std::vector<Cell>& cells, double Cell::*measure,
                      const Statistic& statistic) const {
        return bootstrap(measured(campaign_, cells, measure), statistic, plan_.report.resamplings);
    }

    void fill_means(SolverSummary& summary, const std::vector<Cell>& cells) const {
        const double shift = plan_.report.shift_seconds;
        const Statistic shifted = [shift](const std::vector<Sample>& samples) {
            std::vector<double> values;
            for (const Sample& sample : samples) values.push_back(sample.value);
            return shifted_geometric_mean(values, shift);
        };
        summary.time = interval(cells, &Cell::counted, shifted);
        summary.par10 = interval(cells, &Cell::par10, mean_of);
        summary.gap_to_best = interval(cells, &Cell::gap_to_best, mean_of);
        summary.gap_to_bound = interval(cells, &Cell::gap_to_bound, mean_of);
        summary.primal_integral = interval(cells, &Cell::primal_integral, mean_of);
        std::vector<double> instructions;
        for (const Grouped& number : measured(campaign_, cells, &Cell::instructions)) {
            if (number.value > 0) instructions.push_back(number.value);
        }
        summary.instructions = geometric_mean(instructions);
        std::vector<double> spreads;
        for (const Grouped& number : measured(campaign_, cells, &Cell::spread)) {
            spreads.push_back(number.value);
        }
        summary.spread = geometric_mean(spreads);
    }

    /// On each problem the fastest proof of all; it makes the cells of a solver of its own.
    void fill_virtual_best() {
        std::vector<Cell> best(plan_.problems.size());
        for (std::size_t p = 0; p < plan_.problems.size(); ++p) {
            std::optional<std::size_t> first;
            for (std::size_t s = 0; s < plan_.solvers.size(); ++s) {
                const Cell& cell = result_.cells[s][p];
                const bool counts = result_.solvers[s].is_exact && plan_.solvers[s].start.empty() &&
                                    cell.standing == Standing::Taken;
                if (!counts) continue;
                const auto rank = [&](std::size_t k) {
                    const Cell& c = result_.cells[k][p];
                    return std::pair(c.counted, c.par10);
                };
                if (!first || rank(s) < rank(*first)) first = s;
            }
            if (!first) continue;
            best[p] = result_.cells[*first][p];
            count_taken(result_.virtual_best, best[p], p);
            if (best[p].is_proven) ++result_.solvers[*first].fastest;
        }
        result_.virtual_best.is_exact = true;
        fill_means(result_.virtual_best, best);
    }

    const CampaignRuns& campaign_;
    const Plan& plan_;
    Comparison result_;
};

}  // namespace

std::vector<Grouped> measured(const CampaignRuns& campaign, const std::vector<Cell>& cells,
                              double Cell::*measure) {
    std::vector<Grouped> numbers;
    for (std::size_t p = 0; p < cells.size(); ++p) {
        if (cells[p].standing != Standing::Taken || std::isnan(cells[p].*measure)) continue;
        numbers.push_back({campaign.plan.problems[p].group, cells[p].*measure});
    }
    return numbers;
}

Cell summarise(const std::vector<RunReading>& readings, double horizon, double floor_seconds) {
    Cell cell;
    cell.standing = Standing::Taken;
    cell.made = readings.size();
    const auto proven = std::count_if(readings.begin(), readings.end(),
                                      [](const RunReading& r) { return r.is_proven; });
    cell.was_stopped = std::any_of(readings.begin(), readings.end(),
                                   [](const RunReading& r) { return r.was_stopped; });
    cell.is_proven = 2 * static_cast<std::size_t>(proven) > readings.size();
    cell.seconds = median_over(readings, [](const RunReading& r) { return r.seconds; });
    cell.counted = median_over(readings, [](const RunReading& r) { return r.counted(); });
    cell.spread = spread_of(readings, floor_seconds);
    cell.par10 = median_over(
        readings, [](const RunReading& r) { return r.is_proven ? r.seconds : kPenalty * r.limit; });
    cell.value = median_value(readings);
    cell.gap_to_best = median_over(readings, [](const RunReading& r) { return r.gap_to_best; });
    cell.gap_to_bound = median_over(readings, [](const RunReading& r) { return r.gap_to_bound; });
    cell.primal_integral = median_over(readings, [&](const RunReading& r) {
        return r.steps.empty() ? kUnknown : primal_integral(r.steps, horizon);
    });
    for (std::size_t t = 0; t < kTargets.size(); ++t) {
        cell.target_seconds[t] = median_over(readings, [&](const RunReading& r) {
            return r.steps.empty() ? kUnknown : time_to_gap(r.steps, kTargets[t]).value_or(kNever);
        });
    }
    return cell;
}

Comparison compare_solvers(const CampaignRuns& campaign) { return Comparer(campaign).compare(); }

PairComparison compare_pair(const CampaignRuns& campaign, const Comparison& comparison,
                            std::size_t a, std::size_t b) {
    PairComparison pair;
    pair.a = a;
    pair.b = b;
    const Plan& plan = campaign.plan;
    const double floor = plan.report.floor_seconds;
    std::vector<Grouped> ratios, differences;
    for (std::size_t p = 0; p < plan.problems.size(); ++p) {
        const Cell& x = comparison.cells[a][p];
        const Cell& y = comparison.cells[b][p];
        if (x.standing != Standing::Taken || y.standing != Standing::Taken) continue;
        ++pair.common;
        pair.better_a += x.value > y.value;
        pair.better_b += y.value > x.value;
        pair.equal += x.value == y.value;
        if (!std::isnan(x.gap_to_best)) {
            differences.push_back({plan.problems[p].group, y.gap_to_best - x.gap_to_best});
        }
        pair.both_proven += x.is_proven && y.is_proven;
        pair.only_a += x.is_proven && !y.is_proven;
        pair.only_b += y.is_proven && !x.is_proven;
        if (!x.is_proven && !y.is_proven) continue;
        const double ratio = std::max(y.counted, floor) / std::max(x.counted, floor);
        ratios.push_back({plan.problems[p].group, ratio});
        pair.faster_a += ratio > kTieFactor;
        pair.faster_b += ratio < 1 / kTieFactor;
        pair.ties += ratio <= kTieFactor && ratio >= 1 / kTieFactor;
    }
    pair.time_ratio = bootstrap(ratios, geometric_mean_of, plan.report.resamplings);
    pair.gap_difference = bootstrap(differences, mean_of, plan.report.resamplings);
    return pair;
}

std::size_t baseline_of(const Plan& plan) {
    for (std::size_t s = 0; s < plan.solvers.size(); ++s) {
        if (plan.solvers[s].name == plan.report.baseline) return s;
    }
    return 0;
}

}  // namespace experiment
