#!/usr/bin/env python3
"""Opens a page of `throng cost` in headless Chromium, narrow, middling and wide, light and dark, and
tells what is wrong with it: errors of its script, anything it loads, anything wider than the window,
a table that does not sort, dots that no key reaches, and what axe finds that hinders readers.

usage: check_page.py PAGE AXE.JS
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

WIDTHS = (400, 800, 1280)
MOST_BYTES = 1_000_000
MOST_MS = 1000

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


def probed(page, axe, width, dark):
    """What the page says of itself, as a dictionary; empty where it never came to it."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "page.html"
        text = page.replace("<head>", "<head>" + FIRST, 1)
        path.write_text(text.replace("</body>", f"<script>{axe}</script>{PROBE}</body>"))
        dom = subprocess.run(
            ["chromium-headless-shell", "--no-sandbox", "--disable-gpu", "--dump-dom",
             "--virtual-time-budget=20000", f"--window-size={width},900",
             f"--blink-settings=preferredColorScheme={0 if dark else 1}",
             path.as_uri()], capture_output=True, text=True, timeout=120, check=False).stdout
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
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    page = pathlib.Path(sys.argv[1]).read_text()
    axe = pathlib.Path(sys.argv[2]).read_text()
    failed = len(page.encode()) > MOST_BYTES
    if failed:
        print(f"{len(page.encode())} bytes, wanted at most {MOST_BYTES}")
    for width in WIDTHS:
        for dark in (False, True):
            found = findings(probed(page, axe, width, dark))
            failed = failed or bool(found)
            print(f"{width} pixels, {'dark' if dark else 'light'}: {'; '.join(found) or 'well'}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
