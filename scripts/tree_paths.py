#!/usr/bin/env python3
"""tree_paths.py FILE...: the tree of branch and cut on two lanes, in ticks, as Markdown.

Runs `labeling-solve` (on the path) with 10^8 ticks and prints its ticks, those of the tree, and those
on the longest path when each lane has a thread.
"""

import json
import pathlib
import subprocess
import sys
import tempfile


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__.splitlines()[0])
    print("| problem | ticks / 10^6 | of the tree | longest path | tree faster | nodes |\n|---|---|---|---|---|---|")
    for file in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as folder:
            result = pathlib.Path(folder) / "result.json"
            subprocess.run(
                ["labeling-solve", file, "--work", "100000000", "--result", str(result)],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            run = json.loads(result.read_text(encoding="utf-8"))
        counts = run["statistics"]
        tree, path = counts["tree-work"], counts["tree-path"]
        name = pathlib.Path(file).name.split(".")[0]
        faster = f"{tree / path:.2f}" if path else "-"
        print(
            f"| {name} | {run['work'] / 1e6:.1f} | {tree / 1e6:.1f} | {path / 1e6:.1f} | {faster} | {counts['nodes']:.0f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
