// scalefcn-experiment: campaigns of labeling solvers. See docs/experiments.md.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>

#include "commands.h"
#include "labeling/errors.h"

int main(int argc, char** argv) {
    // A file that would grow over the user's limit is an error that is told, not a sudden death.
    std::signal(SIGXFSZ, SIG_IGN);
    CLI::App program{"Comparisons of labeling solvers: campaigns, records, reports"};
    program.require_subcommand(1);
    program.footer(
        "Example:\n  scalefcn-experiment run experiments/corpora/smoke.toml -o out/smoke\n"
        "  scalefcn-experiment report out/smoke");
    const auto commands = experiment::add_commands(program);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? experiment::kDone : experiment::kUsage;
    }
    try {
        for (const auto& command : commands) {
            if (command.parser->parsed()) return command.run();
        }
        return experiment::kUsage;
    } catch (const labeling::InputError& error) {
        std::fprintf(stderr, "scalefcn-experiment: %s\n", error.what());
        return experiment::kBadInput;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "scalefcn-experiment: internal error: %s\n", error.what());
        return experiment::kInternalFault;
    }
}
