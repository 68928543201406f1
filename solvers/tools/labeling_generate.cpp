// labeling-generate FAMILY -o FILE [--seed N] [--set KEY=VALUE]... [--solution FILE]
// Writes a synthetic labeling problem (the name decides the format) and prints a line: file,
// labels, conflicts, bonuses, rules, and the optimum where it is known. Exit codes: 0 written, 2
// usage, 3 an output cannot be written.
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <string_view>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/generators.h"

namespace {

struct Arguments {
    std::string family, output, solution;
    std::map<std::string, std::string> options;
};

std::string usage() {
    std::string text =
        "usage: labeling-generate FAMILY -o FILE [--seed N] [--set KEY=VALUE]... "
        "[--solution FILE]\nfamilies:";
    for (const std::string& name : labeling::problem_families()) text += " " + name;
    return text + "\n";
}

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    for (int k = 1; k < argc; ++k) {
        const std::string_view word = argv[k];
        auto next = [&]() -> std::string {
            if (k + 1 >= argc) throw labeling::InputError(std::string(word) + " needs a value");
            return argv[++k];
        };
        if (word == "-o") {
            arguments.output = next();
        } else if (word == "--seed") {
            arguments.options["seed"] = next();
        } else if (word == "--set") {
            const std::string pair = next();
            const std::size_t at = pair.find('=');
            if (at == std::string::npos) throw labeling::InputError("--set needs KEY=VALUE");
            arguments.options[pair.substr(0, at)] = pair.substr(at + 1);
        } else if (word == "--solution") {
            arguments.solution = next();
        } else if (arguments.family.empty() && !word.starts_with("-")) {
            arguments.family = word;
        } else {
            throw labeling::InputError("unknown argument '" + std::string(word) + "'");
        }
    }
    if (arguments.family.empty()) throw labeling::InputError("no family given");
    if (arguments.output.empty()) throw labeling::InputError("no output given: -o FILE");
    labeling::problem_format(arguments.output);
    return arguments;
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    labeling::GeneratedProblem made;
    try {
        arguments = parse(argc, argv);
        made = labeling::generate_problem(arguments.family, arguments.options);
        if (!arguments.solution.empty() && !made.optimum) {
            throw labeling::InputError("the optimum of " + arguments.family + " is not known");
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "labeling-generate: %s\n%s", error.what(), usage().c_str());
        return 2;
    }
    try {
        labeling::write_problem(made.problem, arguments.output);
        if (!arguments.solution.empty()) {
            labeling::write_solution(*made.optimum, arguments.solution);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "labeling-generate: %s\n", error.what());
        return 3;
    }
    std::printf("%s labels %d conflicts %zu bonuses %zu rules %zu", arguments.output.c_str(),
                made.problem.label_count(), made.problem.conflict_count(),
                made.problem.bonus_count(), made.problem.rule_count());
    if (made.optimum) {
        std::printf(" optimum %lld", static_cast<long long>(made.optimum->value));
    }
    std::printf("\n");
    return 0;
}
