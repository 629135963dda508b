"""What the README and the pages of docs say of the tree is so."""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True
import printed  # noqa: E402

README = (ROOT / "README.md").read_text(encoding="utf-8")
ARCHITECTURE = (ROOT / "docs/architecture.md").read_text(encoding="utf-8")
PAGES = {path.relative_to(ROOT): text for path, text in printed.pages().items()
         if path.parent in (ROOT, ROOT / "docs")}


class Readme(unittest.TestCase):
    def test_is_short(self):
        lines = README.splitlines()
        self.assertLessEqual(len(lines), 120)
        for line in lines:
            self.assertLessEqual(len(line), 110, line)

    def test_prints_hello_as_it_is_built(self):
        hello = re.search(r"```cpp\n(.*?)```", README, re.DOTALL)
        self.assertEqual(hello[1], (ROOT / "apps" / "hello.cpp").read_text(encoding="utf-8"))


class Pages(unittest.TestCase):
    def test_name_every_folder_that_has_a_readme(self):
        folders = {path.parent.name for path in ROOT.glob("*/README.md")}
        named = set(re.findall(r"^\| `(\w+)` \|", ARCHITECTURE, re.MULTILINE))
        self.assertEqual(named, folders)

    def test_speak_of_files_that_exist(self):
        for page, text in PAGES.items():
            for path in re.findall(r"`([\w/]+\.(?:hpp|cpp|sh|py))`", text):
                with self.subTest(page=str(page), path=path):
                    self.assertTrue(list(ROOT.glob(path)) or list(ROOT.glob(f"*/{path}")))

    def test_links_lead_somewhere(self):
        for page, text in PAGES.items():
            for target in re.findall(r"\]\(([^)#:]+)\)", text):
                with self.subTest(page=str(page), target=target):
                    self.assertTrue((ROOT / page.parent / target).exists())

    def test_every_page_is_listed(self):
        listed = (ROOT / "docs/README.md").read_text(encoding="utf-8")
        for page in (ROOT / "docs").glob("*.md"):
            if page.name != "README.md":
                self.assertIn(f"]({page.name})", listed)

    def test_the_walk_goes_by_stages_of_the_step(self):
        table = (ROOT / "pipeline/step/step_table.cpp").read_text(encoding="utf-8")
        stages = set(re.findall(r"^ +stage<Real, (\w+)", table, re.MULTILINE))
        walked = re.findall(r"\*\*(\w+)\*\*", ARCHITECTURE)
        self.assertGreater(len(walked), 12)
        self.assertEqual(set(walked) - stages, set())

    def test_the_first_page_of_the_headers_names_what_is_in_them(self):
        headers = "".join(path.read_text(encoding="utf-8")
                          for path in (ROOT / "include/throng").glob("*.hpp"))
        for name in re.findall(r"throng::(?:\w+::)?(\w+)", PAGES[pathlib.Path("docs/api.md")]):
            self.assertRegex(headers, rf"\b{name}\b")


if __name__ == "__main__":
    unittest.main()
