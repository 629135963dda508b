#!/usr/bin/env python3
"""Include direction: every include of the tree against the order in which its folders stand.

Three rules, each held for every file:

1. Between top folders `MAY_SEE` tells who may include whom. `throng/` is the public door, in
   include/: all see it, and it sees nobody. Of kernels and the pipeline, cost and apps see besides
   it the headers in `DOOR` alone.
2. Within a folder, at every depth, its folders stand in the order that `INSIDE` gives, and each sees
   those before it and no other. The files that stand directly in the folder count as one of them,
   "." in its list: either its folders may use these files, or these files use its folders, never
   both. A folder that has folders and is not listed (tests, perf) may have any order, but no cycle.
3. No header includes itself, over however many others.

Prints each include that breaks a rule as file:line and the header it names, and exits 1; prints
nothing where all is well.
    tools/include_direction.py [ROOT]
"""
import fnmatch
import pathlib
import re
import sys

# Which top folder may include which, itself besides. narrowphase never sees cooking: what is cooked
# is data by the time of a step.
BELOW = ["throng", "kernels", "cooking", "broadphase", "narrowphase", "scene", "pipeline"]
MAY_SEE = {
    "throng": [],
    "kernels": ["throng"],
    "cooking": ["throng", "kernels"],
    "broadphase": ["throng", "kernels"],
    "narrowphase": ["throng", "kernels", "broadphase"],
    "scene": ["throng", "kernels", "cooking", "narrowphase"],
    "pipeline": ["throng", "kernels", "cooking", "broadphase", "narrowphase", "scene"],
    "cost": ["throng", "cooking", "scene"],
    "apps": ["throng", "cooking", "scene", "cost"],
    "tests": BELOW + ["cost", "apps"],
    "perf": BELOW + ["cost", "apps", "tests"],
}

# What cost and apps see besides: records; fingerprints; what cooked meshes weigh and how deep two lie in one
# another, for the cases.
DOOR = [
    "kernels/geometry/mass.hpp", "kernels/math/hash.hpp", "pipeline/queries/mesh_overlap.hpp", "pipeline/records/*",
]
BEFORE_THE_DOOR = {"cost", "apps"}

# The order of the folders within a folder; "." are its own files.
INSIDE = {
    "throng": ["."],
    "kernels": [".", "math", "simd", "parallel", "data", "geometry", "dynamics", "solver"],
    "kernels/solver": ["direct", "."],
    "cooking": [".", "cache", "repair", "hulls", "decomposition", "sphere_trees", "fields"],
    "cooking/fields": [".", "openvdb"],
    "broadphase": ["."],
    "narrowphase": ["manifold", "convex", "mesh", "solid", "ccd", "alternatives", "."],
    "narrowphase/convex": ["wide", "."],
    "scene": [".", "shapes", "rules", "files", "catalog"],
    "pipeline": ["step", "forces", "contacts", "stages", "solvers", "event_driven", "world", "queries", "events",
                 "records", "."],
    "cost": [".", "answers", "windows", "sweep", "report", "hard_cases"],
    "apps": ["peers", "throng", "."],
    "apps/throng": [".", "bench"],
}

# Which files may include a library: the one file that meets it hides its types. What the machine's
# threads offer counts as one, so that a loop goes through blocks.hpp.
LIBRARIES = {
    r"(tbb|oneapi)/": ["*_tbb.cpp", "broadphase/embree_tree.cpp", "kernels/parallel/sort_keys.cpp",
                       "cooking/fields/openvdb/module.cpp"],
    r"embree\d*/": ["broadphase/embree_tree.cpp"],
    r"(hdf5|H5)": ["pipeline/records/run_file*.cpp", "tests/pipeline/records/run_file*.cpp"],
    r"(openvdb|nanovdb)/": ["cooking/fields/openvdb/*", "perf/cooking/tree_samples.cpp"],
    r"xxhash\.h>": ["cooking/cache/file_checksum.cpp"],
    r"(gtest|gmock)/": ["tests/*"],
    r"benchmark/": ["perf/*"],
    r"(hwy/|\w*intrin\.h)": ["kernels/simd/lanes*"],
    r"(thread|mutex|shared_mutex|condition_variable|future|atomic)>":
        ["kernels/parallel/*", "broadphase/embree_tree.cpp", "scene/shapes/answer_cache.hpp",
         "pipeline/*", "apps/*", "tests/*", "perf/*"],
}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"(?P<ours>[^"]*)"|<(?P<theirs>[^>]*>))')


class Include:
    """An include of ours: who, where, whom."""

    def __init__(self, path, number, included):
        self.path, self.number, self.included = path, number, included

    def told(self, wrong):
        return f"{self.path}:{self.number}: {self.included}: {wrong}"


def listed(words):
    return ", ".join(words) if words else "nothing else"


def wrong_between_tops(include):
    """What is wrong with an include from one top folder into another, or None."""
    folder, wanted = include.path.split("/")[0], include.included.split("/")[0]
    if folder == wanted or wanted in MAY_SEE[folder]:
        return None
    if folder in BEFORE_THE_DOOR and wanted in BELOW:
        if any(fnmatch.fnmatch(include.included, open_to_all) for open_to_all in DOOR):
            return None
        return f"is behind the door; {folder} sees {listed(MAY_SEE[folder])} and DOOR of include_direction.py"
    return f"{folder} may include {listed(MAY_SEE[folder])}, besides itself"


def parting(include):
    """Where the ways to two files part: the folder that holds both, and the part of it that each
    is in. None where they stand side by side."""
    ours, theirs = include.path.split("/"), include.included.split("/")
    depth = 0
    while depth < min(len(ours), len(theirs)) - 1 and ours[depth] == theirs[depth]:
        depth += 1
    if depth == 0:
        return None  # two top folders
    a = ours[depth] if len(ours) > depth + 1 else "."
    b = theirs[depth] if len(theirs) > depth + 1 else "."
    return None if a == b else ("/".join(ours[:depth]), a, b)


def wrong_inside(include):
    """What is wrong with an include from one part of a folder into another, or None."""
    parts = parting(include)
    if parts is None or parts[0] not in INSIDE:
        return None
    folder, a, b = parts
    order = INSIDE[folder]
    for part in (a, b):
        if part not in order:
            return f"{folder}/{part} has no place in the order of {folder}: {listed(order)}"
    if order.index(b) < order.index(a):
        return None
    theirs, ours = (f"what stands directly in {folder}" if part == "." else f"{folder}/{part}"
                    for part in (b, a))
    return f"{theirs} comes after {ours} (order of {folder}: {listed(order)})"


def cycle_in(graph):
    """Some cycle of a graph {node: {other: include}} as a list of includes, or None."""
    done, way = set(), []

    def visit(node):
        done.add(node)
        way.append(node)
        for other, include in sorted(graph.get(node, {}).items()):
            if other in way:
                nodes = way[way.index(other):] + [other]
                return [graph[a][b] for a, b in zip(nodes, nodes[1:])]
            if other not in done and (found := visit(other)):
                return found
        way.pop()
        return None

    for node in sorted(graph):
        if node not in done and (found := visit(node)):
            return found
    return None


def told_as_cycle(what, cycle):
    first, rest = cycle[0], cycle[1:]
    back = "; ".join(f"{i.path}:{i.number} includes {i.included}" for i in rest)
    return first.told(f"a cycle of {what}" + (f": {back}" if rest else ": it includes itself"))


def cycles(includes):
    """Complaints about folders without an order that go round in a circle, and about headers."""
    folders, headers = {}, {}
    for include in includes:
        parts = parting(include)
        if parts is not None and parts[0] not in INSIDE:
            folders.setdefault(parts[0], {}).setdefault(parts[1], {}).setdefault(parts[2], include)
        if include.path.endswith(".hpp"):
            headers.setdefault(include.path, {}).setdefault(include.included, include)
    for folder in sorted(folders):
        if cycle := cycle_in(folders[folder]):
            yield told_as_cycle(f"folders in {folder}", cycle)
    if cycle := cycle_in(headers):
        yield told_as_cycle("headers", cycle)


def complaint_of_theirs(path, included):
    """What is wrong with an include of a library, or None."""
    for library, files in LIBRARIES.items():
        if re.match(library, included) and not any(fnmatch.fnmatch(path, f) for f in files):
            return f"belongs in {', '.join(files)} only"
    return None


def place_of(root, path):
    """Where something stands that includes call by that name: the public door is in include/."""
    return root / "include" / path if path.split("/")[0] == "throng" else root / path


def complaints(root):
    """Every broken rule of a tree, as one line each, in order."""
    found, includes = [], []
    for folder in sorted(MAY_SEE):
        top = place_of(root, folder)
        for file in sorted(top.rglob("*.[ch]pp")):
            path = folder + "/" + file.relative_to(top).as_posix()
            text = file.read_text(encoding="utf-8")
            if file.suffix == ".hpp" and "#pragma once" not in text:
                found.append(f"{path}:1: has no #pragma once")
            for number, line in enumerate(text.splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                if match["ours"] is None:
                    if wrong := complaint_of_theirs(path, match["theirs"]):
                        found.append(f"{path}:{number}: {match['theirs'].rstrip('>')}: {wrong}")
                    continue
                include = Include(path, number, match["ours"])
                if include.included.startswith((".", "/")) or not place_of(root, include.included).is_file():
                    found.append(include.told("is no file, seen from the root"))
                elif wrong := wrong_between_tops(include) or wrong_inside(include):
                    found.append(include.told(wrong))
                else:
                    includes.append(include)
    return found + list(cycles(includes))


def main():
    default = pathlib.Path(__file__).resolve().parent.parent
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default
    found = complaints(root)
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
