"""Help texts, exit codes, and wrong command lines and inputs, each with its message."""

import gzip
import os
import pty
import subprocess
import unittest

from scalefcn_process import (BAD_INPUT, DONE, PROBLEM, PROGRAM, TETRAHEDRON, USAGE, VIOLATION,
                              ProgramTest)

COMMANDS = ["run", "detect", "adapt", "check", "remesh", "measure", "solve", "verify", "convert",
            "explain", "model", "compare", "draw"]


class Help(ProgramTest):
    def test_program_lists_its_commands(self):
        text = self.succeed("--help").stdout
        for command in COMMANDS:
            self.assertRegex(text, rf"(?m)^\s+{command}\s")
        self.assertRegex(self.succeed("--version").stdout, r"^scalefcn \d+\.\d+\.\d+")

    def test_every_command_has_an_example_and_the_common_options(self):
        for command in COMMANDS:
            with self.subTest(command=command):
                text = self.succeed(command, "--help").stdout
                self.assertIn(f"Example:\n  scalefcn {command} ", text)
                for option in ("--json", "--seed", "--threads", "--no-timings", "--help"):
                    self.assertIn(option, text)

    def test_models_are_listed(self):
        names = {m["name"] for m in self.succeed_json("model", "--list")["models"]}
        self.assertLessEqual({"skyscraper", "ribs", "steps", "gear", "octaflower", "thin-wall",
                              "noisy-plane"}, names)


class WrongCommandLines(ProgramTest):
    """Every entry: what is typed, and a part of the one line that comes back; exit code 2."""

    CASES = [
        (["frobnicate"], "frobnicate"),
        ([], "subcommand"),
        (["run"], "MESH"),
        (["run", "box.off", "--nonsense"], "--nonsense"),
        (["run", "box.off", "--scales", "2%,"], "empty entry"),
        (["run", "box.off", "--scales", "wide"], "'wide' is not a length"),
        (["run", "box.off", "--scales", "2%%"], "'2%%' is not a length"),
        (["run", "box.off", "--scales", "nan"], "not a length"),
        (["run", "box.off", "--scales", "inf"], "not a length"),
        (["run", "box.off", "--scales", "0"], "greater than 0"),
        (["run", "box.off", "--scales", "-2%"], "greater than 0"),
        (["run", "box.off", "--scales", "2%,2%"], "given twice"),
        (["run", "box.off", "--scales", "300%", "--no-remesh"], "more than the bounding-box"),
        (["run", "box.off", "--scales", "1%", "--edge-lengths", "1%"], "excludes"),
        (["run", "box.off", "--method", "magic"], "magic"),
        (["run", "box.off", "--method", "sharp+"], "'' is no detector"),
        (["run", "box.off", "--method", "vsa+sharp+vsa"], "vsa is named twice"),
        (["detect", "box.off", "-o", "a.obj", "--method", "sharp+vsa", "--fuse-distance", "0"],
         "--fuse-distance"),
        (["detect", "box.off", "-o", "a.obj", "--method", "sharp", "--seeds", "s.json"],
         "--seeds needs wire"),
        (["detect", "box.off", "-o", "a.obj", "--method", "sharp", "--import", "ridges.txt"],
         "--import needs crest"),
        (["detect", "box.off", "-o", "a.obj", "--method", "crest", "--crest-scale", "0.5"],
         "--crest-scale"),
        (["detect", "box.off", "-o", "a.obj", "--method", "crest", "--crest-scale", "nan"],
         "--crest-scale"),
        (["detect", "box.off", "-o", "a.obj", "--method", "crest", "--crest-sphericalness", "2"],
         "--crest-sphericalness"),
        (["run", "box.off", "--ratio", "1.8"], "1.8"),
        (["run", "box.off", "--ratio", "1"], "[1.01, sqrt(3))"),
        (["run", "box.off", "--lambda0", "-1"], "lambda0"),
        (["run", "box.off", "--threads", "-1"], "threads"),
        (["run", "box.off", "--seed", "x"], "seed"),
        (["run", "box.off", "box.off", "--network", "a.obj"], "one MESH"),
        (["run", "box.off", "--low-angle", "50", "--method", "sharp"], "--low-angle"),
        (["detect", "box.off"], "--output"),
        (["detect", "box.off", "-o", "-", "--json"], "standard output"),
        (["detect", "box.off", "-o", "a.obj", "--patches", "1"], "patches"),
        (["adapt", "box.off", "-o", "a.fcn.json"], "--scale"),
        (["adapt", "box.off", "-o", "a.fcn.json", "--scale", "1%", "--mode", "worst"], "worst"),
        (["adapt", "box.off", "-o", "a.fcn.json", "--scale", "1%", "--unit", "loop"], "loop"),
        (["adapt", "box.off", "-o", "a.fcn.json", "--scale", "1%", "--time-limit", "0"],
         "time-limit"),
        (["adapt", "box.off", "-o", "a.fcn.json", "--scale", "1%", "--boundary", "cut"], "cut"),
        (["adapt", "box.off", "-o", "a.fcn.json", "--scale", "1%", "--keep", "arcs:3"], "'arcs:3'"),
        (["run", "box.off", "--drop", "curve:x"], "neither arc:NUMBER nor curve:NUMBER"),
        (["adapt", "box.off", "-o", "a.fcn.json", "--scale", "1%", "--keep-box", "0,0,0,1,1"],
         "no box"),
        (["remesh", "box.off", "-o", "a.stl", "--scale", "5%", "--type", "quad"], ".obj .off .vtu"),
        (["remesh", "box.off", "-o", "a.obj", "--scale", "5%", "--type", "quad", "--with", "cgal"],
         "--type tri"),
        (["remesh", "box.off", "-o", "a.obj", "--scale", "5%", "--tier", "first"], "--tier"),
        (["remesh", "box.off", "-o", "a.obj", "--scale", "5%", "--guidance", "all"], "--guidance"),
        (["remesh", "box.off", "-o", "a.obj"], "--scale"),
        *((["remesh", "box.off", "-o", "a.obj", "--scale", "5%", "--type", *words], message)
          for words, message in [
              (["tri", "--field", "a.rosy"], "--type quad"),
              (["quad", "--field", "a.rosy", "--tier", "pairing"], "follow no field"),
              (["quad", "--field", "a.txt"], "no mesh format"),
              (["quad", "--field", "b.obj"], "no .rosy file"),
              (["quad", "--field", "a.rosy,b.rosy"], "one .rosy file"),
              (["quad", "--field", "a.rosy,b.obj,b.off"], "one mesh file"),
              (["quad", "--field", "a.rosy,a.obj"], "after -o and after --field"),
              (["quad", "--field", "-"], "standard output")]),
        (["measure", "box.off"], "REFERENCE"),
        (["solve", "p.lab", "--option", "depth"], "NAME=VALUE"),
        (["solve", "p.lab", "--gap", "2"], "gap"),
        (["verify", "-", "-"], "standard input"),
        (["convert", "p.lab", "a.obj"], "not of one kind"),
        (["model"], "NAME is missing"),
    ]

    def setUp(self):
        super().setUp()
        self.model("box", "--resolution", "0.3")
        self.write("p.lab", PROBLEM)

    def test_each_is_refused_with_its_message(self):
        for arguments, message in self.CASES:
            with self.subTest(arguments=arguments):
                result = self.call(*arguments)
                self.assertEqual(result.returncode, USAGE, result.stderr)
                self.assertIn(message.lower(), result.stderr.lower())
                self.assertEqual(result.stdout, "")
                self.assert_one_error(result.stderr)
        self.assertEqual(sorted(self.files()), ["box.off", "p.lab"])


class BadInputs(ProgramTest):
    """Every entry: file name, its content (None: missing), the command, a part of the message."""

    NAN = TETRAHEDRON.replace("1 0 0", "nan 0 0")
    MESHES = [
        ("missing.off", None, "missing.off"),
        ("empty.off", "", "empty.off"),
        ("blank.stl", "\n \n", "blank.stl"),
        ("cut.off", TETRAHEDRON[:30], "cut.off"),
        ("index.off", TETRAHEDRON.replace("3 1 2 3", "3 1 2 7"), "7"),
        ("negative.off", TETRAHEDRON.replace("3 1 2 3", "3 1 2 -3"), "-3"),
        ("nan.off", NAN, "nan"),
        ("word.off", TETRAHEDRON.replace("0 1 0", "0 one 0"), "one"),
        ("noface.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "noface.obj"),
        ("picture.png", "\x89PNG not a mesh", "picture.png"),
        ("story.txt", "Once upon a time there was a mesh.\n", "story.txt"),
        ("half.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "half.ply"),
        ("flat.off", "OFF\n3 1 0\n0 0 0\n0 0 0\n0 0 0\n3 0 1 2\n", "flat.off"),
        ("half.off.gz", gzip.compress(TETRAHEDRON.encode())[:40], "half.off.gz"),
    ]
    NETWORKS = [
        ("missing.fcn.json", None, "missing.fcn.json"),
        ("empty.fcn.json", "", "empty.fcn.json"),
        ("cut.fcn.json", '{"version": 1, "nodes": [', "cut.fcn.json"),
        ("other.fcn.json", '{"hello": "world"}', "other.fcn.json"),
        ("list.fcn.json", "[1, 2, 3]", "list.fcn.json"),
        ("index.obj", "v 0 0 0\nv 1 0 0\nl 1 9\n", "9"),
        ("word.polylines.txt", "2 0 0 0 one 0 0\n", "one"),
    ]
    PROBLEMS = [
        ("missing.lab", None, "missing.lab"),
        ("empty.lab", "", "empty.lab"),
        ("index.lab", PROBLEM.replace("x 1 2", "x 1 8"), "8"),
        ("self.lab", PROBLEM.replace("x 1 2", "x 2 2"), "self.lab"),
        ("bonus.lab", PROBLEM.replace("b 1 3 3", "b 1 3 -3"), "bonus.lab"),
        ("count.lab", PROBLEM.replace("labeling 3", "labeling 4"), "count.lab"),
        ("word.lab", PROBLEM.replace("l 2 3", "l 2 three"), "three"),
        ("huge.lab", PROBLEM.replace("l 2 3", "l 2 9007199254740999"), "huge.lab"),
        ("text.mps", "not a model\n", "text.mps"),
    ]

    def refuse(self, name, content, arguments, message, code=BAD_INPUT):
        if isinstance(content, bytes):
            (self.folder / name).write_bytes(content)
        elif content is not None:
            self.write(name, content)
        result = self.call(*arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertIn(message.lower(), result.stderr.lower())
        self.assert_one_error(result.stderr)

    def test_meshes(self):
        for name, content, message in self.MESHES:
            with self.subTest(name=name):
                self.refuse(name, content, ["detect", name, "-o", "net.fcn.json"], message)
                self.assertFalse((self.folder / "net.fcn.json").exists())

    SEEDS = [
        ("missing.json", None, "missing.json"),
        ("empty.json", "", "empty.json"),
        ("nan.json", '{"wires":[{"points":[[0,0,NaN],[1,1,1]]}]}', "nan.json"),
        ("key.json", '{"wires":[{"vertices":[0,1],"closd":true}]}', "/wires/0/closd: unknown key"),
        ("far.json", '{"wires":[{"points":[[0,0,0],[9,9,9]]}]}', "from the surface"),
        ("one.json", '{"wires":[{"vertices":[3]}]}', "needs 2"),
        ("same.json", '{"wires":[{"vertices":[3,3]}]}', "same point"),
        ("vertex.json", '{"wires":[{"vertices":[3,100000]}]}', "vertex 100000"),
    ]

    def test_seeds(self):
        self.model("box", "--resolution", "0.3")
        for name, content, message in self.SEEDS:
            with self.subTest(name=name):
                self.refuse(name, content, ["detect", "box.off", "--method", "wire", "--seeds",
                                            name, "--threads", "1", "-o", "net.fcn.json"],
                            message)
                self.assertFalse((self.folder / "net.fcn.json").exists())

    PINS = [
        (["--keep", "arc:12"], "arc 12 does not exist"),
        (["--drop", "curve:999"], "curve 999 does not exist"),
        (["--keep", "arc:1", "--drop", "arc:1"], "to be kept and to be dropped"),
        (["--keep-box", "7,7,7,8,8,8"], "no feature passes"),
        (["--importance", "missing.txt"], "missing.txt"),
        (["--importance", "short.txt"], "3 values, the mesh has"),
        (["--importance", "word.txt"], "word.txt:2"),
        (["--importance", "box.ply"], "no property 'importance'"),
        (["--keep-above", "-1", "--importance", "short.txt"], "--keep-above"),
        # The edges of the box are shorter than the scale.
        (["--keep-box", "-9,-9,-9,9,9,9", "--scale", "70%"], "rmin long near"),
    ]

    def test_pins(self):
        self.model("box", "--resolution", "0.3")
        self.succeed("convert", "box.off", "box.ply", "--as", "mesh")
        self.write("short.txt", "1\n2\n3\n")
        self.write("word.txt", "1\ntwo\n")
        for arguments, message in self.PINS:
            with self.subTest(arguments=arguments):
                scale = [] if "--scale" in arguments else ["--scale", "5%"]
                code = USAGE if "--keep-above" in arguments else BAD_INPUT
                self.refuse("unused", None,
                            ["adapt", "box.off", "--threads", "1", "--method", "sharp",
                             "-o", "a.fcn.json", *scale, *arguments], message, code)
                self.assertFalse((self.folder / "a.fcn.json").exists())

    def test_networks(self):
        for name, content, message in self.NETWORKS:
            with self.subTest(name=name):
                self.refuse(name, content, ["check", name, "--scale", "0.1"], message)

    def test_problems(self):
        for name, content, message in self.PROBLEMS:
            with self.subTest(name=name):
                self.refuse(name, content, ["solve", name, "-o", "a.sol"], message)
                self.assertFalse((self.folder / "a.sol").exists())

    def test_folder_without_meshes(self):
        self.write("folder/readme.txt", "nothing here\n")
        self.refuse("unused", None, ["run", "folder"], "no mesh file")

    def test_unknown_extension_of_an_output(self):
        self.model("box", "--resolution", "0.3")
        for arguments in (["detect", "box.off", "-o", "a.xyz"],
                          ["remesh", "box.off", "--scale", "5%", "-o", "a.xyz"],
                          ["convert", "box.off", "a.xyz", "--as", "mesh"]):
            with self.subTest(arguments=arguments):
                result = self.call(*arguments)
                self.assertEqual(result.returncode, USAGE, result.stderr)
                self.assertIn("a.xyz: no ", result.stderr)
                self.assert_one_error(result.stderr)

    def test_unwritable_output(self):
        self.model("box", "--resolution", "0.3")
        self.write("file", "in the way\n")
        self.refuse("unused", None, ["detect", "box.off", "-o", "file/net.fcn.json"], "file")

    def test_network_of_another_mesh(self):
        self.model("box", "--resolution", "0.3")
        self.model("gear")
        self.succeed("detect", "box.off", "-o", "box.fcn.json")
        self.refuse("unused", None, ["adapt", "gear.off", "--network", "box.fcn.json", "--scale",
                                     "2%", "-o", "a.fcn.json"], "mesh")

    def test_initial_network_has_nothing_to_check(self):
        self.model("box", "--resolution", "0.3")
        self.succeed("detect", "box.off", "-o", "box.fcn.json")
        self.refuse("unused", None, ["check", "box.fcn.json", "--scale", "0.1"], "segment")

    def test_unknown_names_list_the_known(self):
        self.write("p.lab", PROBLEM)
        self.model("box", "--resolution", "0.3")
        for arguments, known in ((["solve", "p.lab", "--solver", "oracle"], "branch-and-bound"),
                                 (["adapt", "box.off", "--scale", "9%", "--solver", "oracle", "-o",
                                   "n.fcn.json"], "branch-and-bound"),
                                 (["run", "box.off", "--solvers", "greedy,oracle"], "local-search"),
                                 (["model", "teapot"], "skyscraper")):
            self.refuse("unused", None, arguments, known, code=USAGE)

    def test_model_options_out_of_range(self):
        for option, value in (("--resolution", "0"), ("--spacing", "-1")):
            self.refuse("unused", None, ["model", "ribs", option, value], option[2:], code=USAGE)

    def test_a_scale_beyond_memory_is_refused(self):
        self.model("box", "--resolution", "0.3")
        self.refuse("unused", None, ["adapt", "box.off", "--method", "sharp", "--scale", "1e-9",
                                     "-o", "n.fcn.json"], "too small")

    def test_solution_of_another_problem(self):
        self.write("p.lab", PROBLEM)
        self.refuse("s.sol", "v 4\n17\n", ["verify", "p.lab", "s.sol"], "17")

    def test_a_bad_mesh_among_several_does_not_stop_the_others(self):
        self.model("box", "--resolution", "0.2")
        self.write("broken.off", TETRAHEDRON[:30])
        result = self.call("run", "broken.off", "box.off", "--scales", "20%", "--solvers", "none",
                           "-o", "out")
        self.assertEqual(result.returncode, BAD_INPUT, result.stderr)
        self.assertIn("broken.off", result.stderr)
        self.assertTrue((self.folder / "out/box/20pct/adapted.fcn.json").exists())

    def test_strict_refuses_what_would_be_repaired(self):
        self.write("twice.off", TETRAHEDRON.replace("4 4 0", "4 5 0") + "3 1 2 3\n")
        note = self.succeed("detect", "twice.off", "-o", "net.fcn.json").stderr
        self.assertIn("note: twice.off:", note)
        self.assertIn("note", note)
        self.refuse("unused", None, ["detect", "twice.off", "--strict", "-o", "net.fcn.json"],
                    "twice.off")


class Terminal(ProgramTest):
    def test_progress_is_drawn_on_a_terminal_only(self):
        self.model("box", "--resolution", "0.1")
        arguments = ["adapt", "box.off", "--scale", "10%", "-o", "a.fcn.json"]
        piped = self.succeed(*arguments).stderr
        self.assertNotIn("\r", piped)
        self.assertNotIn("\x1b", piped)
        main_side, terminal = pty.openpty()
        process = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stderr=terminal,
                                   stdout=subprocess.DEVNULL)
        os.close(terminal)
        drawn = b""
        try:
            while chunk := os.read(main_side, 4096):
                drawn += chunk
        except OSError:  # the terminal is closed when the program ends
            pass
        os.close(main_side)
        self.assertEqual(process.wait(), DONE)
        self.assertRegex(drawn.decode(), r"\[#*\.*\] +\d+% box")


class ExitCodes(ProgramTest):
    def test_violations_have_their_own(self):
        self.write("p.lab", PROBLEM)
        self.write("wrong.sol", "v 7\n1\n2\n")
        self.succeed("verify", "p.lab", "wrong.sol", code=VIOLATION)
        self.write("lie.sol", "v 8\n1\n3\n")
        self.assertIn("9", self.succeed("verify", "p.lab", "lie.sol", code=VIOLATION).stdout)
        self.write("right.sol", "v 9\n1\n3\n")
        self.succeed("verify", "p.lab", "right.sol", code=DONE)


if __name__ == "__main__":
    unittest.main()
