"""Remeshes with their curves, opened by the programs they are written for and by our own.

Usage: test_readers.py SCALEFCN PROJECT_FOLDER   (readers that are not installed are skipped)
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv[1]
ROOT = pathlib.Path(sys.argv[2])
PYTHON = ROOT / "build/readers-venv/bin/python"
READER = pathlib.Path(__file__).with_name("read_with.py")
NAMES = ["part.obj", "part.ply", "part.mesh", "part.msh", "part.vtp", "part.sharp", "part.fl"]


def scalefcn(folder, *words):
    result = subprocess.run([PROGRAM, *words], cwd=folder, capture_output=True, text=True,
                            check=False)
    if result.returncode != 0:
        raise AssertionError(f"scalefcn {' '.join(words)}: {result.stderr}")
    return result.stdout


class Exports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """One remesh in every format, and what it holds."""
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = pathlib.Path(cls.scratch.name)
        scalefcn(cls.folder, "model", "gear", "-o", "gear.off")
        scalefcn(cls.folder, "adapt", "gear.off", "--method", "sharp", "--scale", "4%", "-o",
                 "net.fcn.json")
        told = json.loads(scalefcn(cls.folder, "remesh", "gear.off", "--network", "net.fcn.json",
                                   "--scale", "4%", "--json", "-o", ",".join(NAMES)))
        assert told["files"] == NAMES, told["files"]
        cls.expected = {"vertices": told["triangles"]["vertices"],
                        "triangles": told["triangles"]["faces"], "lines": told["feature_edges"]}
        cls.length = cls.length_of_obj()
        assert cls.expected["lines"] > 50 and cls.length > 1

    @classmethod
    def length_of_obj(cls):
        points, length = [], 0.0
        for line in (cls.folder / "part.obj").read_text(encoding="utf-8").splitlines():
            kind, *rest = line.split()
            if kind == "v":
                points.append(tuple(map(float, rest)))
            elif kind == "l":
                length += math.dist(*(points[int(word) - 1] for word in rest))
        return length

    def opened(self, reader, name):
        if not PYTHON.exists():
            self.skipTest("scripts/setup_readers.sh has not been run")
        result = subprocess.run([PYTHON, READER, reader, str(self.folder / name)],
                                capture_output=True, text=True, check=False, timeout=300)
        if result.returncode == 77:
            self.skipTest(result.stderr.strip())
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout.splitlines()[-1])

    def check(self, reader, name, has_lines=True):
        found = self.opened(reader, name)
        for key in ("vertices", "triangles") + (("lines",) if has_lines else ()):
            self.assertEqual(found[key], self.expected[key], f"{reader} {name} {key}")
        if has_lines:
            self.assertAlmostEqual(found["length"], self.length, delta=1e-4 * self.length)
        return found

    def test_gmsh(self):
        self.check("gmsh", "part.msh")
        self.check("gmsh", "part.mesh")

    def test_vtk(self):
        self.check("vtk", "part.vtp")
        self.check("vtk", "part.obj")
        self.check("vtk", "part.ply", has_lines=False)

    def test_meshio(self):
        self.check("meshio", "part.msh")
        self.check("meshio", "part.mesh")

    def test_pymeshlab(self):
        self.check("pymeshlab", "part.obj")
        self.check("pymeshlab", "part.ply", has_lines=False)

    def test_our_own(self):
        """Curves read back have the length that was written."""
        for name in NAMES:
            mesh = ["--mesh", "part.obj"] if name.endswith((".sharp", ".fl")) else []
            scalefcn(self.folder, "convert", name, "back.fcn.json", "--as", "network", *mesh)
            network = json.loads((self.folder / "back.fcn.json").read_text(encoding="utf-8"))
            pieces = [math.dist(a, b) for arc in network["arcs"]
                      for a, b in zip(positions(arc), positions(arc)[1:])]
            self.assertEqual(len(pieces), self.expected["lines"], name)
            self.assertAlmostEqual(sum(pieces), self.length, delta=1e-9 * self.length, msg=name)

    def test_meshes_are_the_same(self):
        reference = scalefcn(self.folder, "convert", "part.obj", "-", "--as", "mesh")
        for name in ("part.ply", "part.mesh", "part.msh"):
            self.assertEqual(scalefcn(self.folder, "convert", name, "-", "--as", "mesh"),
                             reference, name)


def positions(arc):
    return [sample[:3] if isinstance(sample, list) else sample["position"]
            for sample in arc["samples"]]


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
