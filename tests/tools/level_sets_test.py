"""The command has the library for level sets built when a scene first has voxels, and not before.

    level_sets_test.py THRONG LIBTHRONG_COOKING
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

THRONG, LIBRARY = pathlib.Path(), pathlib.Path()
# Stands in for the launcher: notes what it is asked for, says so, and does it or fails.
LAUNCHER = """#!/bin/sh
echo "$*" >> "{folder}/asked"
echo "building"
{does}
"""
VOXELS = ["run", "knots:2", "--set", "nonconvex=voxels", "--steps", "2"]


class LevelSets(unittest.TestCase):
    def setUp(self):
        # A command with no library beside it.
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "apps").mkdir()
        (self.folder / "lib").mkdir()
        shutil.copy(THRONG, self.folder / "apps")

    def run_throng(self, words, does=None):
        environment = {"PATH": "/usr/bin:/bin", "XDG_CACHE_HOME": str(self.folder / "cache")}
        if does is not None:
            launcher = self.folder / "launcher"
            launcher.write_text(LAUNCHER.format(folder=self.folder, does=does), encoding="utf-8")
            launcher.chmod(0o755)
            environment["THRONG_LAUNCHER"] = str(launcher)
        return subprocess.run([self.folder / "apps" / THRONG.name, *words], capture_output=True,
                              text=True, timeout=120, env=environment)

    def asked(self):
        file = self.folder / "asked"
        return file.read_text(encoding="utf-8").splitlines() if file.exists() else []

    def test_voxels_have_it_built_once(self):
        done = self.run_throng(VOXELS, does=f"cp '{LIBRARY}' '{self.folder}/lib'")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.asked(), ["build level-sets"])
        # What the launcher says is no part of the output.
        self.assertNotIn("building", done.stdout)
        self.assertIn("building", done.stderr)
        again = self.run_throng(VOXELS, does="exit 1")
        self.assertEqual(again.stdout.splitlines()[-1], done.stdout.splitlines()[-1])
        self.assertEqual(len(self.asked()), 1)

    def test_other_scenes_do_not(self):
        done = self.run_throng(["run", "pile:5", "--steps", "2"], does="exit 1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.asked(), [])

    def test_what_cannot_be_built_is_refused(self):
        for does in (None, "exit 3", "exit 0"):
            done = self.run_throng(VOXELS, does=does)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("libthrong_cooking.so", done.stderr)


if __name__ == "__main__":
    THRONG, LIBRARY = map(pathlib.Path, sys.argv[1:])
    unittest.main(argv=sys.argv[:1])
