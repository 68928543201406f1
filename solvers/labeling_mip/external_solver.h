#pragma once

#include <memory>
#include <string>

#include "labeling/formats.h"
#include "labeling/solver.h"
#include "labeling_mip/external_answer.h"

namespace labeling {

/// A solver that is a program of its own.
struct ExternalProgram {
    std::string name;
    std::string description;
    std::string advice;  ///< how to get it, for the message when it is missing
    /// Words separated by blanks, "..." or '...' around one that holds blanks. Placeholders:
    /// {problem} {solution} {start} (files), {time} (seconds, a decimal), {seconds} (whole, at
    /// least 1), {threads} {seed} {gap} {python} {worker}. What stands in [ ] is left out when one
    /// of its placeholders has no value (no time limit, no start, no gap).
    std::string command;
    ProblemFormat problem_format = ProblemFormat::Mps;
    AnswerFormat answer_format = AnswerFormat::Columns;
    /// Its values and bounds are exact integers; otherwise bounds are raised by 2^-40 of the
    /// objective's positive terms plus one unit.
    bool is_exact = false;
    /// Relative error that its own tolerances leave in a proof of optimality.
    double relative_tolerance = 0;
    /// Largest coefficient that it reads; 0 = any of ours.
    Value largest_coefficient = 0;
};

/// Runs the program on a file in a scratch folder and believes nothing it says: the labels pass the
/// exact check, and claims that contradict each other or what is known are dropped and named in the
/// message (statistic `false_claims`, stop reason SolverFailed). Extra options: `rows` (paper |
/// strengthened), `command` (another template), `memory` (MiB of address space for each process),
/// `python` (interpreter of the worker). A work limit becomes a time limit of 10^7 ticks a second.
/// Statistics: solver_seconds (its own clock, where it tells), process_seconds, process_cpu,
/// memory_mib, nodes; missing = 1 where the program is not installed, not_applicable = 1 where it
/// cannot take the problem (rules in a graph format, coefficients or a size it does not allow).
std::shared_ptr<const Solver> make_external_solver(ExternalProgram program);

/// glpk, clasp, toulbar2, highs, scip, cp-sat and gurobi, installed or not, and `external`, which
/// runs the options `command`, `format` (mps | lp | opb | cfn | graph | lab) and `answer` (worker |
/// glpk | pb | toulbar2 | columns).
void add_external_solvers(SolverRegistry& registry);

}  // namespace labeling
