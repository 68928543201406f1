"""From a mesh to a checked network, a triangle mesh and a report, as a user would go."""

import gzip
import json
import math
import pathlib
import re
import unittest

from scalefcn_process import BAD_INPUT, USAGE, VIOLATION, ProgramTest

SCALE_FILES = {"initial.fcn.json", "adapted.fcn.json", "initial.obj", "network.obj", "remesh.obj"}


DOCUMENTATION = pathlib.Path(__file__).parents[2] / "docs" / "command-line.md"


def keys_of(value):
    """Every key of a JSON value at any depth; phases and statistics are free-form."""
    if isinstance(value, list):
        return set().union(*map(keys_of, value))
    if not isinstance(value, dict):
        return set()
    found = set(value)
    for key, inner in value.items():
        if key not in ("seconds", "statistics"):
            found |= keys_of(inner)
    return found


def read_triangles(path):
    """Points and triangles of an OFF or OBJ file of ours."""
    lines = [line.split() for line in path.read_text(encoding="utf-8").splitlines()]
    if path.suffix == ".obj":
        return ([tuple(map(float, words[1:])) for words in lines if words[0] == "v"],
                [[int(word) - 1 for word in words[1:]] for words in lines if words[0] == "f"])
    count = int(lines[1][0])
    return ([tuple(map(float, words)) for words in lines[2:2 + count]],
            [list(map(int, words[1:])) for words in lines[2 + count:]])


class StepByStep(ProgramTest):
    def test_detect_adapt_check_remesh_measure(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        self.succeed("detect", "ribs.off", "--method", "sharp", "-o", "initial.fcn.json")
        adapted = self.succeed_json("adapt", "ribs.off", "--network", "initial.fcn.json",
                                    "--scale", "8%", "-o", "adapted.fcn.json", "--save-problems",
                                    "problems")
        self.assertTrue(adapted["conforming"])
        self.assertEqual(adapted["status"], "converged")
        self.assertAlmostEqual(adapted["rmax"], 1.5 * adapted["rmin"])
        self.assertGreater(adapted["segments"], 0)
        self.assertGreaterEqual(adapted["bound"], adapted["value"])
        check = self.succeed_json("check", "adapted.fcn.json", "--scale", "8%", "--mesh",
                                  "ribs.off")
        self.assertEqual(check["violations"], 0)
        remesh = self.succeed_json("remesh", "ribs.off", "--network", "adapted.fcn.json",
                                   "--scale", "8%", "-o", "remesh.obj")
        self.assertGreater(remesh["triangles"]["faces"], 0)
        self.succeed("remesh", "ribs.off", "--network", "adapted.fcn.json", "-o", "own_scale.obj")
        self.assertEqual((self.folder / "own_scale.obj").read_bytes(),
                         (self.folder / "remesh.obj").read_bytes())
        refused = self.call("remesh", "ribs.off", "--network", "initial.fcn.json", "-o", "a.obj")
        self.assertEqual(refused.returncode, 3)
        self.assertIn("not an adapted network", refused.stderr)
        measure = self.succeed_json("measure", "remesh.obj", "ribs.off")
        self.assertEqual(measure["triangles"]["faces"], remesh["triangles"]["faces"])
        self.assertLess(measure["distance"]["hausdorff_over_diagonal"], 0.08)

        self.assertEqual(remesh["broken_segments"], [])
        measure = self.succeed_json("measure", "remesh.obj", "ribs.off", "--network",
                                    "adapted.fcn.json")
        self.assertLess(measure["features"]["max_node"], 1e-6)
        self.assertAlmostEqual(sum(measure["edges"].values()), 1)

    def test_compare_makes_every_way(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        compare = self.succeed_json("compare", "ribs.off", "--scale", "8%", "--iterations", "3",
                                    "--spacing", "2%", "-o", "ways")
        names = [way["way"] for way in compare["ways"]]
        self.assertIn("quadrics", names)
        for way in compare["ways"]:
            self.assertNotIn("failure", way)
            self.assertGreater(way["triangles"]["faces"], 0)
            self.assertTrue((self.folder / "ways" / (way["way"] + ".obj")).exists())
        own = compare["ways"][names.index("own")]
        self.assertEqual(own["broken_segments"], 0)
        result = self.call("compare", "ribs.off", "--scale", "8%", "--ways", "nobody")
        self.assertEqual(result.returncode, BAD_INPUT)
        self.assertIn("nobody", result.stderr)

    def test_compare_makes_every_way_to_quads(self):
        self.model("box", "--resolution", "0.2")
        words = ["compare", "box.off", "--method", "sharp", "--scale", "15%", "--type", "quad",
                 "--spacing", "2%"]
        rows = {way["way"]: way for way in
                self.succeed_json(*words, "-o", "ways")["ways"]}
        self.assertEqual(list(rows), ["own", "own-initial", "own-plain", "curvature-0.5",
                                      "curvature-0.8", "filtered", "pairing"])
        for name, way in rows.items():
            self.assertNotIn("failure", way)
            self.assertEqual(way["tier"], "pairing" if name == "pairing" else "field")
            measured = self.succeed_json("measure", f"ways/{name}.obj", "box.off", "--edge-length",
                                         str(1.2 * 0.15 * math.sqrt(2)))
            self.assertEqual(measured["quads"], way["quads"])
            self.assertEqual(measured["topology"]["euler_characteristic"], 2)
        # On a box all guides say the same, and without its edges it gets round.
        self.assertEqual(rows["curvature-0.8"]["quads"], rows["own-initial"]["quads"])
        self.assertLess(rows["own"]["distance"]["hausdorff"], 1e-6)
        self.assertGreater(rows["filtered"]["distance"]["hausdorff"], 0.01)
        some = self.succeed_json(*words, "--ways", "filtered-2,filtered-0.5,curvature-3")["ways"]
        distances = [way["distance"]["hausdorff"] for way in some[:2]]
        self.assertGreater(distances[0], distances[1])
        result = self.call(*words, "--ways", "filtered-x")
        self.assertEqual(result.returncode, BAD_INPUT)
        self.assertIn("filtered-x", result.stderr)
        self.assertEqual(self.call(*words, "--ways", "quadrics").returncode, BAD_INPUT)

    def test_files_of_curves_alone_need_a_network(self):
        self.model("box", "--resolution", "0.3")
        result = self.call("remesh", "box.off", "--scale", "20%", "-o", "a.obj,a.sharp")
        self.assertEqual(result.returncode, USAGE)
        self.assertIn("a.sharp", result.stderr)
        self.assertFalse((self.folder / "a.obj").exists())

    def test_pins_are_kept_and_dropped(self):
        """Ribs closer than the scale: most are dropped, and pins decide which."""
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        adapt = ["adapt", "ribs.off", "--method", "sharp", "--scale", "12%", "-o", "a.fcn.json"]
        self.succeed(*adapt)
        before = json.loads((self.folder / "a.fcn.json").read_text())
        lost = [d["origin_arc"] for d in before["dropped"] if d["reason"] == "conflict"]
        kept = {o for arc in before["arcs"] for o in arc["origins"]}
        lost = [a for a in lost if a not in kept]
        self.assertTrue(lost)
        out = min(kept)
        self.succeed(*adapt, "--keep", f"arc:{lost[0]}", "--drop", f"arc:{out}")
        after = json.loads((self.folder / "a.fcn.json").read_text())
        pinned = {o for arc in after["arcs"] if arc["pin"] == "keep" for o in arc["origins"]}
        self.assertEqual(pinned, {lost[0]})
        self.assertNotIn(out, {o for arc in after["arcs"] for o in arc["origins"]})
        self.assertIn(("pinned out", out),
                      {(d["reason"], d["origin_arc"]) for d in after["dropped"]})

    def test_several_detectors_become_one_network(self):
        self.model("gear")
        lengths = {}
        for method in ("sharp", "vsa", "sharp+vsa"):
            lengths[method] = self.succeed_json("detect", "gear.off", "--method", method, "-o",
                                                "net.fcn.json")["network"]["length"]
        network = json.loads((self.folder / "net.fcn.json").read_text())
        self.assertEqual({arc["source"] for arc in network["arcs"]}, {"sharp", "vsa"})
        self.assertLess(lengths["sharp+vsa"], lengths["sharp"] + lengths["vsa"])
        self.assertGreaterEqual(lengths["sharp+vsa"], max(lengths.values()) * (1 - 1e-9))

    def test_crest_lines_reach_the_adaptation(self):
        self.model("superellipse-torus", "--resolution", "0.03")
        detected = self.succeed_json("detect", "superellipse-torus.off", "--method", "crest", "-o",
                                     "net.fcn.json")["network"]
        self.assertEqual(detected["arcs"], 4)
        self.assertAlmostEqual(detected["length"], 8 * 3.14159265 * 0.35, delta=0.088)
        adapted = self.succeed_json("adapt", "superellipse-torus.off", "--method", "crest",
                                    "--scale", "3%", "-o", "a.fcn.json")
        self.assertTrue(adapted["conforming"])
        self.assertEqual(adapted["arcs"], 4)

    def test_crest_files_are_read(self):
        self.model("box")
        self.write("ridges.txt", "3 2 1\n.1 .2 .6 0\n.3 .2 .6 0\n.5 .2 .6 0\n2 .9 40\n"
                                 "0 1 0\n1 2 -1\n")
        detect = ["detect", "box.off", "--method", "crest", "--import", "ridges.txt",
                  "--boundary", "ignore", "-o", "net.fcn.json"]
        self.assertAlmostEqual(self.succeed_json(*detect)["network"]["length"], 0.4)
        self.assertEqual(
            self.succeed_json(*detect, "--crest-cyclideness", "41")["network"]["arcs"], 0)
        self.succeed("convert", "ridges.txt", "net.obj", "--mesh", "box.off")

    def test_wires_reach_the_adaptation(self):
        self.model("octaflower", "--resolution", "0.04")
        self.write("seeds.json", '{"wires":[{"vertices":[5,300],"pin":true}]}')
        self.succeed("adapt", "octaflower.off", "--method", "wire", "--seeds", "seeds.json",
                     "--scale", "2%", "-o", "a.fcn.json")
        network = json.loads((self.folder / "a.fcn.json").read_text())
        self.assertTrue(network["arcs"])
        for arc in network["arcs"]:
            self.assertEqual((arc["source"], arc["pin"]), ("wire", "keep"))

    def test_saved_problems_give_the_value_again(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        adapted = self.succeed_json("adapt", "ribs.off", "--method", "sharp", "--scale", "8%",
                                    "-o", "a.fcn.json", "--save-problems", "problems")
        self.succeed("verify", "problems/problem_1.lab.gz", "problems/problem_1.sol")
        solved = self.succeed_json("solve", "problems/problem_1.lab.gz", "--solver", "cbc")
        self.assertAlmostEqual(solved["value"] / solved["units_per_one"], adapted["value"],
                               delta=1e-6 * max(1, abs(adapted["value"])))

    def test_check_finds_what_a_finer_network_violates(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        self.succeed("adapt", "ribs.off", "--method", "sharp", "--scale", "4%", "-o",
                     "fine.fcn.json")
        report = self.succeed_json("check", "fine.fcn.json", "--scale", "12%", code=VIOLATION)
        self.assertFalse(report["conforming"])
        self.assertGreater(len(report["details"]), 0)

    def test_edge_length_is_scale_times_a_factor(self):
        self.model("box", "--resolution", "0.2")
        by_edge = self.succeed_json("adapt", "box.off", "--method", "sharp", "--edge-length",
                                    "0.24", "-o", "edge.fcn.json")
        by_scale = self.succeed_json("adapt", "box.off", "--method", "sharp", "--scale", "0.2",
                                     "-o", "scale.fcn.json")
        self.assertAlmostEqual(by_edge["rmin"], by_scale["rmin"])
        self.assertEqual(by_edge["segments"], by_scale["segments"])

    def test_network_formats_keep_the_curves(self):
        self.model("box", "--resolution", "0.25")
        self.succeed("detect", "box.off", "--method", "sharp", "-o", "box.fcn.json")
        for target in ("box.obj", "box.ply", "box.vtp", "box.mesh", "box.msh",
                       "box.polylines.txt"):
            with self.subTest(target=target):
                self.succeed("convert", "box.fcn.json", target)
                back = self.succeed_json("convert", target, "back.fcn.json", "--as", "network",
                                         "--mesh", "box.off")
                self.assertEqual(back["arcs"], 12)

    def test_explain_accounts_for_every_arc(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.04")
        self.succeed("detect", "ribs.off", "--method", "sharp", "--boundary", "ignore", "-o",
                     "initial.fcn.json")
        self.succeed("adapt", "ribs.off", "--network", "initial.fcn.json", "--scale", "5%", "-o",
                     "adapted.fcn.json")
        with open(self.folder / "initial.fcn.json", encoding="utf-8") as file:
            initial = json.load(file)
        everything = self.succeed_json("explain", "adapted.fcn.json")
        self.assertEqual(everything["arcs"], list(range(len(initial["arcs"]))))
        self.assertGreater(len(everything["dropped"]), 0)
        conflicts = {b["conflict"] for p in everything["dropped"] for b in p["blockers"]}
        self.assertLessEqual(conflicts, {"angle", "distance", "nodes", "rule"})
        for piece in everything["dropped"]:
            if piece["margin"] is not None:
                self.assertGreaterEqual(piece["margin"], 0, "the labeling was optimal")
        by_curve = [self.succeed_json("explain", "adapted.fcn.json", "--curve", str(k))
                    for k in range(len(initial["curves"]))]
        self.assertEqual(sorted(a for c in by_curve for a in c["arcs"]), everything["arcs"])
        for name in ("kept_length", "dropped_length"):
            self.assertAlmostEqual(sum(c[name] for c in by_curve), everything[name])
        text = self.succeed("explain", "adapted.fcn.json", "--arc",
                            str(everything["dropped"][0]["origin_arc"])).stdout
        self.assertIn("rmin", text)
        for arguments, message in ((["--curve", "99999"], "there is no curve 99999"),
                                   (["--arc", "99999"], "there is no arc 99999")):
            done = self.succeed("explain", "adapted.fcn.json", *arguments, code=BAD_INPUT)
            self.assertIn(message, done.stderr)
        self.succeed("explain", "initial.fcn.json", code=BAD_INPUT)

    def test_symmetric_partners_share_their_fate(self):
        self.model("gear", "--count", "6", "--resolution", "0.06")
        self.succeed("adapt", "gear.off", "--method", "sharp", "--symmetry", "--scale", "5%", "-o",
                     "gear.fcn.json")
        initial = self.succeed_json("detect", "gear.off", "--method", "sharp", "--symmetry", "-o",
                                    "initial.fcn.json")
        self.assertGreater(initial["network"]["orbits"], 2)
        with open(self.folder / "initial.fcn.json", encoding="utf-8") as file:
            orbits = json.load(file)["orbits"]
        for orbit in orbits:
            kept = {round(self.succeed_json("explain", "gear.fcn.json", "--arc",
                                            str(member["arc"]))["kept_length"], 3) > 0
                    for member in orbit["members"][:4]}
            self.assertEqual(len(kept), 1, orbit)

    def test_standard_streams(self):
        mesh = self.succeed("model", "box", "--resolution", "0.3", "-o", "-").stdout
        self.assertTrue(mesh.startswith("OFF"))
        network = self.succeed("detect", "-", "--method", "sharp", "-o", "-", stdin=mesh).stdout
        self.assertEqual(len(json.loads(network)["arcs"]), 12)


class ConvertedMeshes(ProgramTest):
    def test_curves_go_along_from_format_to_format(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        self.succeed("detect", "ribs.off", "--method", "sharp", "-o", "net.fcn.json")
        self.succeed("remesh", "ribs.off", "--network", "net.fcn.json", "--scale", "8%", "-o", "a.obj")
        edges = len(re.findall(r"(?m)^l ", (self.folder / "a.obj").read_text(encoding="utf-8")))
        self.assertGreater(edges, 0)
        before = self.succeed_json("convert", "a.obj", "back.fcn.json")
        source = "a.obj"
        for target in ("b.ply", "c.mesh", "d.msh", "e.obj"):
            made = self.succeed_json("convert", source, target, "--as", "mesh")
            self.assertGreater(made["curves"], 0, target)
            after = self.succeed_json("convert", target, "back.fcn.json", "--as", "network")
            for key in ("nodes", "arcs"):
                self.assertEqual(after[key], before[key], target)
            source = target
        self.succeed("convert", source, "f.vtp", "--as", "mesh")
        self.assertIn("NumberOfLines=\"%d\"" % made["curves"], (self.folder / "f.vtp").read_text(encoding="utf-8"))
        plain = self.call("convert", "ribs.off", "g.obj")
        self.assertNotIn("curves are left out", plain.stderr)

    def test_curves_off_the_edges_are_left_out_and_said(self):
        text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.2 0\nf 1 2 3\nf 1 3 4\nl 1 5\n"
        self.write("a.obj", text)
        result = self.call("convert", "a.obj", "b.ply", "--as", "mesh")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("curves are left out", result.stderr)


class Run(ProgramTest):
    def test_files_keys_and_report(self):
        self.model("box", "--resolution", "0.1")
        summary = self.succeed_json("run", "box.off", "--scales", "10%,0.3", "--compare-work",
                                    "300000", "-o", "out")
        mesh = summary["meshes"][0]
        self.assertEqual(mesh["method"], "sharp")
        self.assertEqual([s["scale"] for s in mesh["scales"]], ["10%", "0.3"])
        for scale, folder in zip(mesh["scales"], ("10pct", "0.3")):
            names = {p.name for p in (self.folder / "out/box" / folder).iterdir()}
            self.assertLessEqual(SCALE_FILES | {"problem_1.lab.gz"}, names)
            self.assertEqual({f"out/box/{folder}/{n}" for n in names}, set(scale["files"]))
            self.assertTrue(scale["conforming"])
            self.assertGreater(scale["remesh"]["min_angle_degrees"], 15)
            self.assertEqual([s["solver"] for s in scale["solvers"]],
                             ["greedy", "local-search", "branch-and-bound", "cbc", "auto"])
        report = (self.folder / "out/report.html").read_text(encoding="utf-8")
        self.assertIn("</html>", report)
        self.assertNotRegex(report, r"(src|href)=\"https?://", "the report must work offline")
        with open(self.folder / "out/summary.json", encoding="utf-8") as file:
            self.assertEqual(json.load(file), summary)

    def test_viewer_is_in_the_report_only_if_there_is_one(self):
        self.model("box", "--resolution", "0.3")
        (self.folder / "viewer.js").write_text("viewerMark();", encoding="utf-8")
        run = ["run", "box.off", "--scales", "20%", "--solvers", "none", "-o", "out"]
        report = self.folder / "out/report.html"
        for script, options, has_viewer in (("viewer.js", [], True), ("", [], False),
                                            ("viewer.js", ["--no-viewer"], False)):
            result = self.call(*run, *options, environment={"SCALEFCN_VIEWER": script})
            self.assertEqual(result.returncode, 0, result.stderr)
            text = report.read_text(encoding="utf-8")
            self.assertEqual("viewerMark();" in text, has_viewer)
            self.assertEqual(text.count("data-block="), 2 if has_viewer else 0)
            self.assertEqual("setup_viewer.sh" in text, not has_viewer)
        unknown = self.call(*run, "--baselines", "no-such-way")
        self.assertEqual(unknown.returncode, USAGE)
        self.assertIn("no-such-way", unknown.stderr)
        missing = self.call(*run, environment={"SCALEFCN_VIEWER": "no-such.js"})
        self.assertEqual(missing.returncode, BAD_INPUT)
        self.assert_one_error(missing.stderr)
        self.assertIn("no-such.js", missing.stderr)

    def test_baselines_are_measured_in_summary_and_report(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        run = ["run", "ribs.off", "--scales", "6%,9%", "--solvers", "none", "-o", "out"]
        summary = self.succeed_json(*run, "--baselines", "own-plain,quadrics")
        report = (self.folder / "out/report.html").read_text(encoding="utf-8")
        for scale in summary["meshes"][0]["scales"]:
            ways = {way["way"]: way for way in scale["ways"]}
            self.assertEqual(list(ways), ["own", "own-initial", "own-plain", "quadrics"])
            self.assertEqual(ways["own"]["triangles"]["faces"], scale["remesh"]["faces"])
            # The same as the other commands say.
            folder = f"out/ribs/{scale['scale'].replace('%', 'pct')}"
            measured = self.succeed_json("measure", f"{folder}/remesh.obj", "ribs.off")
            self.assertAlmostEqual(measured["distance"]["hausdorff"],
                                   ways["own"]["distance"]["hausdorff"], delta=1e-6)
        for title in ("Plain remesh, no features", "Quadric decimation to as many vertices"):
            self.assertEqual(len(re.findall(f"<th[^>]*>{title}</th>", report)), 2, title)

    def test_every_key_is_documented(self):
        self.model("box", "--resolution", "0.2")
        found = keys_of(self.succeed_json("run", "box.off", "--scales", "20%", "--compare-work",
                                          "300000", "-o", "out"))
        network = "out/box/20pct/adapted.fcn.json"
        problem = "out/box/20pct/problem_1.lab.gz"
        for arguments in (["check", network, "--scale", "20%"],
                          ["measure", "out/box/20pct/remesh.obj", "box.off"],
                          ["solve", problem, "-o", "a.sol"], ["verify", problem, "a.sol"],
                          ["convert", network, "a.obj"], ["model", "--list"],
                          ["explain", network],
                          ["detect", "box.off", "-o", "net.fcn.json"],
                          ["remesh", "box.off", "--scale", "20%", "-o", "remesh.obj"]):
            found |= keys_of(self.succeed_json(*arguments))
        text = DOCUMENTATION.read_text(encoding="utf-8")
        documented = set(re.findall(r"`\.?([a-z_0-9]+)(?:\[\])?`", text))
        self.assertGreater(len(found), 100)
        self.assertEqual(found - documented, set())

    def test_exact_solvers_side_by_side_agree(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        summary = self.succeed_json("run", "ribs.off", "--scales", "6%", "--no-remesh",
                                    "--compare-work", "1000000", "-o", "out")
        rows = summary["meshes"][0]["scales"][0]["solvers"]
        optimal = {r["value"] for r in rows if r["status"] == "optimal"}
        self.assertEqual(len(optimal), 1, rows)
        for row in rows:
            self.assertLessEqual(row["value"], optimal.copy().pop() * (1 + 1e-12))

    def test_closing_table_leads_with_the_mesh(self):
        self.model("box", "--resolution", "0.1")
        text = self.succeed("run", "box.off", "--scales", "10%", "--compare-work", "300000",
                            "-o", "out").stdout
        head = re.search(r"scale +edge length +network +triangles +smallest angle", text)
        self.assertIsNotNone(head, text)
        self.assertLess(head.start(), text.index("greedy"))
        self.assertRegex(text, r"(?m)^ +10% +\S+ +initial ")
        self.assertRegex(text, r"(?m)^ +adapted .* yes$")
        self.assertTrue(text.rstrip().endswith("out/report.html"), text)

    def test_folder_and_equal_names(self):
        for folder in ("a", "b"):
            (self.folder / "in" / folder).mkdir(parents=True)
            self.succeed("model", "box", "--resolution", "0.3", "-o", f"in/{folder}/box.off")
        self.succeed("run", "in/a", "in/b", "--scales", "20%", "--no-remesh", "--solvers", "none",
                     "-o", "out")
        self.assertTrue((self.folder / "out/box/20pct/adapted.fcn.json").exists())
        self.assertTrue((self.folder / "out/box-2/20pct/adapted.fcn.json").exists())

    def test_quads_are_made_measured_and_reported(self):
        self.model("box", "--resolution", "0.2")
        summary = self.succeed_json("run", "box.off", "--scales", "20%", "--target", "quad",
                                    "--solvers", "none", "-o", "out")
        scale = summary["meshes"][0]["scales"][0]
        path = next(file for file in scale["files"] if file.endswith("quads.obj"))
        measured = self.succeed_json("measure", path, "box.off", "--network",
                                     "out/box/20pct/adapted.fcn.json")
        self.assertEqual(measured["quads"], scale["quads"]["quads"])
        self.assertEqual(measured["topology"]["euler_characteristic"], 2)
        self.assertEqual(measured["quads"]["inverted_corners"], 0)
        self.assertAlmostEqual(measured["alignment"]["mean_degrees"],
                               scale["quads"]["alignment"]["mean_degrees"], places=3)
        self.assertIn("<caption>Quads</caption>",
                      (self.folder / "out/report.html").read_text(encoding="utf-8"))
        again = self.succeed_json("remesh", "box.off", "--network",
                                  "out/box/20pct/adapted.fcn.json", "--type", "quad", "-o",
                                  "again.obj,again.vtu")
        self.assertEqual(again["quads"], scale["quads"]["quads"])
        self.assertEqual((self.folder / "again.obj").read_bytes(),
                         (self.folder / path).read_bytes())
        self.check_field_files(scale)
        pairs = self.succeed_json("remesh", "box.off", "--network",
                                  "out/box/20pct/adapted.fcn.json", "--type", "quad", "--tier",
                                  "pairing", "-o", "pairs.off")
        self.assertEqual(pairs["tier"], "pairing")
        self.assertEqual(pairs["broken_segments"], [])

    def check_field_files(self, scale):
        """The field of the quads of box.off: one unit vector a face, in its plane, along edges."""
        self.assertEqual(scale["quads"]["tier"], "field")
        self.assertEqual(scale["quads"]["attempts"][-1]["reason"], "")
        told = [file for file in scale["files"] if "field." in file]
        self.assertEqual(told, ["out/box/20pct/field.rosy", "out/box/20pct/field.obj"])
        exact = self.succeed_json("remesh", "box.off", "--network",
                                  "out/box/20pct/adapted.fcn.json", "--type", "quad", "-o",
                                  "b.obj", "--field", "carried.rosy,carried.off")
        self.assertEqual(exact["files"], ["b.obj", "carried.rosy", "carried.off"])
        self.succeed("remesh", "box.off", "--network", "out/box/20pct/adapted.fcn.json", "--type",
                     "quad", "-o", "c.obj", "--field", "sampled.rosy.gz")
        self.assertEqual((self.folder / "carried.rosy").read_bytes(),
                         (self.folder / "out/box/20pct/field.rosy").read_bytes())
        # Around singularities faces are halved before the field is used.
        self.assertGreaterEqual(self.check_rosy("carried.rosy", "carried.off"),
                                exact["attempts"][-1]["triangles"])
        self.check_rosy("out/box/20pct/field.rosy", "out/box/20pct/field.obj")
        self.check_rosy("sampled.rosy.gz", "box.off")

    def check_rosy(self, field, mesh):
        content = (self.folder / field).read_bytes()
        text = (gzip.decompress(content) if field.endswith(".gz") else content).decode("utf-8")
        count, symmetry, *rest = text.split()
        numbers = list(map(float, rest))
        points, faces = read_triangles(self.folder / mesh)
        self.assertEqual((int(count), symmetry, len(numbers)), (len(faces), "4", 3 * len(faces)))
        slanted = 0
        for k, face in enumerate(faces):
            arm = numbers[3 * k:3 * k + 3]
            a, b, c = (points[v] for v in face)
            u, v = ([x - y for x, y in zip(p, a)] for p in (b, c))
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0]]
            size = math.hypot(*normal)
            self.assertAlmostEqual(math.hypot(*arm), 1, places=9)
            self.assertLess(abs(sum(x * y for x, y in zip(arm, normal))) / size, 1e-6)
            # The box lies along the axes, and so do its creases: arms turn away from both nowhere.
            slanted += max(map(abs, arm)) < math.cos(math.radians(20))
        self.assertLess(slanted, 0.05 * len(faces))
        return len(faces)

    def test_paper_mode_curve_unit_and_quad_target(self):
        self.model("ribs", "--resolution", "0.05", "--spacing", "0.1")
        for options in (["--mode", "paper"], ["--unit", "curve"], ["--target", "quad"],
                        ["--thin-walls", "conflict"], ["--method", "vsa", "--patches", "20"]):
            with self.subTest(options=options):
                summary = self.succeed_json("run", "ribs.off", "--scales", "6%", "--no-remesh",
                                            "--solvers", "none", "-o", "out", *options)
                scale = summary["meshes"][0]["scales"][0]
                self.assertIn(scale["status"], ("converged", "iteration limit"))
                if options != ["--mode", "paper"]:
                    self.assertTrue(scale["conforming"], scale)


if __name__ == "__main__":
    unittest.main()
