// The program: one parser a command, and the one place where errors become exit codes.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <new>

#include "app/command.h"
#include "app/interrupt.h"
#include "geometry/errors.h"
#include "labeling/errors.h"

namespace fcn::app {
namespace {

int fail(int code, const std::string& message) {
    fmt::print(stderr, "scalefcn: {}\n", message);
    return code;
}

/// Bad words from either half of the project are the user's; everything else is ours.
int run_guarded(const std::function<int()>& action) {
    try {
        return action();
    } catch (const UsageError& error) {
        return fail(kUsage, error.what());
    } catch (const fcn::InputError& error) {
        return fail(kBadInput, error.what());
    } catch (const labeling::InputError& error) {
        return fail(kBadInput, error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        return fail(kBadInput, error.what());
    } catch (const std::bad_alloc&) {
        return fail(kInternalFault, "out of memory");
    } catch (const std::exception& error) {
        return fail(kInternalFault,
                    fmt::format("internal error (please report it): {}", error.what()));
    }
}

int parse_and_run(int argc, char** argv) {
    CLI::App program{
        "scalefcn - feature curve networks at a prescribed scale.\n"
        "Picks the best set of feature curves that a mesh of a given edge length can carry."};
    program.name("scalefcn");
    program.set_version_flag("--version", "scalefcn " SCALEFCN_VERSION);
    program.require_subcommand(1);
    program.footer(
        "Example:\n  scalefcn run part.stl --scales 1%,2%,4% -o out\n"
        "'scalefcn COMMAND --help' shows the options and an example of each command.");
    const std::array commands{
        add_run_command(program),     add_detect_command(program),  add_adapt_command(program),
        add_check_command(program),   add_remesh_command(program),  add_measure_command(program),
        add_compare_command(program), add_solve_command(program),   add_verify_command(program),
        add_convert_command(program), add_explain_command(program), add_model_command(program),
        add_draw_command(program)};
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& request) {  // --help and --version
        return program.exit(request);
    } catch (const CLI::ParseError& error) {
        const auto is_named = [&](const Command& command) {
            return command.parser->get_name() == argv[1];
        };
        if (argc > 1 && argv[1][0] != '-' &&
            std::none_of(commands.begin(), commands.end(), is_named))
            return fail(kUsage,
                        fmt::format("'{}' is not a command (see scalefcn --help)", argv[1]));
        return fail(kUsage, fmt::format("{} (see scalefcn --help)", error.what()));
    }
    for (const Command& command : commands)
        if (command.parser->parsed()) return run_guarded(command.run);
    return fail(kUsage, "no command given");
}

}  // namespace
}  // namespace fcn::app

int main(int argc, char** argv) {
    fcn::app::watch_for_interrupts();
    return fcn::app::parse_and_run(argc, argv);
}
