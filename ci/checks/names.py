#!/usr/bin/env python3
"""Naming by clang-tidy (.clang-tidy) over the files of a compilation database.

Usage: names.py BUILD_DIR [JOBS [FILE...]]. Without FILE: all, but for those of programs that are built when asked for. Files that
passed before and have not changed since, nor any header, are not read again. Exits 1 and prints clang-tidy's words if a name breaks the rules.

Most of the time would go into the headers of libraries, once per file. So files of a folder that are compiled alike are
read together, as one that includes them, unless they have a local name in common, or one has a name that the other's headers have.
Where that does not compile all the same, those that the errors name are read without the others, or each half, at last each alone.
"""
import collections
import concurrent.futures
import functools
import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
FOLDERS = ("mesher", "oracles", "property_tests", "fuzz", "corpus", "reports")
TOGETHER = 64  # files
FEW = 12
WHEN_ASKED = ("corpus/peers/programs/cgal_mesh3.cpp",)  # CGAL's headers take clang-tidy longer than half of all other files
FUZZER_ENTRIES = ("LLVMFuzzerTestOneInput", "LLVMFuzzerCustomMutator", "LLVMFuzzerCustomCrossOver")  # each target has its own
# What a file defines outside of classes and functions begins a line there.
DEFINED = re.compile(r"^(?:using (\w+) =|(?:struct|class|enum class|union) (\w+)|"
                     r"(?:inline |static )*const(?:expr|init)? .*?\b(k[A-Z]\w*)\W|"
                     r"\w+_(MAIN)\(|(?!TEST|INSTANTIATE|namespace|extern)[\w:<].*?[ *&](\w+)\(|(?:TYPED_)?TEST(?:_F|_P)?\((\w+, \w+))")


def digest(paths):
    state = hashlib.sha256()
    for path in sorted(paths):
        with open(path, "rb") as stream:
            state.update(path.encode() + b"\0" + stream.read())
    return state.hexdigest()


def project_headers():
    return [os.path.join(folder, name) for top in FOLDERS for folder, _, names in os.walk(os.path.join(ROOT, top))
            for name in names if name.endswith(".h")]


def sources_of(entry):
    """The file of an entry, or those that CMake has it include (CMAKE_UNITY_BUILD)."""
    file = os.path.realpath(os.path.join(entry["directory"], entry["file"]))
    if os.path.basename(os.path.dirname(file)) != "Unity":
        return [file]
    with open(file, encoding="utf-8") as stream:
        return [os.path.realpath(name) for name in re.findall(r'^#include "([^"]+)"', stream.read(), re.MULTILINE)]


def flags_of(entry):
    """What the file is compiled with, without compiler, file, object, precompiled headers and warnings.

    Definitions {name: flag}, and others in order."""
    words = shlex.split(entry["command"])
    words = words[next(i for i, word in enumerate(words) if word.startswith("-")):]
    defined, others = {}, []
    while words:
        word = words.pop(0)
        if word in ("-o", "-c", "-MF", "-MT", "-MQ", "-include"):
            words.pop(0)
        elif word == "-isystem":
            others.append(word + words.pop(0))
        elif word.startswith("-D"):
            defined[word.split("=")[0]] = word
        elif not word.startswith(("-M", "-W")):
            others.append(word)
    return defined, others


@functools.cache
def local_names(path):
    """{name: pairs of a namespace in which it stands, followed by two colons, and what tells it from others there}. An alias may
    stand in several files."""
    names, namespace = {}, ""
    with open(path, encoding="utf-8") as stream:
        for line in stream:
            if opened := re.match(r"namespace ([\w:]+) \{", line):
                namespace = opened[1] + "::"
            elif line.startswith("}  // namespace " + namespace[:-2]) and namespace:
                namespace = ""
            elif match := DEFINED.match(line.rstrip()):
                names.setdefault(next(name for name in match.groups() if name).lower(), set()).add((namespace, line if match[1] else path))
    return names


def clash(some, others):
    """Whether a name stands in both, in one namespace or in one within the other."""
    return any(what != other and (a.startswith(b) or b.startswith(a))
               for name in some.keys() & others.keys() for a, what in some[name] for b, other in others[name])


def united(all_names):
    names = {}
    for some in all_names:
        for name, namespaces in some.items():
            names[name] = names.get(name, set()) | namespaces
    return names


@functools.cache
def headers_of(path):
    """The project's headers that a file includes, and that those include."""
    with open(path, encoding="utf-8") as stream:
        direct = {os.path.join(ROOT, name) for name in re.findall(r'^#include "([^"]+)"', stream.read(), re.MULTILINE)}
    direct = {header for header in direct if os.path.exists(header)}
    return direct.union(*map(headers_of, direct))


def names_in(headers):
    return united(map(local_names, headers))


class Group:
    """Files that are read together: no local name in common, none that a header of others has, no macro with two values."""

    def __init__(self):
        self.files, self.names, self.headers, self.defined, self.others = [], {}, set(), {}, []

    def takes(self, file, flags):
        names, headers = local_names(file), headers_of(file)
        return len(self.files) < TOGETHER and all(
            self.defined.get(name, flag) == flag for name, flag in flags[0].items()) and not (
                clash(self.names, united([names, names_in(headers - self.headers)])) or clash(names, names_in(self.headers - headers)))

    def add(self, file, flags):
        self.files.append(file)
        self.names = united([self.names, local_names(file)])
        self.headers |= headers_of(file)
        self.defined |= flags[0]
        self.others += [flag for flag in flags[1] if flag not in self.others]


@functools.cache
def reads_cgal(path):
    """Whether a file includes CGAL, by itself or by a header of the project: that takes longer to read than all else."""
    with open(path, encoding="utf-8") as stream:
        return "#include <CGAL/" in stream.read() or any(map(reads_cgal, headers_of(path)))


def add_to_first(groups, file, flags):
    group = next((group for group in groups if group.takes(file, flags)), None)
    if group is None:
        group = Group()
        groups.append(group)
    group.add(file, flags)


def groups_of(files, flags):
    """What lies in one folder includes the same libraries. Few files that agree with no larger group there may agree with those of
    other folders."""
    cgal, others, by_folder = [], [], collections.defaultdict(list)
    for file in files:
        top = os.path.relpath(file, ROOT).split(os.sep)[0]
        add_to_first(cgal if reads_cgal(file) else by_folder[top], file, flags[file])
    large = [group for groups in by_folder.values() for group in groups if len(group.files) >= FEW]
    for groups in by_folder.values():
        for group in groups:
            if len(group.files) < FEW:
                for file in group.files:
                    add_to_first(others, file, flags[file])
    return cgal + large + others


class Tidy:
    def __init__(self, scratch):
        self.scratch = scratch

    def read_together(self, flags, files):
        """{file: (code, words)}; words of a file read with others are those of all of them."""
        unit = files[0]
        if len(files) > 1:
            unit = os.path.join(self.scratch, hashlib.sha256("\n".join(files).encode()).hexdigest()[:16] + ".cpp")
            with open(unit, "w", encoding="utf-8") as stream:
                for n, file in enumerate(files):
                    stream.writelines("#define %s %s%d\n" % (entry, entry, n) for entry in FUZZER_ENTRIES)
                    stream.write('#include "%s"\n' % file)
                    stream.writelines("#undef %s\n" % entry for entry in FUZZER_ENTRIES)
        # Without --config-file each header has the rules of its own folder, so those of libraries have none: of the time two thirds
        # went into words about their names, which nobody sees.
        run = subprocess.run(["clang-tidy", "--quiet", "--header-filter=^%s/(%s)/.*[.](h|cpp)$" % (ROOT, "|".join(FOLDERS)), unit, "--", *flags,
                              "-Wno-unknown-warning-option", "-Wno-everything"], capture_output=True, text=True)
        if run.returncode != 0 and len(files) > 1:
            # Most often a few files do not agree with those before them, and the errors name them or headers of theirs.
            blamed = set(re.findall(r"^([^:\n]+):\d+:\d+: error: ", run.stdout + run.stderr, re.MULTILINE))
            apart = [file for file in files if file in blamed or blamed & headers_of(file)]
            if not 0 < len(apart) < len(files) / 2:
                apart = files[:len(files) // 2]
            rest = [file for file in files if file not in apart]
            return self.read_together(flags, apart) | self.read_together(flags, rest)
        return {file: (run.returncode, run.stdout + ("" if run.returncode == 0 else run.stderr)) for file in files}


def main():
    build = os.path.abspath(sys.argv[1])
    jobs = int(sys.argv[2]) if len(sys.argv) > 2 else os.cpu_count()
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as stream:
        entries = json.load(stream)
    flags = {file: flags_of(e) for e in entries for file in sources_of(e)}
    files = sorted(f for f in flags if f.startswith(ROOT + os.sep) and not f.startswith(os.path.realpath(build)))
    asked = [os.path.join(ROOT, name) for name in sys.argv[3:]]
    apart = [os.path.join(ROOT, name) for name in WHEN_ASKED]
    files = [file for file in files if (file in asked if asked else file not in apart)]
    common = digest(project_headers() + [os.path.join(ROOT, ".clang-tidy")])
    memory = os.path.join(build, "names_checked")
    os.makedirs(memory, exist_ok=True)
    shutil.copy(os.path.join(ROOT, ".clang-tidy"), memory)  # the build tree may be elsewhere
    marks = {f: os.path.join(memory, hashlib.sha256((common + digest([f])).encode()).hexdigest()) for f in files}
    unread = [f for f in files if not os.path.exists(marks[f])]
    groups = sorted(groups_of(unread, flags), key=lambda group: -len(group.files))
    tidy = Tidy(memory)
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for results in pool.map(lambda g: tidy.read_together([*g.defined.values(), *g.others], g.files), groups):
            for path, (code, output) in results.items():
                if code == 0:
                    open(marks[path], "w", encoding="utf-8").close()
                else:
                    failed += 1
                    print(output.strip())
    print("names: %d files, %d unchanged, %d with violations" % (len(files), len(files) - len(unread), failed))
    return 1 if failed or not files else 0


if __name__ == "__main__":
    sys.exit(main())
