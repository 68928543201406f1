// labeling-solve FILE --solver NAME [--work TICKS] [--time SECONDS] [--seed N] [--gap G]
//                     [--threads N] [--set KEY=VALUE] [--start SOLUTION] [--rename SEED]
//                     [-o SOLUTION] [--result JSON]
// Solves one labeling problem and prints a line: file, solver, status, stop reason, value, bound,
// gap, work, seconds, processor seconds of the whole program. SIGINT and SIGTERM end it with the
// best so far. Exit codes: 0 solved or feasible, 2 usage, 3 bad input, 4 no solution.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <utility>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/renaming.h"
#include "labeling/solver.h"
#include "labeling/text_file.h"
#include "tools/argument_words.h"
#include "tools/result_json.h"
#include "tools/stop_at_signals.h"
#ifdef LABELING_WITH_MIP
#include "labeling_mip/mip_solvers.h"
#endif

namespace {

constexpr const char* kUsage =
    "usage: labeling-solve FILE --solver NAME [--work TICKS] [--time SECONDS] [--seed N]\n"
    "                      [--threads N] [--gap G] [--set KEY=VALUE]... [--trace]\n"
    "                      [--start SOLUTION] [--rename SEED] [-o SOLUTION] [--result JSON]\n";

labeling::SolverRegistry solvers() {
#ifdef LABELING_WITH_MIP
    return labeling::all_solvers();
#else
    return labeling::builtin_solvers();
#endif
}

struct Arguments {
    std::string file, solver = "auto", output, start, result;
    std::uint64_t renaming = 0;
    labeling::SolveOptions options;
    bool has_trace = false;
};

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    labeling::ArgumentWords words(argc, argv);
    while (words.next()) {
        if (words.is("--solver")) {
            arguments.solver = words.value();
        } else if (words.is("--work")) {
            arguments.options.work_limit = words.integer();
        } else if (words.is("--time")) {
            arguments.options.time_limit = std::chrono::duration<double>(words.real());
        } else if (words.is("--seed")) {
            arguments.options.seed = words.seed();
        } else if (words.is("--threads")) {
            constexpr std::int64_t kMost = 1024;
            arguments.options.threads =
                static_cast<int>(std::clamp<std::int64_t>(words.integer(), 0, kMost));
        } else if (words.is("--gap")) {
            arguments.options.relative_gap = words.real();
        } else if (words.is("--set")) {
            const auto [key, value] = words.key_and_value();
            arguments.options.extra[key] = value;
        } else if (words.is("--trace")) {
            arguments.has_trace = true;
        } else if (words.is("--start")) {
            arguments.start = words.value();
        } else if (words.is("--rename")) {
            arguments.renaming = words.seed();
        } else if (words.is("--result")) {
            arguments.result = words.value();
        } else if (words.is("-o")) {
            arguments.output = words.value();
        } else if (arguments.file.empty() && !words.is_option()) {
            arguments.file = words.word();
        } else {
            words.unknown();
        }
    }
    if (arguments.file.empty()) throw labeling::InputError("no problem file given");
    return arguments;
}

void print_trace(const labeling::TracePoint& point) {
    std::fprintf(stderr, "%10.3f s %12lld", point.seconds, static_cast<long long>(point.work));
    if (point.value) std::fprintf(stderr, "  value %lld", static_cast<long long>(*point.value));
    if (point.bound) std::fprintf(stderr, "  bound %lld", static_cast<long long>(*point.bound));
    std::fputc('\n', stderr);
}

void print_line(const Arguments& arguments, const labeling::SolveResult& result, double units) {
    std::printf("%s %s %s %s", arguments.file.c_str(), arguments.solver.c_str(),
                std::string(labeling::to_string(result.status)).c_str(),
                std::string(labeling::to_string(result.stop_reason)).c_str());
    if (result.solution) {
        std::printf(" value %.4f", static_cast<double>(result.solution->value) / units);
    }
    if (result.bound) std::printf(" bound %.4f", static_cast<double>(*result.bound) / units);
    if (result.relative_gap()) std::printf(" gap %.5f%%", 100 * *result.relative_gap());
    const double cpu = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    std::printf(" work %lld seconds %.3f cpu %.3f", static_cast<long long>(result.work),
                result.seconds, cpu);
    for (const auto& [key, value] : result.statistics) std::printf(" %s %g", key.c_str(), value);
    if (!result.message.empty()) std::printf(" (%s)", result.message.c_str());
    std::printf("\n");
}

/// Once for each type. Taking millions of rules apart takes longer than an answer to a signal may.
template <class T>
const T& kept_to_the_end(T value) {
    static const T* const kept = new T(std::move(value));
    return *kept;
}

int run(const Arguments& arguments) {
    auto options = arguments.options;
    labeling::has_nothing_to_save() = true;
    options.stop = labeling::stop_at_signals();
    const auto& given = kept_to_the_end(labeling::read_problem(arguments.file));
    const auto& renamed = kept_to_the_end(labeling::rename_labels(given, arguments.renaming));
    labeling::has_nothing_to_save() = false;
    if (!arguments.start.empty()) {
        const auto start = labeling::read_solution(arguments.start, given);
        options.warm_start =
            labeling::renamed_start(renamed, {start.labels.begin(), start.labels.end()});
    }
    const auto solver = solvers().find(arguments.solver);
    if (arguments.has_trace) options.on_improvement = print_trace;
    labeling::SolveResult result = solver->solve(renamed.problem, options);
    if (result.solution) result.solution = labeling::original_solution(renamed, *result.solution);
    print_line(arguments, result, given.units_per_one());
    if (!arguments.output.empty() && result.solution) {
        labeling::write_solution(*result.solution, arguments.output);
    }
    if (!arguments.result.empty()) {
        labeling::write_text_file(arguments.result, labeling::result_json(result));
    }
    return result.solution || result.status == labeling::SolveStatus::Infeasible ? 0 : 4;
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    try {
        arguments = parse(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "labeling-solve: %s\n%s", error.what(), kUsage);
        return 2;
    }
    try {
        return run(arguments);
    } catch (const labeling::InputError& error) {
        std::fprintf(stderr, "labeling-solve: %s\n", error.what());
        return 3;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "labeling-solve: internal error: %s\n", error.what());
        return 1;
    }
}
