"""solve, verify and convert on labeling problems: solvers agree, formats keep the optimum."""

import itertools
import json
import random
import unittest

from scalefcn_process import DONE, NO_RESULT, PROBLEM, VIOLATION, ProgramTest


def random_problem(seed):
    """Text of a small problem with every kind of term, and its optimum by enumeration."""
    draw = random.Random(seed)
    count = draw.randint(6, 10)
    pairs = list(itertools.combinations(range(1, count + 1), 2))
    draw.shuffle(pairs)
    conflicts = pairs[:count]
    bonuses = [(i, j, draw.randint(1, 9)) for i, j in pairs[count:count + 5]]
    weights = [draw.randint(1, 20) for _ in range(count)]
    rule = sorted(draw.sample(range(1, count + 1), 4))
    lines = [f"p labeling {count} {len(conflicts)} {len(bonuses)} 1"]
    lines += [f"l {i + 1} {w}" for i, w in enumerate(weights)]
    lines += [f"x {i} {j}" for i, j in conflicts]
    lines += [f"b {i} {j} {q}" for i, j, q in bonuses]
    lines += ["r le 2 4 " + " ".join(f"1 {i}" for i in rule)]
    best = 0
    for bits in itertools.product((0, 1), repeat=count):
        on = [0, *bits]
        if any(on[i] and on[j] for i, j in conflicts) or sum(on[i] for i in rule) > 2:
            continue
        value = sum(w for w, b in zip(weights, bits) if b)
        best = max(best, value + sum(q for i, j, q in bonuses if on[i] and on[j]))
    return "\n".join(lines) + "\n", best


class Solve(ProgramTest):
    def test_exact_solvers_find_the_enumerated_optimum(self):
        for seed in range(8):
            text, best = random_problem(seed)
            name = self.write(f"random_{seed}.lab", text)
            for solver in ("branch-and-bound", "cbc", "auto"):
                with self.subTest(seed=seed, solver=solver):
                    answer = self.succeed_json("solve", name, "--solver", solver, "-o", "s.sol")
                    self.assertEqual((answer["status"], answer["value"], answer["bound"]),
                                     ("optimal", best, best))
                    self.succeed("verify", name, "s.sol")

    def test_proofs_are_checked_and_belong_to_their_problem(self):
        for seed in range(6):
            text, best = random_problem(seed)
            name = self.write(f"random_{seed}.lab", text)
            self.succeed("solve", name, "-o", "s.sol", "--proof", "s.pbp")
            self.assertIn(f"value {best}, proven optimal",
                          self.succeed("verify", name, "s.sol", "--proof", "s.pbp").stdout)
            answer = self.succeed_json("verify", name, "s.sol", "--proof", "s.pbp")
            self.assertTrue(answer["proven_optimal"])
        # The same proof for another objective, and a proof that ends too early.
        other = self.write("other.lab", text.replace("l 1 ", "l 1 1"))
        self.succeed("solve", other, "-o", "o.sol")
        self.succeed("verify", other, "o.sol", "--proof", "s.pbp", code=VIOLATION)
        proof = (self.folder / "s.pbp").read_text()
        self.write("cut.pbp", proof[:proof.index("conclusion")])
        self.succeed("verify", name, "s.sol", "--proof", "cut.pbp", code=VIOLATION)
        # VeriPB checks it against the exported problem.
        self.succeed("convert", name, "s.opb")

    def test_heuristics_are_feasible_and_claim_no_bound(self):
        text, best = random_problem(99)
        name = self.write("random.lab", text)
        for solver in ("greedy", "local-search"):
            with self.subTest(solver=solver):
                answer = self.succeed_json("solve", name, "--solver", solver, "-o", "s.sol")
                self.assertEqual(answer["status"], "feasible")
                self.assertIsNone(answer["bound"])
                self.assertLessEqual(answer["value"], best)
                self.succeed("verify", name, "s.sol")

    def test_formats_keep_the_optimum(self):
        text, best = random_problem(7)
        self.write("a.lab", text)
        for target in ("b.mps", "b.lp", "b.opb", "b.cfn", "b.lab.gz", "b.mps.gz", "b.lp.gz",
                       "b.opb.gz", "b.cfn.gz"):
            for rows in ("strengthened", "paper"):
                with self.subTest(target=target, rows=rows):
                    self.succeed("convert", "a.lab", target, "--rows", rows)
                    answer = self.succeed_json("solve", target)
                    self.assertEqual(answer["value"], best)

    def test_streams(self):
        solution = self.succeed("solve", "-", "-o", "-", stdin=PROBLEM).stdout
        self.assertIn("v 9", solution.splitlines())
        self.write("p.lab", PROBLEM)
        self.succeed("verify", "p.lab", "-", stdin=solution)

    def test_start_is_never_lost(self):
        text, best = random_problem(3)
        self.write("a.lab", text)
        self.succeed("solve", "a.lab", "--solver", "branch-and-bound", "-o", "best.sol")
        answer = self.succeed_json("solve", "a.lab", "--solver", "local-search", "--start",
                                   "best.sol", "--work-limit", "1000")
        self.assertEqual(answer["value"], best)

    def test_infeasible_is_an_answer(self):
        self.write("none.lab", "p labeling 2 1 0 1\nl 1 1\nl 2 1\nx 1 2\nr ge 2 2 1 1 1 2\n")
        answer = self.succeed_json("solve", "none.lab", "--solver", "branch-and-bound")
        self.assertEqual((answer["status"], answer["value"]), ("infeasible", None))

    def test_no_result_has_its_own_code(self):
        self.write("none.lab", "p labeling 2 1 0 1\nl 1 1\nl 2 1\nx 1 2\nr ge 2 2 1 1 1 2\n")
        result = self.call("solve", "none.lab", "--solver", "greedy", "--json")
        answer = json.loads(result.stdout)
        self.assertIsNone(answer["value"])
        self.assertEqual(result.returncode, NO_RESULT if answer["status"] != "infeasible" else DONE)


if __name__ == "__main__":
    unittest.main()
