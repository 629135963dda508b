#!/usr/bin/env python3
"""Opens a page of `throng cost` in headless Chromium, narrow, middling and wide, light and dark, and
tells what is wrong with it: errors of its script, anything it loads, anything wider than the window,
a table that does not sort, dots that no key reaches, and what axe finds that hinders readers. Of each a
picture is taken and looked at: the paper and the marks have their colors, it is neither empty nor
full, and nothing is cut at its edge.

usage: check_page.py PAGE AXE.JS [FOLDER FOR PICTURES]
"""
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import zlib

WIDTHS = (400, 800, 1280)
MOST_BYTES = 1_000_000
MOST_MS = 1000
HEIGHT = 900
LEAST_MARKS = 200  # pixels: the line beside the advice alone has as many
INKED = (0.01, 0.6)  # of all pixels, what is not paper

FIRST = """<script>
window.troubles = [];
window.addEventListener("error", (event) => window.troubles.push(String(event.message)));
</script>"""

PROBE = """<script>
window.addEventListener("load", async () => {
  const said = { troubles: window.troubles };
  said.loads = performance.getEntriesByType("resource").map((entry) => entry.name);
  said.wider = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  const [way] = performance.getEntriesByType("navigation");
  said.ms = way.domContentLoadedEventEnd - way.responseEnd;
  const heads = [...document.querySelectorAll("#settings th")];
  const time = heads.findIndex((head) => head.textContent.startsWith("time"));
  heads[time].querySelector("button").click();
  const times = [...document.querySelectorAll("#settings tbody tr")]
    .map((row) => row.cells[time].dataset.value).filter((text) => text).map(Number);
  said.sorted = heads[time].getAttribute("aria-sort") === "ascending"
    && times.length > 1 && times.every((value, at) => at === 0 || times[at - 1] <= value);
  const dots = [...document.querySelectorAll("circle[tabindex]")];
  const first = dots.find((dot) => dot.tabIndex === 0);
  first.focus();
  first.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
  const told = document.getElementById("told").textContent;
  said.keys = document.activeElement !== first && told.includes("throng ");
  const found = await axe.run(document, { resultTypes: ["violations"] });
  said.axe = found.violations.map((each) => each.id + ": " + each.nodes[0].html.slice(0, 120));
  const end = document.createElement("pre");
  end.id = "probe";
  end.textContent = JSON.stringify(said);
  document.body.append(end);
});
</script>"""


def browse(path, width, dark, *words):
    return subprocess.run(
        ["chromium-headless-shell", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
         "--virtual-time-budget=20000", f"--window-size={width},{HEIGHT}",
         f"--blink-settings=preferredColorScheme={0 if dark else 1}", *words, path.as_uri()],
        capture_output=True, text=True, timeout=120, check=False).stdout


def rows_of(png):
    """The rows of a picture of 8 bits a color, without interlace, each a list of (r, g, b)."""
    at, size, packed = 8, 3, b""
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at:at + 8])
        data = png[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, _, depth, color, _, _, interlace = struct.unpack(">IIBBBBB", data)
            assert depth == 8 and color in (2, 6) and not interlace
            size = 3 if color == 2 else 4
        if kind == b"IDAT":
            packed += data
        at += length + 12
    raw, before, rows = zlib.decompress(packed), bytes(width * size), []
    for start in range(0, len(raw), width * size + 1):
        line = bytearray(raw[start + 1:start + 1 + width * size])
        for i, byte in enumerate(line):
            left = line[i - size] if i >= size else 0
            up, corner = before[i], before[i - size] if i >= size else 0
            nearest = min((left, up, corner), key=lambda one: abs(left + up - corner - one))
            line[i] = (byte + (0, left, up, (left + up) // 2, nearest)[raw[start]]) % 256
        rows.append([tuple(line[i:i + 3]) for i in range(0, len(line), size)])
        before = line
    return rows


def color(page, name, dark):
    """One of those that the page's style names, light first, as (r, g, b)."""
    return tuple(bytes.fromhex(re.findall(rf"--{name}: #([0-9a-f]{{6}});", page)[int(dark)]))


def seen(rows, paper, mark):
    """What is wrong with a picture of the page's beginning."""
    found = []
    if any(rows[y][x] != paper for y in (0, -1) for x in (0, -1)):
        found.append("its corners are not of the paper's color")
    if any(row[-1] != paper for row in rows):
        found.append("something is cut at its right edge")
    marks = sum(pixel == mark for row in rows for pixel in row)
    if marks < LEAST_MARKS:
        found.append(f"{marks} pixels of the marks' color, wanted {LEAST_MARKS} at least")
    inked = sum(pixel != paper for row in rows for pixel in row) / (len(rows) * len(rows[0]))
    if not INKED[0] <= inked <= INKED[1]:
        found.append(f"{inked:.0%} of it is not paper")
    return found


def pictured(path, page, width, dark, folder):
    """Takes the picture, and says what is wrong with it."""
    picture = pathlib.Path(folder) / f"{width}-{'dark' if dark else 'light'}.png"
    picture.unlink(missing_ok=True)
    browse(path, width, dark, f"--screenshot={picture}")
    if not picture.exists():
        return ["no picture of it"]
    return seen(rows_of(picture.read_bytes()), color(page, "paper", dark), color(page, "mark", dark))


def probed(page, axe, width, dark):
    """What the page says of itself, as a dictionary; empty where it never came to it."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "page.html"
        text = page.replace("<head>", "<head>" + FIRST, 1)
        path.write_text(text.replace("</body>", f"<script>{axe}</script>{PROBE}</body>"))
        dom = browse(path, width, dark, "--dump-dom")
    found = re.search(r'<pre id="probe">(.*?)</pre>', dom, re.S)
    if not found:
        return {}
    text = found.group(1)
    for entity, letter in (("&lt;", "<"), ("&gt;", ">"), ("&amp;", "&")):
        text = text.replace(entity, letter)
    return json.loads(text)


def findings(said):
    if not said:
        return ["its script did not come to its end"]
    found = [f"script: {each}" for each in said["troubles"]]
    found += [f"loads {each}" for each in said["loads"]]
    found += [f"axe: {each}" for each in said["axe"]]
    if said["wider"] > 0:
        found.append(f"{said['wider']} pixels wider than the window")
    if not said["sorted"]:
        found.append("a click on the head of a column does not sort")
    if not said["keys"]:
        found.append("arrow keys do not go from dot to dot")
    if said["ms"] > MOST_MS:
        found.append(f"{said['ms']:.0f} ms to open, wanted at most {MOST_MS}")
    return found


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    path = pathlib.Path(sys.argv[1]).resolve()
    folder = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else path.parent).resolve()
    page = path.read_text()
    axe = pathlib.Path(sys.argv[2]).read_text()
    failed = len(page.encode()) > MOST_BYTES
    if failed:
        print(f"{len(page.encode())} bytes, wanted at most {MOST_BYTES}")
    for width in WIDTHS:
        for dark in (False, True):
            found = findings(probed(page, axe, width, dark))
            found += pictured(path, page, width, dark, folder)
            failed = failed or bool(found)
            print(f"{width} pixels, {'dark' if dark else 'light'}: {'; '.join(found) or 'well'}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
