#!/usr/bin/env python3
"""peer_ratios.py RUNS.csv BASELINE OTHER...: how many times faster the baseline is, as Markdown.

RUNS.csv is written by `scalefcn-experiment report`. Times are median processor seconds over seeds and
renamings, at least 0.05; a run that proves nothing counts with its time limit. The second table has
geometric means over all problems, and over those where the fastest other solver needs over 1 s.
"""

import csv
import math
import statistics
import sys
from collections import defaultdict

FLOOR = 0.05


def read_medians(file):
    times = defaultdict(list)
    with open(file, encoding="utf-8", newline="") as lines:
        for run in csv.DictReader(lines):
            seconds = float(run["user_seconds"]) + float(run["system_seconds"])
            if run["outcome"] != "optimal":
                seconds = float(run["limit_seconds"])
            times[run["problem"], run["name"]].append(max(FLOOR, seconds))
    return {key: statistics.median(values) for key, values in times.items()}


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values)) if values else float("nan")


def main():
    if len(sys.argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    file, baseline, others = sys.argv[1], sys.argv[2], sys.argv[3:]
    median = read_medians(file)
    problems = [p for p in sorted({p for p, _ in median})
                if all((p, s) in median for s in [baseline, *others])]
    fastest = {p: min(median[p, s] for s in others) for p in problems}
    print("| problem | " + " | ".join([baseline, *others]) + " | times faster |")
    print("|---" * (len(others) + 3) + "|")
    for p in problems:
        cells = [f"{median[p, s]:.2f}" for s in [baseline, *others]]
        print(f"| {p} | " + " | ".join(cells) + f" | {fastest[p] / median[p, baseline]:.1f} |")
    slow = [p for p in problems if fastest[p] > 1]
    print(f"\n| {baseline} against | all {len(problems)} | {len(slow)} where the fastest other "
          "needs over 1 s |\n|---|---|---|")
    for name in [*others, "the fastest per problem"]:
        ratio = {p: median.get((p, name), fastest[p]) / median[p, baseline] for p in problems}
        print(f"| {name} | {geometric_mean(list(ratio.values())):.2f} | "
              f"{geometric_mean([ratio[p] for p in slow]):.2f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
