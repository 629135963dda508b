#!/usr/bin/env python3
"""Include direction: every include of the tree against the table of who may reach for what.

Prints each include that breaks a rule as file:line and exits 1; prints nothing where all is well.
    tools/include_direction.py [ROOT]
"""
import fnmatch
import pathlib
import re
import sys

# Which folder may include which. Those named in `OPEN` may include everything.
MAY_INCLUDE = {
    "kernels": {"kernels"},
    "broadphase": {"broadphase", "kernels"},
    "narrowphase": {"narrowphase", "kernels"},
    "pipeline": {"pipeline", "kernels", "broadphase", "narrowphase"},
    "scenes": {"scenes", "pipeline", "kernels"},
    "cost": {"cost", "scenes", "pipeline", "kernels"},
}
OPEN = {"apps", "tests", "perf"}

# Of the pipeline, scenes and cost see what a program may see, and not how a step is made.
BEHIND_THE_DOOR = {
    folder: ["pipeline/stages.hpp", "pipeline/stages/*", "pipeline/stage.hpp",
             "pipeline/step_*", "pipeline/world_state.hpp"]
    for folder in ("scenes", "cost")
}

# Which files may include a library: the one file that meets it hides its types. What the machine's
# threads offer counts as one, so that a loop goes through blocks.hpp.
LIBRARIES = {
    r"(tbb|oneapi)/": ["*_tbb.cpp", "broadphase/embree_tree.cpp", "kernels/parallel/sort_keys.cpp",
                       "narrowphase/solids/voxel_field.cpp"],
    r"embree\d*/": ["broadphase/embree_tree.cpp"],
    r"(hdf5|H5)": ["pipeline/run_file*.cpp", "tests/pipeline/run_file*.cpp"],
    r"(openvdb|nanovdb)/": ["narrowphase/solids/voxel_field.cpp", "perf/tree_samples.cpp"],
    r"(gtest|gmock)/": ["tests/*"],
    r"benchmark/": ["perf/*"],
    r"(hwy/|\w*intrin\.h)": ["kernels/math/lanes*"],
    r"(thread|mutex|shared_mutex|condition_variable|future|atomic)>":
        ["kernels/parallel/*", "broadphase/embree_tree.cpp", "pipeline/*", "apps/*", "tests/*",
         "perf/*"],
}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"(?P<ours>[^"]*)"|<(?P<theirs>[^>]*>))')


def complaint_of_ours(root, path, included):
    """What is wrong with an include of our own, or None."""
    folder, wanted = path.split("/")[0], included.split("/")[0]
    if included.startswith((".", "/")) or not (root / included).is_file():
        return "is no file, seen from the root"
    if folder in OPEN:
        return None
    if wanted not in MAY_INCLUDE[folder]:
        return f"{folder} may include {', '.join(sorted(MAY_INCLUDE[folder]))} only"
    if any(fnmatch.fnmatch(included, hidden) for hidden in BEHIND_THE_DOOR.get(folder, [])):
        return f"{folder} may not look behind pipeline/throng.hpp"
    return None


def complaint_of_theirs(path, included):
    """What is wrong with an include of a library, or None."""
    for library, files in LIBRARIES.items():
        if re.match(library, included) and not any(fnmatch.fnmatch(path, f) for f in files):
            return f"belongs in {', '.join(files)} only"
    return None


def complaints(root):
    """Every broken rule of a tree, as one line each, in order."""
    found = []
    for folder in sorted({*MAY_INCLUDE, *OPEN}):
        for file in sorted((root / folder).rglob("*.[ch]pp")):
            path = file.relative_to(root).as_posix()
            text = file.read_text(encoding="utf-8")
            if file.suffix == ".hpp" and "#pragma once" not in text:
                found.append(f"{path}:1: has no #pragma once")
            for number, line in enumerate(text.splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                ours, theirs = match["ours"], match["theirs"]
                wrong = (complaint_of_theirs(path, theirs) if ours is None
                         else complaint_of_ours(root, path, ours))
                if wrong:
                    found.append(f"{path}:{number}: {ours or theirs.rstrip('>')}: {wrong}")
    return found


def main():
    default = pathlib.Path(__file__).resolve().parent.parent
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default
    found = complaints(root)
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
