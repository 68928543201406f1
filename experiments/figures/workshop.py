"""What all figures are made with: the program, where meshes are and pictures go, tables of both."""

import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIZE, SMALL = "400x320", "312x250"
LINE = "2"
MODELS = {"octaflower": ["--resolution", "0.01"], "gear": ["--resolution", "0.01"], "ribs": [], "skyscraper": []}


class Workshop:
    """Where meshes are, where pictures go, and the program that makes both."""

    def __init__(self, program, meshes, folder, scratch):
        self.program, self.meshes = program, pathlib.Path(meshes)
        self.folder, self.scratch = pathlib.Path(folder), pathlib.Path(scratch)
        self.folder.mkdir(parents=True, exist_ok=True)

    def call(self, *arguments):
        command = [self.program, *map(str, arguments), "--json", "--quiet", "--no-timings"]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        return json.loads(done.stdout)

    def mesh(self, name):
        if name in MODELS:
            path = self.scratch / f"{name}.off"
            self.call("model", name, *MODELS[name], "-o", path)
            return path
        path = self.meshes / f"{name}.off"
        if not path.is_file():
            print(f"figures.py: no {path} (scripts/fetch_meshes.sh)", file=sys.stderr)
            sys.exit(77)
        return path

    def draw(self, name, mesh, seen_as, curves=(), *options, size=SIZE):
        """A picture and what Markdown says to show it; `curves` are FILE=COLOUR."""
        path = self.folder / f"{name}.png"
        chosen = [word for curve in curves for word in ("--curves", curve)]
        self.call("draw", mesh, "--as", seen_as, *chosen, "--size", size, "--line-width", LINE, *options, "-o", path)
        return f"![{name.replace('_', ' ')}]({path.name})"

    def distance(self, mesh, reference):
        return self.call("measure", mesh, reference)["distance"]["hausdorff_over_diagonal"]

    def adapt_and_remesh(self, mesh, options, scales):
        """`run` at each scale: its folder, its JSON, and the remesh's distance from the mesh, by scale."""
        folder = self.scratch / f"{mesh.stem}-run"
        summary = self.call("run", mesh, *options, "--scales", ",".join(scales), "--solvers", "none", "--no-viewer",
                            "-o", folder)["meshes"][0]
        rows = []
        for scale in summary["scales"]:
            at = folder / mesh.stem / scale["scale"].replace("%", "pct")
            rows.append((at, scale, self.distance(at / "remesh.obj", mesh)))
        return summary, rows

    def ways_of(self, mesh, network, scale, ways):
        """`compare`: JSON by way, and the folder of their meshes."""
        folder = self.scratch / f"{mesh.stem}-ways"
        done = self.call("compare", mesh, "--network", network, *scale, "--ways", ",".join(ways), "-o", folder)
        return {way["way"]: way for way in done["ways"]}, folder


def table(rows):
    """Rows of cells, the first the header."""
    lines = ["| " + " | ".join(map(str, row)) + " |" for row in rows]
    lines.insert(1, "|" + "---|" * len(rows[0]))
    return "\n".join(lines)


def percent(share, digits=2):
    return f"{100 * share:.{digits}f} %"


def quality_text(triangles):
    return f"{triangles['min_angle_degrees']:.1f}°, {percent(triangles['share_under_30_degrees'])} under 30°"
