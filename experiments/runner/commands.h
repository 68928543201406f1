#pragma once

#include <functional>
#include <vector>

namespace CLI {
class App;
}

namespace experiment {

/// As for scalefcn: docs/command-line.md.
enum ExitCode : int {
    kDone = 0,
    kInternalFault = 1,
    kUsage = 2,
    kBadInput = 3,
    kNotFinished = 4,  ///< interrupted; resume goes on
    kViolation = 5     ///< the report found contradictions, or compare a regression
};

struct Command {
    CLI::App* parser = nullptr;
    std::function<int()> run;
};

std::vector<Command> add_commands(CLI::App& program);

/// run, resume, plan, execute, merge, study-run.
std::vector<Command> add_run_commands(CLI::App& program);
/// list, show, report, compare, export.
std::vector<Command> add_view_commands(CLI::App& program);

}  // namespace experiment
