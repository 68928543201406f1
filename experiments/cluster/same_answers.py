#!/usr/bin/env python3
"""same_answers.py A B: do two campaigns of one configuration hold the same runs with the same
answers? Compared is everything but times, memory and where a run was made: outcome, status, stop
reason, value, bound, work, and the work, value and bound of every point of the trace. So limits
must be of work, not of seconds. Prints one line; exit code 1 if anything is lost, there twice or
different."""
import json
import sqlite3
import sys
from collections import Counter
from pathlib import Path

ANSWER = "outcome, status, stop_reason, value, bound, work"
SHOWN = 10


def planned_keys(folder):
    plan = json.loads((folder / "plan.json").read_text(encoding="utf-8"))
    return [job["key"] for job in plan["jobs"]]


def answers(folder):
    """(key, answer) of every row; a key that is there twice comes twice."""
    database = sqlite3.connect(f"file:{folder / 'campaign.sqlite'}?mode=ro", uri=True)
    traces = {}
    for key, *point in database.execute(
        "SELECT run, position, work, value, bound FROM trace ORDER BY run, position"
    ):
        traces.setdefault(key, []).append(tuple(point))
    return [
        (key, (tuple(answer), traces.get(key, [])))
        for key, *answer in database.execute(f"SELECT key, {ANSWER} FROM runs")
    ]


def faults(folder, keys, rows):
    planned, found = Counter(keys), Counter(key for key, _ in rows)
    for key in sorted(planned - found):
        yield f"{folder}: run {key} is lost"
    for key in sorted(found - planned):
        yield f"{folder}: run {key} is there {found[key]} times, planned {planned[key]} times"


def differences(first, second):
    there = dict(second)
    for key, answer in first:
        if key in there and there[key] != answer:
            yield f"run {key}: {answer[0]} and {there[key][0]}, traces {answer[1]} and {there[key][1]}"


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    first, second = Path(sys.argv[1]), Path(sys.argv[2])
    keys = planned_keys(first)
    found = []
    if sorted(keys) != sorted(planned_keys(second)):
        found.append(f"{first} and {second} are campaigns of different runs")
    rows = answers(first), answers(second)
    found += [*faults(first, keys, rows[0]), *faults(second, planned_keys(second), rows[1])]
    found += differences(*rows)
    for line in found[:SHOWN]:
        print(line)
    if found:
        print(f"{len(found)} faults")
        return 1
    print(f"{len(keys)} runs, 0 lost, 0 doubled, all answers equal")
    return 0


if __name__ == "__main__":
    sys.exit(main())
