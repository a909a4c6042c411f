"""Where single-line faults can be put into the sources, and how the text reads with them behind a switch.

Each C++ file is parsed with libclang. `points(file)` lists every place an operator of this file knows, with
`before` and `after`: the text reads before + original + after, so that edits nest, and no line is added."""
import hashlib
import re
from dataclasses import dataclass

import clang.cindex as clang
from clang.cindex import CursorKind as Kind
from clang.cindex import TypeKind

INTEGERS = {TypeKind.INT, TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG, TypeKind.ULONGLONG,
            TypeKind.SHORT, TypeKind.USHORT, TypeKind.CHAR_S, TypeKind.SCHAR, TypeKind.UCHAR}
REALS = {TypeKind.DOUBLE, TypeKind.FLOAT, TypeKind.LONGDOUBLE}
NUMBERS = INTEGERS | REALS | {TypeKind.BOOL}
# A sign, a direction or a factor turned round; integers are not divided by what may be 0.
TURNED = {"+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "%": ["/"]}
BOUNDARY = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}
REVERSED = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "==": "!=", "!=": "=="}
EXCHANGED = {"min": "max", "max": "min", "minCoeff": "maxCoeff", "maxCoeff": "minCoeff", "sin": "cos", "cos": "sin",
             "cwiseMin": "cwiseMax", "cwiseMax": "cwiseMin", "topRows": "bottomRows", "head": "tail", "tail": "head",
             "front": "back", "back": "front", "lower_bound": "upper_bound", "upper_bound": "lower_bound"}
SKIPPED = {"abs", "cwiseAbs", "transpose", "sqrt", "reverse"}
HEAD = b"#include <cattaneo/fault_switch.hpp>\n#line 1\n"
HEAD_LINES = HEAD.count(b"\n")
LOOPS = {Kind.FOR_STMT, Kind.WHILE_STMT, Kind.DO_STMT, Kind.CXX_FOR_RANGE_STMT}


@dataclass
class Point:
    """One fault: in the file's bytes start:end, `change` says it on one line."""
    file: str
    line: int
    last: int
    text: str
    operator: str
    change: str
    start: int
    end: int
    before: str
    after: str
    number: int = 0

    def key(self):
        return (self.file, self.text, self.operator, self.change)


def flat(code):
    """Code on one line, without comments."""
    return " ".join(re.sub(r"//[^\n]*|/\*.*?\*/", " ", code, flags=re.S).split())


def headed(cursor):
    return cursor.kind in (Kind.UNEXPOSED_EXPR, Kind.PAREN_EXPR) and len(list(cursor.get_children())) == 1


class Walk:
    def __init__(self, file, path, unit):
        self.file, self.path, self.unit = file, path, unit
        self.source = open(path, "rb").read()
        self.lines = self.source.decode().split("\n")
        self.points = []

    def text(self, a, b):
        # libclang ends some extents within a character of several bytes.
        return self.source[a:b].decode(errors="surrogateescape")

    def span(self, cursor):
        return cursor.extent.start.offset, cursor.extent.end.offset

    def add(self, operator, start, end, before, after, old, new):
        if "#" in self.text(start, end) and re.search(r"^\s*#", self.text(start, end), re.M):
            return
        first = self.source.count(b"\n", 0, start) + 1
        self.points.append(Point(self.file, first, self.source.count(b"\n", 0, end) + 1, self.lines[first - 1].strip(),
                                 operator, f"{flat(old)} -> {flat(new)}", start, end, before, after))

    def value(self, operator, span, new, cast=""):
        """The expression reads as `new`; both are of number types, or of the same type."""
        old = self.text(*span)
        self.add(operator, *span, f"{cast}(cattaneo_fault(@) ? {cast}({flat(new)}) : {cast}(", "))", old, new)

    def condition(self, operator, span, new):
        old = self.text(*span)
        self.add(operator, *span, f"(cattaneo_fault(@) ? bool({flat(new)}) : bool(", "))", old, new)

    def anyhow(self, operator, span, new, number, carrier):
        """As `value`; what is not a number is alternated with the statement or initialiser it stands in."""
        if number:
            return self.value(operator, span, new)
        if carrier is None:
            return None
        how, start, end = carrier
        mutated = flat(self.text(start, span[0]) + new + self.text(span[1], end))
        old = self.text(*span)
        if how == "statement":
            self.add(operator, start, end, f"if (cattaneo_fault(@)) {{ {mutated}; }} else ", "", old, new)
        elif how == "return":
            self.add(operator, start, end, f"if (cattaneo_fault(@)) {{ {mutated}; }} ", "", old, new)
        else:
            self.add(operator, start, end, f"cattaneo_fault(@) ? {how}({mutated}) : {how}(", ")", old, new)

    def skipped(self, operator, span):
        self.add(operator, *span, "if (!cattaneo_fault(@)) ", "", self.text(*span), "nothing")

    def visit(self, cursor, parent, carrier, loop, default):
        kind = cursor.kind
        if kind in (Kind.ENUM_DECL, Kind.STATIC_ASSERT, Kind.CASE_STMT) and kind != Kind.CASE_STMT:
            return
        children = list(cursor.get_children())
        if kind in (Kind.VAR_DECL, Kind.FIELD_DECL, Kind.FUNCTION_DECL, Kind.CXX_METHOD):
            start = cursor.extent.start.offset
            line = self.text(self.source.rfind(b"\n", 0, start) + 1, start + 20)
            if "constexpr" in line:
                return
        if kind in (Kind.FIELD_DECL, Kind.PARM_DECL):
            default = True
        elif kind == Kind.COMPOUND_STMT:
            default = False
        if kind in LOOPS:
            loop = "loop"
        elif kind == Kind.SWITCH_STMT:
            loop = "switch"
        elif kind == Kind.LAMBDA_EXPR:
            loop = carrier = None
        if kind == Kind.VAR_DECL:
            carrier = self.initialiser(cursor, children)
        self.operators(cursor, kind, children, parent, carrier, loop, default)
        if kind == Kind.CASE_STMT:
            children = children[1:]
        if kind == Kind.VAR_DECL and cursor.type.get_canonical().kind == TypeKind.CONSTANTARRAY:
            children = [c for c in children if c.kind != Kind.INTEGER_LITERAL]
        for child in children:
            if kind == Kind.COMPOUND_STMT:
                carrier = None
                if child.kind == Kind.RETURN_STMT:
                    carrier = ("return", *self.span(child))
                elif child.kind.is_expression():
                    carrier = ("statement", *self.span(child))
                    self.statement(child)
            self.visit(child, cursor, carrier, loop, default)

    def initialiser(self, cursor, children):
        """`Type name = expression` of a class type: the expression may be alternated."""
        if cursor.type.get_canonical().kind != TypeKind.RECORD or not children:
            return None
        start, end = self.span(cursor)
        init = self.span(children[-1])
        declared = re.match(r"(?:static\s+|const\s+)*(.*?)\s*\b" + re.escape(cursor.spelling) + r"\s*=\s*$",
                            self.text(start, init[0]), re.S)
        if not declared or "auto" in declared[1] or init[1] != end or not re.match(r"[\w:]+$", declared[1]):
            return None
        return (declared[1], *init)

    def statement(self, child):
        span = self.span(child)
        inner = child
        while headed(inner) or inner.kind == Kind.UNEXPOSED_EXPR and list(inner.get_children()):
            inner = list(inner.get_children())[0]
        text = self.text(*span)
        if text.startswith("require") or inner.kind == Kind.CXX_THROW_EXPR:
            self.skipped("validation dropped", span)
        elif inner.kind == Kind.CALL_EXPR or inner.kind == Kind.CXX_DELETE_EXPR:
            operator = "assignment" if inner.spelling.startswith("operator") else "call"
            if inner.spelling not in ("operator<<", "operator++", "operator--"):
                self.skipped(f"{operator} dropped", span)
        elif inner.kind in (Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR):
            self.skipped("assignment dropped", span)

    def operators(self, cursor, kind, children, parent, carrier, loop, default):
        span = self.span(cursor)
        number = cursor.type.get_canonical().kind in NUMBERS
        if kind in (Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR) and len(children) == 2:
            self.binary(children, span, number, carrier)
        elif kind == Kind.CALL_EXPR:
            arguments = list(cursor.get_arguments())
            if cursor.spelling.startswith("operator") and len(arguments) == 2 and cursor.spelling != "operator()":
                self.binary(arguments, span, False, carrier)
            else:
                self.call(cursor, arguments, span, number, carrier)
        elif kind == Kind.UNARY_OPERATOR and children:
            inner = self.span(children[0])
            operator = self.text(span[0], inner[0]).strip()
            if operator == "-":
                self.anyhow("sign", span, self.text(*inner), number, carrier)
            elif operator == "!":
                self.condition("condition", span, self.text(*inner))
        elif kind in (Kind.IF_STMT, Kind.CONDITIONAL_OPERATOR) and children:
            if children[0].kind.is_expression():
                inner = self.span(children[0])
                self.condition("condition", inner, f"!({self.text(*inner)})")
        elif kind == Kind.RETURN_STMT and children:
            if children[0].type.get_canonical().kind == TypeKind.BOOL:
                inner = self.span(children[0])
                self.condition("condition", inner, f"!({self.text(*inner)})")
        elif kind in (Kind.INTEGER_LITERAL, Kind.FLOATING_LITERAL, Kind.CXX_BOOL_LITERAL_EXPR):
            self.literal(cursor, kind, parent, span, default)
        elif kind == Kind.DECL_REF_EXPR:
            self.enumerator(cursor, span)
        elif kind in (Kind.BREAK_STMT, Kind.CONTINUE_STMT) and loop == "loop":
            old, new = ("break", "continue") if kind == Kind.BREAK_STMT else ("continue", "break")
            self.add("jump", *span, f"if (cattaneo_fault(@)) {{ {new}; }} ", "", old, new)

    def binary(self, children, span, number, carrier):
        left, right = self.span(children[0]), self.span(children[1])
        if not (span[0] <= left[0] and left[1] <= right[0] and right[1] <= span[1]):
            return
        operator = flat(self.text(left[1], right[0]))
        a, b = self.text(*left), self.text(*right)
        types = {c.type.get_canonical().kind for c in children}
        numbers = types <= NUMBERS
        if operator in TURNED:
            for new in TURNED[operator]:
                if operator in "*/" and types <= INTEGERS:
                    new = "+"
                name = "sign" if operator in "+-" else "factor"
                self.anyhow(name, span, f"{a} {new} {b}", number, carrier)
            self.anyhow("term dropped", span, a, number, carrier)
        elif operator in ("+=", "-=", "*=", "/="):
            new = TURNED[operator[0]][0]
            if operator[0] in "*/" and types & INTEGERS:
                return
            self.anyhow("sign" if operator[0] in "+-" else "factor", span, f"{a} {new}= {b}", number and numbers,
                        carrier)
        elif operator in REVERSED:
            # Reals meet by chance: only a bound written as a constant is one that they are expected to meet.
            if operator in BOUNDARY and (types <= INTEGERS or re.fullmatch(r"-?[\d.]+", b.strip())):
                self.condition("comparison", span, f"{a} {BOUNDARY[operator]} {b}")
            self.condition("comparison", span, f"{a} {REVERSED[operator]} {b}")
        elif operator in ("&&", "||"):
            self.condition("condition", span, f"{a} {'||' if operator == '&&' else '&&'} {b}")
            self.condition("condition", span, a)
            self.condition("condition", span, b)

    def call(self, cursor, arguments, span, number, carrier):
        name = cursor.spelling
        spans = [self.span(a) for a in arguments]
        # The name stands before the bracket that opens the arguments.
        opening = spans[0][0] if spans else span[1]
        pattern = rb"\b%s\b" % re.escape(name).encode()
        found = list(re.finditer(pattern, self.source[span[0]:opening])) if name else []
        if name in EXCHANGED and found:
            at = span[0] + found[-1].start()
            new = self.text(span[0], at) + EXCHANGED[name] + self.text(at + len(name), span[1])
            self.anyhow("function", span, new, number, carrier)
        if name in SKIPPED and found:
            at = span[0] + found[-1].start()
            if len(spans) == 1:
                self.anyhow("function", span, f"({self.text(*spans[0])})", number, carrier)
            elif self.text(at - 1, at) == ".":
                self.anyhow("function", span, self.text(span[0], at - 1), number, carrier)
        for one, two in zip(range(len(spans)), range(1, len(spans))):
            a, b = self.text(*spans[one]), self.text(*spans[two])
            kinds = [arguments[i].type.get_canonical().kind for i in (one, two)]
            same = arguments[one].type.get_canonical().spelling.replace("const ", "") == \
                arguments[two].type.get_canonical().spelling.replace("const ", "")
            if not a.strip() or a == b or spans[one][1] > spans[two][0] or name.startswith(("require", "min", "max")):
                continue
            if same and (kinds[0] in NUMBERS or kinds[0] == TypeKind.RECORD and "basic_string" not in
                         arguments[one].type.get_canonical().spelling):
                new = (self.text(span[0], spans[one][0]) + b + self.text(spans[one][1], spans[two][0]) + a +
                       self.text(spans[two][1], span[1]))
                self.anyhow("arguments exchanged", span, new, number, carrier)

    def literal(self, cursor, kind, parent, span, default):
        old = self.text(*span)
        if kind == Kind.CXX_BOOL_LITERAL_EXPR:
            if old in ("true", "false"):
                self.value("default" if default else "constant", span, "false" if old == "true" else "true")
            return
        # A literal that the compiler made itself has the text of whatever stands at its place.
        text = r"\d+[uUlL]*" if kind == Kind.INTEGER_LITERAL else r"(\d+\.?\d*|\.\d+)(e[-+]?\d+)?[lf]?"
        if not re.fullmatch(text, old, re.I):
            return
        # Where a number is converted as it is read, the switch must have the type that is wanted.
        cast = ""
        if parent is not None and parent.kind == Kind.UNEXPOSED_EXPR and self.span(parent) == span:
            wanted = parent.type.get_canonical()
            if wanted.kind in NUMBERS and wanted.kind != cursor.type.get_canonical().kind:
                cast = f"static_cast<{wanted.spelling.replace('const ', '')}>"
        if kind == Kind.FLOATING_LITERAL:
            new = "1.0" if float(old.rstrip("lLfF")) == 0 else f"(2 * {old})"
            self.value("default" if default else "constant", span, new, cast)
        else:
            n = int(old.rstrip("uUlL"), 0)
            for new in ([n + 1, n - 1] if n > 0 else [n + 1]):
                self.value("default" if default else "index", span, str(new), cast)

    def enumerator(self, cursor, span):
        meant = cursor.referenced
        if meant is None or meant.kind != Kind.ENUM_CONSTANT_DECL or "cattaneo" not in str(meant.location.file):
            return
        names = [c.spelling for c in meant.semantic_parent.get_children() if c.kind == Kind.ENUM_CONSTANT_DECL]
        old = self.text(*span)
        if len(names) > 1 and old.endswith(meant.spelling):
            other = names[(names.index(meant.spelling) + 1) % len(names)]
            self.value("enumerator", span, old[:-len(meant.spelling)] + other)


def parsed(path, arguments):
    """Without the templates that wait at the end of a file for their bodies, which take nearly all of the time."""
    return clang.Index.create().parse(path, args=arguments, options=clang.TranslationUnit.PARSE_INCOMPLETE)


def points(job):
    """All points of one file; job = (name to report, path, compiler arguments)."""
    file, path, arguments = job
    unit = parsed(path, arguments)
    errors = [str(d) for d in unit.diagnostics if d.severity >= 3]
    if errors:
        raise RuntimeError(f"{file} cannot be parsed: {errors[0]}")
    walk = Walk(file, path, unit)
    for cursor in unit.cursor.get_children():
        if cursor.location.file and cursor.location.file.name == path:
            walk.visit(cursor, None, None, None, False)
    seen = {}
    for point in walk.points:  # one cursor can be met twice (the two forms of an initialiser list)
        seen.setdefault((point.start, point.end, point.before, point.after), point)
    return list(seen.values())


def errors(job):
    """Lines of the file at which libclang finds an error, and those of its notes: an error within a generic lambda
    or a template comes from the line that calls it."""
    file, path, arguments = job
    unit = parsed(path, arguments)
    found = [d for error in unit.diagnostics if error.severity >= 3 for d in (error, *error.children)]
    return {(file, d.location.line - HEAD_LINES) for d in found
            if d.location.file and d.location.file.name == path}


def rank(point, seed, count):
    """A random number that stays with the fault while other lines come and go."""
    return hashlib.sha256(repr((seed, point.key(), count)).encode()).hexdigest()


def rewritten(source, edits):
    """The file's bytes with these points behind the switch: edits nest, the outer first."""
    edits = sorted(edits, key=lambda p: (p.start, -p.end, p.number))

    def render(start, end, rest):
        out = []
        while rest:
            point, inner, after = rest[0], [], []
            for other in rest[1:]:
                (inner if other.start < point.end else after).append(other)
            out.append(source[start:point.start])
            out.append(point.before.replace("@", str(point.number), 1).encode(errors="surrogateescape"))
            out.append(render(point.start, point.end, inner))
            out.append(point.after.encode(errors="surrogateescape"))
            start, rest = point.end, after
        out.append(source[start:end])
        return b"".join(out)

    return HEAD + render(0, len(source), edits)
