"""What tools/random_scenes promises of its scenes, and that its judge sees what is planted."""
import importlib.machinery
import importlib.util
import json
import math
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True
import random_scene_judge as judge  # noqa: E402
import random_scene_maker as maker  # noqa: E402

LOADER = importlib.machinery.SourceFileLoader("random_scenes", str(ROOT / "tools/random_scenes"))
random_scenes = importlib.util.module_from_spec(importlib.util.spec_from_loader("random_scenes", LOADER))
LOADER.exec_module(random_scenes)

SCENES = [maker.make(seed, 40) for seed in range(300)]


class Maker(unittest.TestCase):
    def test_a_seed_is_a_scene(self):
        for seed in (0, 7, 2 ** 40):
            again = maker.make(seed, 40)
            self.assertEqual(json.dumps(again.scene), json.dumps(maker.make(seed, 40).scene))
            self.assertEqual(again.files, maker.make(seed, 40).files)
        self.assertNotEqual(json.dumps(SCENES[0].scene), json.dumps(SCENES[1].scene))

    def test_numbers_are_finite_and_sizes_within_their_limits(self):
        for made in SCENES:
            json.dumps(made.scene, allow_nan=False)
            for piece in filter(None, made.pieces):
                self.assertGreater(piece.inner, 0.4 * maker.LEAST_SIZE)
                self.assertLessEqual(piece.inner, maker.GREATEST_SIZE)

    def test_every_shape_floor_and_slow_mode_is_met(self):
        classes = set().union(*(made.classes for made in SCENES))
        wanted = {f"shape {kind}" for kind in maker.SHAPES}
        wanted |= {f"floor {kind}" for kind in ("plane", "box", "tiles", "mesh", "walls", "none")}
        wanted |= {"overlap back_up", "overlap subdivide", "solver direct", "springs", "pivots",
                   "kinematic", "drag", "attractor", "restitution 1", "friction 0",
                   "aspect to 1:100", "size below 2 cm", "size above 2 m", "default dials"}
        self.assertEqual(wanted - classes, set())

    def test_slow_modes_are_a_tenth_and_small(self):
        slow = [made for made in SCENES if made.slow]
        self.assertLess(len(slow), 0.15 * len(SCENES))
        self.assertGreater(len(slow), 0.05 * len(SCENES))
        self.assertLessEqual(max(len(made.mass_of) for made in slow), maker.SLOW_BODIES)

    def test_dropped_bodies_begin_apart(self):
        for made in SCENES:
            if "layout drop" not in made.classes:
                continue
            placed = [(body["position"], piece.radius)
                      for body, piece in zip(made.scene["bodies"], made.pieces) if piece]
            for i, (a, reach) in enumerate(placed):
                for b, other in placed[:i]:
                    self.assertGreaterEqual(math.dist(a, b), reach + other)


class Draws(unittest.TestCase):
    def test_the_first_is_the_scene_and_others_differ_by_hairs(self):
        for seed, made in enumerate(SCENES[:50]):
            self.assertIs(random_scenes.moved_by_hairs(made, seed, 0), made)
            one, again, other = (random_scenes.moved_by_hairs(made, seed, draw).scene for draw in (1, 1, 2))
            self.assertEqual(one, again)
            self.assertNotEqual(one, other)
            most = random_scenes.HAIR * judge.thickness_of(made)
            for body, was in zip(one["bodies"], made.scene["bodies"]):
                moved = [abs(a - b) for a, b in zip(body.pop("position"), was["position"])]
                self.assertLessEqual(max(moved), 1.001 * most + 1e-12)
                self.assertEqual("motion" in was and was["motion"] != "dynamic", max(moved) == 0)
                self.assertEqual(body, {key: was[key] for key in was if key != "position"})


def box_on_floor(**changes):
    made = maker.Made({"throng": 1, "settings": {}, "bodies": [{}, {}]}, {}, {"shape box"},
                      [None, maker.box_of([1, 1, 1])], [1000.0], lambda x, y: 0.0, rests_by=5)
    for name, value in changes.items():
        setattr(made, name, value)
    return made


def good_stats(**changes):
    return dict({"steps": 600, "dt": 1 / 60, "kinetic_energy_j": 0.0, "potential_energy_j": 100.0,
                 "energy_gained_j": 0.0, "greatest_kinetic_energy_j": 100.0, "bodies_awake": 0,
                 "max_overlap_m": 1e-4, "ms_per_step": {"p99": 1.0, "greatest": 2.0},
                 "dials": {"substeps": "4"}}, **changes)


BEFORE = {"kinetic_energy_j": 0.0, "potential_energy_j": 200.0}


def told(made=None, code=0, bodies=None, timed_out=False, timed=True, held=None, **changes):
    """The kinds of failures of a run that is good but for these changes."""
    standing = [([0, 0, -1], [0, 0, 0]), ([0, 0, 1], [0, 0, 0])]
    run = judge.Run(code, "", good_stats(**changes), BEFORE,
                    standing if bodies is None else bodies, timed_out, held=held)
    return [line.split(":")[0] for line in judge.failures(made or box_on_floor(), run, timed)]


class Judge(unittest.TestCase):
    def test_finds_nothing_where_all_is_well(self):
        self.assertEqual(told(), [])

    def test_sees_how_a_run_ended(self):
        self.assertEqual(told(timed_out=True), ["hang"])
        self.assertEqual(told(code=-11), ["crash"])
        self.assertEqual(told(code=1), ["quarantine"])
        self.assertEqual(told(code=2), ["refusal"])
        self.assertEqual(told(code=3), ["fault"])
        self.assertEqual(told(bodies=[]), ["output"])

    def test_sees_what_is_not_finite_or_below_the_floor(self):
        lost = [([0, 0, -1], [0, 0, 0]), ([math.nan, 0, 1], [0, 0, 0])]
        self.assertIn("finite", told(bodies=lost))
        through = [([0, 0, -1], [0, 0, 0]), ([0, 0, -0.1], [0, 0, 0])]
        self.assertEqual(told(bodies=through), ["floor"])
        sprung = {"throng": 1, "settings": {}, "bodies": [{}, {"name": "b1"}],
                  "springs": [{"a": "b1", "b": None}]}
        self.assertEqual(told(box_on_floor(scene=sprung), bodies=through), ["floor"])
        self.assertEqual(told(box_on_floor(scene=sprung, has_rim=True), bodies=through), [])

    def test_sees_energy_that_nothing_gave(self):
        self.assertEqual(told(energy_gained_j=2.0), ["energy"])
        self.assertEqual(told(potential_energy_j=205.0), ["energy net"])
        self.assertEqual(told(box_on_floor(driven=True), potential_energy_j=205.0), [])

    def test_takes_the_half_substep_between_velocity_and_place_for_no_gain(self):
        # 1000 kg at 1 m/s: g h v m / 2 is 20.4 J.
        flying = {"kinetic_energy_j": 500.0, "greatest_kinetic_energy_j": 500.0}
        made = box_on_floor(rests_by=math.inf)
        self.assertEqual(told(made, potential_energy_j=-277.0, **flying), [])
        self.assertEqual(told(made, potential_energy_j=-270.0, **flying), ["energy net"])

    def test_takes_what_contacts_hold_and_what_is_lifted_apart_for_no_gain(self):
        self.assertEqual(told(energy_gained_j=40.0, max_overlap_m=0.01), [])
        self.assertEqual(told(energy_gained_j=150.0, max_overlap_m=0.01), ["energy"])
        # They gave it back since.
        then = {"max_overlap_m": 0.01}
        self.assertEqual(told(held=then, energy_gained_j=40.0), [])
        self.assertEqual(told(held=then, energy_gained_j=150.0), ["energy"])
        self.assertEqual(told(held={"max_overlap_m": 10.0}, energy_gained_j=1000.0), ["energy"])
        deep = {"energy_gained_j": 1000.0, "max_overlap_m": 0.25}
        soft = box_on_floor()
        soft.scene["settings"]["response"] = "penalty"
        self.assertEqual(told(soft, **deep), [])
        self.assertEqual(told(**deep), ["energy", "overlap"])
        rigid = {"throng": 1, "settings": {"overlap": "subdivide"}, "bodies": [{}, {}]}
        tower = {"scene": rigid, "classes": {"layout stack"}, "mass_of": [1000.0] * 3,
                 "pieces": [None] + [maker.box_of([1, 1, 1])] * 3}
        held = [([0, 0, -1], [0, 0, 0])] + [([0, 0, 1], [0, 0, 0])] * 3
        made = box_on_floor(**tower)
        made.scene["bodies"] = [{}] * 4
        self.assertEqual(told(made, bodies=held, energy_gained_j=6.0), [])
        self.assertEqual(told(made, bodies=held, energy_gained_j=8.0), ["energy"])

    def test_sees_energy_lost_where_nothing_takes_any(self):
        self.assertEqual(told(box_on_floor(kept=True)), ["energy kept"])
        self.assertEqual(told(box_on_floor(kept=True), potential_energy_j=199.0), [])

    def test_sees_who_does_not_come_to_rest(self):
        moving = {"kinetic_energy_j": 1.0, "bodies_awake": 1}
        self.assertEqual(told(**moving), ["rest"])
        self.assertEqual(told(box_on_floor(rests_by=math.inf), **moving), [])

    def test_sees_deep_overlap_and_long_steps(self):
        self.assertEqual(told(max_overlap_m=0.2), ["overlap"])
        for long in ({"p99": 1.0, "greatest": 2000.0}, {"p99": 100.0, "greatest": 200.0}):
            self.assertEqual(told(ms_per_step=long), ["slow"])
            self.assertEqual(told(box_on_floor(slow=True), ms_per_step=long), [])

    def test_has_no_verdict_on_time_where_none_is_asked_for(self):
        long = {"p99": 100.0, "greatest": 200.0}
        self.assertEqual(told(timed=False, ms_per_step=long), [])


if __name__ == "__main__":
    unittest.main()
