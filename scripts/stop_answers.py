#!/usr/bin/env python3
"""stop_answers.py FILE...: how soon Ctrl-C is answered, as Markdown.

Starts `labeling-solve` (on the path) with each solver on each file, sends SIGINT after so many
processor seconds (of reading and solving), and prints how many more the program takes until it is
gone. Processor time, so that other work beside does not count.
"""

import os
import pathlib
import signal
import statistics
import subprocess
import sys
import time

SOLVERS = ["auto", "local-search"]
MOMENTS = [0.7, 1.7, 2.4, 3.1, 3.8, 4.5, 5.2, 6.0, 7.0]


def processor_seconds(pid):
    """Of all threads."""
    tasks = pathlib.Path(f"/proc/{pid}/task").iterdir()
    return sum(int((task / "schedstat").read_text(encoding="ascii").split()[0]) for task in tasks) / 1e9


def answer(file, solver, moment):
    """Processor seconds after the signal; None if the program ended before."""
    command = ["labeling-solve", file, "--solver", solver, "--time", "3600"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    while process.poll() is None:
        before = processor_seconds(process.pid)
        if before >= moment:
            process.send_signal(signal.SIGINT)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            if process.returncode not in (0, 4):
                sys.exit(f"{' '.join(command)}: exit code {process.returncode} after a signal")
            return usage.ru_utime + usage.ru_stime - before
        time.sleep(0.003)
    return None


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__.splitlines()[0])
    print("| problem | solver | stops | median ms | worst ms |\n|---|---|---|---|---|")
    for file in sys.argv[1:]:
        for solver in SOLVERS:
            times = [answer(file, solver, moment) for moment in MOMENTS]
            times = [1000 * t for t in times if t is not None]
            if not times:
                sys.exit(f"{file}: {solver} ended before any stop")
            name = pathlib.Path(file).name.split(".")[0]
            print(f"| {name} | {solver} | {len(times)} | {statistics.median(times):.0f} | {max(times):.0f} |", flush=True)


if __name__ == "__main__":
    main()
