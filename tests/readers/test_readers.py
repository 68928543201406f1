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


class Reading(unittest.TestCase):
    def opened(self, reader, name):
        if not PYTHON.exists():
            self.skipTest("scripts/setup_readers.sh has not been run")
        result = subprocess.run([PYTHON, READER, reader, str(self.folder / name)],
                                capture_output=True, text=True, check=False, timeout=300)
        if result.returncode == 77:
            self.skipTest(result.stderr.strip())
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout.splitlines()[-1])


class Exports(Reading):
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


class Quads(Reading):
    """Quads with their features, and the field that they follow with its mesh."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = pathlib.Path(cls.scratch.name)
        scalefcn(cls.folder, "model", "box", "--resolution", "0.1", "-o", "box.off")
        scalefcn(cls.folder, "adapt", "box.off", "--method", "sharp", "--target", "quad", "--scale",
                 "8%", "-o", "net.fcn.json")
        cls.told = json.loads(scalefcn(cls.folder, "remesh", "box.off", "--network", "net.fcn.json",
                                       "--type", "quad", "--json", "-o",
                                       "quads.obj,quads.off,quads.vtu", "--field",
                                       "field.rosy,field.obj"))

    def check(self, reader, name, has_lines=True, has_quads=True):
        found = self.opened(reader, name)
        quads = self.told["quads"]
        self.assertEqual(found["vertices"], quads["vertices"], f"{reader} {name}")
        if has_quads:
            self.assertEqual((found["quads"], found["triangles"]), (quads["faces"], 0))
        if has_lines:
            # The edges of the box, 1 by 0.8 by 0.6.
            self.assertEqual(found["lines"], self.told["feature_edges"], f"{reader} {name}")
            self.assertAlmostEqual(found["length"], 4 * 2.4, delta=1e-4)
        return found

    def test_vtk(self):
        self.check("vtk", "quads.obj")
        self.check_data(self.check("vtk", "quads.vtu")["data"])

    def test_meshio(self):
        # It reads neither lines nor, before 5.3, quads of OBJ.
        self.check_data(self.check("meshio", "quads.vtu")["data"])

    def test_pymeshlab(self):
        # It cuts quads into triangles and marks the cuts.
        found = self.check("pymeshlab", "quads.obj", has_lines=False, has_quads=False)
        self.assertEqual(found["triangles"], 2 * self.told["quads"]["faces"])
        self.check("pymeshlab", "quads.off", has_lines=False, has_quads=False)

    def check_data(self, data):
        count = self.told["quads"]["faces"]
        jacobians = data["scaled_jacobian"][:count]
        self.assertAlmostEqual(sum(jacobians) / count, self.told["quads"]["mean_scaled_jacobian"])
        self.assertAlmostEqual(min(jacobians), self.told["quads"]["min_scaled_jacobian"])
        self.assertEqual(set(data["arc"][:count]), {-1})
        self.assertEqual(len(set(data["arc"][count:])), 12)

    def test_the_field_goes_with_its_mesh(self):
        lines = (self.folder / "field.rosy").read_text(encoding="utf-8").split("\n")
        found = self.opened("vtk", "field.obj")
        self.assertEqual(int(lines[0]), found["triangles"])
        self.assertAlmostEqual(found["length"], 4 * 2.4, delta=1e-4)


def positions(arc):
    return [sample[:3] if isinstance(sample, list) else sample["position"]
            for sample in arc["samples"]]


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
