"""Cost runs: `throng cost`, run for those who judge its answers, each run once.

A run is kept in a folder of its own beside the words it was made by, and taken from there when it
is asked for again, so that what was interrupted goes on where it was.
"""
import argparse
import json
import pathlib
import shlex
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent


class Point:
    """A setting with its figures, in the measure that the report is by.

    error, at_most, time: ms for each 1/60 s; None where there is none or it is beyond all bounds
    repeats: times that the time was taken in turn
    done: there was time to measure it on all that there is, or it cannot be had
    whole: measured so, and finite
    """

    def __init__(self, read, measure, trials):
        self.setting = " ".join(f"{dial}={value}" for dial, value in read["settings"].items())
        self.trouble = read.get("trouble", "")
        self.error = self.at_most = self.time = None
        self.repeats, self.on_front, self.whole = 0, False, False
        self.done = bool(self.trouble) or len(read["squares"]) == trials
        if self.trouble:
            return
        self.error, self.at_most = read["errors"][measure], read["errors_at_most"][measure]
        self.time, self.repeats = read["time_ms"]["median"], read["time_ms"]["repeats"]
        self.on_front = read["on_front"]
        # What is not finite is written as null.
        self.whole = self.done and None not in (self.error, self.at_most, self.time)


class Report:
    """What a run has written."""

    def __init__(self, read):
        self.machine, self.measure = read["machine"], read["measure"]
        self.off = read["reference"]["remaining"]
        trials = read["windows"] if "windows" in read else 1
        self.points = [Point(each, self.measure, trials) for each in read["points"]]
        self.meets = bool(read["advice"]) and read["advice"]["meets"]
        self.advised = self.points[read["advice"]["point"]] if read["advice"] else None
        self.doubts = read["doubts"]

    def of(self, setting):
        """The point of a setting; the scene as it is by the empty one."""
        return next((each for each in self.points if each.setting == setting), None)


class Runs:
    """command: as it is called; folder: where runs are kept."""

    def __init__(self, command, folder):
        self.command = [str(pathlib.Path(command).resolve())]
        self.folder = pathlib.Path(folder)

    def cost(self, name, scene, *options, settings=()):
        """The report of `throng cost SCENE OPTIONS`, kept by this name; by these settings alone
        where there are some."""
        folder = self.folder / name
        folder.mkdir(parents=True, exist_ok=True)
        words = ["cost", scene, *map(str, options)]
        listed = "".join(setting + "\n" for setting in settings)
        made_by = shlex.join(words) + "\n" + listed
        note = folder / "made_by.txt"
        if note.exists() and note.read_text() == made_by:
            return Report(json.loads((folder / "cost.json").read_text()))
        note.unlink(missing_ok=True)
        told = f", {len(settings)} settings" if settings else ""
        print(f"throng {shlex.join(words[1:])}{told}", file=sys.stderr, flush=True)
        if settings:
            (folder / "settings.txt").write_text(listed)
            words += ["--settings", str(folder / "settings.txt")]
        quiet = [] if sys.stderr.isatty() else ["--quiet"]
        begin = time.monotonic()
        done = subprocess.run([*self.command, *words, "--out", str(folder), *quiet],
                              stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"throng {shlex.join(words)}: exit code {done.returncode}")
        (folder / "cost.txt").write_text(done.stdout)
        (folder / "seconds.txt").write_text(f"{time.monotonic() - begin:.1f}")
        note.write_text(made_by)
        return Report(json.loads((folder / "cost.json").read_text()))

    def seconds_of(self, name):
        """Of the clock, that a run took when it was made."""
        return float((self.folder / name / "seconds.txt").read_text())

    def state_of(self, scene, seed):
        """Hash of where a scene is after a step."""
        self.folder.mkdir(parents=True, exist_ok=True)
        stats = self.folder / "stats.json"
        subprocess.run([*self.command, "run", scene, "--seed", str(seed), "--steps", "1", "--quiet",
                        "--stats", str(stats)], stdout=subprocess.DEVNULL, check=True)
        return json.loads(stats.read_text())["state_hash"]


def options_of(description, folder, scenes):
    """What every judge can be told."""
    options = argparse.ArgumentParser(description=description.partition("\n\n")[0])
    options.add_argument("--throng", default=ROOT / "throng",
                         help="the command (default: ./throng)")
    options.add_argument("--folder", default=ROOT / "build" / folder, type=pathlib.Path)
    options.add_argument("--scenes", default=",".join(scenes))
    options.add_argument("--docs", action="store_true",
                         help="puts what is printed where it is kept")
    return options


def figure(number, digits=2):
    """In so many digits; 0.00012 as 1.2e-4 where it is small."""
    if number is None:
        return ""
    text = f"{number:.{digits}g}"
    mantissa, _, exponent = text.partition("e")
    return f"{mantissa}e{int(exponent)}" if exponent else text


def table(head, rows):
    lines = ["| " + " | ".join(row) + " |" for row in (head, ["---"] * len(head), *rows)]
    return "\n".join(lines) + "\n"


def put_table(page, name, text):
    """Into a page of docs, between the comments that say what makes it."""
    path = ROOT / "docs" / page
    begin, end = f"<!-- made by `{name}` -->\n", "<!-- end -->\n"
    before, found, rest = path.read_text(encoding="utf-8").partition(begin)
    _, closed, after = rest.partition(end)
    if not (found and closed):
        sys.exit(f"docs/{page}: there is no place for what is made by {name}")
    path.write_text(before + begin + text + end + after, encoding="utf-8")
