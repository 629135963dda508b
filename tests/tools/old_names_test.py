"""Names that were given up stay out of the code, and every word of the glossary is in use."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
OLD_NAMES = ROOT / "tools" / "old_names.txt"
GLOSSARY = ROOT / "docs" / "glossary.md"

# Includes, comments, string and character literals, and identifiers; numbers, so that 1e5 is no name.
TOKEN = re.compile(
    r"(?P<include>^[ \t]*#[ \t]*include[^\n]*)"
    r"|(?P<comment>//(?:[^\n\\]|\\.|\\\n)*|/\*.*?\*/)"
    r'|(?P<text>(?:u8|[uUL])?R"(?P<mark>[^()\s\\"]{0,16})\(.*?\)(?P=mark)"'
    r'|(?:u8|[uUL])?"(?:\\.|[^"\\\n])*")'
    r"|(?P<number>\.?\d(?:[eEpP][+-]|'(?=[0-9a-fA-F])|[\w.])*)"
    r"|(?P<character>'(?:\\.|[^'\\\n])+')"
    r"|(?P<name>[A-Za-z_]\w*)", re.DOTALL | re.MULTILINE)


def files(*endings):
    """Those of the tree; what a build or a tool left there is none of it."""
    for path in sorted(ROOT.rglob("*")):
        inside = path.relative_to(ROOT).parts
        if path.suffix in endings and path.is_file() \
                and not any(part.startswith((".", "build")) for part in inside):
            yield path


def names_in(code):
    """The identifiers of a source, each with its line; not those of comments and literals."""
    for match in TOKEN.finditer(code):
        if match.lastgroup == "name":
            yield match.group(), code.count("\n", 0, match.start()) + 1


def old_names(text):
    return {line.strip() for line in text.splitlines() if line.strip() and not line.startswith("#")}


def terms(text):
    """The terms of a glossary: what stands in bold at the beginning of an item."""
    return re.findall(r"^- \*\*([^*]+)\*\*", text, re.MULTILINE)


def pattern_of(term):
    """A term as prose has it, as a name in code, or as a type; singular or plural."""
    words = re.findall(r"[\w']+", term)
    prose = r"(?i:(?<![a-z])" + r"[\s_-]*".join(map(re.escape, words)) + r"(?:e?s)?(?![a-z]))"
    return prose + "|" + "".join(word[:1].upper() + word[1:] for word in words) + r"(?![a-z])"


class OldNames(unittest.TestCase):
    def test_are_listed_in_order_and_once(self):
        lines = [line for line in OLD_NAMES.read_text(encoding="utf-8").splitlines()
                 if line and not line.startswith("#")]
        self.assertEqual(lines, sorted(set(lines)))
        self.assertTrue(lines)

    def test_stand_in_no_code(self):
        old = old_names(OLD_NAMES.read_text(encoding="utf-8"))
        found = [f"{path.relative_to(ROOT)}:{line}: {name}"
                 for path in files(".cpp", ".hpp", ".h")
                 for name, line in names_in(path.read_text(encoding="utf-8")) if name in old]
        self.assertEqual(found, [])

    def test_are_sought_among_identifiers_alone(self):
        code = 'int seat = 1; // the old seat\nconst char* a = "seat"; /* seat */ int seats = 1e5;\n'
        self.assertEqual([at for at in names_in(code) if at[0] == "seat"], [("seat", 1)])


class Glossary(unittest.TestCase):
    def test_every_term_is_in_use(self):
        listed = terms(GLOSSARY.read_text(encoding="utf-8"))
        self.assertGreater(len(listed), 50)
        self.assertEqual(len(listed), len(set(listed)))
        text = "\n".join(path.read_text(encoding="utf-8") for path in files(".cpp", ".hpp", ".h", ".md")
                         if path != GLOSSARY and "tests" not in path.relative_to(ROOT).parts[:1])
        # Comment lines of one paragraph are one text, so that a term may run over a line's end.
        text = re.sub(r"\n\s*///? ?", "\n", text)
        unused = [term for term in listed if not re.search(pattern_of(term), text)]
        self.assertEqual(unused, [])

    def test_a_term_is_found_as_words_as_a_name_and_as_a_type(self):
        for text in ("the speculative margin of", "double speculative_margin;", "SpeculativeMargins x"):
            self.assertRegex(text, pattern_of("speculative margin"))
        self.assertNotRegex("respeculative margin", pattern_of("speculative margin"))


if __name__ == "__main__":
    unittest.main()
