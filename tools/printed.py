#!/usr/bin/env python3
"""What the pages print of the command: pictures of a step, lists, and the commands themselves.

    tools/printed.py COMMAND            makes each printed answer anew, with that built command
    tools/printed.py COMMAND --check    says which differ, and leaves with 1 if some do

A page marks an answer by a comment above its block:

    <!-- printed by `./throng explain pile:100`, from "stages" on -->

What is printed goes from that line to the next blank one; `outer rows of "stages"` leaves out what is
indented further than the first row.
"""
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

ANSWER = re.compile(r"<!-- printed by `\./throng ([^`]*)`, "
                    r'(from|outer rows of) "([^"]*)"(?: on)? -->\n'
                    r"```text\n(.*?)```\n", re.DOTALL)


def pages():
    """All pages that a user reads, by their path."""
    found = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")),
             *sorted(ROOT.glob("*/README.md"))]
    return {path: path.read_text(encoding="utf-8") for path in found}


def answer(command, arguments, part, first):
    """The lines of what a command prints from a line on, up to a blank one."""
    lines = subprocess.run([command, *shlex.split(arguments)], capture_output=True, text=True,
                           check=True).stdout.splitlines()
    lines = lines[lines.index(first):]
    if "" in lines:
        lines = lines[:lines.index("")]
    if part != "from":
        lines = [line for line in lines if not line.startswith("    ")]
    return "".join(line.rstrip() + "\n" for line in lines)


def made_anew(text, command):
    """A page with each answer as the command gives it now."""
    def fresh(match):
        head = match[0][:match.start(4) - match.start(0)]
        return head + answer(command, match[1], match[2], match[3]) + "```\n"
    return ANSWER.sub(fresh, text)


def blocks(text):
    """The blocks of code of a page: (what the fence says, lines). Indented ones say nothing."""
    fence, lines, found = None, [], []
    for line in [*text.splitlines(), ""]:
        if fence is None and line.startswith("```"):
            fence, lines = line[3:].strip(), []
        elif fence is not None and line.startswith("```"):
            found.append((fence, lines))
            fence, lines = None, []
        elif fence is not None:
            lines.append(line)
        elif line.startswith("    "):
            lines.append(line[4:])
        elif lines:
            found.append(("", lines))
            lines = []
    return found


def commands(text):
    """Every `./throng ...` that a page prints, as words without the first."""
    found = []
    for _, lines in blocks(text):
        joined = "\n".join(lines).replace("\\\n", " ")
        found += [line.strip() for line in joined.splitlines()
                  if line.strip().startswith("./throng ")]
    prose = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    prose = re.sub(r"^```.*?^```$|^    .*?$", "", prose, flags=re.MULTILINE | re.DOTALL)
    for paragraph in prose.split("\n\n"):
        found += [" ".join(span.split()) for span in re.findall(r"`([^`]+)`", paragraph)
                  if span.startswith("./throng ")]
    return [shlex.split(line, comments=True)[1:] for line in found]


def files(text):
    """The files that a page prints whole, by name: their fence says so."""
    return {fence.split()[1]: "\n".join(lines) + "\n" for fence, lines in blocks(text)
            if len(fence.split()) == 2}


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 2
    differ = []
    for path, text in pages().items():
        fresh = made_anew(text, sys.argv[1])
        if fresh == text:
            continue
        differ.append(str(path.relative_to(ROOT)))
        if "--check" not in sys.argv[2:]:
            path.write_text(fresh, encoding="utf-8")
    print("\n".join(differ))
    return 1 if differ and "--check" in sys.argv[2:] else 0


if __name__ == "__main__":
    sys.exit(main())
