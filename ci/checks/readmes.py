#!/usr/bin/env python3
"""The tables of functions in READMEs must be true: the files exist, and what stands beside them is in them.

A table is one whose head is "question", "file", "functions". Files are named relative to the README, and one without a
folder may lie beside the file before it. What a row calls a function has to be defined or declared in one of its files,
or in the header or source of the same name. In a table "to change", "look at" what looks like a name of the code has to
be a word of one of the files that the row names.

Links within the tree must lead somewhere, and so must the files that CONTRIBUTING.md names with a folder: relative to the root, or to the
folder of the project that the sentence is about.

Usage: readmes.py [ROOT]. Prints one line per violation (file:line: reason) and exits 1 if there is any.
"""
import os
import re
import sys

HEAD = "| question | file | functions |"
PROSE = "| to change | look at |"
CODE = re.compile(r"`([^`]+)`")
NAME = re.compile(r"(?:\w+::)*\w*(?:::\w|[a-z][A-Z_]|_[a-z])\w*$")  # with a capital or an underscore inside
LINK = re.compile(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)")
FILE = re.compile(r"`((?:[\w-]+/)+[\w-]+\.(?:cpp|h|pyi?|js|txt|csv|md))`")
ROOMS = ("", "mesher", "oracles", "reports", "python")
COMMENTS = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)


def declared(name, text):
    """Is the name declared in the text, as a function, a type or a constant? A call alone would not do."""
    patterns = (r"(?<!\breturn )(?<!\belse )(?<!\bthrow )(?<=[\w>&*] )(?<!&& )(?<! \* )%s *[({=\[]",  # after its type
                r"^(?:\w[^\n;=(]*(?:::|[ &*]))?%s *\(",  # at the beginning of a line, perhaps of a class
                r"\b(?:class|struct|enum) %s\b")
    return any(re.search(p % re.escape(name), text, re.M) for p in patterns)


def text_of(path):
    """Of the file and of the header or source of the same name, without comments."""
    stem = os.path.splitext(path)[0]
    paths = {path, stem + ".h", stem + ".cpp"} if path.endswith((".h", ".cpp")) else {path}
    text = ""
    for each in sorted(paths):
        if os.path.isfile(each):
            with open(each, encoding="utf-8") as stream:
                text += COMMENTS.sub("", stream.read())
    return text


def files_of(cell, folder, root):
    """(name, path or None) of each file that a cell may name."""
    beside = folder
    for name in CODE.findall(cell):
        places = [os.path.join(f, name + end) for f in (beside, folder, root) for end in ("", ".h", ".cpp")]
        path = next((p for p in places if os.path.isfile(p)), None)
        if path:
            beside = os.path.dirname(path)
        yield name, path


def check_functions(cells, folder, root):
    if len(cells) != 3:
        yield "a row of other than three cells"
        return
    text = ""
    for name, path in files_of(cells[1], folder, root):
        if path:
            text += text_of(path)
        else:
            yield "there is no file " + name
    for name in CODE.findall(cells[2]):
        if not all(declared(part, text) for part in name.split("::")):
            yield "%s is not declared in %s" % (name, cells[1])


def check_prose(cells, folder, root):
    named = list(files_of(cells[-1], folder, root))
    words = set(re.findall(r"\w+", "".join(text_of(path) for _, path in named if path)))
    for name, path in named:
        if path:
            continue
        if re.search(r"\.(?:h|cpp|py|js)$", name):
            yield "there is no file " + name
        elif NAME.match(name) and not name.endswith("_test") and not words.issuperset(name.split("::")):
            yield "%s is in no file that the row names" % name


def check_places(line, path, root):
    folder = os.path.dirname(path)
    for link in LINK.findall(line):
        if not os.path.exists(os.path.join(folder, link)):
            yield "a link leads nowhere: " + link
    if os.path.basename(path) == "CONTRIBUTING.md":
        for name in FILE.findall(line):
            if not any(os.path.isfile(os.path.join(root, room, name)) for room in ROOMS):
                yield "there is no file " + name


def check_readme(path, root):
    with open(path, encoding="utf-8") as stream:
        lines = stream.read().split("\n")
    check, in_code = None, False
    for number, line in enumerate(lines, 1):
        in_code ^= line.startswith("```")
        if not in_code:
            for reason in check_places(line, path, root):
                yield number, reason
        if line in (HEAD, PROSE):
            check = check_functions if line == HEAD else check_prose
        elif not line.startswith("|"):
            check = None
        elif check and not line.startswith("|---"):
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            for reason in check(cells, os.path.dirname(path), root):
                yield number, reason


def check_all(root):
    """Prints the violations below the root; 1 if there are any, or no table at all."""
    failed = tables = 0
    for folder, folders, names in os.walk(root):
        folders[:] = [f for f in folders if not f.startswith(("build", "."))]
        for path in (os.path.join(folder, n) for n in sorted(names) if n.endswith(".md")):
            with open(path, encoding="utf-8") as stream:
                tables += HEAD in stream.read()
            for number, reason in check_readme(path, root):
                print("%s:%d: %s" % (os.path.relpath(path, root), number, reason))
                failed += 1
    if not tables:
        print("there is no table of functions")
    return 1 if failed or not tables else 0


if __name__ == "__main__":
    sys.exit(check_all(os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(__file__), "..", ".."))))
