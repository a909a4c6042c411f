"""Refuses the worst sentences of README.md, docs/ and the messages of the programs.

words.py [SOURCE]

A fault is

* a sentence of more than 40 words,
* a sentence that begins with "Of ",
* a sentence "What … is …" that is no question,
* a cell of a table with more than 25 words,
* a term that docs/glossary.md lists as avoided.

Code spans, code blocks and comments of HTML are no sentences. Messages are the string literals of plugin/,
miniapps/ and python/, of which those side by side are one. words.txt has the files that are not rewritten yet, with
the number of faults that each may have at most; the list can only shrink. words_test.py tests this file.
"""

import ast
import pathlib
import re
import sys

MOST_WORDS, MOST_WORDS_OF_CELL = 40, 25
ALLOWED = pathlib.Path(__file__).resolve().with_name("words.txt")


def paragraphs(page):
    """(paragraphs and items of lists, cells of tables) of a page in Markdown."""
    page = re.sub(r"```.*?```|<!--.*?-->|<a id=[^>]*></a>", "", page, flags=re.S)
    texts, cells = [], []
    for block in re.split(r"\n\s*\n", page):
        lines = [line for line in block.split("\n") if line.strip()]
        if all(line.startswith("    ") for line in lines):
            continue
        rows = [line.strip().strip("|") for line in lines if line.lstrip().startswith("|")]
        cells += [cell.strip() for row in rows for cell in re.split(r"(?<!\\)\|", row) if not re.fullmatch(r"[\s:-]*", cell)]
        text = ""
        for line in lines:
            if line.lstrip().startswith("|"):
                continue
            if re.match(r"\s*([*-]|\d+\.|#+)\s", line):
                texts.append(text)
                text = ""
                line = re.sub(r"^\s*([*-]|\d+\.|#+)\s", "", line)
            text += " " + line.strip()
        texts.append(text)
    return [text.strip() for text in texts if text.strip()], cells


def sentences(text):
    return re.split(r"(?<=[.!?])[*_]*\s+(?=[A-Z`*(\[])", text.strip())


def short(text):
    return text if len(text) < 90 else text[:87] + "…"


def faults_of_sentence(sentence, avoided):
    words = len(sentence.split())
    if words > MOST_WORDS:
        yield f"a sentence of {words} words (at most {MOST_WORDS}): {short(sentence)}"
    start = sentence.lstrip("*_( ")
    if start.startswith("Of "):
        yield f"a sentence that begins with 'Of': {short(sentence)}"
    if re.match(r"What\b(?! to do).*\b(is|are|was|has)\b", start) and not re.search(r"\?[*_)]*$", sentence):
        yield f"a sentence 'What … is': {short(sentence)}"
    yield from faults_of_terms(sentence, avoided)


def faults_of_terms(text, avoided):
    plain = re.sub(r"`[^`]*`", "", text)
    for term, instead in avoided.items():
        if re.search(rf"(?<![\w-]){re.escape(term)}s?(?![\w-])", plain, re.I):
            yield f"'{term}', which docs/glossary.md avoids (instead: {instead}): {short(text)}"


def faults_of_page(page, avoided):
    texts, cells = paragraphs(page)
    for text in texts:
        for sentence in sentences(text):
            yield from faults_of_sentence(sentence, avoided)
    for cell in cells:
        if len(cell.split()) > MOST_WORDS_OF_CELL:
            yield f"a cell of {len(cell.split())} words (at most {MOST_WORDS_OF_CELL}): {short(cell)}"
        yield from faults_of_terms(cell, avoided)


def literals_of_cpp(code):
    """String literals, those side by side as one. Raw strings, which are pages and schemas, are left out."""
    token = re.compile(
        r'(?P<raw>R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)")|(?P<comment>//[^\n]*|/\*.*?\*/)|"(?P<text>(?:[^"\\\n]|\\.)*)"'
        r"|(?P<char>'(?:[^'\\\n]|\\.)+')|(?P<space>\s+)|(?P<number>\d[\w']*)|(?P<other>\w+|.)", re.S)
    found, open_literal = [], False
    for match in token.finditer(code):
        if match["text"] is not None:
            if open_literal:
                found[-1] += match["text"]
            else:
                found.append(match["text"])
            open_literal = True
        elif match["space"] is None and match["comment"] is None:
            open_literal = False
    return [text.replace(r"\n", "\n").replace(r"\"", '"') for text in found]


def literals_of_python(code):
    """String literals but for docstrings; the fixed parts of an f-string are literals of their own."""
    tree = ast.parse(code)
    documents = {id(node.body[0].value) for node in ast.walk(tree)
                 if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and node.body and isinstance(node.body[0], ast.Expr)}
    return [node.value for node in ast.walk(tree)
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documents]


def faults_of_messages(literals, avoided):
    for literal in literals:
        for line in literal.split("\n"):
            for sentence in sentences(line):
                yield from faults_of_sentence(sentence, avoided)


def avoided_terms(glossary):
    """{term: what stands instead} of the table under the heading "Avoided"."""
    table = glossary.partition("\n## Avoided\n")[2].partition("\n## ")[0]
    rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in table.split("\n") if line.startswith("|")]
    return {term.strip(): row[1] for row in rows[2:] for term in row[0].split(",")}


def allowed(text):
    return {file: int(number) for number, file in (line.split() for line in text.split("\n") if line and not line.startswith("#"))}


def faults(source):
    """Faults of all files of the repository that are more than words.txt allows, and remarks on files that could be allowed less."""
    glossary = source / "docs/glossary.md"
    avoided = avoided_terms(glossary.read_text(encoding="utf-8"))
    found = {}
    for page in [source / "README.md", *sorted(source.glob("docs/*.md"))]:
        text = page.read_text(encoding="utf-8")
        if page == glossary:
            text = text.partition("\n## Avoided\n")[0]
        found[page] = list(faults_of_page(text, avoided))
    for folder in ("plugin", "miniapps", "python"):
        for file in sorted((source / folder).rglob("*")):
            if file.suffix in (".cpp", ".hpp"):
                found[file] = list(faults_of_messages(literals_of_cpp(file.read_text(encoding="utf-8")), avoided))
            elif file.suffix == ".py" and "tests" not in file.parts:
                found[file] = list(faults_of_messages(literals_of_python(file.read_text(encoding="utf-8")), avoided))
    limits = allowed(ALLOWED.read_text(encoding="utf-8"))
    wrong, remarks = [], []
    for file, texts in found.items():
        name = str(file.relative_to(source))
        limit = limits.pop(name, 0)
        if len(texts) > limit:
            at_most = f" ({len(texts)} faults, words.txt allows {limit})" if limit else ""
            wrong += [f"{name}{at_most}: {text}" for text in texts]
        elif len(texts) < limit:
            remarks.append(f"{name} has {len(texts)} faults, so tests/docs/words.txt can allow less than {limit}")
    wrong += [f"tests/docs/words.txt: {name} is no file that is checked" for name in limits]
    return wrong, remarks


if __name__ == "__main__":
    wrong, remarks = faults(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ALLOWED.parents[2]).resolve())
    for line in remarks + wrong:
        print(line)
    print(f"{len(wrong)} faults in sentences of README, docs and messages")
    sys.exit(1 if wrong else 0)
