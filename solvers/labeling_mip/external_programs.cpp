// The programs that are known by name, with the options that make them prove optimality to the
// last unit rather than to their default gap.
#include "labeling_mip/external_solver.h"

namespace labeling {
namespace {

constexpr const char* kWorkerAdvice = "scripts/setup_solvers.sh makes the Python environment";

/// A solver behind the Python worker.
ExternalProgram wheel(const std::string& name, const std::string& title, ProblemFormat format) {
    ExternalProgram program;
    program.name = name;
    program.description = title + " as a Python package, in a process of its own";
    program.advice = kWorkerAdvice;
    program.command = "{python} {worker} --solver " + name +
                      " --problem {problem} --solution {solution} --threads {threads}"
                      " --seed {seed} [--time {time}] [--gap {gap}] [--start {start}]";
    program.problem_format = format;
    program.answer_format = AnswerFormat::Worker;
    return program;
}

}  // namespace

void add_external_solvers(SolverRegistry& registry) {
    ExternalProgram glpk;
    glpk.name = "glpk";
    glpk.description = "GLPK's glpsol, in a process of its own";
    glpk.advice = "Debian package glpk-utils";
    glpk.command =
        "glpsol --lp {problem} --write {solution} --cuts --seed {seed}"
        " [--tmlim {seconds}] [--mipgap {gap}]";
    glpk.problem_format = ProblemFormat::Lp;
    glpk.answer_format = AnswerFormat::Glpk;
    glpk.relative_tolerance = 1e-7;  // its tol_obj, by which it prunes
    registry.add(make_external_solver(glpk));

    ExternalProgram clasp;
    clasp.name = "clasp";
    clasp.description = "clasp on the pseudo-Boolean model, in a process of its own";
    clasp.advice = "Debian package clasp";
    clasp.command =
        "clasp {problem} --seed={seed} --parallel-mode={threads} [--time-limit={seconds}]";
    clasp.problem_format = ProblemFormat::Opb;
    clasp.answer_format = AnswerFormat::PseudoBoolean;
    clasp.is_exact = true;
    clasp.largest_coefficient = (Value{1} << 31) - 1;
    registry.add(make_external_solver(clasp));

    ExternalProgram toulbar2;
    toulbar2.name = "toulbar2";
    toulbar2.description = "toulbar2 on the cost function network, in a process of its own";
    toulbar2.advice = "Debian package toulbar2";
    toulbar2.command = "toulbar2 {problem} -w={solution} -seed={seed} [-timer={seconds}] [{start}]";
    toulbar2.problem_format = ProblemFormat::Cfn;
    toulbar2.answer_format = AnswerFormat::Toulbar2;
    toulbar2.is_exact = true;
    registry.add(make_external_solver(toulbar2));

    registry.add(make_external_solver(wheel("highs", "HiGHS", ProblemFormat::Mps)));
    registry.add(make_external_solver(wheel("scip", "SCIP", ProblemFormat::Mps)));
    registry.add(make_external_solver(wheel("gurobi", "Gurobi", ProblemFormat::Mps)));
    ExternalProgram cp_sat = wheel("cp-sat", "CP-SAT of OR-Tools", ProblemFormat::Opb);
    cp_sat.is_exact = true;
    registry.add(make_external_solver(cp_sat));

    ExternalProgram external;
    external.name = "external";
    external.description = "any program: options command, format and answer";
    external.advice = "the option 'command' names it";
    registry.add(make_external_solver(external));
}

}  // namespace labeling
