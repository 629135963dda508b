#!/usr/bin/env python3
"""Writes docs/scene.md: every key of a scene file with type, unit, default and meaning.

    tools/scene_docs.py            writes it
    tools/scene_docs.py --check    says whether it is what would be written, and leaves with 1 if not

Keys and dials come from scene/files/scene.schema.json, limits from scene/limits.hpp: nothing is typed a
second time here.
"""
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/scene.md"

HEAD = """\
# The scene file

<!-- Made by tools/scene_docs.py from the schema; do not edit. -->

A scene is one JSON object. Units are SI and angles radians; quaternions are `[w, x, y, z]` and turn body axes
into world axes. Files that a scene names are found relative to it. Unknown and repeated keys, numbers beyond
double and nesting deeper than 64 are errors; each reads `FILE:LINE:COLUMN: error: PATH: what was wanted`.
`./throng scene --schema` says the same to programs, and `./throng scene pile 10 --out pile.json` writes
a scene to look at. This one drops a crate; `./throng run crate.json --steps 60` runs it.

```json crate.json
{
  "throng": 1,
  "settings": {"dt": "1/60", "substeps": 4},
  "materials": {"wood": {"density": 700, "friction": 0.5}},
  "shapes": {
    "floor": {"plane": {"normal": [0, 0, 1]}},
    "crate": {"box": {"half_extents": [0.5, 0.4, 0.3]}}
  },
  "bodies": [
    {"shape": "floor", "motion": "static"},
    {"name": "top", "shape": "crate", "material": "wood", "position": [0, 0, 2]}
  ]
}
```

*Required* under Default: the key has to be there. In brackets: what holds where it is left out.
"""

TAIL = """\
## Bulk files

`instances` read one record a body from a file of little-endian doubles: position, orientation (w, x, y, z),
velocity, angular velocity; 13 numbers, or 16 where `"sizes": "file"` adds three. A million bodies load in
seconds. Ids count `bodies` first, then `instances`, in the order of the file.

## Limits

| quantity | unit | from | to |
|---|---|---|---|
{limits}

Of quantities that may have either sign these are magnitudes. Directions and quaternions may be off unit
length by {kUnitTolerance}. Limits leave room for what a step makes of a number: masses and moments stay
within float, with their inverses.
"""

# Where each section stands in the schema, with a sentence of its own.
SECTIONS = [
    ("Top level", "", ""),
    ("`settings`: dials", "$defs/settings",
     "Every choice that trades accuracy for time. `./throng run SCENE --set DIAL=VALUE` sets one for a\n"
     "run; a dial that another makes meaningless is reported as unused. [methods.md](methods.md) says\n"
     "when which."),
    ("`materials.NAME`", "$defs/material", ""),
    ("`pairs[]`", "$defs/pair", None),
    ("`bodies[]`", "$defs/body", ""),
    ("`instances[]`", "$defs/instances",
     "The keys of a body but for `name`, `position`, `orientation`, `velocity` and `angular_velocity`, and:"),
    ("`springs[]`", "$defs/spring", None),
    ("`attractors[]`", "$defs/attractor", None),
]

SCHEMA = json.loads((ROOT / "scene/files/scene.schema.json").read_text(encoding="utf-8"))


def at(path):
    node = SCHEMA
    for part in filter(None, path.split("/")):
        node = node[part]
    return node


def resolved(node):
    """A node with what it refers to; what it says itself goes before."""
    if "$ref" not in node:
        return node
    return {**resolved(at(node["$ref"].removeprefix("#/"))), **node}


def number(value):
    text = f"{value:g}"
    if float(text) != value:
        text = str(value)
    return re.sub(r"e([+-])0*", lambda e: "e" + e[1].strip("+"), text)


def bounds(node):
    least, above = node.get("minimum"), node.get("exclusiveMinimum")
    most = node.get("maximum")
    if most == 4294967295:
        return ", 32 bits"
    if above is not None:
        return f" above {number(above)}"
    if least is None:
        return ""
    if most is None:
        return f", at least {number(least)}"
    return f" from {number(least)} to {number(most)}"


def type_of(node):
    """A type in a few words."""
    if "$ref" in node and node["$ref"].endswith(("/vector", "/quaternion")):
        return "[x, y, z]" if node["$ref"].endswith("vector") else "[w, x, y, z]"
    node = resolved(node)
    if "const" in node:
        return f"`{json.dumps(node['const'])}`"
    if "values" in node:
        return node["values"]
    if "enum" in node:
        return ", ".join(f"`{value}`" for value in node["enum"])
    if "oneOf" in node:
        return " or ".join(type_of(one) for one in node["oneOf"])
    kind = node.get("type")
    if kind == "array":
        least, most = node.get("minItems", 0), node.get("maxItems")
        what = type_of(node["items"])
        if most == least and most:
            return f"list of {most}: {what}"
        return f"list of {what}" + (f", {least} or more" if least else "")
    if kind == "object" or "properties" in node:
        return "object"
    kinds = kind if isinstance(kind, list) else [kind]
    words = {"integer": "whole number", "number": "number", "string": "text", "null": "null",
             "boolean": "`true`, `false`"}
    return " or ".join(words[one] + (bounds(node) if one in ("integer", "number") else "")
                       for one in kinds)


def default_of(key, node, required):
    if key in required:
        return "*required*"
    full = resolved(node)
    if "leftOut" in full:
        return f"({full['leftOut']})"
    if "default" in full:
        value = full["default"]
        if isinstance(value, float):
            return f"`{number(value)}`"
        return f"`{value}`" if isinstance(value, str) else f"`{json.dumps(value)}`"
    return "(none)"


def escaped(text):
    return text.replace("|", "\\|")


def sentence(text):
    text = text[:1].upper() + text[1:]
    return text if not text or text.endswith((".", ":")) else text + "."


def dial_rows():
    for key, node in at("$defs/settings/properties").items():
        values = ", ".join(f"`{one}`" for one in node.get("enum", ())) or node["values"]
        yield (f"`{key}`", values, plain_unit(node), default_of(key, node, ()), node["description"] + ".")


# ---- tables ----

def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(map(escaped, row)) + " |" for row in rows]
    return "\n".join(lines)


KEYS = ("Key", "Type", "Unit", "Default", "Meaning")


def plain_unit(node):
    full = resolved(node)
    if "unit" in full:
        return full["unit"]
    return "-"


def key_rows(node):
    full = resolved(node)
    required = full.get("required", ())
    properties = dict(full.get("properties", {}))
    if "$ref" in node and "properties" in node:
        base = resolved(at(node["$ref"].removeprefix("#/")))
        required = [*base.get("required", ()), *node.get("required", ())]
        if node is not at("$defs/instances"):
            properties = {**base["properties"], **properties}
    for key, value in properties.items():
        inner = resolved(value)
        # An object of a few numbers is told key by key.
        if inner.get("type") == "object" and "properties" in inner and "$ref" not in value:
            for name, part in inner["properties"].items():
                yield (f"`{key}.{name}`", type_of(part), plain_unit(part),
                       default_of(name, part, inner.get("required", ())),
                       sentence(inner.get("description", "")) + " "
                       + sentence(resolved(part).get("description", "")))
            continue
        yield (f"`{key}`", type_of(value), plain_unit(value), default_of(key, value, required),
               sentence(inner.get("description", "")))


def shape_rows():
    for kind, node in at("$defs/shape/properties").items():
        full = resolved(node)
        yield (f"`{kind}`", "list of objects" if full.get("type") == "array" else "object", "-", "-",
               sentence(full.get("description", "")))
        inner = resolved(full.get("items", full))
        for key, value in inner["properties"].items():
            dots = "[]." if "items" in full else "."
            yield (f"`{kind}{dots}{key}`", type_of(value), plain_unit(value),
                   default_of(key, value, inner.get("required", ())),
                   sentence(resolved(value).get("description", "")))


def limits():
    text = (ROOT / "scene/limits.hpp").read_text(encoding="utf-8")
    limit = dict(re.findall(r"\b(k\w+) = ([\d.e+-]+)", text))
    rows = [("length, place", "m", "kLeastLength", "kGreatestLength"),
            ("velocity, acceleration", "m/s, rad/s, m/s2", None, "kGreatestLength"),
            ("mass, density", "kg, kg/m3", "kLeastMass", "kGreatestMass"),
            ("principal moment", "kg m2", "kLeastMoment", "kGreatestMoment"),
            ("force, stiffness, other factor", "SI", None, "kGreatestNumber")]
    lines = [f"| {what} | {unit} | {limit[least] if least else 0} | {limit[most]} |"
             for what, unit, least, most in rows]
    return TAIL.format(limits="\n".join(lines), kUnitTolerance=limit["kUnitTolerance"])


def page():
    parts = [HEAD]
    for title, path, words in SECTIONS:
        node = at(path)
        parts.append(f"## {title}\n")
        if words is None:
            words = at("properties/" + title.strip("`[]")).get("description", "")
        if words:
            parts.append(words + "\n")
        if path == "$defs/settings":
            parts.append(table(("Dial", "Values", "Unit", "Default", "What more of it gives, and costs"),
                               dial_rows()) + "\n")
        else:
            parts.append(table(KEYS, key_rows(node)) + "\n")
        if title == "`pairs[]`":
            parts.append("## `shapes.NAME`\n\nOne kind of shape each, in the body's own frame.\n")
            parts.append(table(KEYS, shape_rows()) + "\n")
    parts.append(limits())
    return "\n".join(parts)


def main():
    text = page()
    if "--check" not in sys.argv[1:]:
        PAGE.write_text(text, encoding="utf-8")
        return 0
    if PAGE.exists() and PAGE.read_text(encoding="utf-8") == text:
        return 0
    print("docs/scene.md is not what the schema says; run tools/scene_docs.py")
    return 1


if __name__ == "__main__":
    sys.exit(main())
