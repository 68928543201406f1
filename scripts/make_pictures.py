#!/usr/bin/env python3
"""Makes the pictures of the README and of docs/detectors.md: runs scalefcn on one mesh and takes
them out of its report.

Usage: scripts/make_pictures.py [PROGRAM [MESH]]
"""

import base64
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
SHOWN = {"dropped", "remesh"}
# Few seeds a curve, near the creases that the wires find.
WIRES = {"wires": [
    {"points": [[-0.38, 0.02, -0.04], [0.14, 0.15, -0.42], [0.46, 0.16, -0.50]], "pin": True},
    {"points": [[-0.46, 0.256, -0.04], [0.12, 0.256, -0.407], [0.46, 0.256, -0.50]]},
    {"points": [[0.46, 0.256, 0.308], [0.46, 0.256, -0.50]]},
    {"points": [[0.00, -0.19, 0.39], [-0.23, -0.21, 0.25], [-0.46, -0.23, 0.15]]},
]}
DETECTORS = {"wire": ["--method", "wire", "--seeds", "{seeds}"],
             "combination": ["--method", "sharp+vsa", "--patches", "60"]}
PICTURE = re.compile(r'<img src="data:image/png;base64,([A-Za-z0-9+/=]+)" alt="([^"]*)"')


def pictures_of(program, mesh, *options):
    """PNG bytes and descriptions of the pictures in the report of one run."""
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run([program, "run", mesh, "-o", scratch, "--solvers", "none", "--quiet",
                        *options], check=True, stdout=subprocess.DEVNULL)
        report = (pathlib.Path(scratch) / "report.html").read_text(encoding="utf-8")
    return [(base64.b64decode(png), text) for png, text in PICTURE.findall(report)]


def detector_pictures(program, mesh, folder):
    """What detectors find, without anything else."""
    with tempfile.TemporaryDirectory() as scratch:
        seeds = pathlib.Path(scratch) / "seeds.json"
        seeds.write_text(json.dumps(WIRES), encoding="utf-8")
        for name, options in DETECTORS.items():
            pictures = pictures_of(program, mesh, "--scales", "2%", "--no-remesh",
                                   *(option.format(seeds=seeds) for option in options))
            path = folder / f"detector_{name}.png"
            path.write_bytes(pictures[0][0])
            print(f"{path.relative_to(ROOT)}: {pictures[0][1]}")


def viewer_picture(program, mesh, folder):
    """The report's 3D view, if it and a browser are there (scripts/setup_viewer.sh)."""
    path = folder / "viewer.png"
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run([program, "run", mesh, "-o", scratch, "--solvers", "none", "--quiet",
                        "--method", "vsa", "--patches", "150", "--scales", "5%"], check=True,
                       stdout=subprocess.DEVNULL)
        subprocess.run(["node", ROOT / "viewer/screenshot.mjs", f"{scratch}/report.html", path],
                       check=True)
    print(f"{path.relative_to(ROOT)}: the report's 3D view")


def crest_picture(program, folder):
    """Crest lines need a smooth surface."""
    camel = ROOT / "build/meshes/camel.off"
    png, text = pictures_of(program, camel, "--method", "crest", "--scales", "3%",
                            "--no-remesh")[0]
    path = folder / "detector_crest.png"
    path.write_bytes(png)
    print(f"{path.relative_to(ROOT)}: {text}")


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release/bin/scalefcn"
    mesh = sys.argv[2] if len(sys.argv) > 2 else ROOT / "build/meshes/fandisk.off"
    pictures = pictures_of(program, mesh, "--method", "vsa", "--patches", "150", "--scales", "5%")
    names = ["initial", "dropped", "adapted", "remesh"]
    if len(pictures) != len(names):
        sys.exit(f"expected {len(names)} pictures in the report, found {len(pictures)}")
    folder = ROOT / "docs/images"
    folder.mkdir(parents=True, exist_ok=True)
    for name, (png, text) in zip(names, pictures):
        if name not in SHOWN:
            continue
        path = folder / f"fandisk_{name}.png"
        path.write_bytes(png)
        print(f"{path.relative_to(ROOT)}: {text}")
    viewer_picture(program, mesh, folder)
    detector_pictures(program, mesh, folder)
    crest_picture(program, folder)


if __name__ == "__main__":
    main()
