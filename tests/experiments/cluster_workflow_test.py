"""The Snakemake workflow of a campaign, on this machine: it makes what `scalefcn-experiment run`
makes, whatever dies on the way. Exit code 77 when there is no Snakemake: the rest was tried then.

Usage: cluster_workflow_test.py PROJECT_FOLDER FOLDER_OF_PROGRAMS
"""

import json
import pathlib
import random
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import unittest

PROGRAMS = pathlib.Path(sys.argv.pop(2)).resolve()
ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
CLUSTER = ROOT / "experiments/cluster"
PYTHON = ROOT / "build/experiments-venv/bin/python"
SKIPPED = 77

CAMPAIGN = """name = "workflow"
seeds = [1, 2]
[limits]
work = 200000
memory = "500MiB"
[[problems]]
family = "chain"
labels = [{labels}]
[[solvers]]
solver = "greedy"
[[solvers]]
solver = "auto"
time = 60
threads = 2
"""
RUNS_OF_A_PROBLEM = 4


def has_snakemake():
    question = [PYTHON, "-c", "import snakemake"]
    return (PYTHON.exists() and
            subprocess.run(question, check=False, capture_output=True).returncode == 0)


def ended(process):
    try:
        process.wait(timeout=0.02)
        return True
    except subprocess.TimeoutExpired:
        return False


class Campaign(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="scalefcn-workflow.")
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.configure("30, 60")

    def configure(self, labels):
        (self.folder / "c.toml").write_text(CAMPAIGN.format(labels=labels), encoding="utf-8")

    def call(self, *words, expected=0):
        result = subprocess.run([str(w) for w in words], cwd=self.folder, check=False, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if expected is not None:
            self.assertEqual(result.returncode, expected, result.stdout)
        return result.stdout

    def experiment(self, *words):
        return self.call(PROGRAMS / "scalefcn-experiment", *words)

    def run_alone(self, name="alone"):
        self.experiment("run", "c.toml", "-o", name, "--quiet")

    def compare(self, first, second, expected=0):
        return self.call(sys.executable, CLUSTER / "same_answers.py", first, second,
                         expected=expected)

    def planned_keys(self, name):
        plan = json.loads((self.folder / name / "plan.json").read_text(encoding="utf-8"))
        return [job["key"] for job in plan["jobs"]]

    def records(self, name):
        return {f.name: f.read_bytes() for f in (self.folder / name / "records").glob("*.json")}


class Records(Campaign):
    def change(self, statement):
        database = sqlite3.connect(self.folder / "changed/campaign.sqlite")
        with database:
            self.assertGreater(database.execute(statement).rowcount, 0)
        database.close()

    def test_what_differs_is_found(self):
        self.run_alone()
        self.assertIn("all answers equal", self.compare("alone", "alone"))
        some = "(SELECT min(key) FROM runs)"
        for statement, word in (
            (f"UPDATE runs SET value = value - 1 WHERE key = {some}", "run "),
            (f"UPDATE trace SET work = work + 1 WHERE run = {some}", "traces"),
            (f"DELETE FROM runs WHERE key = {some}", "is lost"),
            (f"UPDATE runs SET key = 'f' || key WHERE key = {some}", "planned 0 times"),
        ):
            with self.subTest(statement):
                shutil.copytree(self.folder / "alone", self.folder / "changed")
                self.change(statement)
                self.assertIn(word, self.compare("alone", "changed", expected=1))
                shutil.rmtree(self.folder / "changed")

    def test_the_first_record_of_a_run_counts(self):
        self.experiment("plan", "c.toml", "-o", "c", "--quiet")
        key = self.planned_keys("c")[0]
        self.experiment("execute", "c", key)
        before = self.records("c")
        self.assertEqual(len(before), 1)
        self.experiment("execute", "c", key)
        self.assertEqual(self.records("c"), before)
        self.assertEqual(list((self.folder / "c/scratch").iterdir()), [])
        (self.folder / f"c/records/{key}.json").write_text("{", encoding="utf-8")
        self.experiment("execute", "c", key)
        self.assertIn("1 new records", self.experiment("merge", "c"))


@unittest.skipUnless(has_snakemake(), "no Snakemake; type: scripts/setup_experiments.sh")
class Workflow(Campaign):
    def command(self, *words, **config):
        config = {"campaign": "c.toml", "output": "out",
                  "program": PROGRAMS / "scalefcn-experiment", **config}
        return [str(w) for w in (PYTHON, "-m", "snakemake", "-s", CLUSTER / "Snakefile", "--cores",
                                 2, "--rerun-incomplete", *words, "--config",
                                 *(f"{k}={v}" for k, v in config.items()))]

    def snakemake(self, *words, expected=0, **config):
        return self.call(*self.command(*words, **config), expected=expected)

    def test_it_makes_what_run_makes(self):
        self.run_alone()
        self.snakemake()
        self.assertIn("8 runs, 0 lost", self.compare("alone", "out"))
        self.assertIn("Nothing to be done", self.snakemake())
        before = self.records("out")
        self.configure("30, 60, 20")
        self.snakemake()
        after = self.records("out")
        self.assertEqual(len(after), len(before) + RUNS_OF_A_PROBLEM)
        self.assertEqual({name: after[name] for name in before}, before)
        self.run_alone("more")
        self.assertIn("12 runs, 0 lost", self.compare("more", "out"))

    def test_batches_leave_alone_what_is_there(self):
        self.run_alone()
        self.experiment("plan", "c.toml", "-o", "out", "--quiet")
        for key in self.planned_keys("out")[::3]:
            self.experiment("execute", "out", key)
        before = self.records("out")
        text = self.snakemake(batch=3)
        self.assertEqual(len(re.findall("rule execute_batch:", text)), 4, text)
        after = self.records("out")
        self.assertEqual({name: after[name] for name in before}, before)
        self.assertIn("8 runs, 0 lost", self.compare("alone", "out"))

    def test_killed_it_goes_on(self):
        self.run_alone()
        seed = random.randrange(1 << 32)
        pick = random.Random(seed)
        with self.subTest(seed=seed):
            for _ in range(3):
                wanted = pick.randrange(1, 7)  # records after which it dies
                with subprocess.Popen(self.command(), cwd=self.folder, stderr=subprocess.DEVNULL,
                                      stdout=subprocess.DEVNULL) as process:
                    while len(self.records("out")) < wanted and not ended(process):
                        pass
                    process.send_signal(signal.SIGKILL)
                self.snakemake("--unlock")
            self.snakemake()
            self.assertIn("8 runs, 0 lost", self.compare("alone", "out"))

    def test_needs_of_a_job(self):
        self.experiment("plan", "c.toml", "-o", "out", "--quiet")
        self.assertEqual(self.needs(), {(1, 1599, 1443), (2, 1599, 5)})
        # (1.1 * 60 + 5 + 5) seconds each, and once three minutes more
        self.assertEqual(self.needs(batch=4), {(1, 1599, 1443), (2, 1599, 9)})
        self.assertEqual(self.needs(memory_overhead_mib=0, unlimited_minutes=10,
                                    runtime_overhead_minutes=0), {(1, 525, 10), (2, 525, 2)})

    def needs(self, **config):
        """Threads, MB and minutes, of every job that makes runs."""
        text = self.snakemake("--dry-run", **config)
        found = set()
        for job in re.split(r"^\[.*\]$", text, flags=re.MULTILINE):
            if not re.search(r"^rule execute", job, re.MULTILINE):
                continue
            threads = re.search(r"threads: (\d+)", job)
            found.add((int(threads[1]) if threads else 1,
                       int(re.search(r"mem_mb=(\d+)", job)[1]),
                       int(re.search(r"runtime=(\d+)", job)[1])))
        return found

    def test_wrong_words_are_refused(self):
        self.assertIn("unknown bach", self.snakemake(bach=2, expected=1))
        self.assertIn("not a number from 0", self.snakemake(batch="many", expected=1))
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    program = unittest.main(exit=False)
    if not program.result.wasSuccessful():
        sys.exit(1)
    sys.exit(SKIPPED if program.result.skipped else 0)
