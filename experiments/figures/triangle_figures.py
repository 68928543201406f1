"""Figures 1, 3, 5, 7, 8 and 9, of triangles, and two creases closer and closer."""

from line_plot import line_plot
from workshop import SMALL, percent, quality_text, table

# Figure 8: mesh or model, detector with its options, scales.
SHOWN = [
    ("fandisk", ["--method", "vsa", "--patches", "150"], ["2%", "4%", "8%"]),
    ("octaflower", ["--method", "vsa"], ["2%", "4%", "8%"]),
    ("rotor_small", ["--method", "sharp"], ["2%", "4%", "8%"]),
    ("turbine", ["--method", "sharp"], ["1%", "2%", "4%"]),
    ("gear", ["--method", "sharp"], ["2%", "4%", "8%"]),
    ("ribs", ["--method", "sharp"], ["2%", "4%", "8%"]),
    ("anchor_dense", ["--method", "vsa", "--patches", "150"], ["2%", "4%", "8%"]),
    ("ChineseDragon-10kv", ["--method", "crest"], ["1%", "2%", "4%"]),
    ("camel", ["--method", "crest"], ["1%", "2%", "4%"]),
    ("lion-head", ["--method", "crest"], ["2%", "4%", "8%"]),
    ("cow", ["--method", "crest"], ["1%", "2%", "4%"]),
    ("elephant", ["--method", "crest+wire"], ["1%", "2%", "4%"]),
]
ALL_CRESTS = [word for name in ("significance", "sharpness", "ridgeness", "sphericalness", "radii")
              for word in (f"--crest-{name}", "0")]
RATIOS = [1.01, 1.14, 1.35, 1.5]


def series(shop, prefix, name, options, scales):
    """One mesh at several scales: the rows of pictures and of numbers, the input first."""
    mesh = shop.mesh(name)
    summary, rows = shop.adapt_and_remesh(mesh, options, scales)
    first = rows[0][0]
    head, pictures = ["initial"], [shop.draw(f"{prefix}_initial", mesh, mesh, [f"{first / 'initial.fcn.json'}=initial"],
                                                size=SMALL)]
    numbers = [f"{summary['mesh']['vertices']} vertices, {summary['network']['arcs']} arcs"]
    shapes = [summary["method"]]
    for at, scale, distance in rows:
        label = scale["scale"]
        head.append(label)
        # The curves lie along the remesh's own edges.
        pictures.append(shop.draw(f"{prefix}_{label.replace('%', 'pct')}", at / "remesh.obj", mesh,
                                  [f"{at / 'remesh.obj'}=kept"] if scale["segments"] else [], "--wireframe",
                                  size=SMALL))
        numbers.append(f"Hd {percent(distance)}, {scale['remesh']['vertices']} vertices")
        shapes.append(quality_text(scale["remesh"]))
    return [head, pictures, numbers, shapes]


def figure_1(shop):
    return table(series(shop, "figure_1", "turbine", ["--method", "vsa", "--patches", "200"],
                        ["1%", "2%", "4%", "8%"]))


def figure_3(shop):
    mesh = shop.mesh("fandisk")
    rows = [[], [], [], [], []]
    for ratio in RATIOS + [1.6, 1.7]:
        network = shop.scratch / f"ratio-{ratio}.fcn.json"
        made = shop.call("adapt", mesh, "--method", "vsa", "--patches", "150", "--scale", "5%", "--ratio", ratio,
                         "-o", network)
        rows[0].append(ratio)
        rows[1].append(shop.draw(f"figure_3_{ratio}", mesh, mesh, [f"{network}=kept"], "--dots")
                       if ratio in RATIOS else "")
        rows[2].append(f"{made['segments']} segments in {made['arcs']} arcs")
        rows[3].append(f"coverage {percent(made['coverage'], 1)}")
        rows[4].append("conforming" if made["conforming"] else f"{made['violations']} violations")
    return table(rows)


def figure_5(shop):
    mesh = shop.mesh("anchor_dense")
    steps, network = shop.scratch / "steps", shop.scratch / "steps.fcn.json"
    initial = shop.scratch / "steps-initial.fcn.json"
    detector = ["--method", "vsa", "--patches", "150"]
    shop.call("detect", mesh, *detector, "-o", initial)
    made = shop.call("adapt", mesh, "--network", initial, "--scale", "5%", "--mode", "paper", "--save-steps", steps,
                     "-o", network)

    def layers(step, **colors):
        files = [(steps / f"step_{step}_{kind}.obj", color) for kind, color in colors.items()]
        return [f"{path}={color}" for path, color in files if path.is_file()]

    second = made["iterations"][1] if len(made["iterations"]) > 1 else made["iterations"][0]
    first = made["iterations"][0]
    columns = [
        ("(a) input", [f"{initial}=initial"], f"{made['initial_arcs']} arcs"),
        ("(b) resampled", layers(1, resampled="kept", short="short"),
         f"{first['segments']} segments, {first['short_segments']} short"),
        ("(c) labeled", layers(1, kept="kept", dropped="dropped"),
         f"{first['conflicts']} conflicts of labels, {first['dropped']} dropped"),
        ("(d) resampled again", layers(2, resampled="kept", short="short"),
         f"{second['segments']} segments, {second['short_segments']} short"),
        ("(e) labeled again", layers(2, kept="kept", dropped="dropped"),
         f"{second['conflicts']} conflicts of labels, {second['dropped']} dropped"),
        ("(f) result", [f"{network}=kept"], f"{made['segments']} segments, {len(made['iterations'])} iterations"),
    ]
    pictures = [shop.draw(f"figure_5_{title[1]}", mesh, mesh, curves) for title, curves, _ in columns]
    halves = []
    for part in (slice(0, 3), slice(3, 6)):
        halves.append(table([[c[0] for c in columns[part]], pictures[part], [c[2] for c in columns[part]]]))
    return "\n\n".join(halves)


def figure_7(shop):
    mesh, network = shop.mesh("skyscraper"), shop.scratch / "skyscraper.fcn.json"
    shop.call("detect", mesh, "--method", "sharp", "-o", network)
    names = {"own": "ours, adapted network", "quadrics": "quadric decimation", "own-plain": "isotropic, no features"}
    ways, folder = shop.ways_of(mesh, network, ["--scale", "4%"], names)
    rows = [["initial"], [shop.draw("figure_7_initial", mesh, mesh, [f"{network}=initial"])], [""], [""], [""]]
    for way, title in names.items():
        row = ways[way]
        rows[0].append(title)
        rows[1].append(shop.draw(f"figure_7_{way}", folder / f"{way}.obj", mesh,
                                 [f"{folder / 'own.obj'}=kept"] if way == "own" else [], "--wireframe"))
        share = row["distance"]["hausdorff"] / row["distance"]["reference_diagonal"]
        rows[2].append(f"Hd {percent(share)} ({1.4 * share:.3f} at diagonal 1.4)")
        rows[3].append(f"{row['triangles']['vertices']} vertices")
        rows[4].append(quality_text(row["triangles"]))
    return table(rows)


def figure_8(shop):
    parts = []
    for name, options, scales in SHOWN:
        rows = series(shop, f"figure_8_{name}", name, options, scales)
        rows[0][0] = f"{name}, {options[1]}"
        rows[3][0] = ""
        parts.append(table(rows))
    return "\n\n".join(parts)


def figure_9(shop):
    mesh = shop.mesh("lion-head")
    columns = []
    for threshold in (0, 5, 50):
        network = shop.scratch / f"crest-{threshold}.fcn.json"
        # Everything that makes lines fewer is off but the threshold itself.
        made = shop.call("detect", mesh, "--method", "crest", "--crest-alone", *ALL_CRESTS, "--crest-cyclideness",
                         threshold, "-o", network)
        ways, folder = shop.ways_of(mesh, network, ["--scale", "4%"], ["own", "own-initial"])
        for name in ("own", "own-initial"):
            (folder / f"{name}.obj").replace(folder / f"{name}-{threshold}.obj")
        if threshold == 0:
            columns.append(("ours", f"own-{threshold}", ways["own"], made, "ours"))
        columns.append((f"T = {threshold}", f"own-initial-{threshold}", ways["own-initial"], made, f"T{threshold}"))
    rows = [[], [], [], [], []]
    for title, stem, row, made, name in columns:
        remesh = folder / f"{stem}.obj"
        rows[0].append(title)
        rows[1].append(shop.draw(f"figure_9_{name}_curves", remesh, mesh, [f"{remesh}=kept"]))
        rows[2].append(shop.draw(f"figure_9_{name}", remesh, mesh, [], "--wireframe"))
        share = row["distance"]["hausdorff"] / row["distance"]["reference_diagonal"]
        rows[3].append(f"Hd {percent(share)}, {row['triangles']['vertices']} vertices")
        rows[4].append(quality_text(row["triangles"]))
    return table(rows)


def creases(shop):
    """A step of height w across a block, remeshed with edges of length L, for w / L from 0.05 to 2."""
    length = 0.1
    names = {"cgal-initial": "CGAL, both creases protected", "own-initial": "ours, not adapted",
             "own": "ours, adapted"}
    shares = [0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.2, 1.5, 2]
    shown = {way: {"angle": [], "slivers": [], "edges": [], "distance": []} for way in names}
    rows = [["w / L", "smallest angle", "under 15°", "under 30°", "edges", "Hd / w"]]
    pictures = {}
    for share in shares:
        mesh, network = shop.scratch / "step.off", shop.scratch / "step.fcn.json"
        shop.call("model", "step", "--spacing", share * length, "--resolution", length / 4, "-o", mesh)
        shop.call("detect", mesh, "--method", "sharp", "-o", network)
        ways, folder = shop.ways_of(mesh, network, ["--edge-length", length], names)
        cells = [[] for _ in rows[0][1:]]
        for way in names:
            row = ways[way]
            triangles = row["triangles"]
            edges = triangles["faces"] * 3 // 2  # closed
            off = row["distance"]["hausdorff"] / length
            texts = [f"{triangles['min_angle_degrees']:.1f}°", percent(triangles["share_under_15_degrees"], 1),
                     percent(triangles["share_under_30_degrees"], 1), str(edges), f"{off / share:.2f}"]
            for cell, text in zip(cells, texts):
                cell.append(text)
            for key, value in (("angle", triangles["min_angle_degrees"]), ("edges", edges),
                               ("slivers", 100 * triangles["share_under_30_degrees"]), ("distance", off)):
                shown[way][key].append(value)
            if share == 0.2:
                pictures[way] = shop.draw(f"creases_{way}", folder / f"{way}.obj", mesh, [], "--wireframe", "--view",
                                          "-1,-1.2,0.9", "--up", "0,0,1")
        rows.append([share, *(" / ".join(cell) for cell in cells)])
    panels = [("smallest angle (degrees)", "angle"), ("triangles under 30 degrees (%)", "slivers"),
              ("edges", "edges"), ("Hausdorff distance / L", "distance")]
    plot = line_plot("distance of the creases, in edge lengths (w / L)", shares, list(names.values()),
                     [(title, [shown[way][key] for way in names]) for title, key in panels])
    (shop.folder / "creases.svg").write_text(plot, encoding="utf-8")
    top = table([[f"{title}, w / L = 0.2" for title in names.values()], [pictures[way] for way in names]])
    return f"{top}\n\n![angles, slivers, edges and distance against w / L](creases.svg)\n\n{table(rows)}"
