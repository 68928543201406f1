#!/usr/bin/env python3
"""Writes a page a command from what the program itself says to --help.

Usage: scripts/command_reference.py PROGRAM FOLDER
"""

import pathlib
import re
import subprocess
import sys


def help_of(program, *command):
    return subprocess.run([program, *command, "--help"], capture_output=True, text=True,
                          check=True).stdout


def commands_of(text):
    """(name, one line) of each subcommand."""
    listing = text.split("Subcommands:\n", 1)[1].split("\n\n", 1)[0]
    return re.findall(r"^  (\S+)\s+(\S.*)$", listing, flags=re.MULTILINE)


def page(name, summary, text):
    """The example first, since it is what most people look for."""
    example = re.search(r"^Example:?\n((?:  .*\n?)+)", text, flags=re.MULTILINE)
    lines = [f"# scalefcn {name}", "", f"{summary}.", ""]
    if example:
        lines += ["```", *(line.strip() for line in example[1].splitlines()), "```", ""]
    return "\n".join([*lines, "```text", text.rstrip(), "```", ""])


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    text = help_of(program)
    rows = ["# Commands", "", "What `scalefcn COMMAND --help` says, a page each.", "",
            "| command | |", "|---|---|"]
    for name, summary in commands_of(text):
        (folder / f"{name}.md").write_text(page(name, summary, help_of(program, name)),
                                           encoding="utf-8")
        rows.append(f"| [{name}]({name}.md) | {summary} |")
    rows += ["", "```text", text.rstrip(), "```", ""]
    (folder / "index.md").write_text("\n".join(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
