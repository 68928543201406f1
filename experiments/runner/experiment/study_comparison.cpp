// The study of what the objective is worth: each solver's network is remeshed, and the meshes are
// compared with how far its objective was from the best one. Meshes differ far more from each other
// than solvers do on one, so differences to the baseline on the same problem are compared.
#include "experiment/study_comparison.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>

#include "experiment/primal_integral.h"
#include "experiment/statistics.h"

namespace experiment {
namespace {

namespace fs = std::filesystem;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kChanged = "changed_segments";

const std::vector<StudyMeasure>& all_measures() {
    static const std::vector<StudyMeasure> kMeasures{
        {"coverage", "feature coverage [%]", 100},
        {"hausdorff_over_diagonal", "Hausdorff distance [% of diagonal]", 100},
        {"min_angle_degrees", "smallest angle [°]", 1},
        {"mean_min_angle_degrees", "mean of triangles' smallest angles [°]", 1},
        {"share_under_30_degrees", "angles under 30° [%]", 100},
        {"segments", "segments kept", 1},
        {kChanged, "segments changed against the baseline [%]", 100}};
    return kMeasures;
}

std::vector<std::string> lines_of(const fs::path& file) {
    std::ifstream in(file);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) {
        if (!line.empty()) lines.push_back(line);
    }
    return lines;
}

class StudyComparer {
public:
    StudyComparer(const CampaignRuns& campaign, const fs::path& home)
        : campaign_(campaign), plan_(campaign.plan), folder_(home / "segments") {}

    StudyComparison compare() {
        for (std::size_t s = 0; s < plan_.solvers.size(); ++s) {
            if (plan_.solvers[s].name == plan_.report.baseline) result_.baseline = s;
        }
        collect_runs();
        std::map<std::size_t, std::int64_t> best;
        for (const auto& [where, jobs] : runs_) {
            for (const std::size_t j : jobs) {
                const auto found = best.emplace(where.first, *record(j).value).first;
                found->second = std::max(found->second, *record(j).value);
            }
        }
        for (const auto& [where, jobs] : runs_) {
            result_.entries.push_back(entry_of(where.first, where.second, jobs, best));
        }
        drop_unknown_measures();
        return std::move(result_);
    }

private:
    const Record& record(std::size_t job) const { return *campaign_.records[job]; }

    void collect_runs() {
        for (std::size_t j = 0; j < plan_.jobs.size(); ++j) {
            const Job& job = plan_.jobs[j];
            if (!plan_.problems[job.problem].is_study || !campaign_.records[j]) continue;
            if (is_solved(record(j).outcome) && record(j).value) {
                runs_[{job.problem, job.solver}].push_back(j);
            } else {
                ++result_.runs_without_result;
            }
        }
    }

    StudyEntry entry_of(std::size_t problem, std::size_t solver,
                        const std::vector<std::size_t>& jobs,
                        const std::map<std::size_t, std::int64_t>& best) const {
        StudyEntry entry;
        entry.solver = solver;
        entry.problem = problem;
        entry.runs = jobs.size();
        std::vector<double> values, gaps;
        for (const std::size_t j : jobs) {
            values.push_back(static_cast<double>(*record(j).value) /
                             plan_.problems[problem].units_per_one);
            gaps.push_back(primal_gap(record(j).value, best.at(problem)));
        }
        entry.value = median(values);
        entry.gap = median(gaps);
        for (const StudyMeasure& measure : all_measures()) {
            std::vector<double> numbers;
            for (const std::size_t j : jobs) {
                const double number = statistic(measure.key, j);
                if (!std::isnan(number)) numbers.push_back(measure.factor * number);
            }
            entry.measures.push_back(median(numbers));
        }
        return entry;
    }

    double statistic(const std::string& key, std::size_t j) const {
        if (key == kChanged) return changed(j);
        const auto& statistics = record(j).statistics;
        const auto it = statistics.find(key);
        return it == statistics.end() ? kUnknown : it->second;
    }

    /// Against the baseline's run of the same seed, or else its first.
    double changed(std::size_t j) const {
        const auto found = runs_.find({plan_.jobs[j].problem, result_.baseline});
        if (found == runs_.end()) return kUnknown;
        std::size_t other = found->second.front();
        for (const std::size_t k : found->second) {
            if (plan_.jobs[k].seed == plan_.jobs[j].seed) other = k;
        }
        const fs::path ours = folder_ / (plan_.jobs[j].key + ".txt");
        const fs::path theirs = folder_ / (plan_.jobs[other].key + ".txt");
        std::error_code error;
        if (!fs::exists(ours, error) || !fs::exists(theirs, error)) return kUnknown;
        return changed_share(lines_of(ours), lines_of(theirs));
    }

    void drop_unknown_measures() {
        const auto& measures = all_measures();
        std::vector<std::size_t> kept;
        for (std::size_t m = 0; m < measures.size(); ++m) {
            const bool is_known =
                std::any_of(result_.entries.begin(), result_.entries.end(),
                            [&](const StudyEntry& e) { return !std::isnan(e.measures[m]); });
            if (!is_known) continue;
            kept.push_back(m);
            result_.measures.push_back(measures[m]);
        }
        for (StudyEntry& entry : result_.entries) {
            std::vector<double> known;
            for (const std::size_t m : kept) known.push_back(entry.measures[m]);
            entry.measures = std::move(known);
        }
    }

    const CampaignRuns& campaign_;
    const Plan& plan_;
    fs::path folder_;
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> runs_;
    StudyComparison result_;
};

double number_of(const StudyEntry& entry, std::size_t m) {
    return m < entry.measures.size() ? entry.measures[m] : 100 * entry.gap;
}

}  // namespace

const StudyEntry* StudyComparison::find(std::size_t solver, std::size_t problem) const {
    for (const StudyEntry& entry : entries) {
        if (entry.solver == solver && entry.problem == problem) return &entry;
    }
    return nullptr;
}

StudyComparison compare_studies(const CampaignRuns& campaign, const fs::path& home) {
    return StudyComparer(campaign, home).compare();
}

double changed_share(std::vector<std::string> a, std::vector<std::string> b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    std::vector<std::string> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    const std::size_t all = a.size() + b.size() - both.size();
    if (all == 0) return 0;
    return 1 - static_cast<double>(both.size()) / static_cast<double>(all);
}

Interval study_mean(const CampaignRuns& campaign, const StudyComparison& study, std::size_t solver,
                    std::size_t m) {
    std::vector<Grouped> numbers;
    for (const StudyEntry& entry : study.entries) {
        if (entry.solver != solver || std::isnan(number_of(entry, m))) continue;
        numbers.push_back({campaign.plan.problems[entry.problem].group, number_of(entry, m)});
    }
    return bootstrap(numbers, mean_of, campaign.plan.report.resamplings);
}

Interval study_difference(const CampaignRuns& campaign, const StudyComparison& study,
                          std::size_t solver, std::size_t m) {
    std::vector<Grouped> numbers;
    for (const StudyEntry& entry : study.entries) {
        if (entry.solver != solver) continue;
        const StudyEntry* base = study.find(study.baseline, entry.problem);
        if (base == nullptr) continue;
        const double difference = number_of(entry, m) - number_of(*base, m);
        if (std::isnan(difference)) continue;
        numbers.push_back({campaign.plan.problems[entry.problem].group, difference});
    }
    return bootstrap(numbers, mean_of, campaign.plan.report.resamplings);
}

Interval study_correlation(const CampaignRuns& campaign, const StudyComparison& study,
                           std::size_t m) {
    std::vector<Grouped> numbers;
    for (const StudyEntry& entry : study.entries) {
        const StudyEntry* base = study.find(study.baseline, entry.problem);
        if (base == nullptr || entry.solver == study.baseline) continue;
        const double difference = number_of(entry, m) - number_of(*base, m);
        if (std::isnan(difference)) continue;
        numbers.push_back(
            {campaign.plan.problems[entry.problem].group, entry.gap - base->gap, difference});
    }
    const Statistic correlation = [](const std::vector<Sample>& drawn) {
        Points points;
        for (const Sample& sample : drawn) points.emplace_back(sample.value, sample.other);
        return rank_correlation(points).value_or(kUnknown);
    };
    return bootstrap(numbers, correlation, campaign.plan.report.resamplings);
}

}  // namespace experiment
