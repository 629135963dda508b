"""docs/scene.md is what tools/scene_docs.py makes, and says something of every key."""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True
import scene_docs  # noqa: E402


def keys(node, found):
    """The names of all properties below a node of the schema."""
    if isinstance(node, dict):
        found |= set(node.get("properties", {}))
        for part in node.values():
            keys(part, found)
    elif isinstance(node, list):
        for part in node:
            keys(part, found)
    return found


class SceneDocs(unittest.TestCase):
    def test_is_what_the_tool_makes(self):
        self.assertEqual(scene_docs.PAGE.read_text(encoding="utf-8"), scene_docs.page(),
                         "run tools/scene_docs.py")

    def test_has_every_key_of_the_schema(self):
        told = set(re.findall(r"^\| `(?:[\w\[\]]+\.)*(\w+)`", scene_docs.page(), re.MULTILINE))
        told |= {"drag"}  # told as drag.linear and drag.angular
        self.assertEqual(keys(scene_docs.SCHEMA, set()) - told, set())

    def test_says_what_each_key_means_and_what_it_is_without(self):
        rows = [line for line in scene_docs.page().splitlines() if line.startswith("| `")]
        self.assertGreater(len(rows), 90)
        for row in rows:
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", row)[1:-1]]
            self.assertEqual(len(cells), 5, row)
            self.assertTrue(all(cells), row)
            self.assertNotIn("None", row)

    def test_numbers_have_a_unit(self):
        # Counts, bits and names have none; whatever is measured does.
        for row in scene_docs.page().splitlines():
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", row)[1:-1]]
            if len(cells) == 5 and re.match(r"number|\[x, y, z\]|list of .*(number|\[x)", cells[1]):
                self.assertNotEqual(cells[2], "-", row)


if __name__ == "__main__":
    unittest.main()
