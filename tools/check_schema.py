#!/usr/bin/env python3
"""Checks that scene/files/scene.schema.json is a schema, and takes scene files.

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

root = pathlib.Path(__file__).resolve().parent.parent
schema = json.loads((root / "scene/files/scene.schema.json").read_text())
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
trouble = []

seeds = root / "tests/fuzz/corpus/scene_file"
for path in [pathlib.Path(a) for a in sys.argv[1:]] or sorted(seeds.glob("*.json")):
    # What follows the mark is the content of the files that a seed names.
    text = path.read_bytes().split(b"%%%")[0]
    for error in validator.iter_errors(json.loads(text)):
        trouble.append(f"{path}: {error.json_path}: {error.message}")

print("\n".join(trouble) or "schema: all scenes good")
sys.exit(1 if trouble else 0)
