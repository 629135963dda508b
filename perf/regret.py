#!/usr/bin/env python3
"""Regret: whether what `throng cost` recommends is nearly the cheapest that there is, and how far
the default dials are from the front, on ten scenes of the catalogue.

    perf/regret.py [--throng COMMAND] [--folder FOLDER] [--scenes A,B] [--docs]

Of each scene: `throng cost` for an error and for a time in the middle of the front of dt and
substeps; then all of a product of dials, measured whole on the same windows; then the cheapest of
both, timed in turn. What was measured is kept in the folder (build/regret): a run that was
interrupted goes on from there, and another build begins with another folder. Prints both tables;
--docs puts them into docs/ and the sweep into perf/regret.csv. An hour and a half on one core;
times are of one thread.
"""
import csv
import itertools
import math
import statistics
import sys

sys.dont_write_bytecode = True
from cost_runs import ROOT, Runs, figure, options_of, put_table, table  # noqa: E402

SCENES = ("spring:1", "card_house:2", "pile:50", "stacks:50", "spheres:50", "hulls:50",
          "tumbler:50", "wall:50", "pyramid:50", "crowd:50")
WINDOWS = ("--threads", 1, "--windows", 12)
# Of what is as exact as wanted, so many of the cheapest are timed in turn with what is recommended.
NEAR = 5
TIMED = 2  # so many times, each by seven rounds
MOST_OF_FRONT = 7  # settings that are printed of each

STEPS = [("dt", ("1/30", "", "1/120", "1/240")), ("substeps", ("1", "2", "", "8", "16"))]
PRECISION = ("precision", ("", "double"))
CONTACT = [[("iterations", ("", "2", "4")), ("relax_iterations", ("", "2")),
            ("escalation", ("", "off")), ("contact_rate", ("", "0.4"))],
           [("solver", ("pgs",)), ("iterations", ("5", "", "60"))],
           [("solver", ("direct",))]]
FLIGHT = [[("integrator", ("", "euler", "semi_implicit", "midpoint", "rk4"))]]


def product(scene):
    """Every combination; of a value that is left empty the dial stays as it is."""
    settings = []
    for method in FLIGHT if scene.startswith("spring:") else CONTACT:
        dials = [*STEPS, *method, PRECISION]
        for values in itertools.product(*(choices for _, choices in dials)):
            words = [f"{dial}={value}" for (dial, _), value in zip(dials, values) if value]
            settings.append(" ".join(words))
    return [setting for setting in settings if setting]


def same(setting):
    """A key of what is the same in another order of words."""
    return frozenset(setting.split())


def union(*lists):
    """Of all, each once; the scene as it is goes without saying."""
    found = {same(setting): setting for setting in reversed([x for each in lists for x in each])}
    found.pop(frozenset(), None)
    return list(reversed(found.values()))


def middle(values, digits):
    """Geometric, of the ends."""
    return figure(math.sqrt(min(values) * max(values)), digits)


class Wish:
    """What was asked for, what was recommended, and what else is as exact."""

    def __init__(self, text, setting, limit, near):
        self.text, self.setting, self.limit, self.near = text, setting, limit, near
        self.ratios, self.times, self.best = [], [], []


class Scene:
    def __init__(self, runs, name):
        self.name = name
        folder = name.replace(":", "-")
        look = runs.cost(f"{folder}/look", name, "--dials", "dt,substeps", "--minutes", 1, *WINDOWS)
        front = [each for each in look.points if each.on_front]
        self.error = middle([each.at_most for each in front], 1)
        self.time = middle([each.time for each in front], 2)
        asked = [("--error", self.error), ("--within", self.time)]
        told = [runs.cost(f"{folder}/{wish[0].strip('-')}", name, *wish, "--minutes", 2, *WINDOWS)
                for wish in asked]
        self.sweep = runs.cost(f"{folder}/sweep", name, "--error", self.error, "--minutes", 6,
                               *WINDOWS, settings=union(product(name)))
        self.machine = self.sweep.machine
        self.measured = sum(each.whole for each in self.sweep.points)
        # Those of the product first: what is in both has the sweep's figures.
        self.points = {}
        for report in (self.sweep, *told):
            for each in report.points:
                if each.whole:
                    self.points.setdefault(same(each.setting), each)
        self.wishes = []
        for wish, report in zip(asked, told):
            setting = report.advised.setting
            limit = self.points.get(same(setting), report.advised).at_most
            if wish[0] == "--error":
                limit = max(limit, float(self.error))
            text = f"`{wish[0]} {wish[1]}`" + ("" if report.meets else ", not met")
            self.wishes.append(Wish(text, setting, limit, self.cheapest(limit)))
        own = self.points[frozenset()]
        self.default = Wish("default", "", own.at_most, self.cheapest(own.at_most))
        listed = union(*([each.setting, *each.near] for each in self.all_wishes()))
        for k in range(TIMED):
            timed = runs.cost(f"{folder}/timed-{k}", name, "--error", self.error, "--minutes", 1,
                              *WINDOWS, settings=listed)
            for each in self.all_wishes():
                self.compare(each, timed)

    def all_wishes(self):
        return [*self.wishes, self.default]

    def cheapest(self, limit):
        """Settings that are as exact, cheapest first by the sweep's times."""
        fit = [each for each in self.points.values() if each.at_most <= limit]
        return [each.setting for each in sorted(fit, key=lambda each: each.time)[:NEAR]]

    @staticmethod
    def compare(wish, timed):
        time_of = {same(each.setting): each.time for each in timed.points if each.whole}
        own = time_of[same(wish.setting)]
        best = min([wish.setting, *wish.near], key=lambda each: time_of.get(same(each), math.inf))
        wish.times.append(own)
        wish.best.append((time_of[same(best)], best))
        wish.ratios.append(own / time_of[same(best)])


def words(setting):
    return f"`{setting}`" if setting else "the scene as it is"


def best_of(wish):
    """That of the run whose ratio is the middle one, so that a row is of one run."""
    at = wish.ratios.index(statistics.median_low(wish.ratios))
    return wish.times[at], *wish.best[at], wish.ratios[at]


def regret_table(scenes):
    rows = []
    for scene in scenes:
        for wish in scene.wishes:
            own, least, best, ratio = best_of(wish)
            rows.append([f"`{scene.name}`", wish.text, words(wish.setting), figure(own),
                         words(best) if best != wish.setting else "the same", figure(least),
                         f"{ratio:.2f}", f"{scene.measured} of {len(scene.sweep.points)}"])
    return table(["scene", "wish", "recommended", "ms", "the cheapest as exact", "ms", "regret",
                  "of the product"], rows)


def default_table(scenes):
    rows = []
    for scene in scenes:
        own, least, best, ratio = best_of(scene.default)
        point = scene.points[frozenset()]
        rows.append([f"`{scene.name}`", figure(point.error), figure(point.at_most), figure(own),
                     words(best), figure(least), f"{ratio:.2f}"])
    return table(["scene", "error, m", "at most, m", "ms", "the cheapest as exact", "ms", "ratio"],
                 rows)


def front_of(scene):
    """Of all that was measured: each more exact than all that are faster."""
    front = []
    for point in sorted(scene.points.values(), key=lambda each: (each.time, each.at_most)):
        if not front or point.at_most < front[-1].at_most:
            front.append(point)
    return front


def thinned(front):
    """The ends, and of what lies between them one for each equal step of the logarithm of time."""
    if len(front) <= MOST_OF_FRONT:
        return front
    least, span = front[0].time, math.log(front[-1].time / front[0].time)
    wanted = [least * math.exp(span * k / (MOST_OF_FRONT - 1)) for k in range(MOST_OF_FRONT)]
    kept = [min(front, key=lambda each: abs(math.log(each.time / time))) for time in wanted]
    return [each for each in front if each in kept]


def fronts_table(scenes):
    """A row a scene, fastest first, and among them the scene as it is, on the front or not."""
    rows = []
    for scene in scenes:
        own = scene.points[frozenset()]
        front = front_of(scene)
        told = sorted({id(each): each for each in [*thinned(front), own]}.values(),
                      key=lambda each: each.time)
        texts = [f"{figure(each.time)}: {figure(each.at_most)}" for each in told]
        texts = [f"**{text}**" if each is own else text for text, each in zip(texts, told)]
        rows.append([f"`{scene.name}`", "; ".join(texts), "yes" if own in front else "no"])
    return table(["scene", "ms: at most, m", "default on the front"], rows)


def write_sweep(scenes, path):
    """A row a setting; of each scene error at most and time, empty where it was not tried."""
    keys = {}
    for scene in scenes:
        for key, point in scene.points.items():
            keys.setdefault(key, point.setting)
    machine = scenes[0].machine
    with open(path, "w", newline="", encoding="utf-8") as file:
        file.write(f"# perf/regret.py --docs, {machine['processor']}, 1 thread of "
                   f"{machine['cores']} cores, throng {machine['throng']}\n")
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["setting", *(f"{scene.name} {what}" for scene in scenes
                                   for what in ("at_most_m", "ms"))])
        for key, setting in keys.items():
            row = [setting]
            for scene in scenes:
                point = scene.points.get(key)
                row += [figure(point.at_most, 3), figure(point.time, 3)] if point else ["", ""]
            out.writerow(row)


def main():
    asked = options_of(__doc__, "regret", SCENES).parse_args()
    runs = Runs(asked.throng, asked.folder)
    scenes = [Scene(runs, name) for name in asked.scenes.split(",")]
    tables = {"performance.md": regret_table(scenes),
              "accuracy.md": default_table(scenes) + "\n" + fronts_table(scenes)}
    for page, text in tables.items():
        print("\n" + text, end="")
        if asked.docs:
            put_table(page, "perf/regret.py", text)
    if asked.docs:
        write_sweep(scenes, ROOT / "perf/regret.csv")


if __name__ == "__main__":
    main()
