"""Functions of effects: none is entered in a scene that does not call for them.

    ownership_test.py THRONG

Reads the table of docs/effects.md, runs scenes under callgrind, and looks at who was entered. Ends
with 77, which counts as skipped, where there is no valgrind.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parents[2]
STEPS = 4

FORCED = {
    "throng": 1,
    "materials": {"rubber": {"restitution": 0.5, "rolling_friction": 0.01}},
    "shapes": {"floor": {"plane": {"normal": [0, 0, 1], "offset": 0}},
               "box": {"box": {"half_extents": [0.2, 0.2, 0.2]}}},
    "bodies": [{"shape": "floor", "motion": "static"},
               {"name": "top", "shape": "box", "material": "rubber",
                "position": [0, 0, 0.2]}],
}


# What `run` is asked for besides, by which a program's effects are on.
LISTENS = "--events"


def forced(**of_body):
    scene = json.loads(json.dumps(FORCED))
    top = {key: of_body.pop(key) for key in ("springs", "attractors", "wind") if key in of_body}
    scene["bodies"][1].update(of_body)
    scene.update(top)
    return scene


def sensed():
    scene = forced()
    scene["bodies"].append({"shape": "box", "motion": "static", "sensor": True, "position": [0, 0, 0.3]})
    return scene


# A scene of the catalogue or of our own, its steps, and dials.
SCENES = [
    ("pile:8", STEPS, []), ("spheres:8", STEPS, []), ("sparse:8", STEPS, []),
    ("tumbler:6", STEPS, []), ("crowd:6", STEPS, []), ("meshes:4", STEPS, []),
    ("knots:2", STEPS, []), ("knots:2", STEPS, ["nonconvex=spheres"]),
    ("knots:2", STEPS, ["nonconvex=depth_image"]), ("spring:2", STEPS, []),
    ("bouncing:4", STEPS, []), ("rolling:4", STEPS, []), ("bullet_plate:3", STEPS, []),
    ("cradle:3", STEPS, []), ("spheres:4", STEPS, ["overlap=back_up"]),
    ("spheres:4", STEPS, ["overlap=subdivide"]), ("pile:8", STEPS, ["sleep=off"]), ("pile:8", STEPS, ["partial_rest=on"]),
    ("pile:8", STEPS, ["gyroscopic=off"]), ("pile:8", STEPS, ["precision=double"]),
    (forced(), STEPS, []),
    (forced(force=[0.1, 0, 0]), STEPS, []),
    (forced(drag={"linear": 0.1, "angular": 0.01}, wind=[1, 0, 0]), STEPS, []),
    (forced(pivot=[0.2, 0.2, 0.2]), STEPS, []),
    (forced(attractors=[{"position": [0, 0, 9], "strength": 1}]), STEPS, []),
    (forced(springs=[{"a": "top", "b": None, "at_b": [0, 0, 1], "stiffness": 1e6,
                      "length": 0.5}]), STEPS, []),
    ("stacks:30", 90, ["substeps=1"]), ("bouncing:4", 40, [LISTENS]),
    (sensed(), STEPS, [LISTENS]),
]


def table():
    rows = []
    for line in (ROOT / "docs/effects.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("| ") or len(cells) != 3:
            continue
        functions = re.findall(r"`([^`]*[(<])`", cells[2])
        effects = set(cells[0].split(", "))
        if "with the other forces" in cells[2]:
            effects |= {"springs", "attractors", "wind", "drag", "pivot"}
        if "with a program's field" in cells[2]:
            effects |= {"forces"}
        rows += [(function, effects) for function in functions]
    return rows


class Run:
    """Which effects were on, as it began or ended, and which functions were entered."""

    def __init__(self, throng, scene, steps, dials, folder):
        name = scene
        if isinstance(scene, dict):
            name = str(folder / "scene.json")
            pathlib.Path(name).write_text(json.dumps(scene))
        self.name = " ".join([name if isinstance(scene, str) else json.dumps(scene)] + dials)
        listens = ["--events", str(folder / "events.csv")] if LISTENS in dials else []
        sets = [word for dial in dials if dial != LISTENS for word in ("--set", dial)]
        told, stats, counts = folder / "explain", folder / "stats", folder / "callgrind"
        subprocess.run([throng, "explain", name, "--json", told] + sets, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={counts}", throng,
                        "run", name, "--steps", str(steps), "--threads", "1", "--quiet", "--stats",
                        stats] + listens + sets,
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                       env=dict(os.environ, THRONG_LANES="avx2"))
        self.on = set()
        for path in (told, stats):
            self.on |= {entry["effect"] for entry in json.loads(path.read_text())["effect_ledger"]
                        if entry["on"]}
        if json.loads(stats.read_text())["islands_escalated"] > 0:
            self.on.add("escalation")  # for a while
        self.entered = set(re.findall(r"^c?fn=\(\d+\) (.*)$", counts.read_text(), re.M))


def main():
    if shutil.which("valgrind") is None:
        print("skipped: there is no valgrind")
        return 77
    rows = table()
    with tempfile.TemporaryDirectory() as top, ThreadPoolExecutor(os.cpu_count()) as pool:
        folders = [pathlib.Path(top) / str(i) for i in range(len(SCENES))]
        for folder in folders:
            folder.mkdir()
        runs = list(pool.map(lambda scene, folder: Run(sys.argv[1], *scene, folder), SCENES,
                             folders))
    failures, checks = [], 0
    for function, effects in rows:
        met = False
        for run in runs:
            entered = [name for name in run.entered if function in name]
            checks += 1
            if entered and not run.on & effects:
                failures.append(f"{run.name}: none of {sorted(effects)} is on, and it entered "
                                f"{entered[0]}")
            met = met or bool(entered)
        if not met:
            failures.append(f"no scene enters {function}, of {sorted(effects)}")
    print("\n".join(failures))
    print(f"{len(rows)} functions, {len(runs)} scenes, {checks} looks, {len(failures)} failed")
    return 1 if failures else 0


sys.exit(main())
