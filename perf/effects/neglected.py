#!/usr/bin/env python3
"""What effects=auto leaves out of each scene of the catalogue, and of slow tops.

    perf/effects/neglected.py [PROGRAM] [SCENE...]

Runs PROGRAM explain, build/release/apps/throng by default, on one thread over 60 steps, and prints a
table: of whom the last step left something out, the greatest bound of one, what of a step's time it
saved, how far off bodies were for it in 0.1 s (root of the mean square), how far apart the last
digits alone take them, and what was promised beyond that. Ends with 1 where a promise was not kept.
"""

import json
import os
import random
import subprocess
import sys
import tempfile

TOPS = 5000


def slow_tops():
    """Boxes 1:2:3 in flight, each with a spin of 0.2 to 0.8 rad/s about an axis of its own."""
    draw = random.Random(1)
    bodies = []
    for i in range(TOPS):
        axis = [draw.gauss(0, 1) for _ in range(3)]
        size = sum(x * x for x in axis) ** 0.5
        spin = draw.uniform(0.2, 0.8) / size
        bodies.append({"shape": "top", "position": [5 * (i % 100), 5 * (i // 100), 0],
                       "angular_velocity": [spin * x for x in axis]})
    return {"throng": 1, "gravity": [0, 0, 0], "shapes": {"top": {"box": {"half_extents": [0.5, 1, 1.5]}}},
            "bodies": bodies}


def row(program, name, scene, folder):
    path = os.path.join(folder, "explain.json")
    subprocess.run([program, "explain", scene, "--set", "effects=auto", "--steps", "60", "--threads", "1",
                    "--json", path], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(path, encoding="utf-8") as file:
        told = json.load(file)
    report = told["neglected"]
    left = {entry["effect"]: entry for entry in told["effect_ledger"] if entry["neglected"] > 0}
    what = ", ".join(f"{effect} {entry['neglected']:,} of {entry['callers']:,}"
                     if effect == "gyroscopic" else f"{effect} in {entry['neglected']:,} contacts"
                     for effect, entry in left.items())
    bound = max((entry["bound"] for entry in left.values()), default=0)
    saved = 100 * (1 - report["ms_per_step"] / report["ms_per_step_called"])
    print(f"| {name} | {what or 'nothing'} | {bound:.2g} | {saved:.1f} | {report['drift_m']:.2g} m, "
          f"{report['turn_rad']:.2g} rad | {report['last_digits_m']:.2g} m, "
          f"{report['last_digits_rad']:.2g} rad | {report['promised_m']:.2g} m |"
          + ("" if report["kept"] else " **not kept**"), flush=True)
    return report["kept"]


def main():
    words = sys.argv[1:]
    program = words.pop(0) if words and os.path.exists(words[0]) else "build/release/apps/throng"
    names = words
    if not names:
        listed = subprocess.run([program, "scene"], capture_output=True, text=True, check=True).stdout
        names = [line.split()[0] for line in listed.splitlines()[1:]] + ["slow tops"]
    print("| scene | left out in the last step | bound | time saved, % | off after 0.1 s | last digits | "
          "promised |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        tops = os.path.join(folder, "tops.json")
        with open(tops, "w", encoding="utf-8") as file:
            json.dump(slow_tops(), file)
        kept = [row(program, name, tops if name == "slow tops" else name, folder) for name in names]
    sys.exit(0 if all(kept) else 1)


if __name__ == "__main__":
    main()
