#!/usr/bin/env python3
"""Prices of effects: what a body takes in a step that calls for one.

    perf/effects/prices.py [PROGRAM] [EFFECT...]

Runs build/perf/perf/effect_prices, or PROGRAM, with nobody, 1, 10 and 100 % of 10,000 bodies calling
for an effect, under valgrind for instructions (those of AVX2, the same on every machine) and by
itself for time, and prints a table. A price is what a step takes beyond that with nobody calling,
over the callers; `fixed` what the line through the first two leaves at no callers, as a share of the
step; `scattered` the price where 1 % call, one in a hundred bodies instead of side by side.
"""

import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

EFFECTS = ["contact", "rotation", "gyroscopic", "friction", "rolling_friction", "restitution",
           "fast_motion", "forces", "drive", "drag", "springs", "pivot", "seams", "mesh_contact",
           "voxel_contact", "sphere_contact", "image_contact"]
BODIES, STEPS, FEW, SOME = 10_000, 2, 100, 1_000


def instructions(program, effect, callers, every):
    run = subprocess.run(
        ["valgrind", "--tool=callgrind", "--collect-atstart=no", "--callgrind-out-file=/dev/null",
         program, effect, str(callers), str(every)],
        capture_output=True, text=True, env=dict(os.environ, THRONG_LANES="avx2"), check=True)
    return int(re.search(r"Collected : (\d+)", run.stderr).group(1)) / STEPS


def step_ns(program, effect, callers):
    runs = [subprocess.run([program, effect, str(callers)], capture_output=True, text=True,
                           check=True).stdout for _ in range(5)]
    return min(float(run.split()[0]) for run in runs)


def row(effect, base, few, some, everybody, scattered, ns):
    price = [(few - base) / FEW, (some - base) / SOME, (everybody - base) / BODIES]
    fixed = (few - base) - FEW * (some - few) / (SOME - FEW)
    return (f"| {effect.replace('_', ' ')} | {base / 1e6:.1f} | " +
            " | ".join(f"{p:,.0f}" for p in price) +
            f" | {(scattered - base) / FEW:,.0f} | {100 * fixed / base:.2f} | {ns:.0f} |")


def main():
    words = sys.argv[1:]
    program = words.pop(0) if words and os.path.exists(words[0]) else "build/perf/perf/effect_prices"
    effects = words or EFFECTS
    print("| effect | step, nobody calls, M instructions | a caller: 1 % | 10 % | 100 % | scattered "
          "1 % | fixed, % of the step | ns a caller |")
    print("|---|---|---|---|---|---|---|---|")
    asked = [(0, 1), (FEW, 1), (SOME, 1), (BODIES, 1), (FEW, BODIES // FEW)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = {effect: [pool.submit(instructions, program, effect, *one) for one in asked]
                for effect in effects}
        counts = {effect: [job.result() for job in jobs[effect]] for effect in effects}
    for effect in effects:  # alone, once the processors are idle
        ns = (step_ns(program, effect, BODIES) - step_ns(program, effect, 0)) / BODIES
        print(row(effect, *counts[effect], ns), flush=True)


main()
