"""What tools/test_groups.py promises, on programs that answer as test programs do."""
import os
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True
import test_groups  # noqa: E402

# Says of each test that it is asked for what its name says.
PROGRAM = """#!/bin/sh
status=0
for name in $(echo "${1#--gtest_filter=}" | tr : ' '); do
    case $name in
    *Fails) echo "[  FAILED  ] $name (0 ms)"; status=1 ;;
    *Crashes) kill -SEGV $$ ;;
    *Hangs) exec sleep 60 ;;
    *Vanishes) ;;
    *Skips) echo "[  SKIPPED ] $name (0 ms)" ;;
    *) echo "[       OK ] $name (0 ms)" ;;
    esac
done
exit $status
"""


def test(name, program="tests", labels=()):
    return {"name": name, "command": [program, "--gtest_filter=" + name],
            "properties": [{"name": "LABELS", "value": list(labels)}]}


class Groups(unittest.TestCase):
    def verdict(self, *names, timeout=20):
        """How many of the tests are well, and what is said of the others."""
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "tests"
            program.write_text(PROGRAM)
            os.chmod(program, 0o755)
            command = [str(program), "--gtest_filter=" + ":".join(names)]
            well, complaint = test_groups.run(command, folder, len(names), timeout)
            return len(well), complaint

    def test_what_passes_and_is_skipped_is_well(self):
        self.assertEqual(self.verdict("A.One", "A.Skips"), (2, ""))

    def test_what_fails_crashes_or_never_reports_is_told(self):
        for name in ("A.Fails", "A.Crashes", "A.Vanishes"):
            well, complaint = self.verdict("A.One", name)
            self.assertEqual(well, 1, name)
            self.assertIn(name, complaint)

    def test_what_hangs_is_told(self):
        well, complaint = self.verdict("A.One", "A.Hangs", timeout=0.5)
        self.assertEqual(well, 0)
        self.assertIn("no end within 0.5 s", complaint)

    def test_times_are_those_of_the_last_run(self):
        with tempfile.TemporaryDirectory() as folder:
            kept = pathlib.Path(folder) / "Testing/Temporary/CTestCostData.txt"
            kept.parent.mkdir(parents=True)
            kept.write_text("A.One 2 0.25\nAll/A.Of # GetParam() = 3 1 1.5\n---\nA.One\n")
            self.assertEqual(test_groups.took(folder), {"A.One": 0.25, "All/A.Of # GetParam() = 3": 1.5})

    def test_every_test_is_in_one_group_and_programs_are_kept_apart(self):
        names = [f"A.{number}" for number in range(40)]
        groups = test_groups.grouped([test(name) for name in names] + [test("B.One", "others")])
        held = [name for command, _, _ in groups for name in command[-1][len(test_groups.FILTER):].split(":")]
        self.assertEqual(sorted(held), sorted(names + ["B.One"]))
        self.assertEqual(sum(count for _, _, count in groups), 41)
        self.assertEqual([command for command, _, _ in groups if command[0] == "others"],
                         [["others", "--gtest_filter=B.One"]])

    def test_choice_is_by_name_and_label(self):
        tests = [test("A.One"), test("A.Two"), test("Slow.One", labels=["slow"])]
        self.assertEqual([each["name"] for each in test_groups.chosen(tests, "slow|tree", "One|Two", "Two")], ["A.One"])


if __name__ == "__main__":
    unittest.main()
