// Numbers of the plots; the drawing itself knows nothing of solvers (plots.py). Solvers with a
// start are in no plot but their scatter: they had help.
#include "experiment/plot_data.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiment/ablation.h"

namespace experiment {
namespace {

using nlohmann::json;

constexpr std::size_t kFewestPoints = 2;
constexpr int kTimePoints = 80;

json axis(const std::string& label, const std::string& scale = "linear") {
    return {{"label", label}, {"scale", scale}};
}

/// Percentages over several orders, zero included.
json percent_axis(const std::string& label) {
    return {{"label", label}, {"scale", "symlog"}, {"threshold", 0.01}, {"low", 0}};
}

json series_of(const std::string& name, std::size_t index, const Points& points) {
    json x = json::array(), y = json::array();
    for (const auto& [a, b] : points) {
        x.push_back(a);
        y.push_back(b);
    }
    return {{"name", name}, {"index", index}, {"x", x}, {"y", y}};
}

json line_of(const Points& points) {
    json line = series_of("", 0, points);
    return {{"x", line["x"]}, {"y", line["y"]}};
}

class SolverPlots {
public:
    SolverPlots(const CampaignRuns& campaign, const Comparison& comparison, PlotData& data)
        : campaign_(campaign), plan_(campaign.plan), comparison_(comparison), data_(data) {
        for (std::size_t s = 0; s < plan_.solvers.size(); ++s) {
            if (!plan_.solvers[s].start.empty() || comparison.solvers[s].taken == 0) continue;
            cold_.push_back(s);
            if (comparison.solvers[s].is_exact) exact_.push_back(s);
        }
        clock_ = plan_.report.clock == "wall" ? "wall time [s]" : "CPU time [s]";
    }

    void add_all() {
        if (!exact_.empty()) {
            add_profile();
            add_cactus();
        }
        if (!cold_.empty()) add_gap_over_time();
        add_gaps("gap-best", "Gap to the best known value", &Cell::gap_to_best,
                 "gap to the best known value [%]");
        add_gaps("gap-bound", "Gap to the best bound", &Cell::gap_to_bound,
                 "gap to the best proven bound [%]");
        add_scaling();
        add_ablations();
        add_scatters();
    }

private:
    const std::string& name(std::size_t s) const { return plan_.solvers[s].name; }

    void add(const std::string& section, const std::string& file, const std::string& kind,
             const std::string& title, const std::string& caption, json figure) {
        figure["name"] = file;
        figure["kind"] = kind;
        figure["title"] = title;
        data_.figures.push_back(std::move(figure));
        data_.captions.push_back({section, {file, caption}});
    }

    /// Problems that every exact solver took, so that no curve is over easier ones.
    std::vector<std::size_t> common_problems() const {
        std::vector<std::size_t> common;
        for (std::size_t p = 0; p < plan_.problems.size(); ++p) {
            if (std::all_of(exact_.begin(), exact_.end(), [&](std::size_t s) {
                    return comparison_.cells[s][p].standing == Standing::Taken;
                })) {
                common.push_back(p);
            }
        }
        return common;
    }

    double floored(const Cell& cell) const {
        return std::max(cell.counted, plan_.report.floor_seconds);
    }

    void add_profile() {
        const auto problems = common_problems();
        if (problems.empty()) return;
        constexpr double kInfinite = std::numeric_limits<double>::infinity();
        std::vector<Points> curves;
        double largest = 1.05;
        for (const std::size_t s : exact_) {
            std::vector<double> ratios;
            for (const std::size_t p : problems) {
                double best = kInfinite;
                for (const std::size_t other : exact_) {
                    const Cell& cell = comparison_.cells[other][p];
                    if (cell.is_proven) best = std::min(best, floored(cell));
                }
                const Cell& cell = comparison_.cells[s][p];
                ratios.push_back(cell.is_proven ? floored(cell) / best : kInfinite);
            }
            curves.push_back(performance_profile(ratios, problems.size()));
            if (!curves.back().empty()) largest = std::max(largest, curves.back().back().first);
        }
        json series = json::array();
        for (std::size_t k = 0; k < exact_.size(); ++k) {
            Points points = curves[k];
            if (points.empty() || points.front().first > 1) points.insert(points.begin(), {1, 0});
            points.emplace_back(largest * 1.1, points.back().second);
            for (auto& [x, y] : points) y *= 100;
            series.push_back(series_of(name(exact_[k]), exact_[k], points));
        }
        json y = axis("problems proven [%]");
        y["low"] = 0;
        y["high"] = 102;
        add("plots", "profile", "lines", "Performance profile",
            "Performance profile over the " + std::to_string(problems.size()) +
                " problems that all of these solvers took: the share proven within x times the "
                "time of the fastest one (times below the floor count as the floor). A profile "
                "of more than two solvers does not rank them; see the pairwise ratios.",
            {{"steps", true},
             {"series", series},
             {"x", axis("time over the fastest solver's time", "log")},
             {"y", y}});
    }

    void add_cactus() {
        json series = json::array();
        for (const std::size_t s : exact_) {
            std::vector<double> times;
            for (const Cell& cell : comparison_.cells[s]) {
                if (cell.standing == Standing::Taken && cell.is_proven) {
                    times.push_back(floored(cell));
                }
            }
            if (!times.empty()) series.push_back(series_of(name(s), s, cactus(times)));
        }
        if (series.empty()) return;
        json count = axis("problems proven");
        count["is_count"] = true;
        add("plots", "cactus", "lines", "Cactus plot",
            "Cactus plot: how many problems each exact solver proves when every problem may take "
            "that long (times below the floor count as the floor); further right and lower is "
            "better. "
            "Each over the problems it took.",
            {{"series", series},
             {"x", count},
             {"y", axis("limit for each problem, " + clock_, "log")}});
    }

    /// Mean over problems of the mean over runs of the gap at `seconds`, in percent.
    double gap_at(const std::vector<std::vector<std::vector<GapStep>>>& problems,
                  double seconds) const {
        double sum = 0;
        for (const auto& runs : problems) {
            double of_problem = 0;
            for (const auto& steps : runs) {
                double gap = 1;
                for (const GapStep& step : steps) {
                    if (step.seconds <= seconds) gap = step.gap;
                }
                of_problem += gap;
            }
            sum += of_problem / static_cast<double>(runs.size());
        }
        return 100 * sum / static_cast<double>(problems.size());
    }

    void add_gap_over_time() {
        const RunReader reader(campaign_, comparison_.check);
        const double end = comparison_.horizon;
        const double begin = std::min(0.01, end / 10);
        if (!(end > 0)) return;
        json series = json::array();
        for (const std::size_t s : cold_) {
            std::map<std::size_t, std::vector<std::vector<GapStep>>> by_problem;
            for (std::size_t j = 0; j < plan_.jobs.size(); ++j) {
                if (plan_.jobs[j].solver != s) continue;
                if (plan_.problems[plan_.jobs[j].problem].is_study) continue;
                RunReading reading = reader.read(j);
                if (reading.steps.empty()) continue;
                by_problem[plan_.jobs[j].problem].push_back(std::move(reading.steps));
            }
            if (by_problem.empty()) continue;
            std::vector<std::vector<std::vector<GapStep>>> problems;
            for (auto& [p, runs] : by_problem) problems.push_back(std::move(runs));
            Points points;
            for (int k = 0; k <= kTimePoints; ++k) {
                const double seconds = begin * std::pow(end / begin, k / double{kTimePoints});
                points.emplace_back(seconds, gap_at(problems, seconds));
            }
            series.push_back(series_of(name(s), s, points));
        }
        if (series.empty()) return;
        json y = percent_axis("mean gap to the best known value [%]");
        y["high"] = 120;
        add("plots", "gap-over-time", "lines", "Primal gap over time",
            "Mean gap to the best known value over time, by the solvers' own clock; 100% before "
            "the first solution. The area under a curve is the primal integral.",
            {{"steps", true}, {"series", series}, {"x", axis("time [s]", "log")}, {"y", y}});
    }

    void add_gaps(const std::string& file, const std::string& title, double Cell::*measure,
                  const std::string& label) {
        json series = json::array();
        for (const std::size_t s : cold_) {
            json values = json::array();
            for (const Grouped& number : measured(campaign_, comparison_.cells[s], measure)) {
                values.push_back(100 * number.value);
            }
            if (values.empty()) continue;
            series.push_back({{"name", name(s)}, {"index", s}, {"y", values}});
        }
        if (series.empty()) return;
        add("plots", file, "boxes", title,
            title +
                ", a point for each problem that the solver took: median, quartiles, and "
                "whiskers at 5% and 95%.",
            {{"series", series}, {"x", percent_axis(label)}});
    }

    void add_scaling() {
        json series = json::array();
        for (const Scaling& scaling : scalings(campaign_, comparison_)) {
            if (!plan_.solvers[scaling.solver].start.empty()) continue;
            if (scaling.points.size() < kFewestPoints) continue;
            json entry = series_of(name(scaling.solver), scaling.solver, scaling.points);
            if (scaling.law) {
                const auto [low, high] =
                    std::minmax_element(scaling.points.begin(), scaling.points.end());
                char exponent[32];
                std::snprintf(exponent, sizeof exponent, "%.2f", scaling.law->exponent);
                entry["name"] = name(scaling.solver) + ", ~n^" + exponent;
                Points fit;
                for (const double x : {low->first, high->first}) {
                    fit.emplace_back(x, scaling.law->factor * std::pow(x, scaling.law->exponent));
                }
                entry["fit"] = line_of(fit);
            }
            series.push_back(std::move(entry));
        }
        if (series.empty()) return;
        add("scaling", "time-size", "points", "Time against size",
            "Time against the number of labels: problems proven by exact solvers; for the others, "
            "runs that no limit ended. Lines are least squares of logarithms. Problems "
            "that were not finished are missing at the upper right, so exponents are too low where "
            "there are many; and a program's start, in all times, makes them lower still where "
            "problems are small.",
            {{"series", series}, {"x", axis("labels", "log")}, {"y", axis(clock_, "log")}});
    }

    void add_bars(const std::string& file, const std::string& title, const std::string& caption,
                  const json& bars, double reference, json x) {
        if (bars.empty()) return;
        json figure{{"bars", bars}, {"reference", reference}, {"x", std::move(x)}};
        figure["series"] = json::array();
        add("ablations", file, "bars", title, caption, std::move(figure));
    }

    void add_ablations() {
        json times = json::array(), gaps = json::array();
        for (const Ablation& ablation : find_ablations(plan_)) {
            const auto pair =
                compare_pair(campaign_, comparison_, ablation.parent, ablation.variant);
            if (pair.common == 0) continue;
            const std::string text = name(ablation.parent) + ": " + ablation.change;
            const auto bar = [&](const Interval& interval, double factor) {
                const bool is_known = interval.is_known;
                return json{{"name", text},
                            {"index", ablation.parent},
                            {"value", factor * interval.estimate},
                            {"low", is_known ? json(factor * interval.low) : json()},
                            {"high", is_known ? json(factor * interval.high) : json()}};
            };
            if (std::isfinite(pair.time_ratio.estimate)) times.push_back(bar(pair.time_ratio, 1));
            if (std::isfinite(pair.gap_difference.estimate)) {
                gaps.push_back(bar(pair.gap_difference, 100));
            }
        }
        add_bars("ablation-time", "Ablations: time",
                 "Time with one thing changed over time as it is, geometric mean over the problems "
                 "that either proves, with 95% intervals by group; right of 1 the change costs "
                 "time.",
                 times, 1, axis("time over the unchanged solver's time", "log"));
        add_bars("ablation-gap", "Ablations: gap",
                 "Gap to the best known value with one thing changed, less the gap as it is, with "
                 "95% intervals by group; right of 0 the change costs quality.",
                 gaps, 0, axis("difference of the mean gap [percentage points]"));
    }

    void add_scatters() {
        const std::size_t a = baseline_of(plan_);
        for (std::size_t b = 0; b < plan_.solvers.size(); ++b) {
            if (b == a || !plan_.solvers[b].start.empty()) continue;
            const bool are_exact =
                comparison_.solvers[a].is_exact && comparison_.solvers[b].is_exact;
            are_exact ? add_time_scatter(a, b) : add_gap_scatter(a, b);
        }
    }

    template <class Coordinate>
    Points pair_points(std::size_t a, std::size_t b, const Coordinate& coordinate) const {
        Points points;
        for (std::size_t p = 0; p < plan_.problems.size(); ++p) {
            const Cell& x = comparison_.cells[a][p];
            const Cell& y = comparison_.cells[b][p];
            if (x.standing != Standing::Taken || y.standing != Standing::Taken) continue;
            const std::pair point(coordinate(x), coordinate(y));
            if (!std::isnan(point.first) && !std::isnan(point.second)) points.push_back(point);
        }
        return points;
    }

    void add_time_scatter(std::size_t a, std::size_t b) {
        const Points points = pair_points(a, b, [&](const Cell& c) { return floored(c); });
        if (points.size() < kFewestPoints) return;
        double low = plan_.report.floor_seconds, high = low * 10;
        for (const auto& [x, y] : points) high = std::max({high, x, y});
        add("pairs", "scatter-" + std::to_string(b), "points", name(a) + " against " + name(b),
            name(a) + " against " + name(b) +
                ", a point a problem that both took; unproven at the "
                "limit, at least the floor. Above the diagonal " +
                name(a) + " is faster.",
            {{"series", {series_of(name(b), b, points)}},
             {"square", true},
             {"guides", {line_of({{low, low}, {high, high}})}},
             {"x", axis(name(a) + ", " + clock_, "log")},
             {"y", axis(name(b) + ", " + clock_, "log")}});
    }

    void add_gap_scatter(std::size_t a, std::size_t b) {
        const Points points = pair_points(a, b, [](const Cell& c) { return 100 * c.gap_to_best; });
        if (points.size() < kFewestPoints) return;
        add("pairs", "scatter-" + std::to_string(b), "points", name(a) + " against " + name(b),
            name(a) + " against " + name(b) +
                ", a point a problem that both took: gap to the best "
                "known value. Above the diagonal " +
                name(a) + " is better.",
            {{"series", {series_of(name(b), b, points)}},
             {"square", true},
             {"guides", {line_of({{0, 0}, {100, 100}})}},
             {"x", percent_axis(name(a) + ", gap [%]")},
             {"y", percent_axis(name(b) + ", gap [%]")}});
    }

    const CampaignRuns& campaign_;
    const Plan& plan_;
    const Comparison& comparison_;
    PlotData& data_;
    std::vector<std::size_t> cold_, exact_;
    std::string clock_;
};

}  // namespace

std::vector<Block> PlotData::of_section(const std::string& id) const {
    std::vector<Block> blocks;
    for (const auto& [section, figure] : captions) {
        if (section == id) blocks.emplace_back(figure);
    }
    return blocks;
}

std::vector<Scaling> scalings(const CampaignRuns& campaign, const Comparison& comparison) {
    const Plan& plan = campaign.plan;
    std::vector<Scaling> result;
    for (std::size_t s = 0; s < plan.solvers.size(); ++s) {
        Scaling scaling;
        scaling.solver = s;
        for (std::size_t p = 0; p < plan.problems.size(); ++p) {
            const Cell& cell = comparison.cells[s][p];
            if (cell.standing != Standing::Taken || plan.problems[p].labels < 1) continue;
            const bool is_done = comparison.solvers[s].is_exact
                                     ? cell.is_proven
                                     : cell.value.has_value() && !cell.was_stopped;
            if (!is_done || cell.seconds <= 0) continue;
            scaling.points.emplace_back(static_cast<double>(plan.problems[p].labels), cell.seconds);
        }
        scaling.law = fit_power_law(scaling.points);
        if (!scaling.points.empty()) result.push_back(std::move(scaling));
    }
    return result;
}

void add_solver_plots(const CampaignRuns& campaign, const Comparison& comparison, PlotData& data) {
    SolverPlots(campaign, comparison, data).add_all();
}

}  // namespace experiment
