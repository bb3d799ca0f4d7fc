"""Where a source can be mutated: libclang finds the places, so that operands, statements and contexts are those of the language.

A site replaces text[start:end] by `after`. What libclang knows to be needed at compile time (template arguments, case labels, sizes,
constexpr variables) and text in macros have none.
"""
import re
import sys
from dataclasses import dataclass, field

sys.path.append("/usr/lib/python3/dist-packages")  # Debian's package, whichever Python runs this
try:
    from clang import cindex
    from clang.cindex import CursorKind as Kind
except ImportError:
    sys.exit("ci/planted/mutants: the Python module clang is missing (Debian: python3-clang-14)")
if not cindex.Config.loaded:
    cindex.Config.set_library_file("libclang-14.so.1")

OPERATORS = ("comparison", "sign", "constant", "dropped", "off-by-one")

COMPARISONS = {"<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",)}
SIGNS = {"+": ("-",), "-": ("+",), "+=": ("-=",), "-=": ("+=",)}
GAP = re.compile(r"\s*(<=|>=|==|!=|\+=|-=|<|>|\+|-)\s*")
INTEGER = re.compile(r"(0[xX][0-9a-fA-F']+|0[bB][01']+|[0-9']+)([uUlLzZ]*)")
FLOAT = re.compile(r"[0-9.][0-9a-fA-FxXpP.'+-]*?[fFlL]?")

NAMED_CONSTANT = re.compile(r"(\w+::)*k[A-Z]\w*")
FLOATING = {cindex.TypeKind.DOUBLE, cindex.TypeKind.FLOAT}
INTEGRAL = {cindex.TypeKind.INT, cindex.TypeKind.UINT, cindex.TypeKind.LONG, cindex.TypeKind.ULONG}

# Calls whose absence nobody can see but by the clock or in memory.
ONLY_TIME = re.compile(r"(\.|->|^)(reserve|shrink_to_fit|__builtin_prefetch|prefetch\w*)\s*\(")

# Room for one more than is needed changes nothing either.
ROOM = re.compile(r"(\.|->)(resize|assign)\($|\bvector<.*> \w+\($")

CONSTANT = {Kind.ENUM_DECL, Kind.STATIC_ASSERT, Kind.TEMPLATE_NON_TYPE_PARAMETER, Kind.TEMPLATE_TYPE_PARAMETER, Kind.TYPEDEF_DECL,
            Kind.TYPE_ALIAS_DECL, Kind.TYPE_REF, Kind.TEMPLATE_REF, Kind.FRIEND_DECL}
CALLS = {Kind.CALL_EXPR, Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR}
BODIES = {Kind.COMPOUND_STMT, Kind.IF_STMT, Kind.FOR_STMT, Kind.WHILE_STMT, Kind.DO_STMT, Kind.CXX_FOR_RANGE_STMT}
EXPRESSIONS = {Kind.CALL_EXPR, Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR, Kind.UNARY_OPERATOR, Kind.UNEXPOSED_EXPR}


@dataclass
class Site:
    file: str
    line: int
    start: int
    end: int
    operator: str
    before: str
    after: str
    statement: bool = False
    number: int = 0
    children: list = field(default_factory=list)

    def key(self, line_text, occurrence):
        """The same mutation has the same key as long as its line stays what it is."""
        return "\t".join((self.file, line_text.strip(), self.operator, one_line(self.before), one_line(self.after), str(occurrence)))


def one_line(text):
    return re.sub(r"\s+", " ", text).strip()


class Finder:
    """Collects the sites of translation units in the files under some folders."""

    def __init__(self, root, wanted):
        self.root, self.wanted, self.index = root.rstrip("/") + "/", wanted, cindex.Index.create()
        self.texts, self.sites, self.seen = {}, {}, set()

    def parse(self, sources, arguments):
        """All of them at once; one by one if they do not agree."""
        together = self.root + "together.cpp"
        unit = self.index.parse(together, args=arguments, unsaved_files=[(together, "".join(f'#include "{s}"\n' for s in sources))],
                                options=cindex.TranslationUnit.PARSE_DETAILED_PROCESSING_RECORD)
        errors = [d for d in unit.diagnostics if d.severity >= cindex.Diagnostic.Error]
        if errors and len(sources) > 1:
            for source in sources:
                self.parse([source], arguments)
            return
        if errors:
            raise RuntimeError(f"{sources[0]}: {errors[0].spelling}")
        self.macros = {}
        files = set()
        for cursor in unit.cursor.get_children():
            name = cursor.location.file.name if cursor.location.file else None
            file = self.relative(name)
            if file is None or file in self.seen:
                continue
            files.add(file)
            if cursor.kind == Kind.MACRO_INSTANTIATION:
                self.macros.setdefault(file, []).append((cursor.extent.start.offset, cursor.extent.end.offset))
            elif cursor.kind not in (Kind.MACRO_DEFINITION, Kind.INCLUSION_DIRECTIVE):
                self.visit(cursor, None, file)
        self.seen |= files

    def relative(self, name):
        if name is None or not name.startswith(self.root):
            return None
        file = name[len(self.root):]
        return file if self.wanted(file) else None

    def text(self, file):
        if file not in self.texts:
            with open(self.root + file, "rb") as f:
                self.texts[file] = f.read().decode("latin-1")  # offsets are bytes
        return self.texts[file]

    def visit(self, cursor, parent, file):
        kind = cursor.kind
        if kind in CONSTANT:
            return
        children = list(cursor.get_children())
        text = self.text(file)
        start, end = cursor.extent.start.offset, cursor.extent.end.offset
        if kind in (Kind.VAR_DECL, Kind.FIELD_DECL):
            head = text[start:cursor.location.offset]
            if "constexpr" in head or (kind == Kind.FIELD_DECL and cursor.is_bitfield()):
                return
            # The type may name constants: what is initialised stands behind the name.
            children = [c for c in children if c.extent.start.offset >= cursor.location.offset]
            if cursor.type.kind == cindex.TypeKind.CONSTANTARRAY or text[end - 1:end] == "]":
                children = [c for c in children if c.kind == Kind.INIT_LIST_EXPR]
        elif kind == Kind.CASE_STMT:
            children = children[1:]
        elif kind == Kind.IF_STMT and re.match(r"if\s+constexpr", text[start:]):
            children = children[1:]
        elif kind.is_expression() or kind.is_statement():
            self.consider(cursor, children, parent, file, text, start, end)
        for child in children:
            if child.extent.start.file and self.relative(child.extent.start.file.name) == file:
                self.visit(child, cursor, file)

    def add(self, file, start, end, operator, after, statement=False):
        text = self.text(file)
        before = text[start:end]
        if any(s < end and start < e and not (start <= s and e <= end) or (s <= start and end <= e)
               for s, e in self.macros.get(file, ())):
            return
        first, last = text.rfind("\n", 0, start) + 1, text.find("\n", end)
        lines = text[first:last]
        if "//" in before or "#" in before:
            return
        if text[start - 1] == "<" or text[end:end + 1] == ">":
            return  # a template argument, by the formatting
        if any(w in lines for w in ("operator<", "template <", "static_assert")):
            return
        site = Site(file, text.count("\n", 0, start) + 1, start, end, operator, before, after, statement)
        self.sites.setdefault((file, start, end, after), site)

    def consider(self, cursor, children, parent, file, text, start, end):
        kind = cursor.kind
        source = text[start:end]
        if not source:
            return  # made by a macro
        if kind in CALLS and len(children) >= 2:
            left, right = children[0].extent, children[-1].extent
            gap = GAP.fullmatch(text[left.end.offset:right.start.offset])
            if gap and left.start.offset == start and right.end.offset == end:
                self.binary(file, text, start, end, gap.group(1), left.end.offset, right.start.offset, parent)
        if kind == Kind.UNARY_OPERATOR and source[0] == "-" and source[1] != "-":
            self.add(file, start, end, "sign", "(" + source[1:] + ")")
        if kind == Kind.UNARY_OPERATOR and source[0] == "!" and source[1] != "=":
            self.add(file, start, end, "comparison", "static_cast<bool>(" + source[1:] + ")")
        if kind == Kind.INTEGER_LITERAL:
            match = INTEGER.fullmatch(source)
            if match:
                value = int(match.group(1).replace("'", "") or "0", 0) if not re.fullmatch("0[0-9]+", match.group(1)) else 0
                self.add(file, start, end, "constant", f"{value + 1}{match.group(2)}")
                if value > 0:
                    self.add(file, start, end, "constant", f"{value - 1}{match.group(2)}")
        if kind == Kind.FLOATING_LITERAL and FLOAT.fullmatch(source):
            try:
                zero = (float.fromhex(source) if "x" in source.lower() else float(source.replace("'", ""))) == 0
            except ValueError:
                return
            if zero:
                self.add(file, start, end, "constant", "1.0")
            else:
                self.add(file, start, end, "constant", f"(2 * {source})")
                self.add(file, start, end, "constant", f"(0.5 * {source})")
        if kind == Kind.CXX_BOOL_LITERAL_EXPR and source in ("true", "false"):
            self.add(file, start, end, "constant", "false" if source == "true" else "true")
        if kind == Kind.DECL_REF_EXPR and NAMED_CONSTANT.fullmatch(source):
            self.named(cursor, file, start, end, source)
        if kind == Kind.CALL_EXPR and re.search(r"(\.|->)size\(\)$", source):
            self.add(file, start, end, "off-by-one", f"({source} - 1)")
            if not ROOM.search(text[:start].rsplit("\n", 1)[-1]):
                self.add(file, start, end, "off-by-one", f"({source} + 1)")
        if parent is not None and parent.kind in BODIES:
            self.statement(cursor, children, parent, file, text, start, end)

    def named(self, cursor, file, start, end, source):
        """A use of a constant that has a name and is needed when compiling, so that its definition cannot be switched."""
        kind = cursor.type.get_canonical().kind
        if kind in FLOATING:
            self.add(file, start, end, "constant", f"(2 * {source})")
            self.add(file, start, end, "constant", f"(0.5 * {source})")
        elif kind in INTEGRAL:
            self.add(file, start, end, "constant", f"({source} + 1)")
            self.add(file, start, end, "constant", f"({source} - 1)")

    def binary(self, file, text, start, end, op, left_end, right_start, parent):
        left, right = text[start:left_end], text[right_start:end]
        for other in COMPARISONS.get(op, ()):
            self.add(file, start, end, "comparison", f"{left} {other} {right}")
        for other in SIGNS.get(op, ()):
            if '"' not in left and '"' not in right:
                self.add(file, start, end, "sign", f"{left} {other} {right}")
        if op in ("+", "-") and right == "1":
            self.add(file, start, end, "off-by-one", left)
        if op in ("<", "<=") and parent is not None and parent.kind == Kind.FOR_STMT and start > parent.extent.start.offset:
            self.add(file, start, end, "off-by-one", f"{left} {op} {right} - 1")
            self.add(file, start, end, "off-by-one", f"{left} {op} {right} + 1")

    def statement(self, cursor, children, parent, file, text, start, end):
        if parent.kind != Kind.COMPOUND_STMT:
            # Only what is a body, not a condition or the parts of a for: a statement begins behind a bracket, else or do.
            before = text[:start].rstrip()
            closing = text[end:].lstrip()[:1]
            if closing != ";" or not (before.endswith(")") or re.search(r"\b(else|do)$", before)):
                return
        kind = cursor.kind
        semicolon = text.find(";", end)
        if semicolon < 0 or text[end:semicolon].strip():
            return
        source = text[start:end]
        jump = kind in (Kind.CONTINUE_STMT, Kind.BREAK_STMT) or (kind == Kind.RETURN_STMT and source == "return")
        if not jump and kind not in EXPRESSIONS or ONLY_TIME.search(source) or source.startswith("throw"):
            return
        if kind == Kind.BREAK_STMT and parent.kind == Kind.COMPOUND_STMT and re.search(r"(case [^:]*|default):", text[parent.extent.start.offset:start]):
            return
        self.add(file, start, semicolon + 1, "dropped", "{}", statement=True)


def rewrite(text, sites):
    """The text with a switch around every site, and for every site the lines its switch is on.

    A site inside another one is switched in the other's original half, so that the text grows by little; no line is added."""
    ordered = sorted(sites, key=lambda s: (s.start, -s.end, s.number))
    roots, stack = [], []
    for site in ordered:
        site.children = []
        while stack and stack[-1].end <= site.start:
            stack.pop()
        (stack[-1].children if stack else roots).append(site)
        stack.append(site)

    def render(start, end, inside):
        parts, at = [], start
        for site in inside:
            parts.append(text[at:site.start])
            parts.append(switch(site))
            at = site.end
        parts.append(text[at:end])
        return "".join(parts)

    def switch(site):
        original = render(site.start, site.end, site.children)
        if site.statement:
            return f"{{ if (!::mutants::on<{site.number}>()) {{ {original} }} }}"
        return f"(::mutants::on<{site.number}>() ? ({one_line(site.after)}) : ({original}))"

    return render(0, len(text), roots)
