#!/usr/bin/env python3
"""What makes labeling problems hard: tables over runs.csv and problems.csv of a campaign's report.

usage: what_is_hard.py FOLDER [SOLVER...]

FOLDER holds runs.csv and problems.csv (scalefcn-experiment report); SOLVER are names as in the
report, default all that claim bounds. Prints Markdown: for each value of each tag the problems
proven and the shifted geometric mean of the counted seconds (shift 1 s), and for each solver the
rank correlation of its time with measures of a problem's size and density. A problem counts by the
median over its runs; runs that prove nothing count at their limit.
"""
import csv
import math
import statistics
import sys
from collections import defaultdict

TAGS = ("tag_mode", "tag_target", "tag_detector", "tag_scale", "tag_mesh")
MEASURES = {
    "labels": lambda p: p["labels"],
    "conflicts": lambda p: p["conflicts"],
    "conflicts per label": lambda p: p["conflicts"] / p["labels"],
    "bonuses per label": lambda p: p["bonuses"] / p["labels"],
    "rules per label": lambda p: p["rules"] / p["labels"],
}


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def medians(runs):
    """(solver, problem) -> (seconds, is proven), of runs that say how long they count."""
    seconds, proven = defaultdict(list), defaultdict(list)
    for run in runs:
        if run["outcome"] in ("not-applicable", "missing") or not run["counted_seconds"]:
            continue
        key = (run["name"], run["problem"])
        seconds[key].append(float(run["counted_seconds"]))
        proven[key].append(int(run["is_proven"]))
    return {key: (statistics.median(seconds[key]), statistics.median(proven[key]) >= 1)
            for key in seconds}


def shifted_mean(values):
    return math.exp(sum(math.log(v + 1) for v in values) / len(values)) - 1


def ranks(values):
    order = sorted(range(len(values)), key=values.__getitem__)
    result = [0.0] * len(values)
    start = 0
    while start < len(order):
        end = start
        while end + 1 < len(order) and values[order[end + 1]] == values[order[start]]:
            end += 1
        for k in range(start, end + 1):
            result[order[k]] = (start + end) / 2
        start = end + 1
    return result


def correlation(a, b):
    a, b = ranks(a), ranks(b)
    if len(set(a)) < 2 or len(set(b)) < 2:
        return None
    return statistics.correlation(a, b)


def print_row(cells):
    print("| " + " | ".join(cells) + " |")


def print_tags(results, problems, solvers):
    for tag in TAGS:
        groups = defaultdict(list)
        for name, problem in problems.items():
            if problem.get(tag):
                groups[problem[tag]].append(name)
        if len(groups) < 2:
            continue
        print(f"\n## By {tag.removeprefix('tag_')}\n\n"
              "Proven of the problems that the solver took, and mean seconds.\n")
        print_row([tag.removeprefix("tag_"), "problems"] + solvers)
        print_row(["---", "---:"] + ["---:"] * len(solvers))
        for value, names in groups.items():
            cells = [value, str(len(names))]
            for solver in solvers:
                taken = [results[solver, n] for n in names if (solver, n) in results]
                cells.append(f"{sum(p for _, p in taken)}/{len(taken)}, "
                             f"{shifted_mean([s for s, _ in taken]):.3f}" if taken else "–")
            print_row(cells)


def print_correlations(results, problems, solvers):
    print("\n## Rank correlation of time with\n")
    print_row(["solver", "problems"] + list(MEASURES))
    print_row(["---", "---:"] + ["---:"] * len(MEASURES))
    for solver in solvers:
        names = [n for n in problems if (solver, n) in results]
        times = [results[solver, n][0] for n in names]
        cells = [solver, str(len(names))]
        for measure in MEASURES.values():
            value = correlation([measure(problems[n]) for n in names], times) if names else None
            cells.append("–" if value is None else f"{value:.2f}")
        print_row(cells)


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 2 if len(sys.argv) < 2 else 0
    runs = read(f"{sys.argv[1]}/runs.csv")
    problems = {}
    for row in read(f"{sys.argv[1]}/problems.csv"):
        sizes = {key: float(row[key]) for key in ("labels", "conflicts", "bonuses", "rules")}
        problems[row["problem"]] = row | sizes
    exact = {run["name"] for run in runs if int(run["is_proven"] or 0)}
    solvers = sys.argv[2:] or sorted(exact)
    unknown = set(solvers) - {run["name"] for run in runs}
    if unknown:
        print(f"what_is_hard.py: no runs of {', '.join(sorted(unknown))}", file=sys.stderr)
        return 2
    results = medians(runs)
    print_tags(results, problems, solvers)
    print_correlations(results, problems, solvers)
    return 0


if __name__ == "__main__":
    sys.exit(main())
