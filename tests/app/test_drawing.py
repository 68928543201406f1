"""scalefcn draw, the steps that adapt saves, and the figures that are made of both."""

import pathlib
import re
import struct
import subprocess
import sys
import unittest
import xml.dom.minidom
import zlib

from scalefcn_process import BAD_INPUT, PROGRAM, USAGE, ProgramTest

EXPERIMENT = pathlib.Path(__file__).parents[2] / "experiments" / "figures"
sys.path.insert(0, str(EXPERIMENT))
from line_plot import line_plot  # noqa: E402  (its folder is known only here)
from rib_count import count_ribs  # noqa: E402
from ribbed_plate import ribbed_plate  # noqa: E402


def read_png(path):
    """Width, height and rows of (r, g, b); filters of PNG undone by their definition."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height = struct.unpack(">II", data[at + 8:at + 16])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, rows, above = zlib.decompress(packed), [], bytes(3 * width)
    for y in range(height):
        kind, line = raw[y * (3 * width + 1)], bytearray(raw[y * (3 * width + 1) + 1:(y + 1) * (3 * width + 1)])
        for i in range(3 * width):
            left, up = (line[i - 3] if i >= 3 else 0), above[i]
            corner = above[i - 3] if i >= 3 else 0
            nearest = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, nearest)[kind]) % 256
        rows.append([tuple(line[i:i + 3]) for i in range(0, 3 * width, 3)])
        above = line
    return width, height, rows


def red(rows):
    """Where a picture is clearly red."""
    return {(x, y) for y, row in enumerate(rows) for x, (r, g, b) in enumerate(row) if r > max(g, b) + 60}


class Draw(ProgramTest):
    def picture(self, *options):
        self.succeed("draw", *options, "-o", "picture.png")
        return read_png(self.folder / "picture.png")

    def test_curves_are_where_the_edges_of_the_box_are(self):
        self.model("box", "--resolution", "0.2")
        self.succeed("detect", "box.off", "--method", "sharp", "-o", "net.fcn.json")
        view = ["--view", "0,0,1", "--up", "0,1,0", "--size", "200x160"]
        width, height, plain = self.picture("box.off", *view)
        self.assertEqual((width, height), (200, 160))
        self.assertEqual(red(plain), set())
        drawn = red(self.picture("box.off", "--curves", "net.fcn.json=#ff0000", *view)[2])
        self.assertGreater(len(drawn), 2 * (160 + 130))
        # Along the axis a box shows the outline of its top and nothing inside.
        xs, ys = {x for x, _ in drawn}, {y for _, y in drawn}
        inner = {(x, y) for x, y in drawn
                 if min(xs) + 4 < x < max(xs) - 4 and min(ys) + 4 < y < max(ys) - 4}
        self.assertEqual(inner, set())

    def test_framing_of_another_mesh(self):
        self.model("box", "--resolution", "0.2")
        self.model("sphere", "--resolution", "0.2")
        view = ["--view", "0,0,1", "--up", "0,1,0", "--size", "100x80"]
        own = self.picture("sphere.off", *view)
        self.assertNotEqual(own, self.picture("sphere.off", "--as", "box.off", *view))
        self.assertEqual(own, self.picture("sphere.off", "--as", "sphere.off", *view))

    def test_wrong_words_are_named(self):
        self.model("box", "--resolution", "0.5")
        for options, code, part in ((["--curves", "net.obj=mauve"], USAGE, "mauve"),
                                    (["--size", "10by10"], USAGE, "10by10"),
                                    (["--size", "0x10"], USAGE, "0x10"),
                                    (["--view", "1,2"], USAGE, "1,2"),
                                    (["--view", "0,0,x"], USAGE, "0,0,x"),
                                    (["--size", "99999x2"], BAD_INPUT, "99999"),
                                    (["--curves", "nothing.obj"], BAD_INPUT, "nothing.obj"),
                                    (["--as", "nothing.off"], BAD_INPUT, "nothing.off")):
            result = self.call("draw", "box.off", "-o", "a.png", *options)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn(part, result.stderr)
            self.assert_one_error(result.stderr)
            self.assertFalse((self.folder / "a.png").exists())


class Steps(ProgramTest):
    def test_a_network_is_drawn_on_a_coarse_mesh(self):
        self.model("octaflower")
        self.succeed("detect", "octaflower.off", "--method", "crest", "-o", "net.fcn.json")
        self.succeed("adapt", "octaflower.off", "--network", "net.fcn.json", "--scale", "2%", "-o", "fine.fcn.json")
        self.succeed("remesh", "octaflower.off", "--scale", "15%", "-o", "coarse.obj")
        self.succeed("draw", "coarse.obj", "--curves", "fine.fcn.json=kept", "-o", "a.png")

    def test_lines_are_as_many_as_the_report_counts(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        adapted = self.succeed_json("adapt", "ribs.off", "--method", "sharp", "--scale", "8%", "--mode", "paper", "-o",
                                    "adapted.fcn.json", "--save-steps", "steps")

        def lines(step, kind):
            path = self.folder / "steps" / f"step_{step}_{kind}.obj"
            return len(re.findall(r"(?m)^l ", path.read_text(encoding="utf-8"))) if path.exists() else 0

        self.assertGreater(adapted["iterations"][0]["dropped"], 0)
        for iteration in adapted["iterations"]:
            step = iteration["iteration"]
            self.assertEqual(lines(step, "resampled") + lines(step, "short"), iteration["segments"])
            self.assertEqual(lines(step, "short"), iteration["short_segments"])
            self.assertEqual(lines(step, "kept"), iteration["kept"])
            self.assertEqual(lines(step, "dropped"), iteration["dropped"])
        self.assertLessEqual({f"steps/{p.name}" for p in (self.folder / "steps").iterdir()}, set(adapted["files"]))


class Figures(ProgramTest):
    def test_ribs_are_counted(self):
        for count, height in ((9, 0.05), (16, 0.02)):
            ribbed_plate(self.folder / "plate.off", count=count, height=height)
            lines = (self.folder / "plate.off").read_text(encoding="utf-8").splitlines()
            corners = [tuple(map(int, line.split()[1:])) for line in lines if line.startswith("3 ")]
            edges = {(f[k], f[(k + 1) % 3]) for f in corners for k in range(3)}
            self.assertEqual(len(edges), 3 * len(corners), "an edge twice in one direction")
            self.assertEqual(edges, {(b, a) for a, b in edges}, "closed and oriented")
            self.succeed("convert", "plate.off", "plate.obj", "--as", "mesh")
            for whole in (height, 4 * height):  # what the rise is a share of
                found, rise = count_ribs(self.folder / "plate.obj", whole)
                self.assertLessEqual(abs(found - (count - 2)), 1)  # but for the margins at both ends
                self.assertAlmostEqual(rise, height / whole, delta=0.05 * height / whole)
        self.model("box", "--resolution", "0.1")
        self.succeed("convert", "box.off", "box.obj", "--as", "mesh")
        self.assertEqual(count_ribs(self.folder / "box.obj", 0.05), (0, 0))

    def test_a_figure_shows_what_its_table_names(self):
        self.model("skyscraper")
        done = subprocess.run([sys.executable, "-B", EXPERIMENT / "figures.py", "--scalefcn", PROGRAM, "--meshes",
                               self.folder, "-o", self.folder / "shown", "7"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [line for line in done.stdout.splitlines() if line.startswith("|")]
        self.assertEqual({row.count("|") for row in rows}, {5}, done.stdout)
        named = re.findall(r"\]\(([^)]+)\)", done.stdout)
        self.assertEqual(len(named), 4)
        self.assertEqual(set(named), {path.name for path in (self.folder / "shown").iterdir()})
        distances = [float(value) for value in re.findall(r"Hd ([0-9.]+) %", done.stdout)]
        self.assertEqual(len(distances), 3)
        self.assertEqual(distances[1], 0, "decimation by quadrics keeps planes, and the tower is made of planes")
        self.assertGreater(min(distances[0], distances[2]), 0, "set-backs below the scale go")
        missing = subprocess.run([sys.executable, "-B", EXPERIMENT / "figures.py", "--scalefcn", PROGRAM, "--meshes",
                                  self.folder, "-o", self.folder / "shown", "9"], capture_output=True, text=True, check=False)
        self.assertEqual(missing.returncode, 77)
        self.assertIn("fetch_meshes.sh", missing.stderr)

    def test_plot_is_xml_with_a_marker_for_every_value(self):
        text = line_plot("x < 1 & y", [0.1, 1, 2], ["one", "two"],
                         [("a", [[1, 2, 3], [3, None, 1]]), ("b", [[0, 0, 0], [5, 6, 700]])])
        plot = xml.dom.minidom.parseString(text)
        self.assertEqual(len(plot.getElementsByTagName("circle")), 3 + 3 + 1)
        # One is the background.
        self.assertEqual(len(plot.getElementsByTagName("rect")), 2 + 3 + 1 + 1)
        inside = [float(c.getAttribute("cy")) for c in plot.getElementsByTagName("circle")]
        self.assertLess(max(inside), float(plot.documentElement.getAttribute("height")))


if __name__ == "__main__":
    unittest.main()
