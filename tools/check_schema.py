#!/usr/bin/env python3
"""Checks scene/files/scene.schema.json against the dials of this build and against scene files.

    tools/check_schema.py [SCENE.json]...

Without arguments, the seeds of the scene fuzzer are the scenes. Needs python3-jsonschema; without
it, says so and leaves with 77, which test runners count as skipped.
"""
import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)

sys.dont_write_bytecode = True
import scene_docs  # noqa: E402

root = pathlib.Path(__file__).resolve().parent.parent
schema = json.loads((root / "scene/files/scene.schema.json").read_text())
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
trouble = []

# Every dial of the table is in the schema, and none that is not.
dials = scene_docs.dials()
listed = set(schema["$defs"]["settings"]["properties"])
if set(dials) != listed:
    trouble.append(f"settings: dials and schema differ in {sorted(set(dials) ^ listed)}")

# Dials with names for values: the same names in the same order, the default first.
for name, dial in dials.items():
    stated = scene_docs.resolved(schema["$defs"]["settings"]["properties"].get(name, {}))
    if dial["choices"] and dial["choices"] != stated.get("enum"):
        trouble.append(f"settings.{name}: the dial has the values {dial['choices']}")
    if dial["choices"] and dial["choices"][0] != stated.get("default"):
        trouble.append(f"settings.{name}: the dial's default is {dial['choices'][0]}")
    if not dial["choices"] and "default" not in stated:
        trouble.append(f"settings.{name}: no default is stated")

seeds = root / "tests/fuzz/corpus/scene_file"
for path in [pathlib.Path(a) for a in sys.argv[1:]] or sorted(seeds.glob("*.json")):
    # What follows the mark is the content of the files that a seed names.
    text = path.read_bytes().split(b"%%%")[0]
    for error in validator.iter_errors(json.loads(text)):
        trouble.append(f"{path}: {error.json_path}: {error.message}")

print("\n".join(trouble) or f"schema: {len(dials)} dials, all scenes good")
sys.exit(1 if trouble else 0)
