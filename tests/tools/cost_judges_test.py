"""What perf/regret.py and perf/promises.py make of reports: that they see what is planted."""
import argparse
import json
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "perf"))
sys.dont_write_bytecode = True
import cost_runs  # noqa: E402
import promises  # noqa: E402
import regret  # noqa: E402


def point(setting, error, at_most, time, trials=2):
    return {"settings": dict(word.split("=") for word in setting.split()),
            "errors": {"drift": error}, "errors_at_most": {"drift": at_most},
            "squares": [[error ** 2]] * trials, "on_front": True,
            "time_ms": {"median": time, "least": time, "most": time, "repeats": 7}}


def report(points, advised=0, meets=True):
    return {"machine": {"processor": "P", "cores": 2, "threads": 1, "load": 0, "throng": "1"},
            "measure": "drift", "windows": 2, "reference": {"remaining": 0}, "points": points,
            "advice": {"point": advised, "meets": meets}, "doubts": []}


class MadeRuns:
    """Errors and times by a law of substeps; other dials cost and do nothing."""

    def __init__(self, named="substeps=8", off=lambda options: 1):
        self.named, self.off, self.calls = named, off, []

    def cost(self, name, scene, *options, settings=()):
        self.calls.append(name)
        settings = ["", *settings] if settings else ["", "substeps=2", "substeps=8", self.named]
        points = []
        for setting in settings:
            dials = dict(word.split("=") for word in setting.split())
            error = 4e-3 / int(dials.get("substeps", 4)) * self.off(options)
            time = float(dials.pop("substeps", 4)) * (2 if dials else 1)
            points.append(point(setting, error, 1.1 * error, time))
        return cost_runs.Report(report(points, advised=len(points) - 1))

    def seconds_of(self, name):
        return 1.0

    def state_of(self, scene, seed):
        return str(seed) if scene.startswith("pile") else "always"


class Regret(unittest.TestCase):
    def test_is_none_where_the_best_is_named(self):
        for wish in regret.Scene(MadeRuns(), "pile:50").all_wishes():
            self.assertEqual(wish.ratios, [1] * regret.TIMED)

    def test_is_seen_where_something_dearer_is_named(self):
        scene = regret.Scene(MadeRuns("substeps=8 precision=double"), "pile:50")
        for wish in scene.wishes:
            self.assertEqual(regret.best_of(wish)[2:], ("substeps=8", 2))
        self.assertEqual(scene.default.ratios, [1] * regret.TIMED)
        rows = regret.regret_table([scene]).splitlines()
        self.assertTrue(rows[2].endswith("| `substeps=8` | 8 | 2.00 | 1120 of 1120 |"), rows[2])

    def test_the_product_has_each_setting_once(self):
        for scene, size in (("pile:50", 1119), ("spring:1", 199)):
            settings = regret.union(regret.product(scene))
            self.assertEqual(len(settings), size)
            self.assertEqual(len({regret.same(each) for each in settings}), size)

    def test_the_sweep_is_kept_whole(self):
        scene = regret.Scene(MadeRuns(), "pile:50")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "sweep.csv"
            regret.write_sweep([scene], path)
            lines = path.read_text().splitlines()
        self.assertEqual(lines[1], "setting,pile:50 at_most_m,pile:50 ms")
        self.assertEqual(len(lines), 2 + len(scene.points))
        self.assertIn("substeps=8,0.00055,8", lines)


class Promises(unittest.TestCase):
    ASKED = argparse.Namespace(threads=1, fresh=20, minutes=1)

    def found(self, runs, scene="pile:50"):
        return promises.promises_of(runs, scene, self.ASKED)

    def test_hold_where_errors_stay(self):
        for each in self.found(MadeRuns()):
            self.assertEqual((each.kept, each.holds), (20, True))

    def test_are_broken_by_two_of_twenty_and_not_by_one(self):
        for broken, holds in (((3,), True), ((3, 7), False)):
            def off(options, broken=broken):
                seed = options[1] if options[0] == "--seed" else 0
                return 2 if seed in broken else 1
            within = self.found(MadeRuns(off=off))[1]
            self.assertEqual((within.kept, within.holds), (20 - len(broken), holds))

    def test_go_by_the_error_that_was_asked_for_where_it_is_met(self):
        error, within = self.found(MadeRuns())
        self.assertEqual(error.limit, 1e-3)
        self.assertAlmostEqual(within.limit, 4.4e-3 / 8)

    def test_of_a_scene_without_seeds_are_held_on_other_windows(self):
        asked = []
        self.found(MadeRuns(off=lambda options: asked.append(options[:2]) or 1), "stacks:50")
        self.assertIn(("--windows", 44), asked)
        self.assertNotIn("--seed", [options[0] for options in asked])


class Kept(unittest.TestCase):
    def test_a_run_is_made_once_for_each_command(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            command = folder / "throng"
            made = json.dumps(report([point("", 1, 1, 1)]))
            command.write_text("#!/bin/sh\n"
                               "while [ $# -gt 0 ]; do [ $1 = --out ] && out=$2; shift; done\n"
                               f"echo >>{folder}/calls; echo '{made}' >$out/cost.json\n")
            command.chmod(0o755)
            runs = cost_runs.Runs(command, folder / "runs")
            told, sys.stderr = sys.stderr, open("/dev/null", "w")
            try:
                for options, settings in (((), ()), ((), ()), (("--error", 1), ()), ((), ("a=1",)),
                                          ((), ("a=1",)), ((), ("a=2",))):
                    found = runs.cost("run", "pile:5", *options, settings=settings)
                    self.assertEqual(found.of("").time, 1)
            finally:
                sys.stderr.close()
                sys.stderr = told
            self.assertEqual(len((folder / "calls").read_text()), 4)


if __name__ == "__main__":
    unittest.main()
