"""Figures 8 (quads), 10 and 11, of quads."""

from rib_count import count_ribs
from ribbed_plate import ribbed_plate
from triangle_figures import ALL_CRESTS
from workshop import SMALL, percent, table

# Figure 8: mesh or model, detector with its options, scales.
SHOWN = [
    ("fandisk", ["--method", "sharp"], ["2%", "4%", "6%"]),
    ("rotor_small", ["--method", "sharp"], ["2%", "4%", "6%"]),
    ("anchor_dense", ["--method", "sharp"], ["3%", "4%", "6%"]),
    ("camel", ["--method", "crest"], ["2%", "3%", "4%"]),
    ("elephant", ["--method", "crest"], ["2%", "3%", "4%"]),
]
FROM_ABOVE = ["--view=-0.5,-1.2,0.9", "--up", "0,0,1"]
RIB_HEIGHT = 0.03
# Lengths of the ribbed plate, whose ribs are 0.09 apart.
RIB_SCALES = [0.03, 0.045, 0.06, 0.09]
FILTERS = [0.5, 1, 1.5, 2]  # times the first scale
DRAGON_SCALE = "3%"
CYCLIDENESS = [50, 100]


def shape_text(way):
    """The mesh and what the paper prints under it: Hd and average scaled Jacobian; and what it does not print."""
    share = way["distance"]["hausdorff"] / way["distance"]["reference_diagonal"]
    quads = way["quads"]
    return (f"Hd {percent(share)} / aSJ {quads['mean_scaled_jacobian']:.2f}",
            f"{quads['vertices']} vertices, {percent(quads['share_irregular'], 1)} irregular"
            + (", by pairing" if way["tier"] == "pairing" else ""))


def figure_8_quads(shop):
    parts = []
    for name, options, scales in SHOWN:
        mesh = shop.mesh(name)
        folder = shop.scratch / f"{name}-quads"
        summary = shop.call("run", mesh, *options, "--target", "quad", "--scales", ",".join(scales), "--solvers", "none",
                            "--no-viewer", "-o", folder)["meshes"][0]
        prefix = f"figure_8_quads_{name}"
        first = folder / mesh.stem / scales[0].replace("%", "pct") / "initial.fcn.json"
        rows = [[f"{name}, {options[1]}"], [shop.draw(f"{prefix}_initial", mesh, mesh, [f"{first}=initial"], size=SMALL)],
                [f"{summary['mesh']['vertices']} vertices, {summary['network']['arcs']} arcs"], [""]]
        for scale in summary["scales"]:
            label = scale["scale"]
            quads = folder / mesh.stem / label.replace("%", "pct") / "quads.obj"
            rows[0].append(label)
            rows[1].append(shop.draw(f"{prefix}_{label.replace('%', 'pct')}", quads, mesh, [f"{quads}=kept"]
                                     if scale["quads"]["feature_edges"] else [], "--wireframe", size=SMALL))
            for row, text in zip(rows[2:], shape_text(scale["quads"])):
                row.append(text)
        parts.append(table(rows))
    return "\n\n".join(parts)


def ribs_text(path):
    count, rise = count_ribs(path, RIB_HEIGHT)
    return f"**{count} {'rib' if count == 1 else 'ribs'}**, {percent(rise, 0)} of their height"


def figure_10(shop):
    mesh, network = shop.scratch / "plate.obj", shop.scratch / "plate.fcn.json"
    ribbed_plate(shop.scratch / "plate.off", height=RIB_HEIGHT)
    shop.call("convert", shop.scratch / "plate.off", mesh, "--as", "mesh")
    shop.call("detect", mesh, "--method", "sharp", "-o", network)
    ours = [["ours", *(f"rmin {scale}" for scale in RIB_SCALES)],
            [shop.draw("figure_10_initial", mesh, mesh, [f"{network}=initial"], *FROM_ABOVE, size=SMALL)],
            [ribs_text(mesh)], [""], [""]]
    smoothed = [["smoothed", *(f"detail below {k * RIB_SCALES[0]:g}" for k in FILTERS)], [""], [""], [""], [""]]

    def add(rows, name, way, quads, curves):
        rows[1].append(shop.draw(name, quads, mesh, curves, "--wireframe", *FROM_ABOVE, size=SMALL))
        rows[2].append(ribs_text(quads))
        for row, text in zip(rows[3:], shape_text(way)):
            row.append(text)

    for scale in RIB_SCALES:
        ways, folder = shop.ways_of(mesh, network, ["--scale", scale, "--type", "quad"], ["own"])
        quads = folder / "own.obj"
        add(ours, f"figure_10_own_{scale}", ways["own"], quads, [f"{quads}=kept"] if ways["own"]["feature_edges"] else [])
    names = [f"filtered-{k:g}" for k in FILTERS]
    ways, folder = shop.ways_of(mesh, network, ["--scale", RIB_SCALES[0], "--type", "quad"], names)
    for name in names:
        add(smoothed, f"figure_10_{name}", ways[name], folder / f"{name}.obj", [])
    return f"{table(ours)}\n\n{table(smoothed)}"


def figure_11(shop):
    mesh = shop.mesh("ChineseDragon-10kv")
    columns = []
    for threshold in CYCLIDENESS:
        network = shop.scratch / f"crest-{threshold}.fcn.json"
        made = shop.call("detect", mesh, "--method", "crest", "--crest-alone", *ALL_CRESTS, "--crest-cyclideness",
                         threshold, "-o", network)["network"]
        columns.append((f"threshold {threshold}", f"T{threshold}", network, "own-initial", made, "kept"))
    network, adapted = shop.scratch / "crest.fcn.json", shop.scratch / "adapted.fcn.json"
    shop.call("detect", mesh, "--method", "crest", "-o", network)
    made = shop.call("adapt", mesh, "--network", network, "--target", "quad", "--scale", DRAGON_SCALE, "-o", adapted)
    columns.append(("ours, adapted network", "own", network, "own", made, "kept"))
    columns.append(("no guidance", "plain", network, "own-plain", None, None))
    rows = [[], [], [], [], [], [], []]
    for title, name, network, way, made, color in columns:
        ways, folder = shop.ways_of(mesh, network, ["--scale", DRAGON_SCALE, "--type", "quad"], [way])
        quads = folder / f"{way}.obj"
        guide = adapted if way == "own" else network
        rows[0].append(title)
        rows[1].append(shop.draw(f"figure_11_{name}_guide", mesh, mesh, [f"{guide}={color}"] if color else []))
        rows[2].append(shop.draw(f"figure_11_{name}", quads, mesh, [], "--wireframe"))
        hausdorff, shape = shape_text(ways[way])
        rows[3].append(hausdorff)
        rows[4].append(shape)
        rows[5].append(f"{made['arcs']} arcs" if made else "")
        rows[6].append(aligned_with(shop, quads, mesh, adapted))
    paper = {"threshold 50": "0.024 / 0.90", "threshold 100": "0.025 / 0.95", "ours, adapted network": "0.022 / 0.94"}
    rows.insert(4, [f"paper: {paper[title]}" if title in paper else "" for title in rows[0]])
    return table(rows)


def aligned_with(shop, quads, mesh, network):
    """Every column against the same network, the adapted one."""
    angle = shop.call("measure", quads, mesh, "--network", network)["alignment"]["mean_degrees"]
    return f"{angle:.1f}° off the adapted network"
