"""Reads the C++ headers and writes the headers that the Python module takes its settings and words from.

    settings.py INCLUDES FOLDER HEADER…

words.hpp has the enumerators of every enumeration of the headers (paths within INCLUDES), and NAME.hpp, for each struct
NAMESettings or NAMEWeights, its class of Python's: its members in the order of the struct, with their comments."""

import pathlib
import re
import sys

# Callbacks and pointers, which functions of the module take as arguments.
NO_MEMBERS = re.compile(r"Monitor\b|std::function|const \w+ \*|static ")


def comment(lines):
    """A text of Python's words: without the marks of a comment, members joined to their class by a dot."""
    words = {"true": "True", "false": "False"}
    text = " ".join(re.sub(r"^\s*(///<?|/\*\*|\*/)|\*/$", "", line).strip() for line in lines)
    text = re.sub(r"\b(true|false)\b", lambda found: words[found[0]], " ".join(text.split()))
    return re.sub(r"(?<=\w)::(?=\w)", ".", text)


def members(body):
    """(text, comment) of each thing that ends with one of the marks at the top of a body in braces."""
    found, above, code, open_comment = [], [], "", False
    for line in body.splitlines():
        bare = line.strip()
        if open_comment or bare.startswith(("///", "/**")) and not bare.startswith("///<"):
            above.append(bare)
            open_comment = (open_comment or bare.startswith("/**")) and not bare.endswith("*/")
            continue
        text, mark, behind = bare.partition("///<")
        if not text.strip():
            if mark and found:
                found[-1][1].append("///<" + behind)
            continue
        code += " " + text.strip()
        if re.search(r"[;,]\s*$", code) or not re.search(r"[({=]\s*$", code) and body.rstrip().endswith(line.rstrip()):
            found.append((code.strip(), above + ([mark + behind] if mark else [])))
            above, code = [], ""
        elif mark:
            above.append(mark + behind)
    return [(code.rstrip(";, "), comment(lines)) for code, lines in found]


def blocks(text, kind):
    """(name, what stands behind it, comment above, body) of each struct or enumeration at the top of a namespace."""
    above = r"(?P<above>(?:^///[^\n]*\n)+|^/\*\*(?:[^*]|\*(?!/))*\*/\n)?"
    for found in re.finditer(above + rf"^{kind} (?P<name>\w+)(?P<more>[^\n;{{]*)\n\{{\n(?P<body>.*?)^\}};", text, re.M | re.S):
        yield found["name"], found["more"], comment((found["above"] or "").splitlines()), found["body"]


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def struct(name, about, body, header, scope, words):
    lines = []
    for code, said in members(body):
        if NO_MEMBERS.match(code) or re.match(r"[^=]*\(", code):
            continue
        kind, member = re.match(r"([\w:<>]+) (\w+)", code).groups()
        said = "\n".join([said] + [f"'{word}': {of}" for word, of in words.get(kind, []) if of])
        lines.append(f"      .member({quoted(member)}, &{scope}::{name}::{member}, {quoted(said)})\n")
    return (
        f"#pragma once\n\n#include \"settings.hpp\"\n#include <{header}>\n\nnamespace cattaneo::python\n{{\n\n"
        f"template <>\ninline void bind_settings<{scope}::{name}>(nb::module_ &m)\n{{\n"
        f"   Settings<{scope}::{name}>(m, {quoted(name)}, {quoted(about)})\n{''.join(lines)}      .done();\n}}\n\n"
        "} // namespace cattaneo::python\n"
    )


def main(includes, folder, *headers):
    texts = [(header, pathlib.Path(includes, header).read_text(encoding="utf-8")) for header in headers]
    scopes = {header: re.search(r"^namespace ([\w:]+)$", text, re.M)[1] for header, text in texts}
    words, out = {}, "#pragma once\n\n#include \"arguments.hpp\"\n"
    for header, text in texts:
        for name, more, _, body in blocks(text, "enum class"):
            words[name] = members(body)
            out += f"\nnamespace {scopes[header]}\n{{\nenum class {name}{more};\n}}\ntemplate <>\n"
            out += f"inline const std::vector<std::string> &cattaneo::python::words<{scopes[header]}::{name}>()\n{{\n"
            listed = ", ".join(quoted(word.split(" ")[0]) for word, _ in words[name])
            out += f"   static const std::vector<std::string> all = {{{listed}}};\n   return all;\n}}\n"
    written = {"words.hpp": out}
    for header, text in texts:
        for name, _, about, body in blocks(text, "struct"):
            if name.endswith(("Settings", "Weights")):
                written[f"{name}.hpp"] = struct(name, about, body, header, scopes[header], words)
    for name, content in written.items():
        file = pathlib.Path(folder, name)
        if not file.exists() or file.read_text(encoding="utf-8") != content:
            file.write_text(content, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
