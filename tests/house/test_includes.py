"""Who may include whom: app -> report -> meshing -> adaptation -> features -> network -> geometry;
the solvers know the standard library, zlib and themselves; CGAL stays out of headers.

Usage: test_includes.py PROJECT_FOLDER
"""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else pathlib.Path.cwd()
ORDER = ["geometry", "network", "features", "adaptation", "meshing", "report", "app"]
# The files that translate between networks and labeling problems, and the parts that see both.
SEES_SOLVERS = {"adaptation", "meshing", "report", "app"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
PARTS = ORDER + ["labeling", "labeling_mip"]


def sources(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in {".h", ".cpp"})


def includes(path):
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def is_standard(name):
    return "/" not in name and not name.endswith((".h", ".hpp"))


def forbidden_in_part(part, name):
    """Why `part` of src/ must not include `name`, or None."""
    head = name.split("/")[0]
    if head in ORDER and ORDER.index(head) > ORDER.index(part):
        return f"{part} comes before {head}"
    if head in {"labeling", "labeling_mip"} and part not in SEES_SOLVERS:
        return f"{part} must not know the solvers"
    if head == "labeling_mip" and part not in {"app", "report"}:
        return f"{part} must not know the MIP adapters"
    return None


def forbidden_in_solvers(part, bracket, name):
    """Why `part` of solvers/ must not include `name`, or None."""
    allowed = {"labeling": {"labeling"}, "labeling_mip": {"labeling", "labeling_mip"}}[part]
    if bracket == '"':
        return None if name.split("/")[0] in allowed else "solvers include only themselves"
    if is_standard(name) or name == "zlib.h":
        return None
    if name in POSIX:
        return None
    if part == "labeling_mip" and re.match(r"(coin/)?(Cbc|Coin|Osi|Clp|Cgl)\w*\.(h|hpp)$", name):
        return None
    return "solvers include the standard library and zlib alone"


POSIX = {"fcntl.h", "unistd.h", "signal.h", "poll.h", "sys/wait.h", "sys/types.h", "sys/stat.h",
         "sys/resource.h", "sys/prctl.h", "spawn.h"}


class Includes(unittest.TestCase):
    def test_parts_follow_the_order(self):
        seen = 0
        for part in ORDER:
            for path in sources(ROOT / "src" / part):
                for _, name in includes(path):
                    seen += 1
                    reason = forbidden_in_part(part, name)
                    self.assertIsNone(reason, f"{path} includes {name}: {reason}")
        self.assertGreater(seen, 100, "the test looked at nothing")

    def test_solvers_stand_alone(self):
        seen = 0
        for part in ("labeling", "labeling_mip"):
            for path in sources(ROOT / "solvers" / part):
                for bracket, name in includes(path):
                    seen += 1
                    reason = forbidden_in_solvers(part, bracket, name)
                    self.assertIsNone(reason, f"{path} includes {name}: {reason}")
        self.assertGreater(seen, 20, "the test looked at nothing")

    def test_no_header_needs_cgal(self):
        for path in sources(ROOT / "src"):
            if path.suffix == ".h":
                for _, name in includes(path):
                    self.assertFalse(name.startswith("CGAL/"), f"{path} includes {name}")

    def test_every_header_is_guarded(self):
        for folder in ("src", "solvers"):
            for path in sources(ROOT / folder):
                if path.suffix == ".h":
                    self.assertIn("#pragma once", path.read_text(encoding="utf-8"), str(path))

    def test_the_rules_can_fail(self):
        self.assertIsNotNone(forbidden_in_part("geometry", "network/network.h"))
        self.assertIsNotNone(forbidden_in_part("features", "labeling/problem.h"))
        self.assertIsNotNone(forbidden_in_part("meshing", "labeling_mip/mip_solvers.h"))
        self.assertIsNotNone(forbidden_in_solvers("labeling", '"', "geometry/mesh.h"))
        self.assertIsNotNone(forbidden_in_solvers("labeling", "<", "Eigen/Core"))
        self.assertIsNotNone(forbidden_in_solvers("labeling", "<", "tbb/parallel_for.h"))
        self.assertIsNotNone(forbidden_in_solvers("labeling", "<", "coin/Cbc_C_Interface.h"))
        self.assertIsNone(forbidden_in_solvers("labeling", "<", "vector"))


if __name__ == "__main__":
    unittest.main()
