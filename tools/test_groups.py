#!/usr/bin/env python3
"""Runs the tests of a build in groups that share a process.

Usage: test_groups.py BUILD [-j JOBS] [-LE LABELS] [-R NAMED] [-E EXCLUDED] [--under SECONDS --times BUILD]
                      [--timeout SECONDS]

CTest starts a program for each test. Under a sanitizer the start alone takes a quarter of a second to a
second, which over the suite is a third of the time. Here what CTest knows of the tests stays the list;
those of one program run some at a time in one process. -LE, -R, -E are CTest's, but by Python's regular
expressions; of a test's properties, its labels and its folder count. --under leaves out what took longer
when CTest last ran the tests of the build that --times names. Prints what a group that failed has
printed and, at the end, which tests took longest and how many ran. Exits 1 when one failed, crashed, took
more than SECONDS (600) with its group, or never reported.
"""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys
import time

GROUP = 12  # tests a process: enough to forget its start, few enough to keep every core busy to the end
LONGEST = 40  # tests told of
FILTER = "--gtest_filter="


def listed(build):
    """What CTest knows of the tests of a build folder."""
    shown = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, check=True, stdout=subprocess.PIPE)
    return json.loads(shown.stdout)["tests"]


def chosen(tests, without_labels=None, named=None, excluded=None):
    """Those of the tests that are asked for."""
    def is_asked_for(test):
        properties = {each["name"]: each["value"] for each in test["properties"]}
        if without_labels and any(re.search(without_labels, each) for each in properties.get("LABELS", [])):
            return False
        if named and not re.search(named, test["name"]):
            return False
        return not (excluded and re.search(excluded, test["name"]))
    return [test for test in tests if is_asked_for(test)]


def took(build):
    """Seconds of each test when CTest last ran those of a build folder."""
    times = {}
    for line in (pathlib.Path(build) / "Testing/Temporary/CTestCostData.txt").read_text().splitlines():
        if line == "---":  # those that failed come after
            break
        name, _, seconds = line.rsplit(" ", 2)
        times[name] = float(seconds)
    return times


def grouped(tests):
    """Commands, each with its folder and the number of its tests: neighbors, which take alike long, are
    dealt to different groups."""
    programs, commands = collections.defaultdict(list), []
    for test in tests:
        command = test.get("command", ["false"])  # what is not built has none
        folder = next((each["value"] for each in test["properties"] if each["name"] == "WORKING_DIRECTORY"), None)
        names = [word[len(FILTER):] for word in command if word.startswith(FILTER)]
        if names:
            rest = tuple(word for word in command if not word.startswith(FILTER))
            programs[rest, folder].append(names[0])
        else:
            commands.append((command, folder, 1))
    for (command, folder), names in programs.items():
        groups = -(-len(names) // GROUP)
        for first in range(groups):
            share = names[first::groups]
            commands.append(([*command, FILTER + ":".join(share)], folder, len(share)))
    return commands


def run(command, folder, count, timeout):
    """Of each test that passed or was skipped its milliseconds and name; what was printed where one did not."""
    start = time.monotonic()
    try:
        done = subprocess.run(command, cwd=folder, timeout=timeout, text=True, errors="replace",
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except subprocess.TimeoutExpired as late:
        printed = late.stdout or b""
        return [], f"{printed.decode(errors='replace')}\nno end within {timeout} s: {' '.join(command)}\n"
    if not any(word.startswith(FILTER) for word in command):
        spent = round(1000 * (time.monotonic() - start))
        return ([(spent, " ".join(command))], "") if done.returncode in (0, 77) else ([], done.stdout)
    told = re.findall(r"^\[  (?:     OK|SKIPPED) \] (\S+).* \((\d+) ms\)$", done.stdout, re.MULTILINE)
    well = [(int(spent), name) for name, spent in told]
    if done.returncode == 0 and len(well) == count:
        return well, ""
    return well, (f"{done.stdout}\nexit {done.returncode}, {len(well)} of {count} tests well: "
                  f"{' '.join(command)}\n")


def main(words):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build")
    parser.add_argument("-j", type=int, default=1, metavar="JOBS")
    parser.add_argument("-LE", metavar="LABELS")
    parser.add_argument("-R", metavar="NAMED")
    parser.add_argument("-E", metavar="EXCLUDED")
    parser.add_argument("--under", type=float, metavar="SECONDS")
    parser.add_argument("--times", metavar="BUILD")
    parser.add_argument("--timeout", type=float, default=600, metavar="SECONDS")
    asked = parser.parse_args(words)

    tests = chosen(listed(asked.build), asked.LE, asked.R, asked.E)
    if asked.under is not None:
        times = took(asked.times)
        tests = [test for test in tests if times.get(test["name"], 0) <= asked.under]
    commands = grouped(tests)
    total = sum(count for _, _, count in commands)
    if not total:
        print("no test is left to run", file=sys.stderr)
        return 1
    start, well, failed = time.monotonic(), [], 0
    with concurrent.futures.ThreadPoolExecutor(asked.j) as pool:
        runs = [pool.submit(run, *command, asked.timeout) for command in commands]
        for done in concurrent.futures.as_completed(runs):
            passed, complaint = done.result()
            well += passed
            if complaint:
                failed += 1
                print(complaint, flush=True)
    print("longest, s: " + ", ".join(f"{name} {spent / 1000:.1f}" for spent, name in sorted(well)[:-LONGEST - 1:-1]))
    print(f"{len(well)} of {total} tests passed or were skipped, in {len(commands)} groups, "
          f"{time.monotonic() - start:.0f} s")
    return 1 if failed or len(well) != total else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
