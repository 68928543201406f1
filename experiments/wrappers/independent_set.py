"""Runs a solver of maximum weight independent set on a labeling problem without rules.

independent_set.py PROBLEM.lab SOLUTION --convert SCALEFCN -- COMMAND WORD...

The problem becomes a METIS graph (`scalefcn convert`): a vertex for each label and, behind them, one
for each bonus, in conflict with whatever conflicts with one of its labels. In COMMAND's words %graph
is that file and %set the file that it is to write: the numbers of the chosen vertices, from 1, or,
with --flags, a line 0 or 1 for each vertex. Labels whose bonus was chosen are on: nothing chosen can
conflict with them. Exit code 1 when the command fails, 2 on wrong usage.
"""

import argparse
import os
import subprocess
import sys
import tempfile


def read_problem(file):
    weights, bonuses, has_rules = [], [], False
    with open(file, encoding="ascii") as lines:
        for line in lines:
            words = line.split()
            if not words:
                continue
            if words[0] == "p":
                weights = [0] * int(words[2])
            elif words[0] == "l":
                weights[int(words[1]) - 1] = int(words[2])
            elif words[0] == "b":
                bonuses.append((int(words[1]) - 1, int(words[2]) - 1, int(words[3])))
            elif words[0] == "r":
                has_rules = True
    return weights, bonuses, has_rules


def read_set(file, has_flags):
    with open(file, encoding="ascii") as numbers:
        values = [int(word) for word in numbers.read().split()]
    if has_flags:
        return [vertex for vertex, value in enumerate(values) if value == 1]
    return [value - 1 for value in values]


def labels_of(vertices, weights, bonuses):
    chosen = set()
    for vertex in vertices:
        if vertex < len(weights):
            chosen.add(vertex)
        else:
            chosen.update(bonuses[vertex - len(weights)][:2])
    return chosen


def main():
    if "--" not in sys.argv:
        print(__doc__, file=sys.stderr)
        return 2
    split = sys.argv.index("--")
    parser = argparse.ArgumentParser(description="labeling problem as independent set")
    parser.add_argument("problem")
    parser.add_argument("solution")
    parser.add_argument("--convert", default="scalefcn")
    parser.add_argument("--flags", action="store_true")
    arguments = parser.parse_args(sys.argv[1:split])
    command = sys.argv[split + 1:]
    weights, bonuses, has_rules = read_problem(arguments.problem)
    if has_rules:
        print("the problem has rules, an independent set has none", file=sys.stderr)
        return 1
    with tempfile.TemporaryDirectory() as folder:
        graph = os.path.join(folder, "problem.graph")
        chosen = os.path.join(folder, "set.txt")
        convert = [arguments.convert, "convert", arguments.problem, graph, "-q"]
        subprocess.run(convert, check=True, stdout=subprocess.DEVNULL)
        command = [w.replace("%graph", graph).replace("%set", chosen) for w in command]
        try:
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        except FileNotFoundError:
            print(f"{command[0]}: not installed", file=sys.stderr)
            return 127
        labels = labels_of(read_set(chosen, arguments.flags), weights, bonuses)
    value = sum(weights[label] for label in labels)
    value += sum(q for a, b, q in bonuses if a in labels and b in labels)
    with open(arguments.solution, "w", encoding="ascii") as file:
        file.write(f"v {value}\n")
        file.writelines(f"{label + 1}\n" for label in sorted(labels))
    return 0


if __name__ == "__main__":
    sys.exit(main())
