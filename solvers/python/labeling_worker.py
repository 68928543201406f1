"""Solves one problem file with a solver that comes as a Python package, and writes what it says.

labeling_worker.py --solver highs|scip|gurobi|cp-sat --problem FILE --solution FILE
                   [--time SECONDS] [--threads N] [--seed N] [--gap G] [--start FILE]

HiGHS, SCIP and Gurobi read free MPS that minimises (columns b1, b2, ... are the labels), CP-SAT
reads OPB (x1, x2, ...). All are asked to prove optimality to half a unit, since their default gap
of 1e-4 is none of an exact solver. The solution file holds, one per line: `status` (optimal,
feasible, infeasible, unknown, failed), `bound` and `value` (maximised), `seconds` (the solver's own
clock), `nodes`, `message`, then `label <i>` for each label that is 1, and `end`.
"""

import argparse
import math
import os
import sys
import time

BEGIN = time.monotonic()
INTEGER_GAP = 0.5


class Answer:
    def __init__(self):
        self.status = "unknown"
        self.value = None
        self.bound = None
        self.seconds = None
        self.nodes = None
        self.message = ""
        self.labels = []

    def text(self):
        lines = [f"status {self.status}"]
        for key in ("bound", "value", "seconds", "nodes"):
            number = getattr(self, key)
            if number is not None and math.isfinite(number) and abs(number) < 1e19:
                lines.append(f"{key} {float(number)!r}")
            elif key == "value" and number is not None:
                self.labels = []
        if self.message:
            lines.append("message " + " ".join(self.message.split())[:300])
        lines += [f"label {label}" for label in self.labels]
        return "\n".join(lines + ["end", ""])


def time_left(arguments):
    """What is left of the limit after the packages have been loaded and the file read."""
    if arguments.time is None:
        return None
    return max(0.05, arguments.time - (time.monotonic() - BEGIN))


def read_start(file):
    with open(file, encoding="ascii") as lines:
        return {name: int(value) for name, value in (line.split() for line in lines)}


def labels_of(values):
    """Numbers of the columns b<i> that are 1, from pairs of name and value."""
    return sorted(int(name[1:]) for name, value in values if name[0] == "b" and value > 0.5)


def solve_highs(arguments):
    import highspy

    highs = highspy.Highs()
    highs.setOptionValue("output_flag", False)
    highs.setOptionValue("threads", arguments.threads)
    highs.setOptionValue("random_seed", arguments.seed)
    highs.setOptionValue("mip_rel_gap", arguments.gap)
    highs.setOptionValue("mip_abs_gap", INTEGER_GAP)
    highs.readModel(arguments.problem)
    model = highs.getLp()
    names = list(model.col_names_)
    if arguments.start:
        start = read_start(arguments.start)
        solution = highspy.HighsSolution()
        solution.col_value = [float(start[name]) for name in names]
        highs.setSolution(solution)
    left = time_left(arguments)
    if left is not None:
        highs.setOptionValue("time_limit", left)
    highs.run()
    answer = Answer()
    info = highs.getInfo()
    status = highs.getModelStatus()
    answer.seconds = highs.getRunTime()
    answer.nodes = info.mip_node_count
    if status in (highspy.HighsModelStatus.kInfeasible,
                  highspy.HighsModelStatus.kUnboundedOrInfeasible):
        answer.status = "infeasible"
        return answer
    answer.bound = -info.mip_dual_bound
    if info.primal_solution_status == 2:
        is_optimal = status == highspy.HighsModelStatus.kOptimal
        answer.status = "optimal" if is_optimal else "feasible"
        answer.value = -info.objective_function_value
        answer.labels = labels_of(zip(names, highs.getSolution().col_value))
    return answer


def solve_scip(arguments):
    from pyscipopt import Model

    model = Model()
    model.hideOutput()
    model.readProblem(arguments.problem)
    model.setParam("limits/gap", arguments.gap)
    model.setParam("limits/absgap", INTEGER_GAP)
    model.setParam("randomization/randomseedshift", arguments.seed)
    model.setParam("parallel/maxnthreads", arguments.threads)
    variables = {variable.name: variable for variable in model.getVars()}
    if arguments.start:
        start = read_start(arguments.start)
        solution = model.createSol()
        for name, variable in variables.items():
            model.setSolVal(solution, variable, start[name])
        model.addSol(solution)
    left = time_left(arguments)
    if left is not None:
        model.setParam("limits/time", left)
    if arguments.threads > 1:
        model.solveConcurrent()
    else:
        model.optimize()
    answer = Answer()
    status = model.getStatus()
    answer.seconds = model.getSolvingTime()
    answer.nodes = model.getNTotalNodes()
    if status in ("infeasible", "inforunbd"):
        answer.status = "infeasible"
        return answer
    answer.bound = -model.getDualbound()
    if model.getNSols() > 0:
        answer.status = "optimal" if status in ("optimal", "gaplimit") else "feasible"
        best = model.getBestSol()
        answer.value = -model.getSolObjVal(best)
        answer.labels = labels_of((name, model.getSolVal(best, variable))
                                  for name, variable in variables.items())
    return answer


def solve_gurobi(arguments):
    import gurobipy

    with gurobipy.Env(params={"OutputFlag": 0}) as environment:
        with gurobipy.read(arguments.problem, environment) as model:
            model.Params.Threads = arguments.threads
            model.Params.Seed = arguments.seed
            model.Params.MIPGap = arguments.gap
            model.Params.MIPGapAbs = INTEGER_GAP
            if arguments.start:
                start = read_start(arguments.start)
                for variable in model.getVars():
                    variable.Start = start[variable.VarName]
            left = time_left(arguments)
            if left is not None:
                model.Params.TimeLimit = left
            model.optimize()
            answer = Answer()
            answer.seconds = model.Runtime
            answer.nodes = model.NodeCount
            if model.Status in (gurobipy.GRB.INFEASIBLE, gurobipy.GRB.INF_OR_UNBD):
                answer.status = "infeasible"
                return answer
            answer.bound = -model.ObjBound
            if model.SolCount > 0:
                is_optimal = model.Status == gurobipy.GRB.OPTIMAL
                answer.status = "optimal" if is_optimal else "feasible"
                answer.value = -model.ObjVal
                answer.labels = labels_of((v.VarName, v.X) for v in model.getVars())
            return answer


def read_opb(file):
    """Objective and rows, each a list of (coefficient, variable), and the number of labels."""
    objective, rows, label_count = [], [], None
    with open(file, encoding="ascii") as lines:
        for line in lines:
            words = line.split()
            if not words:
                continue
            if words[0] == "*":
                if words[1:2] == ["labels"]:
                    label_count = int(words[2])
                continue
            is_objective = words[0] == "min:"
            if is_objective:
                words = words[1:]
            words = words[:-1]  # the semicolon
            relation = None
            if not is_objective:
                relation, side = words[-2], int(words[-1])
                words = words[:-2]
            terms = [(int(words[k]), int(words[k + 1][1:])) for k in range(0, len(words), 2)]
            if is_objective:
                objective = terms
            else:
                rows.append((relation, side, terms))
    return objective, rows, label_count


def add_row(model, variables, relation, side, terms):
    if relation == ">=" and len(terms) > 1 and all(c == -1 for c, _ in terms) and side == -1:
        model.add_at_most_one(variables[x] for _, x in terms)
    elif relation == ">=" and side == 0 and sorted(c for c, _ in terms) == [-1, 1]:
        smaller, larger = (x for _, x in sorted(terms))
        model.add_implication(variables[smaller], variables[larger])
    else:
        activity = sum(c * variables[x] for c, x in terms if c != 0)
        if isinstance(activity, int):
            if (activity < side) if relation == ">=" else (activity != side):
                model.add_bool_or([])
        elif relation == ">=":
            model.add(activity >= side)
        else:
            model.add(activity == side)


def solve_cp_sat(arguments):
    from ortools.sat.python import cp_model

    objective, rows, label_count = read_opb(arguments.problem)
    numbers = {x for _, x in objective}.union(range(1, label_count + 1))
    for _, _, terms in rows:
        numbers.update(x for _, x in terms)
    model = cp_model.CpModel()
    variables = {x: model.new_bool_var(f"x{x}") for x in sorted(numbers)}
    for row in rows:
        add_row(model, variables, *row)
    model.maximize(sum(-c * variables[x] for c, x in objective))
    if arguments.start:
        for name, value in read_start(arguments.start).items():
            model.add_hint(variables[int(name[1:])], value)
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = arguments.threads
    solver.parameters.random_seed = arguments.seed
    solver.parameters.linearization_level = 2
    solver.parameters.relative_gap_limit = arguments.gap
    left = time_left(arguments)
    if left is not None:
        solver.parameters.max_time_in_seconds = left
    status = solver.solve(model)
    answer = Answer()
    answer.seconds = solver.wall_time
    answer.nodes = solver.num_branches
    if status == cp_model.INFEASIBLE:
        answer.status = "infeasible"
    elif status == cp_model.MODEL_INVALID:
        answer.status = "failed"
        answer.message = "CP-SAT: " + model.validate()
    else:
        answer.bound = solver.best_objective_bound
    if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        answer.status = "optimal" if status == cp_model.OPTIMAL else "feasible"
        answer.value = solver.objective_value
        answer.labels = [x for x in variables if x <= label_count and solver.value(variables[x])]
    return answer


SOLVERS = {"highs": solve_highs, "scip": solve_scip, "gurobi": solve_gurobi,
           "cp-sat": solve_cp_sat}


def main():
    parser = argparse.ArgumentParser(description="one problem, one solver, one solution file")
    parser.add_argument("--solver", required=True, choices=sorted(SOLVERS))
    parser.add_argument("--problem", required=True)
    parser.add_argument("--solution", required=True)
    parser.add_argument("--start")
    parser.add_argument("--time", type=float)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--gap", type=float, default=0.0)
    arguments = parser.parse_args()
    try:
        answer = SOLVERS[arguments.solver](arguments)
    except ImportError as error:
        answer = Answer()
        answer.status = "failed"
        answer.message = (f"not installed: {error}; scripts/setup_solvers.sh makes the Python "
                          "environment")
    except Exception as error:  # whatever a package throws is its answer
        answer = Answer()
        answer.status = "failed"
        answer.message = f"{arguments.solver}: {type(error).__name__}: {error}"
    partial = arguments.solution + ".part"
    with open(partial, "w", encoding="ascii", errors="replace") as file:
        file.write(answer.text())
    os.replace(partial, arguments.solution)
    return 0


if __name__ == "__main__":
    sys.exit(main())
