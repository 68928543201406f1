// labeling_independent_sets COMMAND FILE... [--solver NAME] [--seed N]
// Labeling problems without their rules as maximum weight independent set: another program against
// one of our heuristics in equal processor time. COMMAND is run by the shell with {graph} replaced
// by a METIS graph (vertices: labels and bonuses), {solution} by a file to be written with the
// chosen vertices, one per line from 1, and {seed}. Ours gets the processor seconds that the
// command took, reading the graph included. Every set is checked; rows are Markdown.
// Example: labeling_independent_sets 'CHILS -g {graph} -o {solution} -p 4 -c 1 -t 10 -s 1 -r
// {seed}' a.lab.gz
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling_runs.h"
#include "tools/argument_words.h"

namespace {

namespace fs = std::filesystem;
using labeling::Label;
using labeling::LabelingProblem;
using labeling::Value;

/// Labels that are worth something, conflicts and bonuses.
LabelingProblem without_rules(const LabelingProblem& problem) {
    labeling::ProblemBuilder builder;
    std::vector<Label> number(problem.label_count(), -1);
    for (Label i = 0; i < problem.label_count(); ++i) {
        if (problem.weight(i) < 0) continue;
        if (problem.weight(i) == 0 && problem.bonuses_of(i).empty()) continue;
        number[i] = builder.add_label(problem.weight(i));
    }
    auto is_kept = [&](const auto& pair) {
        return number[pair.first] >= 0 && number[pair.second] >= 0;
    };
    for (const auto& c : problem.conflicts()) {
        if (is_kept(c)) builder.add_conflict(number[c.first], number[c.second]);
    }
    for (const auto& b : problem.bonuses()) {
        if (is_kept(b)) builder.add_bonus(number[b.first], number[b.second], b.value);
    }
    return builder.build();
}

double processor_seconds(int who) {
    rusage usage{};
    getrusage(who, &usage);
    return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    for (std::size_t at = text.find(what); at != std::string::npos;
         at = text.find(what, at + with.size())) {
        text.replace(at, what.size(), with);
    }
    return text;
}

/// Weight of the set in the file; throws InputError when it is none.
Value set_weight(const LabelingProblem& graph, const fs::path& file) {
    labeling::Solution solution{std::vector<std::uint8_t>(graph.label_count(), 0), 0};
    std::ifstream in(file);
    if (!in) throw labeling::InputError("the command wrote no solution");
    for (std::int64_t vertex = 0; in >> vertex;) {
        if (vertex < 1 || vertex > graph.label_count()) {
            throw labeling::InputError("the command's solution names vertex " +
                                       std::to_string(vertex));
        }
        solution.labels[static_cast<std::size_t>(vertex - 1)] = 1;
    }
    const auto check = check_solution(graph, solution);
    if (!check.is_feasible) throw labeling::InputError("the command's set is not independent");
    return check.value;
}

struct Arguments {
    std::string command;
    std::vector<fs::path> files;
    std::string solver = "local-search";
    std::uint64_t seed = 1;
};

void compare(const Arguments& arguments, const fs::path& file, const fs::path& folder) {
    const LabelingProblem problem = without_rules(labeling::read_problem(file));
    const fs::path graph_file = folder / "problem.graph", solution_file = folder / "set.txt";
    fs::remove(solution_file);
    labeling::write_problem(problem, graph_file);
    const LabelingProblem graph = labeling::read_problem(graph_file);
    std::string command = replaced(arguments.command, "{graph}", graph_file.string());
    command = replaced(command, "{solution}", solution_file.string());
    command = replaced(command, "{seed}", std::to_string(arguments.seed));
    double before = processor_seconds(RUSAGE_CHILDREN);
    if (std::system((command + " >/dev/null").c_str()) != 0) {
        throw labeling::InputError("the command failed: " + command);
    }
    const double seconds = processor_seconds(RUSAGE_CHILDREN) - before;
    const Value theirs = set_weight(graph, solution_file);

    labeling::SolveOptions options;
    options.seed = arguments.seed;
    options.clock = [] { return processor_seconds(RUSAGE_SELF); };
    options.time_limit = std::chrono::duration<double>(seconds);
    before = processor_seconds(RUSAGE_SELF);
    const auto result =
        labeling_runs::every_solver().find(arguments.solver)->solve(problem, options);
    const double own_seconds = processor_seconds(RUSAGE_SELF) - before;
    const Value ours = result.solution ? result.solution->value : 0;
    std::printf("| %s | %d | %zu | %lld | %lld | %+.4f%% | %.2f | %.2f |\n",
                labeling_runs::problem_name(file).c_str(), graph.label_count(),
                graph.conflict_count(), static_cast<long long>(theirs),
                static_cast<long long>(ours),
                100 * static_cast<double>(ours - theirs) / static_cast<double>(theirs), seconds,
                own_seconds);
    std::fflush(stdout);
}

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    labeling::ArgumentWords words(argc, argv);
    while (words.next()) {
        if (words.is("--solver")) {
            arguments.solver = words.value();
        } else if (words.is("--seed")) {
            arguments.seed = words.seed();
        } else if (arguments.command.empty()) {
            arguments.command = words.word();
        } else {
            const auto files = labeling_runs::problem_files(fs::path(words.word()));
            arguments.files.insert(arguments.files.end(), files.begin(), files.end());
        }
    }
    if (arguments.files.empty()) throw labeling::InputError("no command or no problem given");
    return arguments;
}

void run(const Arguments& arguments) {
    std::string folder = (fs::temp_directory_path() / "independent_sets_XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw labeling::InputError("no temporary folder");
    std::printf(
        "| problem | vertices | edges | command | ours | ours over command | CPU s | our CPU s |\n"
        "|---|---|---|---|---|---|---|---|\n");
    try {
        for (const fs::path& file : arguments.files) compare(arguments, file, folder);
    } catch (...) {
        fs::remove_all(folder);
        throw;
    }
    fs::remove_all(folder);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run(parse(argc, argv));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "labeling_independent_sets: %s\n", error.what());
        return 2;
    }
}
