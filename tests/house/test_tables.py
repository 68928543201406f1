"""scripts/redo_tables.py: what it replaces, what it keeps, and what it refuses.

Usage: test_tables.py PROJECT_FOLDER
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else pathlib.Path.cwd()
END = "<!-- end of table -->\n"


def block(command, body):
    return f"```sh table\n{command}\n```\n\n{body}\n\n{END}"


class Tables(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.page = pathlib.Path(folder.name) / "page.md"

    def redo(self, text, *options):
        self.page.write_text(text, encoding="utf-8")
        run = subprocess.run(
            [sys.executable, ROOT / "scripts/redo_tables.py", *options, self.page],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        return run, self.page.read_text(encoding="utf-8")

    def test_the_output_takes_the_place_of_the_table(self):
        page = "# Page\n\n{}\nbetween\n\n{}after\n"
        many = "for word in a b; do\n    echo \"| $word |\"\ndone"
        run, text = self.redo(page.format(block(many, "| old |"), block("echo '| c |'", "")))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(text, page.format(block(many, "| a |\n| b |"), block("echo '| c |'", "| c |")))
        run, again = self.redo(text)
        self.assertEqual(again, text)

    def test_a_failing_command_keeps_its_table_and_others_go_on(self):
        page = block("echo '| half |'; false | cat", "| a |") + block("echo '| new |'", "| b |")
        run, text = self.redo(page)
        self.assertEqual(run.returncode, 1)
        self.assertIn("exit code 1", run.stderr)
        self.assertEqual(text, block("echo '| half |'; false | cat", "| a |") + block("echo '| new |'", "| new |"))
        run, text = self.redo(block("true", "| a |"))
        self.assertEqual((run.returncode, text), (1, block("true", "| a |")))

    def test_what_needs_something_missing_is_kept_without_a_failure(self):
        page = block("exit 77", "| a |")
        run, text = self.redo(page)
        self.assertEqual((run.returncode, text), (0, page))
        self.assertIn("missing", run.stderr)

    def test_a_table_without_end_is_refused_before_anything_runs(self):
        page = block("echo '| new |'", "| a |") + "```sh table\necho x\n```\n| b |\n"
        for text in (page, page + block("echo y", "| c |")):
            run, after = self.redo(text)
            self.assertNotEqual(run.returncode, 0)
            self.assertEqual(after, text)

    def test_only_some(self):
        page = block("echo '| first |'", "| a |") + block("echo '| second |'", "| b |")
        _, text = self.redo(page, "--only", "second")
        self.assertEqual(text, block("echo '| first |'", "| a |") + block("echo '| second |'", "| second |"))

    def test_every_page_with_a_table_says_how_it_is_made(self):
        pages = sorted((ROOT / "results").glob("*.md"))
        self.assertTrue(pages)
        for page in pages:
            run = subprocess.run(
                [sys.executable, ROOT / "scripts/redo_tables.py", "--list", page],
                capture_output=True, text=True, check=False,
            )  # fmt: skip
            self.assertEqual(run.returncode, 0, run.stderr)
            lines = page.read_text(encoding="utf-8").splitlines()
            tables = sum(line.startswith("|---") or line.startswith("|--:") for line in lines)
            if tables:
                self.assertIn("```sh table", lines, f"{page}: a table without a command")


if __name__ == "__main__":
    unittest.main()
