#!/usr/bin/env python3
"""figures.py [--scalefcn PROGRAM] [--meshes FOLDER] [-o FOLDER] WHAT...: the paper's figures on our meshes and models.

WHAT: 1, 3, 5, 7, 8, 8-quads, 9, 10 or 11, the figure of Gehre, Lim and Kobbelt 2016 that is redone, or creases, two
parallel creases closer and closer. Prints a Markdown table of pictures with the numbers under each, and leaves the
pictures in FOLDER (default results/figures). All pictures come from `scalefcn draw`, all numbers from scalefcn's JSON
but the ribs of figure 10, which rib_count.py counts. Meshes come from scripts/fetch_meshes.sh (default folder
build/meshes) and `scalefcn model`; ends with 77 if they are not there.

Hd: two-sided Hausdorff distance in % of the bounding box's diagonal, sampled every half percent of it. aSJ: average
scaled Jacobian.
"""

import argparse
import os
import tempfile

from quad_figures import figure_8_quads, figure_10, figure_11
from triangle_figures import creases, figure_1, figure_3, figure_5, figure_7, figure_8, figure_9
from workshop import ROOT, Workshop

FIGURES = {"1": figure_1, "3": figure_3, "5": figure_5, "7": figure_7, "8": figure_8, "8-quads": figure_8_quads,
           "9": figure_9, "10": figure_10, "11": figure_11, "creases": creases}


def main():
    parser = argparse.ArgumentParser(description="the paper's figures on our meshes and models")
    parser.add_argument("what", nargs="+", choices=FIGURES)
    parser.add_argument("--scalefcn", default=ROOT / "build/release/bin/scalefcn", help="program")
    parser.add_argument("--meshes", default=os.environ.get("MESHES", ROOT / "build/meshes"), help="folder of meshes")
    parser.add_argument("-o", "--output", default=ROOT / "results/figures", help="folder for the pictures")
    arguments = parser.parse_args()
    for what in arguments.what:
        with tempfile.TemporaryDirectory() as scratch:
            print(FIGURES[what](Workshop(arguments.scalefcn, arguments.meshes, arguments.output, scratch)) + "\n")


if __name__ == "__main__":
    main()
