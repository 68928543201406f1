"""./run, ./test and .ci/run: they parse, refuse wrong arguments before doing anything, and the
continuous integration calls ./test.

Usage: test_scripts.py PROJECT_FOLDER
"""

import os
import pathlib
import shutil
import subprocess
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else pathlib.Path.cwd()
SCRIPTS = ["run", "test", ".ci/run", "scripts/setup.sh", "scripts/setup_solvers.sh",
           "scripts/fetch_meshes.sh", "scripts/list_problems.sh", "experiments/reproduce",
           "scripts/setup_experiments.sh", "scripts/setup_viewer.sh",
           "scripts/setup_readers.sh", "scripts/make_docs.sh", "experiments/cluster/try_slurm.sh"]


def call(*arguments):
    return subprocess.run([str(a) for a in arguments], capture_output=True, text=True, check=False)


class Scripts(unittest.TestCase):
    def test_syntax(self):
        for script in SCRIPTS:
            result = call("bash", "-n", ROOT / script)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_shellcheck(self):
        if shutil.which("shellcheck") is None:
            self.skipTest("shellcheck is not installed")
        result = subprocess.run(["shellcheck", "-x", *SCRIPTS], cwd=ROOT, capture_output=True,
                                text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_commands_are_executable_and_fail_early(self):
        for script in ("run", "test", ".ci/run"):
            self.assertTrue(os.access(ROOT / script, os.X_OK), script)
            self.assertIn("set -eu", (ROOT / script).read_text(encoding="utf-8"))

    def test_continuous_integration_calls_test(self):
        self.assertIn("/test", (ROOT / ".ci/run").read_text(encoding="utf-8"))

    def test_run_help(self):
        result = call(ROOT / "run", "--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("./run [MESH] [LENGTH]", result.stdout)

    def test_run_refuses_wrong_arguments(self):
        self.assertEqual(call(ROOT / "run", "--nonsense").returncode, 2)
        self.assertEqual(call(ROOT / "run", "a", "b", "c").returncode, 2)
        missing = call(ROOT / "run", "no-such-mesh.off")
        self.assertEqual(missing.returncode, 3)
        self.assertIn("no-such-mesh.off", missing.stderr)


if __name__ == "__main__":
    unittest.main()
