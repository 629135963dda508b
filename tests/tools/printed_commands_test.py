"""Every command that a page prints does what it says: it runs, on less than what is printed.

    printed_commands_test.py THRONG

Scenes get twenty bodies and runs three steps, so that a line which takes minutes as it is printed
is parsed, and run, all the same. What a page prints of answers is held to what the command answers.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True
import printed  # noqa: E402

THRONG = None
PAGES = printed.pages()

# Words of the launcher, with what they would do.
LAUNCHER = {"build", "test", "clean"}
# Cases that take a second at most; others are looked for in the list, and not run: minutes.
CHEAP_CASES = {"H17", "H18", "H23", "H32", "H41", "H77"}
# Words that stand for something of the user's.
PLACEHOLDERS = {"SCENE": "pile:20", "FILE": "out.json", "METHOD": "gjk", "WAY": "voxels",
                "STEPS": "3", "NAME": "pile", "DIAL": "substeps", "VALUE": "2", "COMMAND": "run",
                "N": "3"}
CASE = re.compile(r"H\d+|pairs")
# Options that stand alone; all others have a value behind them.
FLAGS_OF = {"bench": {"--error"}}
FLAGS = {"--schema", "--resume", "--compare", "--text", "--quiet", "--energy", "--help", "--version"}
# Options that are made less: at most so much, and added where they are not there.
LESS = {"run": {"--steps": 3}, "explain": {}, "scene": {}, "cases": {},
        "cost": {"--windows": 2, "--seconds": 1},
        "bench": {"--steps": 3, "--sizes": 20, "--repeat": 1, "--max-seconds": 5}}
CAPPED = {"--steps": 3, "--max-seconds": 5}
MOST_BODIES = 20

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def answered(words, folder=None, code=0):
    done = subprocess.run([THRONG, *words], capture_output=True, text=True, cwd=folder, timeout=300,
                          env={"PATH": "/usr/bin:/bin", "XDG_CACHE_HOME": CACHE.name})
    if done.returncode != code:
        raise AssertionError(f"throng {' '.join(words)}\n"
                             f"leaves with {done.returncode}\n{done.stderr}")
    return done.stdout


def helps(word):
    if word not in helps.known:
        helps.known[word] = answered([word, "--help"])
    return helps.known[word]


helps.known = {}


def options_of(word):
    return set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", helps(word)))


def filled(word):
    """A word with something for each placeholder in it."""
    names = "|".join(PLACEHOLDERS)
    return re.sub(rf"\b({names})\b(?!\.obj)", lambda name: PLACEHOLDERS[name[0]], word)


def smaller(words):
    """The same command on less."""
    command, less = words[0], dict(LESS[words[0]])
    if command == "cost" and ("--compare" in words or CASE.fullmatch(words[1])):
        less = {}  # nothing is cut into windows
    out, rest = [command], list(words[1:])
    while rest:
        word = rest.pop(0)
        if word.startswith("--"):
            out.append(word)
            if word not in FLAGS and word not in FLAGS_OF.get(command, ()):
                value = rest.pop(0)
                if word in less or word in CAPPED:
                    most = less.pop(word, CAPPED.get(word))
                    value = ",".join(str(min(int(one), most)) for one in value.split(","))
                if word == "--peers":
                    value = "none"  # they may not be installed here
                out.append(value)
            continue
        scene = re.fullmatch(r"(\w+):(\d+)", word)
        if scene:
            word = f"{scene[1]}:{min(int(scene[2]), MOST_BODIES)}"
        elif word.isdigit():
            word = str(min(int(word), MOST_BODIES))
        out.append(word)
    for option, most in less.items():
        out += [option, str(most)]
    return out


class PrintedCommands(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        for name in ("FILE.obj", "bunny.obj"):
            (pathlib.Path(self.folder.name) / name).write_text(TETRAHEDRON)

    def tearDown(self):
        self.folder.cleanup()

    def write_reports(self, names):
        answered(["cost", "stacks:10", "--windows", "2", "--seconds", "1", "--dials", "none",
                  "--out", "made"], self.folder.name)
        folder = pathlib.Path(self.folder.name)
        for name in names:
            (folder / name).write_text((folder / "made" / "cost.json").read_text())

    def all_commands(self):
        for path, text in PAGES.items():
            for words in printed.commands(text):
                if words and words != ["..."]:
                    yield path.relative_to(ROOT), words

    def test_there_are_some(self):
        self.assertGreater(len(list(self.all_commands())), 20)

    def test_words_and_options_are_there(self):
        launcher = (ROOT / "throng").read_text(encoding="utf-8")
        known = set(re.findall(r"^  (\w+) ", answered(["--help"]), re.MULTILINE))
        for page, words in self.all_commands():
            with self.subTest(page=str(page), command=" ".join(words)):
                if words[0] in LAUNCHER:
                    self.assertIn(f"./throng {words[0]} ", launcher)
                    continue
                if words[0].startswith("--") or words[0] == "help":
                    continue
                self.assertIn(words[0], known)
                for word in words[1:]:
                    if word.startswith("--"):
                        self.assertIn(word, options_of(words[0]))

    def test_scenes_cases_and_dials_are_there(self):
        scenes = set(re.findall(r"^(\w+) ", answered(["scene"]), re.MULTILINE)) - {"name"}
        cases = set(re.findall(r"^  (H\d+|pairs) ", helps("cases"), re.MULTILINE))
        dials = set(re.findall(r"^  (\w+)  ", helps("run"), re.MULTILINE))
        for page, words in self.all_commands():
            with self.subTest(page=str(page), command=" ".join(words)):
                for before, word in zip(words, words[1:]):
                    scene = re.fullmatch(r"(\w+):\d+", word)
                    if scene:
                        self.assertIn(scene[1], scenes)
                    if before in ("--set", "--vary"):
                        self.assertIn(filled(word).split("=")[0], dials)
                    if words[0] in ("cases", "cost") and CASE.fullmatch(word):
                        self.assertIn(word, cases)

    def test_each_runs(self):
        done = set()
        for path, text in PAGES.items():
            # What a page writes with one command it may read with the next.
            for name, content in printed.files(text).items():
                (pathlib.Path(self.folder.name) / name).write_text(content, encoding="utf-8")
            for words in printed.commands(text):
                if not words or words == ["..."] or words[0] in LAUNCHER:
                    continue
                if words[0] == "help" or words[0].startswith("--"):
                    answered([filled(word) for word in words])
                    continue
                if words[0] == "cases" and words[1:] != ["--help"] \
                        and not (words[1:] and set(words[1:]) <= CHEAP_CASES):
                    continue  # minutes
                short = smaller([filled(word) for word in words])
                if tuple(short) in done:
                    continue
                done.add(tuple(short))
                if "--compare" in short:
                    self.write_reports(word for word in short if word.endswith(".json"))
                with self.subTest(page=str(path.relative_to(ROOT)), command=" ".join(words)):
                    answered(short, self.folder.name)
        self.assertGreater(len(done), 15)

    def test_printed_answers_are_what_it_answers(self):
        found = 0
        for path, text in PAGES.items():
            found += len(printed.ANSWER.findall(text))
            with self.subTest(page=str(path.relative_to(ROOT))):
                self.assertEqual(text, printed.made_anew(text, THRONG),
                                 "run tools/printed.py with the built command")
        self.assertGreaterEqual(found, 3)

    def test_defaults_of_dials_are_those_of_the_command(self):
        page = (ROOT / "docs/scene.md").read_text(encoding="utf-8")
        page = page.split("\n## ")[2]
        told = dict(re.findall(r"^\| `(\w+)` \| [^|]* \| [^|]* \| `([^`]*)` \|", page,
                               re.MULTILINE))
        entries = re.split(r"\n  (?=\w)", helps("run").split("\ndials")[1])[1:]
        self.assertGreater(len(entries), 30)
        for entry in entries:
            name, text = entry.split(maxsplit=1)
            default = re.search(r"\(default ([^)]*)\)", " ".join(text.split()))[1]
            try:
                self.assertEqual(float(default), float(told[name]), name)
            except ValueError:
                self.assertEqual(default, told[name], name)


CACHE = tempfile.TemporaryDirectory()

if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    THRONG = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
