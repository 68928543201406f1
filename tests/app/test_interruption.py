"""A killed run leaves complete files or none; Ctrl-C leaves the best result so far and says so.

The moments of the signals are chosen by what the run has done so far (files that appeared), so
nothing here depends on how fast the machine is.
"""

import gzip
import json
import os
import pathlib
import signal
import subprocess
import unittest

from scalefcn_process import DONE, NO_RESULT, PROGRAM, ProgramTest


def is_complete(path):
    """Whether a finished file of this kind looks like this one: each kind has an end mark."""
    content = path.read_bytes()
    if path.suffix == ".json":
        json.loads(content)
        return True
    if path.suffix == ".gz":
        return gzip.decompress(content).endswith(b"\n")
    if path.suffix == ".html":
        return content.rstrip().endswith(b"</html>")
    return content.endswith(b"\n")


def is_temporary(path):
    """The names under which files are written before they are renamed."""
    return path.name.startswith(".") and path.name.endswith(".part")


class Interruption(ProgramTest):
    def start(self, *arguments):
        return subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def signal_once(self, process, number, is_time):
        """Sends `number` as soon as `is_time()`; False when the process ended before."""
        while process.poll() is None:
            if is_time():
                os.kill(process.pid, number)
                return True
        return False

    def outputs(self):
        return [p for p in (self.folder / "out").rglob("*") if p.is_file()]

    def run_arguments(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        return ["run", "ribs.off", "--scales", "4%,5%,6%,8%", "--solvers", "greedy,cbc", "-o", "out"]

    def test_killed_runs_leave_no_half_file(self):
        arguments = self.run_arguments()
        killed = 0
        for count in (0, 1, 2, 4, 6, 9, 12):
            with self.subTest(files=count):
                process = self.start(*arguments)
                was_sent = self.signal_once(process, signal.SIGKILL,
                                            lambda c=count: len(self.outputs()) >= c)
                process.communicate()
                killed += was_sent
                for path in self.outputs():
                    if not is_temporary(path):
                        self.assertTrue(is_complete(path), str(path))
                for path in self.outputs():
                    path.unlink()
        self.assertGreater(killed, 0, "every run ended before it could be killed")

    def test_a_run_after_a_killed_one_is_whole(self):
        arguments = self.run_arguments()
        process = self.start(*arguments)
        self.signal_once(process, signal.SIGKILL, lambda: len(self.outputs()) >= 3)
        process.communicate()
        self.succeed(*arguments)
        self.assertTrue((self.folder / "out/report.html").exists())

    def test_interrupt_keeps_what_is_finished(self):
        arguments = self.run_arguments()
        first = self.folder / "out/ribs/4pct/adapted.fcn.json"
        process = self.start(*arguments)
        was_sent = self.signal_once(process, signal.SIGINT, first.exists)
        _, errors = process.communicate()
        if not was_sent:
            self.skipTest("the run ended before it could be interrupted")
        self.assertEqual(process.returncode, DONE, errors)
        self.assertIn("interrupted", errors)
        summary = json.loads((self.folder / "out/summary.json").read_text(encoding="utf-8"))
        self.assertTrue(summary["interrupted"])
        self.assertGreaterEqual(len(summary["meshes"][0]["scales"]), 1)
        self.assertTrue(is_complete(self.folder / "out/report.html"))

    def test_interrupted_solver_returns_its_best(self):
        problem = pathlib.Path(self.folder) / "hard.lab"
        problem.write_text(hard_problem(), encoding="utf-8")
        process = self.start("solve", "hard.lab", "--solver", "local-search", "--time-limit",
                             "3600", "--json", "-o", "best.sol")
        # The solver has begun once the process has used some processor time.
        was_sent = self.signal_once(process, signal.SIGINT,
                                    lambda: processor_ticks(process.pid) > 30)
        output, errors = process.communicate()
        self.assertTrue(was_sent, "the solver stopped by itself")
        self.assertIn("interrupted", errors)
        self.assertIn(process.returncode, (DONE, NO_RESULT))
        answer = json.loads(output)
        self.assertEqual(answer["stop_reason"], "interrupted")
        self.assertIsNotNone(answer["value"])
        self.succeed("verify", "hard.lab", "best.sol")

    def test_interrupt_while_reading_ends_at_once(self):
        process = subprocess.Popen([PROGRAM, "solve", "-", "-o", "best.sol"], cwd=self.folder,
                                   stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        # More than a pipe holds: when the last line has left, the program is reading.
        process.stdin.write("p labeling 1 0 0 0\n" + "c a comment\n" * 100_000)
        process.stdin.flush()
        os.kill(process.pid, signal.SIGINT)
        # The input has not ended, so an answer means that nothing was waited for.
        self.assertEqual(process.wait(), NO_RESULT)
        process.stdin.close()
        self.assertIn("interrupted", process.stderr.read())
        process.stderr.close()
        self.assertFalse((self.folder / "best.sol").exists())


def processor_ticks(pid):
    """User time of a process in clock ticks (1/100 s); 0 when it is gone."""
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1]
    except OSError:
        return 0
    return int(fields.split()[11])


def hard_problem():
    """A ring of cliques with weights that no solver finishes by itself within its hour."""
    size, rings = 40, 30
    count = size * rings
    lines, conflicts, bonuses = [], [], []
    for label in range(1, count + 1):
        lines.append(f"l {label} {label * 7919 % 101 + 1}")
        for step in (1, 7, 40, 41, 333):
            other = (label + step - 1) % count + 1
            conflicts.append(tuple(sorted((label, other))))
        partner = (label + 16) % count + 1
        bonuses.append((*sorted((label, partner)), label * 104729 % 53 + 1))
    conflicts = sorted(set(conflicts))
    bonuses = [b for b in bonuses if b[:2] not in set(conflicts)]
    head = f"p labeling {count} {len(conflicts)} {len(bonuses)} 0"
    lines = [head, *lines, *(f"x {i} {j}" for i, j in conflicts),
             *(f"b {i} {j} {q}" for i, j, q in bonuses)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    unittest.main()
