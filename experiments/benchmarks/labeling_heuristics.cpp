// labeling_heuristics FILE|FOLDER... [--solvers A,B:KEY=VALUE:KEY=VALUE] [--seeds N]
//                     [--at TICKS,TICKS] [--best FILE] [--permute] [--threads N]
// Runs heuristics with seeds 1 to N, each to the largest amount of work in --at, and prints a
// Markdown table: mean and largest distance in percent to the best known value after each amount
// of work, in how many runs it was reached, and processor seconds a run. A solver may be followed
// by extra options of its own. --best names a file of lines `problem value`; better values met here
// count too. A run ends when the value in the file is reached. --permute renames the labels by the
// seed.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling_runs.h"
#include "tools/argument_words.h"

namespace {

namespace fs = std::filesystem;
using labeling::LabelingProblem;
using labeling::Value;
using labeling_runs::parse_variant;
using labeling_runs::Variant;

constexpr double kSame = 1e-8;  ///< relative; files give four digits
constexpr double kNoTarget = 1e300;

struct Arguments {
    std::vector<fs::path> files;
    std::vector<Variant> variants;
    std::vector<std::int64_t> checkpoints{10'000'000, 100'000'000};
    std::map<std::string, double> best;
    int seeds = 5;
    int threads = 1;
    bool is_permuted = false;
};

/// What one solver reached on one problem.
struct Row {
    std::vector<std::vector<double>> values;  ///< by checkpoint, then seed
    double seconds = 0;
};

/// Sums over the rows of one solver.
struct Total {
    std::vector<double> gap, worst;
    std::vector<int> reached;
    int runs = 0;
    double seconds = 0;
};

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    std::vector<std::string> solvers{"local-search"};
    labeling::ArgumentWords words(argc, argv);
    while (words.next()) {
        if (words.is("--solvers")) {
            solvers = words.list();
        } else if (words.is("--seeds")) {
            arguments.seeds = static_cast<int>(words.integer());
        } else if (words.is("--threads")) {
            arguments.threads = static_cast<int>(words.integer());
        } else if (words.is("--permute")) {
            arguments.is_permuted = true;
        } else if (words.is("--at")) {
            arguments.checkpoints.clear();
            for (const std::string& ticks : words.list()) {
                arguments.checkpoints.push_back(static_cast<std::int64_t>(std::stod(ticks)));
            }
        } else if (words.is("--best")) {
            std::ifstream in{std::string(words.value())};
            std::string name;
            for (double value = 0; in >> name >> value;) arguments.best[name] = value;
        } else {
            const auto files = labeling_runs::problem_files(fs::path(words.word()));
            arguments.files.insert(arguments.files.end(), files.begin(), files.end());
        }
    }
    for (const std::string& text : solvers) arguments.variants.push_back(parse_variant(text));
    if (arguments.files.empty()) throw labeling::InputError("no problem given");
    if (arguments.seeds < 1) throw labeling::InputError("--seeds needs at least 1");
    return arguments;
}

/// Best value of the trace by then, in units of the real objective.
double value_at(const labeling::SolveResult& result, std::int64_t work, double units) {
    Value value = 0;
    for (const auto& point : result.trace) {
        if (point.work <= work && point.value) value = *point.value;
    }
    return static_cast<double>(value) / units;
}

Row run_variant(const Arguments& arguments, const Variant& variant, const LabelingProblem& given,
                double target) {
    const labeling::SolverRegistry solvers = labeling_runs::every_solver();
    Row row;
    row.values.resize(arguments.checkpoints.size());
    for (int seed = 1; seed <= arguments.seeds; ++seed) {
        labeling::SolveOptions options;
        options.seed = static_cast<std::uint64_t>(seed);
        options.threads = arguments.threads;
        options.extra = variant.extra;
        options.work_limit = arguments.checkpoints.back();
        std::stop_source source;
        options.stop = source.get_token();
        options.on_improvement = [&](const labeling::TracePoint& point) {
            const double value = static_cast<double>(point.value.value_or(0));
            if (value >= target * given.units_per_one()) source.request_stop();
        };
        const LabelingProblem problem =
            arguments.is_permuted ? labeling_runs::renamed(given, options.seed) : LabelingProblem();
        const double before = labeling_runs::processor_seconds();
        const auto result =
            solvers.find(variant.solver)->solve(arguments.is_permuted ? problem : given, options);
        row.seconds += (labeling_runs::processor_seconds() - before) / arguments.seeds;
        for (std::size_t c = 0; c < arguments.checkpoints.size(); ++c) {
            row.values[c].push_back(
                value_at(result, arguments.checkpoints[c], given.units_per_one()));
        }
    }
    return row;
}

void print_row(const std::string& name, const Variant& variant, const Row& row, double best,
               Total& total) {
    std::printf("| %s | %s |", name.c_str(), variant.text.c_str());
    total.gap.resize(row.values.size());
    total.worst.resize(row.values.size());
    total.reached.resize(row.values.size());
    for (std::size_t c = 0; c < row.values.size(); ++c) {
        double sum = 0, worst = 0;
        int reached = 0;
        for (double value : row.values[c]) {
            const double gap = std::max(0.0, 100 * (best - value) / best);
            sum += gap / static_cast<double>(row.values[c].size());
            worst = std::max(worst, gap);
            if (best - value < kSame * best) ++reached;
        }
        std::printf(" %.4f | %.4f | %d |", sum, worst, reached);
        total.gap[c] += sum;
        total.worst[c] = std::max(total.worst[c], worst);
        total.reached[c] += reached;
    }
    std::printf(" %.2f |\n", row.seconds);
    total.seconds += row.seconds;
    total.runs += static_cast<int>(row.values.front().size());
}

void print_totals(const Arguments& arguments, const std::vector<Total>& totals) {
    const auto problems = static_cast<double>(arguments.files.size());
    for (std::size_t v = 0; v < totals.size(); ++v) {
        const Total& t = totals[v];
        std::printf("| all | %s |", arguments.variants[v].text.c_str());
        for (std::size_t c = 0; c < t.gap.size(); ++c) {
            std::printf(" %.4f | %.4f | %d of %d |", t.gap[c] / problems, t.worst[c], t.reached[c],
                        t.runs);
        }
        std::printf(" %.2f |\n", t.seconds / problems);
    }
}

void run(const Arguments& arguments) {
    std::printf("| problem | solver |");
    for (std::int64_t ticks : arguments.checkpoints) {
        std::printf(" %.3g ticks: mean %% | worst %% | reached |", static_cast<double>(ticks));
    }
    std::printf(" CPU s |\n|---|---|");
    for (std::size_t c = 0; c < arguments.checkpoints.size(); ++c) std::printf("---|---|---|");
    std::printf("---|\n");
    std::vector<Total> totals(arguments.variants.size());
    for (const fs::path& file : arguments.files) {
        const std::string name = labeling_runs::problem_name(file);
        const LabelingProblem problem = labeling::read_problem(file);
        const auto known = arguments.best.find(name);
        double best = known == arguments.best.end() ? 0 : known->second;
        std::vector<Row> rows;
        for (const Variant& variant : arguments.variants) {
            const double target = known == arguments.best.end() ? kNoTarget : known->second;
            rows.push_back(run_variant(arguments, variant, problem, target * (1 - kSame)));
            for (double value : rows.back().values.back()) {
                if (value <= best * (1 + kSame)) continue;
                best = value;
            }
        }
        if (known == arguments.best.end() || best > known->second * (1 + kSame)) {
            std::fprintf(stderr, "new best: %s %.4f\n", name.c_str(), best);
        }
        for (std::size_t v = 0; v < rows.size(); ++v) {
            print_row(name, arguments.variants[v], rows[v], best, totals[v]);
        }
        std::fflush(stdout);
    }
    print_totals(arguments, totals);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run(parse(argc, argv));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "labeling_heuristics: %s\n", error.what());
        return 2;
    }
}
