"""The public door: throng/throng.hpp compiles alone, and brings in all that is installed, Eigen and
std, and nothing else.

    door_test.py COMPILER EIGEN_INCLUDE
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = ROOT / "include"

# Folders of the system's own: a compiler's, C's and the kernel's. Headers of libraries lie in
# others, or below /usr/include in folders of their own.
SYSTEM = [
    r"/usr/(local/)?lib/.*",
    r"/usr/include/[^/]+\.h",
    r"/usr/include/(\w+-linux-gnu/)?(c\+\+|bits|sys|gnu|asm|asm-generic|linux)/.*",
    r"/usr/include/\w+-linux-gnu/[^/]+\.h",
]


class Compiler:
    def __init__(self, path, eigen):
        self.path, self.eigen = path, eigen

    def run(self, text, *options):
        """What the compiler says to a program's text."""
        return subprocess.run([self.path, "-std=c++20", "-Wall", "-Wextra", "-Werror", "-fsyntax-only",
                               f"-I{INCLUDE}", "-isystem", self.eigen, *options, "-x", "c++", "-"],
                              input=text, text=True, capture_output=True)

    def included(self, text):
        """All files that a program gets to see."""
        with tempfile.TemporaryDirectory() as folder:
            listing = pathlib.Path(folder, "door.d")
            done = self.run(text, "-MD", "-MF", listing, "-MT", "door")
            if done.returncode != 0:
                sys.exit(done.stderr)
            files = listing.read_text().replace("\\\n", " ").split(":", 1)[1]
            names = re.findall(r"(?:\\ |\S)+", files)
            return {os.path.realpath(name.replace("\\ ", " ")) for name in names if name != "-"}


def foreign(path, eigen):
    """Whether a file is neither public, nor Eigen's, nor the system's."""
    own = (os.path.realpath(eigen), INCLUDE)
    if any(pathlib.Path(path).is_relative_to(folder) for folder in own):
        return False
    return not any(re.fullmatch(pattern, path) for pattern in SYSTEM)


def main():
    compiler = Compiler(*sys.argv[1:])
    seen = compiler.included("#include <throng/throng.hpp>\nint main() { throng::World world; }\n")
    found = [f"throng/throng.hpp brings in {path}" for path in sorted(seen)
             if foreign(path, compiler.eigen)]
    public = {str(path) for path in INCLUDE.rglob("*.hpp")}
    found += [f"throng/throng.hpp does not bring in {path}, which is installed"
              for path in sorted(public - seen)]
    # A listing that was read wrongly would hold no strangers either.
    if not any("/Eigen/" in path for path in seen):
        found.append("the compiler's listing lacks Eigen")
    for header in sorted(public):
        name = pathlib.Path(header).relative_to(INCLUDE)
        if compiler.run(f"#include <{name}>\n").returncode != 0:
            found.append(f"{name} does not compile alone")
    # The world's inside stays there.
    reaching = "#include <throng/throng.hpp>\nauto reach(throng::World& world) { return &world.%s; }\n"
    found += [f"World::{inside} can be reached" for inside in ("state()", "state_")
              if compiler.run(reaching % inside).returncode == 0]
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
