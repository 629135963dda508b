"""What tools/include_direction.py promises, on small trees made for it, and on the tree itself."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True
import include_direction  # noqa: E402


def complaints_about(files):
    """The complaints about a tree that consists of these files: {path: text}."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for path, text in files.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
        return include_direction.complaints(root)


KERNEL = {"kernels/a.hpp": "#pragma once\n"}
STAGE = {"pipeline/stages.hpp": "#pragma once\n"}


class IncludeDirection(unittest.TestCase):
    def test_this_tree_keeps_the_rules(self):
        self.assertEqual(include_direction.complaints(ROOT), [])

    def test_downwards_is_allowed(self):
        self.assertEqual(complaints_about({**KERNEL, "broadphase/b.cpp": '#include "kernels/a.hpp"'}), [])

    def test_upwards_is_told_with_file_and_line(self):
        found = complaints_about({**STAGE, "kernels/a.cpp": '\n#include "pipeline/stages.hpp"\n'})
        self.assertEqual(len(found), 1)
        self.assertTrue(found[0].startswith("kernels/a.cpp:2: pipeline/stages.hpp"), found)

    def test_sideways_is_told(self):
        tree = {"narrowphase/n.hpp": "#pragma once\n", "broadphase/b.cpp": '#include "narrowphase/n.hpp"'}
        self.assertEqual(len(complaints_about(tree)), 1)

    def test_scenes_stay_before_the_door(self):
        tree = {**STAGE, "pipeline/throng.hpp": "#pragma once\n",
                "scenes/good.cpp": '#include "pipeline/throng.hpp"',
                "scenes/bad.cpp": '#include "pipeline/stages.hpp"'}
        found = complaints_about(tree)
        self.assertEqual([line.split(":")[0] for line in found], ["scenes/bad.cpp"])

    def test_a_library_stays_in_its_file(self):
        tree = {"broadphase/embree_tree.cpp": "#include <embree3/rtcore.h>",
                "kernels/parallel/blocks_tbb.cpp": "#include <tbb/parallel_for.h>"}
        self.assertEqual(complaints_about(tree), [])
        for library in ("embree3/rtcore.h", "tbb/parallel_for.h", "hdf5.h", "gtest/gtest.h", "thread"):
            found = complaints_about({"narrowphase/gjk.cpp": f"#include <{library}>"})
            self.assertEqual(len(found), 1, library)

    def test_a_path_that_does_not_start_at_the_root_is_told(self):
        self.assertEqual(len(complaints_about({**KERNEL, "kernels/b.cpp": '#include "a.hpp"'})), 1)
        self.assertEqual(len(complaints_about({**KERNEL, "apps/b.cpp": '#include "../kernels/a.hpp"'})), 1)

    def test_a_header_without_a_guard_is_told(self):
        self.assertEqual(len(complaints_about({"kernels/a.hpp": "int a;\n"})), 1)


if __name__ == "__main__":
    unittest.main()
