"""The public door: pipeline/throng.hpp compiles alone, and brings in Eigen and std and nothing else.

    door_test.py COMPILER EIGEN_INCLUDE
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Folders of the system's own: a compiler's, C's and the kernel's. Headers of libraries lie in
# others, or below /usr/include in folders of their own.
SYSTEM = [
    r"/usr/(local/)?lib/.*",
    r"/usr/include/[^/]+\.h",
    r"/usr/include/(\w+-linux-gnu/)?(c\+\+|bits|sys|gnu|asm|asm-generic|linux)/.*",
    r"/usr/include/\w+-linux-gnu/[^/]+\.h",
]


def included_by_the_door(compiler, eigen):
    """All files that a program gets to see, by compiling one that includes nothing else."""
    with tempfile.TemporaryDirectory() as folder:
        source, listing = pathlib.Path(folder, "door.cpp"), pathlib.Path(folder, "door.d")
        source.write_text('#include "pipeline/throng.hpp"\nint main() { throng::World world; }\n')
        subprocess.run([compiler, "-std=c++20", "-Wall", "-Wextra", "-Werror", "-fsyntax-only",
                        f"-I{ROOT}", "-isystem", eigen, "-MD", "-MF", listing, source], check=True)
        files = listing.read_text().replace("\\\n", " ").split(":", 1)[1]
        names = re.findall(r"(?:\\ |\S)+", files)
        return {os.path.realpath(name.replace("\\ ", " ")) for name in names} - {str(source)}


def foreign(path, eigen):
    """Whether a file is neither ours, nor Eigen's, nor the system's."""
    if pathlib.Path(path).is_relative_to(os.path.realpath(eigen)):
        return False
    if pathlib.Path(path).is_relative_to(ROOT):
        return False
    return not any(re.fullmatch(pattern, path) for pattern in SYSTEM)


def main():
    compiler, eigen = sys.argv[1:]
    seen = included_by_the_door(compiler, eigen)
    strangers = sorted(path for path in seen if foreign(path, eigen))
    for path in strangers:
        print(f"pipeline/throng.hpp brings in {path}")
    # A listing that was read wrongly would hold no strangers either.
    whole = str(ROOT / "pipeline" / "throng.hpp") in seen and any("/Eigen/" in path for path in seen)
    if not whole:
        print("the compiler's listing lacks throng.hpp or Eigen")
    return 1 if strangers or not whole else 0


if __name__ == "__main__":
    sys.exit(main())
