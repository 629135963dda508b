#!/usr/bin/env python3
"""Shows Doxygen a header as its writer meant it: docs_filter.py HEADER, to the standard output.

What opens a file is about the file; a plain comment above a declaration or behind it is about that
declaration; lists with meaning in their columns stay as they are set.
"""
import re
import sys

text = open(sys.argv[1], encoding="utf-8").read().splitlines()
out, at_top, listed = [], True, False

for line in text:
    comment = re.match(r"(\s*)//(/?)( ?)(.*)$", line)
    if comment:
        indent, words = comment[1], comment[4]
        if at_top and not out:
            out.append("/// \\file")
        # A list is indented, after a blank line of comment, and runs to the next blank one.
        if words.startswith("  ") and out[-1].strip() == "///":
            listed = True
        elif not words.startswith("  "):
            listed = False
        out.append(f"{indent}///" + (" " if words else "") + ("    " if listed else "") + words)
        continue
    listed = False
    if at_top:
        out.append("")  # the file's comment ends here
    at_top = False
    behind = re.match(r"(.*[;,{}\w])  +// (.*)$", line)
    if not behind:
        out.append(line)
    elif behind[1].endswith("{"):
        indent = re.match(r"\s*", line)[0]
        out += [f"{indent}/// {behind[2]}", behind[1]]
    else:
        out.append(f"{behind[1]}  ///< {behind[2]}")

print("\n".join(out))
