"""What the README says of the tree is so."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


class Readme(unittest.TestCase):
    def test_prints_hello_as_it_is_built(self):
        printed = re.search(r"```cpp\n(.*?)```", README, re.DOTALL)
        self.assertEqual(printed[1], (ROOT / "apps" / "hello.cpp").read_text(encoding="utf-8"))

    def test_names_every_folder_of_sources(self):
        with_sources = {path.parent.name
                        for path in ROOT.glob("*/README.md")}
        named = set(re.findall(r"^\| `(\w+)` \|", README, re.MULTILINE))
        self.assertEqual(named, with_sources)

    def test_speaks_of_files_that_exist(self):
        for path in re.findall(r"`([\w/]+\.(?:hpp|cpp|sh))`", README):
            self.assertTrue(list(ROOT.glob(path)) or list(ROOT.glob(f"*/{path}")), path)


if __name__ == "__main__":
    unittest.main()
