// labeling_solvers FILE|FOLDER... [--solvers A,B] [--time SECONDS] [--work TICKS] [--seed N]
//                  [--set KEY=VALUE]... [--permute N]
// Solves labeling problems with several solvers and prints a Markdown table: value, bound, gap,
// processor seconds (children included), wall seconds, those by an external solver's clock, nodes,
// and when the last better value came.
// --permute renames the labels (N = 0: as they are), to see how much is luck.
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/solver.h"
#ifdef LABELING_WITH_MIP
#include "labeling_mip/mip_solvers.h"
#endif

namespace {

namespace fs = std::filesystem;
using labeling::Label;
using labeling::LabelingProblem;

struct Arguments {
    std::vector<fs::path> files;
    std::vector<std::string> solvers{"auto"};
    labeling::SolveOptions options;
    std::uint64_t permutation = 0;
};

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t to = std::min(text.find(',', from), text.size());
        parts.push_back(text.substr(from, to - from));
        from = to + 1;
    }
    return parts;
}

void add_files(const fs::path& path, std::vector<fs::path>& files) {
    if (!fs::is_directory(path)) {
        files.push_back(path);
        return;
    }
    for (const auto& entry : fs::directory_iterator(path)) {
        if (entry.path().string().find(".lab") != std::string::npos) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
}

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    for (int k = 1; k < argc; ++k) {
        const std::string_view word = argv[k];
        auto next = [&]() -> std::string {
            if (k + 1 >= argc) throw labeling::InputError(std::string(word) + " needs a value");
            return argv[++k];
        };
        if (word == "--solvers") {
            arguments.solvers = split(next());
        } else if (word == "--time") {
            arguments.options.time_limit = std::chrono::duration<double>(std::stod(next()));
        } else if (word == "--work") {
            arguments.options.work_limit = static_cast<std::int64_t>(std::stod(next()));
        } else if (word == "--seed") {
            arguments.options.seed = std::stoull(next());
        } else if (word == "--permute") {
            arguments.permutation = std::stoull(next());
        } else if (word == "--set") {
            const std::string pair = next();
            const std::size_t at = pair.find('=');
            if (at == std::string::npos) throw labeling::InputError("--set needs KEY=VALUE");
            arguments.options.extra[pair.substr(0, at)] = pair.substr(at + 1);
        } else {
            add_files(fs::path(word), arguments.files);
        }
    }
    if (arguments.files.empty()) throw labeling::InputError("no problem given");
    return arguments;
}

LabelingProblem renamed(const LabelingProblem& problem, std::uint64_t seed) {
    std::vector<Label> order(problem.label_count());
    std::iota(order.begin(), order.end(), 0);
    std::mt19937_64 engine(seed);
    for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[engine() % k]);
    labeling::ProblemBuilder builder;
    std::vector<labeling::Value> weights(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        weights[order[i]] = problem.weight(static_cast<Label>(i));
    }
    for (labeling::Value w : weights) builder.add_label(w);
    for (const auto& c : problem.conflicts()) builder.add_conflict(order[c.first], order[c.second]);
    for (const auto& b : problem.bonuses()) {
        builder.add_bonus(order[b.first], order[b.second], b.value);
    }
    std::vector<labeling::Rule> rules(problem.rules().begin(), problem.rules().end());
    for (std::size_t k = rules.size(); k > 1; --k) std::swap(rules[k - 1], rules[engine() % k]);
    for (labeling::Rule& rule : rules) {
        for (labeling::Term& t : rule.terms) t.label = order[t.label];
        builder.add_rule(std::move(rule));
    }
    builder.set_units_per_one(problem.units_per_one());
    return builder.build();
}

double processor_seconds() {
    double seconds = 0;
    for (int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        getrusage(who, &usage);
        seconds += static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                   1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
    }
    return seconds;
}

void print_row(const fs::path& file, const LabelingProblem& problem,
               const labeling::SolveResult& result, double seconds) {
    std::string name = file.filename().string();
    name = name.substr(0, name.find(".lab"));
    const double units = problem.units_per_one();
    std::printf("| %s | %s |", name.c_str(), result.solver.c_str());
    if (result.solution) {
        std::printf(" %.4f |", static_cast<double>(result.solution->value) / units);
    } else {
        std::printf(" |");
    }
    if (result.bound) {
        std::printf(" %.4f |", static_cast<double>(*result.bound) / units);
    } else {
        std::printf(" |");
    }
    const bool is_optimal = result.status == labeling::SolveStatus::Optimal;
    if (is_optimal) {
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
    std::printf(" %.2f | %.2f | %.2f | %.2f | %.0f | %lld |", seconds, result.seconds,
                own == result.statistics.end() ? result.seconds : own->second, last_value,
                nodes == result.statistics.end() ? 0.0 : nodes->second,
                static_cast<long long>(result.work));
    std::printf(" %s |\n", result.message.c_str());
    std::fflush(stdout);
}

void run(const Arguments& arguments) {
#ifdef LABELING_WITH_MIP
    const labeling::SolverRegistry solvers = labeling::all_solvers();
#else
    const labeling::SolverRegistry solvers = labeling::builtin_solvers();
#endif
    std::printf(
        "| problem | solver | value | bound | gap | CPU s | s | own s | last value at | nodes "
        "| work | message |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const fs::path& file : arguments.files) {
        LabelingProblem problem = labeling::read_problem(file);
        if (arguments.permutation > 0) problem = renamed(problem, arguments.permutation);
        for (const std::string& name : arguments.solvers) {
            const double before = processor_seconds();
            const labeling::SolveResult result =
                solvers.find(name)->solve(problem, arguments.options);
            print_row(file, problem, result, processor_seconds() - before);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run(parse(argc, argv));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "labeling_solvers: %s\n", error.what());
        return 2;
    }
}
