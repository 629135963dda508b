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


ONCE = "#pragma once\n"
KERNEL = {"kernels/a.hpp": ONCE}
STAGE = {"pipeline/step/stages.hpp": ONCE}


def including(*names):
    return ONCE + "".join(f'#include "{name}"\n' for name in names)


class IncludeDirection(unittest.TestCase):
    def told(self, files, path, included):
        """That one thing is told of a tree, which names both files."""
        found = complaints_about(files)
        self.assertEqual(len(found), 1, found)
        self.assertIn(path, found[0])
        self.assertIn(included, found[0])

    def test_this_tree_keeps_the_rules(self):
        self.assertEqual(include_direction.complaints(ROOT), [])

    def test_every_folder_of_this_tree_has_its_place(self):
        for folder, order in include_direction.INSIDE.items():
            top = include_direction.place_of(ROOT, folder)
            there = {path.parent.relative_to(top).parts[:1] for path in top.rglob("*.[ch]pp")}
            self.assertEqual({part for parts in there for part in parts}, set(order) - {"."}, folder)

    def test_downwards_is_allowed(self):
        self.assertEqual(complaints_about({**KERNEL, "broadphase/b.cpp": '#include "kernels/a.hpp"'}), [])

    def test_upwards_is_told_with_file_and_line(self):
        found = complaints_about({**STAGE, "kernels/a.cpp": '\n#include "pipeline/step/stages.hpp"\n'})
        self.assertEqual(len(found), 1)
        self.assertTrue(found[0].startswith("kernels/a.cpp:2: pipeline/step/stages.hpp"), found)

    def test_sideways_is_told(self):
        self.told({"narrowphase/n.hpp": ONCE, "broadphase/b.cpp": including("narrowphase/n.hpp")},
                  "broadphase/b.cpp", "narrowphase/n.hpp")

    def test_narrowphase_never_sees_cooking_nor_cooking_narrowphase(self):
        tree = {"cooking/repair/c.hpp": ONCE, "narrowphase/mesh/n.hpp": ONCE}
        self.told({**tree, "narrowphase/mesh/n.cpp": including("cooking/repair/c.hpp")},
                  "narrowphase/mesh/n.cpp", "cooking/repair/c.hpp")
        self.told({**tree, "cooking/repair/c.cpp": including("narrowphase/mesh/n.hpp")},
                  "cooking/repair/c.cpp", "narrowphase/mesh/n.hpp")

    def test_upwards_within_a_folder_is_told_at_every_depth(self):
        self.told({"kernels/solver/a.hpp": ONCE, "kernels/geometry/b.cpp": including("kernels/solver/a.hpp")},
                  "kernels/geometry/b.cpp", "kernels/solver/a.hpp")
        self.told({"kernels/solver/a.hpp": ONCE,
                   "kernels/solver/direct/b.cpp": including("kernels/solver/a.hpp")},
                  "kernels/solver/direct/b.cpp", "kernels/solver/a.hpp")

    def test_files_of_a_folder_use_its_folders_or_are_used_by_them_but_not_both(self):
        dispatch = {"narrowphase/dispatch.hpp": including("narrowphase/mesh/m.hpp"), "narrowphase/mesh/m.hpp": ONCE}
        self.assertEqual(complaints_about(dispatch), [])
        self.told({**dispatch, "narrowphase/mesh/m.cpp": including("narrowphase/dispatch.hpp")},
                  "narrowphase/mesh/m.cpp", "narrowphase/dispatch.hpp")
        self.told({"scene/files/f.hpp": ONCE, "scene/s.cpp": including("scene/files/f.hpp")},
                  "scene/s.cpp", "scene/files/f.hpp")

    def test_a_folder_without_a_place_is_told(self):
        self.told({"kernels/math/m.hpp": ONCE, "kernels/new/n.cpp": including("kernels/math/m.hpp")},
                  "kernels/new/n.cpp", "kernels/new has no place")

    def test_a_cycle_of_folders_without_an_order_is_told(self):
        tree = {"tests/a/one.hpp": including("tests/b/one.hpp"), "tests/b/one.hpp": ONCE, "tests/b/two.hpp": ONCE}
        self.assertEqual(complaints_about(tree), [])
        self.told({**tree, "tests/b/t.cpp": including("tests/a/one.hpp")}, "tests/b/t.cpp", "tests/a/one.hpp")

    def test_a_header_that_includes_itself_is_told(self):
        self.told({"kernels/math/a.hpp": including("kernels/math/b.hpp"),
                   "kernels/math/b.hpp": including("kernels/math/a.hpp")},
                  "kernels/math/a.hpp", "kernels/math/b.hpp")

    def test_cost_and_apps_stay_before_the_door(self):
        tree = {**STAGE, "include/throng/world.hpp": ONCE, "pipeline/world/world_state.hpp": ONCE,
                "pipeline/records/trace.hpp": ONCE, "kernels/solver/k.hpp": ONCE, "scene/names.hpp": ONCE}
        good = including("throng/world.hpp", "scene/names.hpp", "pipeline/records/trace.hpp")
        for folder in ("cost", "apps"):
            self.assertEqual(complaints_about({**tree, f"{folder}/good.cpp": good}), [])
            for hidden in ("pipeline/step/stages.hpp", "kernels/solver/k.hpp", "pipeline/world/world_state.hpp"):
                self.told({**tree, f"{folder}/bad.cpp": including(hidden)}, f"{folder}/bad.cpp", hidden)

    def test_the_door_brings_in_nobody(self):
        tree = {**KERNEL, "include/throng/math.hpp": ONCE}
        self.assertEqual(complaints_about({**tree, "include/throng/a.hpp": including("throng/math.hpp"),
                                           "kernels/b.cpp": including("throng/math.hpp")}), [])
        self.told({**tree, "include/throng/a.hpp": including("kernels/a.hpp")}, "throng/a.hpp", "kernels/a.hpp")

    def test_a_library_stays_in_its_file(self):
        tree = {"broadphase/embree_tree.cpp": "#include <embree3/rtcore.h>",
                "kernels/parallel/blocks_tbb.cpp": "#include <tbb/parallel_for.h>"}
        self.assertEqual(complaints_about(tree), [])
        for library in ("embree3/rtcore.h", "tbb/parallel_for.h", "hdf5.h", "gtest/gtest.h", "thread"):
            self.told({"narrowphase/convex/gjk.cpp": f"#include <{library}>"}, "narrowphase/convex/gjk.cpp", library)

    def test_a_path_that_does_not_start_at_the_root_is_told(self):
        self.assertEqual(len(complaints_about({**KERNEL, "kernels/b.cpp": '#include "a.hpp"'})), 1)
        self.assertEqual(len(complaints_about({**KERNEL, "apps/b.cpp": '#include "../kernels/a.hpp"'})), 1)

    def test_a_header_without_a_guard_is_told(self):
        self.assertEqual(len(complaints_about({"kernels/a.hpp": "int a;\n"})), 1)


if __name__ == "__main__":
    unittest.main()
