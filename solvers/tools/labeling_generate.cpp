// labeling-generate FAMILY -o FILE [--seed N] [--set KEY=VALUE]... [--solution FILE]
// Writes a synthetic labeling problem (the name decides the format) and prints a line: file,
// labels, conflicts, bonuses, rules, and the optimum where it is known. Exit codes: 0 written, 2
// usage, 3 an output cannot be written.
#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include "labeling/errors.h"
#include "labeling/formats.h"
#include "labeling/generators.h"
#include "tools/argument_words.h"

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
    labeling::ArgumentWords words(argc, argv);
    while (words.next()) {
        if (words.is("-o")) {
            arguments.output = words.value();
        } else if (words.is("--seed")) {
            arguments.options["seed"] = words.value();
        } else if (words.is("--set")) {
            const auto [key, value] = words.key_and_value();
            arguments.options[key] = value;
        } else if (words.is("--solution")) {
            arguments.solution = words.value();
        } else if (arguments.family.empty() && !words.is_option()) {
            arguments.family = words.word();
        } else {
            words.unknown();
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
