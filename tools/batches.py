#!/usr/bin/env python3
"""Batches: which files of a folder can be compiled as one.

usage: batches.py SIZE FILE...

Prints a line `BATCH FILE` for each. Most of what a compiler does for a file of ours, it does for
what the file includes, so a batch takes hardly longer than one of its files. Files cannot stand in
one where their unnamed namespaces share a name, or where one names something as a header of the
other does: each file goes to the first batch that has room for it and that it leaves alone.
"""

import functools
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TYPE = re.compile(r"(?:struct|class|union|enum class|enum)\s+(\w+)")
OTHER = re.compile(r"(\w+)\s*(?:\[[^]]*\]\s*)*[(={;]")
CONSTANTS = re.compile(r"^(?:inline )?constexpr [^;]*;", re.MULTILINE)  # of which one may have many
CONSTANT = re.compile(r"\b(k[A-Z]\w*)\s*[=\[{]")
NONE_OF_OURS = r"template|namespace|static_assert|using \w+::|[A-Z_]+\("


def defined_in(text):
    """The names that a text defines, by the shape that clang-format gives them."""
    for line in text.splitlines():
        if re.match(rf"(?!{NONE_OF_OURS})\w", line):
            found = TYPE.match(line) or OTHER.search(line)
            if found:
                yield found.group(1)
    for statement in CONSTANTS.findall(text):
        yield from CONSTANT.findall(statement)


def unnamed(text):
    """What stands in the unnamed namespaces of a file."""
    return "\n".join(re.findall(r"^namespace \{$(.*?)^\}  // namespace$", text,
                                re.MULTILINE | re.DOTALL))


@functools.cache
def header_names(name):
    """What a header of ours defines, and those that it includes."""
    path = ROOT / "include" / name if name.startswith("throng/") else ROOT / name
    if not path.is_file():
        return frozenset()
    text = path.read_text()
    return included_names(text).union(defined_in(text))


def included_names(text):
    included = re.findall(r'^#include "(.*)"', text, re.MULTILINE)
    return frozenset().union(*map(header_names, included))


def in_batches(files, size):
    batches = []
    for file in sorted(files):
        text = Path(file).read_text()
        own, seen = set(defined_in(unnamed(text))), included_names(text)
        # A template is instantiated whole in one file, and some of its members in another.
        templates = re.findall(r"^template \w+ (\w+)<", text, re.MULTILINE)
        own.update("template " + name for name in templates)
        for at, (count, others, all_seen) in enumerate(batches):
            if count < size and not own & (others | all_seen) and not seen & others:
                break
        else:
            at, count, others, all_seen = len(batches), 0, set(), set()
            batches.append(None)
        batches[at] = (count + 1, others | own, all_seen | seen)
        yield at, file


def main():
    size, files = int(sys.argv[1]), sys.argv[2:]
    for batch, file in in_batches(files, size):
        print(batch, file)


if __name__ == "__main__":
    main()
