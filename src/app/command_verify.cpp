#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.h"
#include "app/inputs.h"
#include "app/json_summary.h"
#include "labeling/formats.h"

namespace fcn::app {
namespace {

struct VerifyArguments {
    CommonArguments common;
    std::string problem_path;
    std::string solution_path;
};

int verify(const VerifyArguments& arguments) {
    if (arguments.problem_path == "-" && arguments.solution_path == "-")
        throw UsageError("verify: only one of PROBLEM and SOLUTION can be standard input");
    const labeling::LabelingProblem problem = load_problem(arguments.problem_path);
    const labeling::Solution solution = labeling::parse_solution(read_text(arguments.solution_path),
                                                                 arguments.solution_path, problem);
    const labeling::SolutionCheck check = labeling::check_solution(problem, solution);
    const bool is_right = check.is_feasible && check.value_matches;
    if (arguments.common.is_json) {
        Json conflicts = Json::array();
        for (const labeling::Conflict& conflict : check.violated_conflicts)
            conflicts.push_back({conflict.first + 1, conflict.second + 1});
        Json rules = Json::array();
        for (const std::int32_t rule : check.violated_rules) rules.push_back(rule + 1);
        print_json({{"feasible", check.is_feasible},
                    {"value", check.value},
                    {"claimed_value", solution.value},
                    {"value_matches", check.value_matches},
                    {"violated_conflicts", conflicts},
                    {"violated_rules", rules},
                    {"message", check.message}});
    } else if (is_right) {
        fmt::print("feasible, value {}\n", check.value);
    } else {
        fmt::print("WRONG: {}\n", check.message);
    }
    return is_right ? kDone : kViolation;
}

}  // namespace

Command add_verify_command(CLI::App& program) {
    auto arguments = std::make_shared<VerifyArguments>();
    CLI::App* parser = program.add_subcommand(
        "verify", "Check a solution of a labeling problem in exact integers");
    parser
        ->add_option("PROBLEM", arguments->problem_path,
                     "Labeling problem (- for .lab on "
                     "standard input)")
        ->required();
    parser->add_option("SOLUTION", arguments->solution_path, "Solution (- for standard input)")
        ->required();
    add_common_arguments(*parser, arguments->common);
    parser->footer(
        "Exit code 5 when the solution is infeasible or its stated value is wrong.\n"
        "Example:\n  scalefcn verify problem_1.lab.gz best.sol");
    return {parser, [arguments] { return verify(*arguments); }};
}

}  // namespace fcn::app
