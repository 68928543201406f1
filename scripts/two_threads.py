#!/usr/bin/env python3
"""two_threads.py FILE...: local search on one and on two threads, as Markdown.

Runs `labeling-solve` (on the path) with 6 10^7 ticks each, three times in turn, and prints the
smallest wall times. Fails if the labelings of one and of two threads differ. Ends with 77 on a
machine with one processor.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROUNDS = 3
WORK = "60000000"


def run(file, threads, solution):
    command = ["labeling-solve", file, "--solver", "local-search", "--work", WORK]
    started = time.monotonic()
    subprocess.run(
        [*command, "--threads", str(threads), "-o", solution], check=True, stdout=subprocess.DEVNULL
    )
    return time.monotonic() - started


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__.splitlines()[0])
    if len(os.sched_getaffinity(0)) < 2:
        print("two_threads.py: one processor only", file=sys.stderr)
        sys.exit(77)
    print("| problem | 1 thread, s | 2 threads, s | faster |\n|---|---|---|---|")
    for file in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as folder:
            solutions = [f"{folder}/{n}.sol" for n in (1, 2)]
            times = [min(t) for t in zip(*([run(file, n, solutions[n - 1]) for n in (1, 2)] for _ in range(ROUNDS)))]
            if len({pathlib.Path(s).read_bytes() for s in solutions}) != 1:
                sys.exit(f"{file}: the labelings of one and of two threads differ")
        name = pathlib.Path(file).name.split(".")[0]
        print(f"| {name} | {times[0]:.2f} | {times[1]:.2f} | {times[0] / times[1]:.2f} |", flush=True)


if __name__ == "__main__":
    main()
