"""case_schema.py CONTACT2D SCHEMA CASE...: the schema of case files has contact2d's keys, and shipped cases fit it."""

import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile


def keys_of(program):
    """What the program says of a key that it does not know."""
    with tempfile.TemporaryDirectory() as folder:
        case = pathlib.Path(folder) / "case.json"
        case.write_text('{"nonsense": 1}', encoding="utf-8")
        run = subprocess.run([program, "--case", str(case)], text=True, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, check=False)
    return set(run.stdout.split("must be one of ")[1].strip().split(", "))


def main():
    program, schema_file, *cases = sys.argv[1:]
    schema = json.loads(pathlib.Path(schema_file).read_text(encoding="utf-8"))
    wrong = keys_of(program) ^ (set(schema["properties"]) - {"$schema"})
    for key in sorted(wrong):
        print(f"'{key}' is a key of one alone, of the program or of the schema")
    if importlib.util.find_spec("jsonschema") is None:
        print("no python3-jsonschema: shipped cases are not compared with the schema")
    else:
        import jsonschema
        for case in cases:
            data = json.loads(pathlib.Path(case).read_text(encoding="utf-8"))
            jsonschema.validate(data, schema)
            for bad in ({**data, "friction": "much"}, {**data, "yung1": 2}, {**data, "cycles": 1.5}):
                assert list(jsonschema.Draft202012Validator(schema).iter_errors(bad)), bad
    sys.exit(bool(wrong) or not cases)


main()
