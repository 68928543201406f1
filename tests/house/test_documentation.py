"""The documentation: links lead somewhere, the site's contents exist, commands have their pages.

Usage: test_documentation.py PROJECT_FOLDER SCALEFCN
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv[1])
PROGRAM = sys.argv[2]
PAGES = [path for pattern in ("*.md", "docs/**/*.md", "results/**/*.md")
         for path in sorted(ROOT.glob(pattern))]
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def anchor_of(heading):
    """As GitHub and MkDocs make them."""
    text = re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", text.strip().lower()).replace(" ", "-")


def without_code(text):
    return re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.DOTALL)


class Documentation(unittest.TestCase):
    def test_links(self):
        self.assertGreater(len(PAGES), 8)
        count = 0
        for page in PAGES:
            for target in LINK.findall(without_code(page.read_text(encoding="utf-8"))):
                if re.match(r"[a-z]+:", target):
                    continue
                count += 1
                name, _, anchor = target.partition("#")
                linked = (page.parent / name).resolve() if name else page
                self.assertTrue(linked.exists(), f"{page.relative_to(ROOT)}: {target}")
                if anchor and linked.suffix == ".md":
                    text = re.sub(r"```.*?```", "", linked.read_text(encoding="utf-8"),
                                  flags=re.DOTALL)
                    headings = re.findall(r"^#+ (.*)$", text, flags=re.MULTILINE)
                    self.assertIn(anchor, {anchor_of(heading) for heading in headings},
                                  f"{page.relative_to(ROOT)}: {target}")
        self.assertGreater(count, 10)

    def test_the_site_shows_pages_that_exist(self):
        text = (ROOT / "docs/site/mkdocs.yml").read_text(encoding="utf-8")
        pages = re.findall(r": (\S+\.md)$", text, flags=re.MULTILINE)
        self.assertGreater(len(pages), 8)
        for page in pages:
            if not page.startswith("reference/"):  # made from the program and its headers
                self.assertTrue((ROOT / page).exists(), page)

    def test_every_command_has_a_page_with_its_options_and_an_example(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch) / "reference"
            subprocess.run([sys.executable, ROOT / "scripts/command_reference.py", PROGRAM, folder],
                           check=True)
            index = (folder / "index.md").read_text(encoding="utf-8")
            names = set(LINK.findall(index))
            self.assertLessEqual({f"{name}.md" for name in
                                  ("run", "detect", "adapt", "check", "remesh", "measure", "solve",
                                   "verify", "convert", "explain", "model")}, names)
            self.assertEqual({path.name for path in folder.iterdir()}, names | {"index.md"})
            for name in names:
                page = (folder / name).read_text(encoding="utf-8")
                command = name.removesuffix(".md")
                text = subprocess.run([PROGRAM, command, "--help"], capture_output=True, text=True,
                                      check=True).stdout
                self.assertIn(text.rstrip(), page)
                self.assertRegex(page, rf"```\nscalefcn {command} ")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
