#!/usr/bin/env python3
"""benchmark_table.py: JSON of Google Benchmark on standard input, as a Markdown table.

One row a benchmark and size, CPU time, and the counters that it reports.
"""

import json
import sys

USUAL = {
    "name", "family_index", "per_family_instance_index", "run_name", "run_type", "repetitions",
    "repetition_index", "threads", "iterations", "real_time", "cpu_time", "time_unit", "label",
    "aggregate_name", "aggregate_unit", "cpu_coefficient", "real_coefficient", "big_o", "rms",
}  # fmt: skip


def main():
    print("| benchmark | CPU | counters |\n|---|---|---|")
    for run in json.load(sys.stdin)["benchmarks"]:
        if run["run_type"] == "aggregate":
            if "big_o" in run:
                print(f"| {run['name']} | {run['cpu_coefficient']:.3g} {run['big_o']} {run['time_unit']} | |")
            continue
        counters = ", ".join(f"{v:,.0f} {k}" for k, v in run.items() if k not in USUAL)
        print(f"| {run['name']} | {run['cpu_time']:,.3f} {run['time_unit']} | {counters} |")


if __name__ == "__main__":
    main()
