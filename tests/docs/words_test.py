"""words_test.py: words.py finds every kind of fault in sentences that have it, and none in those that do not."""

import pathlib
import sys
import tempfile

import words

LONG, FITS = "It " + "really " * 39 + "slips.", "It " + "really " * 38 + "slips."
CELL, FITTING_CELL = "word " * 26, "word " * 25
AVOIDED = {"slip region": "slip zone", "half plane": "half-plane"}

# (text of a page, what its faults begin with)
PAGES = [
    (f"# Title\n\n{LONG}", ["a sentence of 41 words"]),
    (f"* Short.\n* {LONG}\n", ["a sentence of 41 words"]),
    (f"1. {LONG}\n2. Short.\n", ["a sentence of 41 words"]),
    (LONG.replace(" really", "\nreally"), ["a sentence of 41 words"]),
    (f"Before. {LONG} After.", ["a sentence of 41 words"]),
    (f"**{LONG}** After.", ["a sentence of 41 words"]),
    (f"  deep in a list\n\n  {LONG}", ["a sentence of 41 words"]),
    ("Of all nodes one slips.", ["a sentence that begins with 'Of'"]),
    ("It sticks. Of all nodes one slips.", ["a sentence that begins with 'Of'"]),
    ("* **Of all nodes** one slips.", ["a sentence that begins with 'Of'"]),
    ("What slips is worn.", ["a sentence 'What … is'"]),
    ("It sticks. *What was free* has moved.", ["a sentence 'What … is'"]),
    ("## What is solved", ["a sentence 'What … is'"]),
    (f"| a | b |\n|---|---|\n| {CELL} | short |", ["a cell of 26 words"]),
    ("| a slip region | b |\n|---|---|\n", ["'slip region'"]),
    ("The Slip regions grow on a half plane.", ["'slip region'", "'half plane'"]),
    # None of these is a fault.
    (FITS, []),
    (f"{FITS} {FITS}", []),
    (f"| {FITTING_CELL} | b |", []),
    ("What is a slip zone?", []),
    ("*What to do:* the node is free.", []),
    ("A part of it. Offset nodes stick. Whatever is left slips.", []),
    (f"```\n{LONG}\nOf all.\n```\n", []),
    (f"    {LONG}\n", []),
    (f"<!-- {LONG} -->", []),
    ("The key `slip region` and half-plane.", []),
]

# (C++ code, what the faults of its literals begin with)
CPP = [
    (f'fail("{LONG}");', ["a sentence of 41 words"]),
    (f'fail("{LONG[:100]}"\n   // why\n     "{LONG[100:]}");', ["a sentence of 41 words"]),
    ('say("It sticks.\\nOf all nodes one slips.");', ["a sentence that begins with 'Of'"]),
    ('say("\\"What slips\\" is worn: What is worn is gone.");', []),
    ('say("What slips is worn.");', ["a sentence 'What … is'"]),
    ("x = 1'000; say(\"the slip region\");", ["'slip region'"]),
    (f'// "{LONG}"\n/* "Of all." */ char c = \'"\'; say("short");', []),
    (f'say("{LONG[:100]}", "{LONG[100:]}");', []),
    (f'auto page = R"(Of all. {LONG})";', []),
]

PYTHON = [
    ('"""Of a module."""\nraise ValueError("Of all nodes one slips.")', ["a sentence that begins with 'Of'"]),
    ('def f():\n    """What is it is documented."""\n    return f"the slip region {x}"', ["'slip region'"]),
]


def begins(found, wanted, text):
    found = list(found)
    if len(found) != len(wanted) or not all(fault.startswith(start) for fault, start in zip(found, wanted)):
        sys.exit(f"words.py finds {found} where {wanted} is to be found:\n{text}")


for page, wanted in PAGES:
    begins(words.faults_of_page(page, AVOIDED), wanted, page)
for code, wanted in CPP:
    begins(words.faults_of_messages(words.literals_of_cpp(code), AVOIDED), wanted, code)
for code, wanted in PYTHON:
    begins(words.faults_of_messages(words.literals_of_python(code), AVOIDED), wanted, code)

GLOSSARY = "# Glossary\n\n| word | meaning |\n|---|---|\n| slip | a |\n\n## Avoided\n\n| avoided | instead |\n|---|---|\n| slip region, adhesive zone | a zone |\n"
assert words.avoided_terms(GLOSSARY) == {"slip region": "a zone", "adhesive zone": "a zone"}, words.avoided_terms(GLOSSARY)

# A repository with a fault more than its list allows, with as many, with fewer, and with a line for no file.
with tempfile.TemporaryDirectory() as folder:
    source = pathlib.Path(folder)
    (source / "docs").mkdir()
    (source / "plugin").mkdir()
    (source / "README.md").write_text("Of all. What is it is it.", encoding="utf-8")
    (source / "docs/glossary.md").write_text(GLOSSARY, encoding="utf-8")
    (source / "plugin/a.cpp").write_text('say("the slip region")', encoding="utf-8")
    words.ALLOWED = source / "words.txt"
    for allowed, wanted, remarked in [("", 3, 0), ("2 README.md\n1 plugin/a.cpp", 0, 0), ("1 README.md\n1 plugin/a.cpp", 2, 0),
                                      ("3 README.md\n1 plugin/a.cpp", 0, 1), ("# a list\n2 README.md\n1 plugin/a.cpp\n1 plugin/b.cpp", 1, 0)]:
        words.ALLOWED.write_text(allowed, encoding="utf-8")
        wrong, remarks = words.faults(source)
        if (len(wrong), len(remarks)) != (wanted, remarked):
            sys.exit(f"words.py finds {wrong} and remarks {remarks} with this list:\n{allowed}")
print(f"words.py is right about {len(PAGES) + len(CPP) + len(PYTHON)} texts")
