"""Draws the figures that plots.json describes: NAME.svg to show and NAME.pdf to print, each.

plots.py plots.json FOLDER

Nothing is computed here; what the numbers mean is said in the data. Kinds of figures: `lines`
(steps or not), `points` (with lines of fits and guides), `bars` (with intervals), `boxes`.
Colours are those of Okabe and Ito, which colour-blind readers can tell apart, and every solver has
a dash pattern and a marker of its own as well. Equal data give equal bytes.
"""

import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402
from matplotlib import ticker  # noqa: E402

COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8C6D1F"]
DASHES = ["-", "--", "-.", ":", (0, (6, 1, 1, 1, 1, 1)), (0, (8, 3)), (0, (3, 1, 1, 1)),
          (0, (1, 2))]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]
STYLE = {
    "svg.hashsalt": "scalefcn", "svg.fonttype": "path", "pdf.fonttype": 42,
    "font.family": "DejaVu Sans", "font.size": 9, "axes.titlesize": 10, "legend.fontsize": 8,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
    "grid.color": "#d8dde3", "grid.linewidth": 0.6, "axes.axisbelow": True,
    "figure.dpi": 100, "lines.linewidth": 1.6, "legend.frameon": False,
}
FLAT = {"bars", "boxes"}
LEGEND_COLUMNS = 3
MOST_TOGETHER = 4  # clouds of points that can be told apart in one drawing


def look(index):
    """Colour, dashes and marker of the solver with this number."""
    turn = index // len(COLOURS)
    return (COLOURS[index % len(COLOURS)], DASHES[(index + turn) % len(DASHES)],
            MARKERS[(index + turn) % len(MARKERS)])


def draw_lines(axes, figure):
    for series in figure["series"]:
        colour, dashes, marker = look(series["index"])
        style = "steps-post" if figure.get("steps") else "default"
        is_sparse = not figure.get("steps") and len(series["x"]) <= 40
        axes.plot(series["x"], series["y"], color=colour, linestyle=dashes, drawstyle=style,
                  marker=marker if is_sparse else None, markersize=3.5, label=series["name"])


def draw_points(axes, figure):
    for line in figure.get("guides", []):
        axes.plot(line["x"], line["y"], color="#6b7580", linewidth=0.9, zorder=1)
    for series in figure["series"]:
        colour, dashes, marker = look(series["index"])
        axes.scatter(series["x"], series["y"], s=22, color=colour, marker=marker, alpha=0.75,
                     linewidths=0, clip_on=False, label=series["name"])
        if "fit" in series:
            axes.plot(series["fit"]["x"], series["fit"]["y"], color=colour, linestyle=dashes,
                      linewidth=1.2)


def name_rows(axes, names):
    """From top to bottom."""
    axes.set_yticks(range(len(names)), list(reversed(names)))
    axes.set_ylim(-0.7, len(names) - 0.3)
    axes.grid(axis="y", visible=False)


def draw_bars(axes, figure):
    axes.axvline(figure["reference"], color="#6b7580", linewidth=1)
    for at, bar in enumerate(reversed(figure["bars"])):
        colour = look(bar["index"])[0]
        axes.plot([figure["reference"], bar["value"]], [at, at], color=colour, linewidth=7,
                  solid_capstyle="butt", alpha=0.85)
        if bar["low"] is not None:
            axes.errorbar(bar["value"], at, xerr=[[max(0, bar["value"] - bar["low"])],
                                                  [max(0, bar["high"] - bar["value"])]],
                          color="#1c2128", linewidth=1.1, capsize=3)
        axes.plot(bar["value"], at, marker="o", markersize=4, color="#1c2128")
    name_rows(axes, [bar["name"] for bar in figure["bars"]])


def draw_boxes(axes, figure):
    for at, series in enumerate(reversed(figure["series"])):
        colour, _, marker = look(series["index"])
        axes.boxplot([series["y"]], positions=[at], orientation="horizontal", widths=0.55,
                     showfliers=False, patch_artist=True, whis=(5, 95),
                     boxprops={"facecolor": colour + "40", "edgecolor": colour},
                     medianprops={"color": "#1c2128", "linewidth": 1.6},
                     whiskerprops={"color": colour}, capprops={"color": colour})
        # Apart from each other by their place in the list, not by chance.
        spread = [at + 0.2 * (((7 * k) % 11) / 5 - 1) for k in range(len(series["y"]))]
        axes.scatter(series["y"], spread, s=9, color=colour, marker=marker, linewidths=0, alpha=0.6,
                     clip_on=False)
    name_rows(axes, [series["name"] for series in figure["series"]])


DRAW = {"lines": draw_lines, "points": draw_points, "bars": draw_bars, "boxes": draw_boxes}


def between_powers(value, _):
    """Labels 2 and 5 times a power of ten alone."""
    digits = f"{value:.0e}"[0]
    return f"{value:g}" if digits in "25" else ""


def set_axis(axes, which, axis):
    scale = axis.get("scale", "linear")
    set_scale, set_limits, set_label = (
        (axes.set_xscale, axes.set_xlim, axes.set_xlabel) if which == "x"
        else (axes.set_yscale, axes.set_ylim, axes.set_ylabel))
    if scale == "symlog":
        set_scale("symlog", linthresh=axis["threshold"])
    else:
        set_scale(scale)
    if scale != "linear":
        side = axes.xaxis if which == "x" else axes.yaxis
        side.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
        low, high = side.get_view_interval()
        ratio = high / max(low, 1e-300) if scale == "log" else float("inf")
        if ratio < 8:  # hardly a power of ten in it: round numbers at equal distances
            side.set_major_locator(ticker.MaxNLocator(6, steps=[1, 2, 5, 10]))
            side.set_minor_locator(ticker.NullLocator())
        side.set_minor_formatter(ticker.FuncFormatter(between_powers) if ratio < 30
                                 else ticker.NullFormatter())
    if axis.get("is_count"):
        (axes.xaxis if which == "x" else axes.yaxis).set_major_locator(
            ticker.MaxNLocator(integer=True))
    if axis.get("low") is not None:
        set_limits(axis["low"], None)
    if axis.get("high") is not None:
        set_limits(None, axis["high"])
    set_label(axis["label"])


def draw_alone(figure):
    is_flat = figure["kind"] in FLAT
    rows = len(figure.get("bars", [])) or len(figure["series"])
    legend_rows = -(-rows // LEGEND_COLUMNS)
    height = max(2.2, 1.1 + 0.34 * rows) if is_flat else 3.7 + 0.17 * legend_rows
    canvas, axes = pyplot.subplots(figsize=(6.0, height), layout="constrained")
    DRAW[figure["kind"]](axes, figure)
    set_axis(axes, "x", figure["x"])
    if not is_flat:
        set_axis(axes, "y", figure["y"])
        if len(figure["series"]) > 1 or "fit" in figure["series"][0]:
            canvas.legend(loc="outside lower center", ncols=LEGEND_COLUMNS)
    if figure.get("square"):
        axes.set_box_aspect(1)
    axes.set_title(figure["title"], loc="left", fontweight="bold")
    return canvas


def draw_panels(figure):
    """A panel for each cloud of points, all with the same axes."""
    rows = -(-len(figure["series"]) // LEGEND_COLUMNS)
    canvas, grid = pyplot.subplots(rows, LEGEND_COLUMNS, figsize=(7.2, 0.7 + 1.55 * rows),
                                   sharex=True, sharey=True, squeeze=False, layout="constrained")
    panels = list(grid.flat)
    for axes, series in zip(panels, figure["series"]):
        draw_points(axes, {**figure, "series": [series]})
        axes.set_title(series["name"], loc="left", fontsize=8)
    for which in ("x", "y"):
        set_axis(panels[0], which, {**figure[which], "label": ""})
    for axes in panels[len(figure["series"]):]:
        axes.set_visible(False)
    for axes in panels[len(figure["series"]) - LEGEND_COLUMNS:len(figure["series"])]:
        axes.tick_params(labelbottom=True)
    canvas.supxlabel(figure["x"]["label"], fontsize=9)
    canvas.supylabel(figure["y"]["label"], fontsize=9)
    canvas.suptitle(figure["title"], x=0.02, ha="left", fontsize=10, fontweight="bold")
    return canvas


def draw(figure, folder):
    is_crowded = figure["kind"] == "points" and len(figure["series"]) > MOST_TOGETHER
    canvas = draw_panels(figure) if is_crowded else draw_alone(figure)
    canvas.savefig(folder / (figure["name"] + ".svg"), metadata={"Date": None})
    canvas.savefig(folder / (figure["name"] + ".pdf"),
                   metadata={"CreationDate": None, "ModDate": None})
    pyplot.close(canvas)


def main():
    data = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    folder = pathlib.Path(sys.argv[2])
    matplotlib.rcParams.update(STYLE)
    for figure in data["figures"]:
        draw(figure, folder)


if __name__ == "__main__":
    main()
