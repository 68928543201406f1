"""The same input, options and seed give the same bytes, on one thread and on two."""

import unittest

from scalefcn_process import ProgramTest


class Determinism(ProgramTest):
    def run_in(self, folder, threads, *options):
        (self.folder / folder).mkdir()
        arguments = ["run", "ribs.off", "--scales", "5%,9%", "--no-timings", "--threads", threads,
                     "--work-limit", "3000000", "--compare-work", "300000", "--json", "-o", "out", *options]
        self.succeed("model", "ribs", "--resolution", "0.04", "--spacing", "0.08", "-o",
                     f"{folder}/ribs.off")
        base, self.folder = self.folder, self.folder / folder
        try:
            printed = self.succeed(*arguments).stdout
        finally:
            self.folder = base
        return printed, self.files(f"{folder}/out")

    def test_threads_change_nothing(self):
        for method in (["--method", "sharp"], ["--method", "vsa", "--patches", "30"],
                       ["--method", "crest"]):
            with self.subTest(method=method):
                name = method[1]
                one = self.run_in(f"{name}-1", 1, *method)
                two = self.run_in(f"{name}-2", 2, *method)
                self.assertEqual(one[0], two[0])
                self.assertEqual(sorted(one[1]), sorted(two[1]))
                for file, content in one[1].items():
                    self.assertEqual(content, two[1][file], f"{file} differs")
                self.assertIn("report.html", one[1])

    def test_no_timings_leaves_no_seconds(self):
        printed, _ = self.run_in("timeless", 1)
        self.assertNotIn("seconds", printed)


if __name__ == "__main__":
    unittest.main()
