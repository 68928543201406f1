#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace CLI {
class App;
}

namespace fcn::app {

/// What the process returns; the numbers are documented in docs/command-line.md.
enum ExitCode : int {
    kDone = 0,
    kInternalFault = 1,
    kUsage = 2,
    kBadInput = 3,
    kNoResult = 4,   ///< a limit was reached, or Ctrl-C pressed, before there was any result
    kViolation = 5,  ///< `check` or `verify` found one
    kKilled = 130    ///< second Ctrl-C
};

/// A command line that cannot be right whatever the files hold.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A subcommand: its parser, and what to do once parsing has succeeded.
struct Command {
    CLI::App* parser = nullptr;
    std::function<int()> run;
};

Command add_run_command(CLI::App& program);
Command add_detect_command(CLI::App& program);
Command add_adapt_command(CLI::App& program);
Command add_check_command(CLI::App& program);
Command add_remesh_command(CLI::App& program);
Command add_measure_command(CLI::App& program);
Command add_compare_command(CLI::App& program);
Command add_solve_command(CLI::App& program);
Command add_verify_command(CLI::App& program);
Command add_convert_command(CLI::App& program);
Command add_explain_command(CLI::App& program);
Command add_draw_command(CLI::App& program);
Command add_model_command(CLI::App& program);

}  // namespace fcn::app
