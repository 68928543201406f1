#!/usr/bin/env python3
"""redo_tables.py [--list] [--only WORD] PAGE.md...: makes the tables of result pages again.

A page says how each table is made in a code block of kind `sh table`. What that prints takes the
place of everything between the block and the next line `<!-- end of table -->`. Commands run by bash
in the project's root; the programs of build/release/bin and of scripts are on the path, $PROBLEMS is
experiments/problems/development, $MESHES the folder of fetched meshes, $CAMPAIGNS the folder that
experiments/reproduce fills.

A command that ends with 77 needs something that is not there: its table stays, and a line on stderr
says so. Any other failure keeps the table, too, and makes the exit code 1. Files are replaced whole.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BLOCK = re.compile(
    r"^```sh table\n(?P<command>.*?)^```\n(?P<body>.*?)^<!-- end of table -->$", re.DOTALL | re.MULTILINE
)
NOT_HERE = 77


def environment():
    build = pathlib.Path(os.environ.get("SCALEFCN_BUILD", ROOT / "build/release"))
    return {
        **os.environ,
        "PATH": os.pathsep.join([str(build / "bin"), str(ROOT / "scripts"), os.environ["PATH"]]),
        "PROBLEMS": "experiments/problems/development",
        "MESHES": os.environ.get("SCALEFCN_MESHES", str(ROOT / "build/meshes")),
        "CAMPAIGNS": os.environ.get("SCALEFCN_CAMPAIGNS", str(ROOT / "out/campaigns")),
    }


def check_blocks(page, text):
    """Every block must have an end, or the next table's text would be replaced."""
    begins = [match.start() for match in re.finditer(r"^```sh table$", text, re.MULTILINE)]
    found = [match.start() for match in BLOCK.finditer(text)]
    inner = [match for match in BLOCK.finditer(text) if "```sh table" in match["body"]]
    if begins != found or inner:
        sys.exit(f"{page}: a table without '<!-- end of table -->'")


def redo(page, match):
    """The new text of a block, and whether its command failed."""
    command = match["command"]
    title = " ".join(command.split())
    started = time.monotonic()
    run = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", command],
        cwd=ROOT,
        env=environment(),
        stdout=subprocess.PIPE,
        text=True,
        check=False,
    )
    seconds = time.monotonic() - started
    if run.returncode == 0 and run.stdout.strip():
        print(f"{page}: {title} ({seconds:.0f} s)", file=sys.stderr)
        body = "\n" + run.stdout.strip("\n") + "\n\n"
        return f"```sh table\n{command}```\n{body}<!-- end of table -->", False
    if run.returncode == NOT_HERE:
        print(f"{page}: kept, something is missing: {title}", file=sys.stderr)
        return match[0], False
    reason = f"exit code {run.returncode}" if run.returncode else "it printed nothing"
    print(f"{page}: kept, {reason}: {title}", file=sys.stderr)
    return match[0], True


def redo_page(page, only):
    text = page.read_text(encoding="utf-8")
    check_blocks(page, text)
    failed = False
    # One at a time, and written after each: a table can take an hour.
    for index in range(len(list(BLOCK.finditer(text)))):
        match = list(BLOCK.finditer(text))[index]
        if only and only not in match["command"]:
            continue
        block, has_failed = redo(page, match)
        failed |= has_failed
        text = text[: match.start()] + block + text[match.end() :]
        fresh = page.with_suffix(".part")
        fresh.write_text(text, encoding="utf-8")
        fresh.replace(page)
    return failed


def main():
    parser = argparse.ArgumentParser(description="makes the tables of result pages again")
    parser.add_argument("pages", nargs="+", type=pathlib.Path, metavar="PAGE.md")
    parser.add_argument("--list", action="store_true", help="print the commands and run none")
    parser.add_argument("--only", metavar="WORD", help="only tables whose command contains WORD")
    arguments = parser.parse_args()
    failed = False
    for page in arguments.pages:
        if not page.is_file():
            sys.exit(f"{page}: no such file")
        if arguments.list:
            text = page.read_text(encoding="utf-8")
            check_blocks(page, text)
            for match in BLOCK.finditer(text):
                print(f"{page}: {' '.join(match['command'].split())}")
        else:
            failed |= redo_page(page, arguments.only)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
