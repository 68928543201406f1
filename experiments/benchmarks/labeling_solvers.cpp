// labeling_solvers FILE|FOLDER... [--solvers A,B] [--time SECONDS] [--work TICKS] [--seed N]
//                  [--set KEY=VALUE]... [--permute N | --permutations N]
// Solves labeling problems with several solvers and prints a Markdown table: value, bound, gap,
// processor seconds (children included), wall seconds, those by an external solver's clock, nodes,
// and when the last better value came; then how many problems each solver proved, and how fast. A
// solver may be followed by extra options of its own, as in highs:rows=paper. --permute renames
// labels and rules (N = 0: as they are), to see how much is luck.
// --permutations prints another table: for every problem the median seconds to the proof over N
// renamings, one solver after the other on each. Without a proof the time limit counts; no time is
// less than 0.05 s; a solver that fails throughout is left out; of an external solver the smaller
// counts of its own clock and the processor seconds. Then the geometric means of the first solver's
// speed relative to each other one and to the best other one per problem, over all problems and
// over those where that one needs over 1 s.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling_runs.h"
#include "tools/argument_words.h"

namespace {

namespace fs = std::filesystem;
using labeling::LabelingProblem;
using labeling::SolveResult;
using labeling::SolveStatus;
using labeling_runs::parse_variant;
using labeling_runs::Variant;

struct Arguments {
    std::vector<fs::path> files;
    std::vector<Variant> variants;
    labeling::SolveOptions options;
    std::uint64_t permutation = 0;
    int permutations = 0;
};

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    std::vector<std::string> solvers{"auto"};
    labeling::ArgumentWords words(argc, argv);
    while (words.next()) {
        if (words.is("--solvers")) {
            solvers = words.list();
        } else if (words.is("--time")) {
            arguments.options.time_limit = std::chrono::duration<double>(words.real());
        } else if (words.is("--work")) {
            arguments.options.work_limit = words.integer();
        } else if (words.is("--seed")) {
            arguments.options.seed = words.seed();
        } else if (words.is("--permute")) {
            arguments.permutation = words.seed();
        } else if (words.is("--permutations")) {
            arguments.permutations = static_cast<int>(words.integer());
        } else if (words.is("--set")) {
            const auto [key, value] = words.key_and_value();
            arguments.options.extra[key] = value;
        } else if (!words.is_option()) {
            const auto files = labeling_runs::problem_files(words.word());
            arguments.files.insert(arguments.files.end(), files.begin(), files.end());
        } else {
            words.unknown();
        }
    }
    for (const std::string& text : solvers) arguments.variants.push_back(parse_variant(text));
    if (arguments.files.empty()) throw labeling::InputError("no problem given");
    if (arguments.permutations > 0 && !arguments.options.time_limit) {
        throw labeling::InputError("--permutations needs --time");
    }
    return arguments;
}

struct Run {
    SolveResult result;
    double processor_seconds = 0;
};

Run solve(const LabelingProblem& problem, const Variant& variant, labeling::SolveOptions options) {
    static const labeling::SolverRegistry solvers = labeling_runs::every_solver();
    for (const auto& [key, value] : variant.extra) options.extra[key] = value;
    const double before = labeling_runs::processor_seconds();
    Run run;
    run.result = solvers.find(variant.solver)->solve(problem, options);
    run.processor_seconds = labeling_runs::processor_seconds() - before;
    return run;
}

// ---- one row a run --------------------------------------------------------------------------

void print_value(const std::optional<double>& value) {
    if (value) {
        std::printf(" %.4f |", *value);
    } else {
        std::printf(" |");
    }
}

void print_row(const fs::path& file, const LabelingProblem& problem, const std::string& solver,
               const Run& run) {
    const SolveResult& result = run.result;
    const double units = problem.units_per_one();
    std::printf("| %s | %s |", labeling_runs::problem_name(file).c_str(), solver.c_str());
    std::optional<double> value, bound;
    if (result.solution) value = static_cast<double>(result.solution->value) / units;
    if (result.bound) bound = static_cast<double>(*result.bound) / units;
    print_value(value);
    print_value(bound);
    if (result.status == labeling::SolveStatus::Optimal) {
        std::printf(" proven |");
    } else if (const auto gap = result.relative_gap()) {
        std::printf(" %.3f%% |", 100 * *gap);
    } else {
        std::printf(" |");
    }
    const auto nodes = result.statistics.find("nodes");
    double last_value = 0;
    std::optional<labeling::Value> best;
    for (const auto& point : result.trace) {
        if (point.value && (!best || *point.value > *best)) {
            best = point.value;
            last_value = point.seconds;
        }
    }
    const auto own = result.statistics.find("solver_seconds");
    std::printf(" %.2f | %.2f | %.2f | %.2f | %.0f | %lld |", run.processor_seconds, result.seconds,
                own == result.statistics.end() ? result.seconds : own->second, last_value,
                nodes == result.statistics.end() ? 0.0 : nodes->second,
                static_cast<long long>(result.work));
    std::printf(" %s |\n", result.message.c_str());
    std::fflush(stdout);
}

/// How one solver did on all problems.
struct Tally {
    int runs = 0, proven = 0, proven_soon = 0, at_once = 0;

    void add(const Run& run) {
        constexpr double kSoon = 10, kAtOnce = 0.05;
        ++runs;
        if (run.result.status != SolveStatus::Optimal) return;
        ++proven;
        proven_soon += run.processor_seconds < kSoon ? 1 : 0;
        at_once += run.processor_seconds < kAtOnce ? 1 : 0;
    }
};

void print_runs(const Arguments& arguments) {
    std::vector<Tally> tallies(arguments.variants.size());
    std::printf(
        "| problem | solver | value | bound | gap | CPU s | s | own s | last value at | nodes "
        "| work | message |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const fs::path& file : arguments.files) {
        LabelingProblem problem = labeling::read_problem(file);
        if (arguments.permutation > 0) {
            problem = labeling_runs::renamed(problem, arguments.permutation);
        }
        for (std::size_t k = 0; k < arguments.variants.size(); ++k) {
            const Variant& variant = arguments.variants[k];
            const Run run = solve(problem, variant, arguments.options);
            print_row(file, problem, variant.text, run);
            tallies[k].add(run);
        }
    }
    std::printf(
        "\n| solver | problems | proven | within 10 CPU s | within 0.05 CPU s |\n"
        "|---|---|---|---|---|\n");
    for (std::size_t k = 0; k < tallies.size(); ++k) {
        const Tally& t = tallies[k];
        std::printf("| %s | %d | %d | %d | %d |\n", arguments.variants[k].text.c_str(), t.runs,
                    t.proven, t.proven_soon, t.at_once);
    }
}

// ---- medians over renamings -----------------------------------------------------------------

constexpr double kLeastSeconds = 0.05;
constexpr double kEasySeconds = 1;

/// Seconds to the proof as they count.
double counted_seconds(const Run& run, double limit) {
    const SolveStatus status = run.result.status;
    if (status != SolveStatus::Optimal && status != SolveStatus::Infeasible) return limit;
    double seconds = run.processor_seconds;
    const auto own = run.result.statistics.find("solver_seconds");
    if (own != run.result.statistics.end()) seconds = std::min(seconds, own->second);
    return std::clamp(seconds, kLeastSeconds, limit);
}

struct Median {
    double seconds = 0;
    int proven = 0;
    int failed = 0;  ///< runs in which an external solver was missing or crashed
    bool counts(int runs) const { return failed < runs; }
};

/// Problems by solvers.
using Table = std::vector<std::vector<Median>>;

std::vector<Median> medians(const fs::path& file, const Arguments& arguments) {
    const LabelingProblem problem = labeling::read_problem(file);
    const double limit = arguments.options.time_limit->count();
    std::vector<std::vector<double>> seconds(arguments.variants.size());
    std::vector<Median> row(arguments.variants.size());
    for (int k = 1; k <= arguments.permutations; ++k) {
        const auto order = static_cast<std::uint64_t>(k);
        const LabelingProblem renamed = labeling_runs::renamed(problem, order);
        for (std::size_t v = 0; v < arguments.variants.size(); ++v) {
            const Run run = solve(renamed, arguments.variants[v], arguments.options);
            seconds[v].push_back(counted_seconds(run, limit));
            row[v].proven += seconds[v].back() < limit ? 1 : 0;
            if (run.result.stop_reason == labeling::StopReason::SolverFailed) {
                ++row[v].failed;
                std::fprintf(stderr, "%s: %s\n", arguments.variants[v].text.c_str(),
                             run.result.message.c_str());
            }
        }
    }
    for (std::size_t v = 0; v < row.size(); ++v) {
        std::sort(seconds[v].begin(), seconds[v].end());
        const std::size_t middle = seconds[v].size() / 2;
        row[v].seconds = seconds[v].size() % 2 == 1
                             ? seconds[v][middle]
                             : (seconds[v][middle - 1] + seconds[v][middle]) / 2;
    }
    return row;
}

/// Index of the fastest of all but the first solver; 0 when all others fail.
std::size_t best_other(const std::vector<Median>& row, int runs) {
    std::size_t best = 0;
    for (std::size_t v = 1; v < row.size(); ++v) {
        if (!row[v].counts(runs)) continue;
        if (best == 0 || row[v].seconds < row[best].seconds) best = v;
    }
    return best;
}

/// Geometric mean of how many times faster the first solver is; `other` picks the opponent.
template <class Other>
void print_mean(const Table& table, const std::string& name, const Other& other) {
    double sums[2] = {0, 0};
    int counts[2] = {0, 0};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& row : table) {
        const std::size_t v = other(row);
        if (v == 0) continue;
        const double opponent = row[v].seconds;
        const double ratio = opponent / row[0].seconds;
        least = std::min(least, ratio);
        for (int hard : {0, 1}) {
            if (hard == 1 && opponent <= kEasySeconds) continue;
            sums[hard] += std::log(ratio);
            ++counts[hard];
        }
    }
    std::printf("| %s |", name.c_str());
    for (int hard : {0, 1}) {
        if (counts[hard] > 0) std::printf(" %.2f", std::exp(sums[hard] / counts[hard]));
        std::printf(" | %d |", counts[hard]);
    }
    if (counts[0] > 0) std::printf(" %.2f", least);
    std::printf(" |\n");
}

void print_medians(const Arguments& arguments) {
    const auto& variants = arguments.variants;
    const bool has_others = variants.size() > 1;
    const int runs = arguments.permutations;
    std::printf("Median seconds of %d renamings, limit %g s; in brackets how many were proven.\n\n",
                runs, arguments.options.time_limit->count());
    std::printf("| problem |");
    for (const Variant& variant : variants) std::printf(" %s |", variant.text.c_str());
    std::printf(has_others ? " best other | ratio |\n|---|---|---|" : "\n|---|");
    for (std::size_t v = 0; v < variants.size(); ++v) std::printf("---|");
    std::printf("\n");
    Table table;
    for (const fs::path& file : arguments.files) {
        table.push_back(medians(file, arguments));
        const auto& row = table.back();
        std::printf("| %s |", labeling_runs::problem_name(file).c_str());
        for (const Median& m : row) {
            if (m.counts(runs)) {
                std::printf(" %.2f (%d) |", m.seconds, m.proven);
            } else {
                std::printf(" failed |");
            }
        }
        const std::size_t best = best_other(row, runs);
        if (best > 0) {
            std::printf(" %s | %.2f |", variants[best].text.c_str(),
                        row[best].seconds / row[0].seconds);
        } else if (has_others) {
            std::printf(" | |");
        }
        std::printf("\n");
        std::fflush(stdout);
    }
    if (!has_others) return;
    std::printf(
        "\n| %s against | times faster, all | problems | where it needs over %g s | problems "
        "| least |\n|---|---|---|---|---|---|\n",
        variants[0].text.c_str(), kEasySeconds);
    for (std::size_t v = 1; v < variants.size(); ++v) {
        print_mean(table, variants[v].text,
                   [v, runs](const auto& row) { return row[v].counts(runs) ? v : 0; });
    }
    print_mean(table, "the best per problem",
               [runs](const auto& row) { return best_other(row, runs); });
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const Arguments arguments = parse(argc, argv);
        if (arguments.permutations > 0) {
            print_medians(arguments);
        } else {
            print_runs(arguments);
        }
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "labeling_solvers: %s\n", error.what());
        return 2;
    }
}
