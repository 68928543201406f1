"""Starts the program under test and collects what it says. Standard library only."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ.get("SCALEFCN_PROGRAM", "scalefcn")
DONE, FAULT, USAGE, BAD_INPUT, NO_RESULT, VIOLATION = range(6)

# A tetrahedron: too small for most scales, good enough for every reader.
TETRAHEDRON = """OFF
4 4 0
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
"""

# Two labels that exclude each other and a third: the optimum is 9.
PROBLEM = """p labeling 3 1 1 0
l 1 4
l 2 3
l 3 2
x 1 2
b 1 3 3
"""


class ProgramTest(unittest.TestCase):
    """A scratch folder per test, and calls of the program in it."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="scalefcn-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def call(self, *arguments, stdin=None, timeout=300, environment=None):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, input=stdin,
                              capture_output=True, text=True, timeout=timeout, check=False,
                              env={**os.environ, **(environment or {})})

    def succeed(self, *arguments, code=DONE, stdin=None):
        result = self.call(*arguments, stdin=stdin)
        self.assertEqual(result.returncode, code,
                         f"scalefcn {' '.join(map(str, arguments))}\n{result.stdout}"
                         f"{result.stderr}")
        return result

    def succeed_json(self, *arguments, code=DONE):
        return json.loads(self.succeed(*arguments, "--json", code=code).stdout)

    def assert_one_error(self, errors):
        """One line tells what is wrong; notes may come before it."""
        lines = [line for line in errors.splitlines() if not line.startswith("note: ")]
        self.assertEqual(len(lines), 1, errors)
        self.assertTrue(lines[0].startswith("scalefcn: "), errors)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return name

    def model(self, name, *options):
        """A built-in model as a file in the scratch folder."""
        file = f"{name}.off"
        self.succeed("model", name, "-o", file, *options)
        return file

    def files(self, folder="."):
        """Every regular file below `folder`, relative to it, with its bytes."""
        base = self.folder / folder
        return {str(p.relative_to(base)): p.read_bytes()
                for p in sorted(base.rglob("*")) if p.is_file()}
