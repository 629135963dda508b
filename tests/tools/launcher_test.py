"""What the launcher builds for each word of the command: the hard cases only for who asks for one.

    launcher_test.py
"""
import pathlib
import re
import subprocess
import unittest

LAUNCHER = pathlib.Path(__file__).resolve().parents[2] / "throng"
FUNCTION = re.search(r"^build_for\(\) \{.*?^\}", LAUNCHER.read_text(encoding="utf-8"),
                     re.MULTILINE | re.DOTALL)[0]
# The builds, which say who they are; a command that is there, or is not.
STUBS = """set -euo pipefail
build_cases() { echo cases; }
build_bench() { echo bench; }
build_command() { echo command; }
command=$1
shift
build_for "$@"
"""


def built(*words, command="/nowhere"):
    return subprocess.run(["bash", "-c", FUNCTION + "\n" + STUBS, "throng", command, *words],
                          capture_output=True, text=True, check=True).stdout.strip()


class Launcher(unittest.TestCase):
    def test_scenes_do_not_pay_for_the_cases(self):
        for words in (["run", "pile"], ["cost", "stacks:10", "--error", "1e-3"], ["cost", "./H3"],
                      ["cost", "--compare", "A.json", "B.json"], ["cost"], ["explain", "H3"]):
            self.assertEqual(built(*words), "command", words)
        self.assertEqual(built("bench"), "bench")

    def test_who_asks_for_a_case_has_them(self):
        for words in (["cases"], ["cases", "H3"], ["cost", "H3"], ["cost", "--error", "1", "h100"],
                      ["cost", "Pairs", "--within", "2"]):
            self.assertEqual(built(*words), "cases", words)

    def test_help_is_answered_by_the_command_that_is_there(self):
        self.assertEqual(built("cost", "H3", "--help", command="/bin/true"), "")
        self.assertEqual(built("cases", "--help", command="/bin/true"), "cases")

    def test_other_words_after_build_are_refused(self):
        done = subprocess.run([LAUNCHER, "build", "al"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("wanted all", done.stderr)


if __name__ == "__main__":
    unittest.main()
