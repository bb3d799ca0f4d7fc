#!/usr/bin/env python3
"""Checks of the source tree that no compiler makes: include directions, machine paths, licence notes, one list of packages, one version.

Usage: tree.py [ROOT]. Prints one line per violation (file:line: reason) and exits 1 if there is any.
"""
import itertools
import os
import re
import subprocess
import sys

SOURCE = (".h", ".cpp")
TOP = ("mesher", "oracles", "property_tests", "fuzz", "corpus", "reports", "python", "ci")

STANDARD = set("""algorithm any array atomic barrier bit bitset cassert cctype cerrno cfenv cfloat charconv chrono
cinttypes climits clocale cmath codecvt compare complex concepts condition_variable coroutine csetjmp csignal cstdarg
cstddef cstdint cstdio cstdlib cstring ctime cuchar cwchar cwctype deque exception execution filesystem
forward_list fstream functional future initializer_list iomanip ios iosfwd iostream istream iterator latch limits
list locale map memory memory_resource mutex new numbers numeric optional ostream queue random ranges ratio regex
scoped_allocator semaphore set shared_mutex source_location span sstream stack stdexcept stop_token streambuf string
string_view syncstream system_error thread tuple type_traits typeindex typeinfo unordered_map unordered_set utility
valarray variant vector version""".split())

# Layers of the mesher: which layers a folder may include besides itself and the types of the public headers
# (mesher/delmesher/). The stages never include each other, nor a header of the root. What stands between stages
# (enrich), what they share in a run (run), what is told of all of them (results) and what is decided about them
# (policies) knows those before; only the drivers (pipeline.cpp, plane_pipeline.cpp) know all.
FOUNDATION = ("base", "arithmetic", "predicates", "geometry", "surface", "delaunay", "tetmesh")
LAYERS = {
    "base": (),
    "arithmetic": ("base",),
    "predicates": ("base", "arithmetic"),
    "geometry": ("base", "arithmetic", "predicates"),
    "surface": ("base", "arithmetic", "predicates", "geometry"),
    "delaunay": ("base", "arithmetic", "predicates", "geometry"),
    "tetmesh": ("base", "arithmetic", "predicates", "geometry", "surface", "delaunay"),
    "chamfer": FOUNDATION,
    "refine": FOUNDATION,
    "cdt": FOUNDATION,
    "plane": FOUNDATION,
    "improve": FOUNDATION,
    "remesh": ("base", "arithmetic", "predicates", "geometry", "surface"),
    "output": FOUNDATION,
    "enrich": FOUNDATION + ("chamfer", "refine", "cdt"),
    "run": FOUNDATION + ("plane",),
    "planar": FOUNDATION + ("run",),
    "results": FOUNDATION + ("chamfer", "refine", "cdt", "improve", "output", "plane", "run", "planar"),
    "policies": FOUNDATION + ("chamfer", "refine", "cdt", "output", "enrich", "plane", "run", "planar", "results"),
    "io": ("base", "arithmetic", "predicates", "geometry"),
    "cli": ("base", "arithmetic", "predicates", "geometry", "surface", "io"),
}
# Folders that are namespaces under delmesher; the public types and the tables of their names are in delmesher itself.
NAMESPACES = tuple(LAYERS)
OF_NO_FOLDER = ("mesher/base/namespaces.h", "mesher/cli/main.cpp")
# Rooms of the oracles, from the lowest: each may include those before it, and the headers in oracles/ itself all of them.
# cgal/ asks other libraries, and is asked by any room.
ROOMS = ("base", "verdict", "files", "surface", "mesh", "record", "improvement")
ORACLES = {room: ROOMS[:n] for n, room in enumerate(ROOMS)} | {"plane": ("base", "verdict", "files")}
OPINIONS = "oracles/cgal/"
PIPELINE = tuple(layer for layer in LAYERS if layer not in ("io", "cli"))

# Top-level folders: which others each may include. None of these but mesher itself sees more of the mesher
# than the public header, except the property tests and the fuzz targets.
PUBLIC_HEADERS = ("mesher/delmesher.h", "mesher/delmesher_c.h", "mesher/delmesher_files.h", "mesher/delmesher_plane.h")
PUBLIC_TYPES = "mesher/delmesher/"  # what they are made of; installed beside them
USE_PUBLIC_HEADERS = ("run", "results", "policies", "io", "cli")
FOLDERS = {
    "oracles": (),
    "corpus": ("oracles", "reports"),
    "reports": ("oracles",),
    "property_tests": ("oracles", "mesher"),
    "fuzz": ("property_tests", "oracles", "corpus", "mesher"),
    "python": ("oracles", "reports"),
    "ci": (),
}

# The benchmarks time the kernels. The adapters of peers read and write with the very code of the mesher's command line, so that every mesher
# sees the same doubles; the io library needs nothing of the mesher but the public header.
ADAPTERS = {"reports/benchmark/": "mesher/", "corpus/peers/tetgen/": "mesher/io/", "corpus/peers/programs/": "mesher/io/",
            "python/": "mesher/delmesher/option_table.h", "corpus/peers/meshers": "mesher/delmesher/option_table.h",
            "corpus/cli/union_command": "mesher/delmesher/option_table.h"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
OPENED = re.compile(r"^(?:inline )?namespace(?: ([\w:]+))? \{$")
CLASS = re.compile(r"^(?:class|struct|union|enum class|enum struct|enum) ([\w:]+)(?: final)?(?: :[^:;]*)? \{")
# Assembled so that this file does not trip over itself.
MACHINE_PATH = re.compile(r"(?<![\w.$})/-])/(?:" + "|".join(["work", "tmp", "home", "root", "Users"]) + r")/\w")


def tracked_files(root):
    """Files under version control or about to be; everything outside build trees when there is no git."""
    listing = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard"],
                             capture_output=True, text=True)
    if listing.returncode == 0 and listing.stdout:
        return sorted(f for f in listing.stdout.split("\n") if f and os.path.isfile(os.path.join(root, f)))
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [f for f in folders if not f.startswith("build") and f != ".git"]
        found += [os.path.relpath(os.path.join(folder, n), root) for n in names]
    return sorted(found)


def mesher_angle(layer, is_test, header):
    if header in STANDARD:
        return None
    if layer == "arithmetic" and header == "immintrin.h":  # the compiler's own: carries on x86
        return None
    if is_test and (header.startswith("gtest/") or header in ("gmp.h", "gmpxx.h")):
        return None
    if layer == "io" and header == "zlib.h":  # optional: see mesher/io/CMakeLists.txt
        return None
    if layer in ("io", "cli") and re.match(r"^(unistd|fcntl|sys/\w+)\.h$", header):
        return None
    if layer == "cli" and header.startswith(("CLI/", "nlohmann/")):
        return None
    return "the mesher may use the standard library only, not <%s>" % header


def for_tests(header):
    """A *_reference.h is a plain second opinion, a test_*.h what several tests have in common."""
    return header.endswith("_reference.h") or re.match(r"test_.*\.h$", os.path.basename(header)) is not None


def mesher_quoted(layer, is_test, header):
    parts = header.split("/")
    if header.startswith(PUBLIC_TYPES):
        return None
    if header in PUBLIC_HEADERS:
        seen = is_test or layer is None or layer in USE_PUBLIC_HEADERS
        return None if seen else "mesher/%s must not include a header of the root, but %s" % (layer, PUBLIC_TYPES)
    if parts[0] != "mesher" or len(parts) < 3 and layer is not None:
        return "mesher files include only mesher headers, not \"%s\"" % header
    if for_tests(header) and not is_test:
        return "%s is for tests" % header
    target = parts[1]
    if len(parts) == 2:
        return None  # the pipeline's own helpers
    if target == layer or is_test and target in LAYERS:
        return None  # tests may look into every stage
    allowed = PIPELINE if layer is None else LAYERS.get(layer, ())
    if target in allowed:
        return None
    return "mesher/%s must not include mesher/%s" % (layer or "pipeline", target)


def between_rooms(path, header):
    """Reason why a file of the oracles must not include a header of theirs, or None."""
    parts, target = path.split("/"), header.split("/")
    if len(parts) < 3 or parts[1] not in ORACLES or header.startswith(OPINIONS) or target[1] in (parts[1],) + ORACLES[parts[1]]:
        return None
    return "oracles/%s must not include %s" % (parts[1], header)


def public_include(path, kind, header, root):
    """Public headers find each other relative to their own folder, in the sources as where they are installed."""
    if kind == "<":
        standard_of_c = path.endswith("_c.h") and header in ("stddef.h", "stdint.h")
        return None if header in STANDARD or standard_of_c else "a public header includes the standard library only, not %s" % header
    target = os.path.normpath(os.path.join(os.path.dirname(path), header))
    if target not in PUBLIC_HEADERS and not target.startswith(PUBLIC_TYPES):
        return "a public header includes no other than public headers, not %s" % header
    return None if os.path.isfile(os.path.join(root, target)) else "no such file: \"%s\"" % header


def check_include(path, kind, header, root):
    """Reason why `path` must not include `header`, or None."""
    parts = path.split("/")
    is_test = path.endswith("_test.cpp") or for_tests(path)
    layer = parts[1] if len(parts) > 2 else None
    if parts[0] == "mesher":
        if path in PUBLIC_HEADERS or path.startswith(PUBLIC_TYPES) and path.endswith(".h"):
            return public_include(path, kind, header, root)
        rule = mesher_angle if kind == "<" else mesher_quoted
        reason = rule(layer, is_test, header)
    elif path.startswith("ci/packaging/npm/port/"):  # stands for parts of the mesher
        reason = mesher_angle("cli", is_test, header) if kind == "<" else None
    elif parts[0] == "ci" or kind == "<":
        reason = "other projects see installed headers, not <%s>" % header if header.startswith("mesher/") else None
    else:
        target = header.split("/")[0]
        adapter = any(path.startswith(a) and header.startswith(h) for a, h in ADAPTERS.items())
        if target == parts[0] or header in PUBLIC_HEADERS or target in FOLDERS.get(parts[0], ()) or adapter:
            reason = None
        elif target == "mesher":
            reason = "%s may include %s only, no stage of the mesher" % (parts[0], " and ".join(PUBLIC_HEADERS))
        else:
            reason = "%s must not include %s" % (parts[0], header)
    if reason is None and kind == '"' and parts[0] == "oracles" and header.startswith("oracles/"):
        reason = between_rooms(path, header)
    if reason is None and kind == '"' and parts[0] != "ci" and not os.path.isfile(os.path.join(root, header)):
        reason = "no such file from the root: \"%s\"" % header
    return reason


def check_source(path, lines, root):
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if match:
            reason = check_include(path, match.group(1), match.group(2), root)
            if reason:
                yield number, reason
    if path.endswith(".h") and not any(l.startswith("#pragma once") for l in lines):
        yield 1, "header without #pragma once"


def classes_defined(lines):
    """(line number, namespaces and name) of each class defined at namespace scope, those in unnamed namespaces left out."""
    namespaces = []
    for number, line in enumerate(lines, 1):
        opened = OPENED.match(line)
        if opened:
            namespaces.append(opened.group(1) or "")
        elif line.startswith("}  // namespace") and namespaces:
            namespaces.pop()
        else:
            match = CLASS.match(line)
            if match and "" not in namespaces:
                yield number, "::".join(namespaces + [match.group(1)])


def check_namespaces(path, lines, texts):
    """A folder of the mesher is a namespace, and a class that a source file defines for itself is in an unnamed one, unless a
    header beside it declares it: then nothing is defined twice under one name, of which the linker would take either and say
    nothing (the one-definition rule)."""
    parts = path.split("/")
    if path.endswith(".cpp"):
        for number, name in classes_defined(lines):
            declaration = re.compile(r"\b(?:class|struct) %s;" % name.split("::")[-1])
            if not any(os.path.dirname(h) == os.path.dirname(path) and h.endswith(".h") and declaration.search(t)
                       for h, t in texts.items()):
                yield number, "%s is defined in a source file outside of an unnamed namespace" % name
    if parts[0] != "mesher" or len(parts) < 3 or parts[1] not in NAMESPACES or path in OF_NO_FOLDER:
        return
    opened = [o.group(1) for o in map(OPENED.match, lines) if o and o.group(1)]
    wanted = "delmesher::" + parts[1]
    if opened and not any(n == wanted or n.startswith((wanted + "::", "delmesher::plane")) for n in opened):
        yield 1, "a file of mesher/%s opens namespace %s" % (parts[1], wanted)


def licences_used(path, text):
    """Copyleft code that a file builds on, by what it includes or links."""
    used = set()
    if path.endswith(SOURCE) and re.search(r"#\s*include\s*<CGAL/", text):
        used.add("GPL")
    if path.endswith(SOURCE) and re.search(r'#\s*include\s*[<"]tetgen\.h', text):
        used.add("AGPL")
    if path.endswith("CMakeLists.txt") and re.search(r"\bCGAL::", text):
        used.add("GPL")
    return used


# Names of Debian's libraries, which are not paths.
PACKAGE = re.compile(r"(?<![\w./+-])(?:lib[\w.+-]+|[\w.+-]+-dev)(?![\w/])")


def check_packages(texts):
    """What is to be installed stands in ci/packages alone; another list of it would be forgotten."""
    known = {line.split()[0] for line in texts.get("ci/packages", "").split("\n") if line and not line.startswith("#")}
    for path, text in texts.items():
        for number, line in enumerate(text.split("\n"), 1):
            if path != "ci/packages" and len(known.intersection(PACKAGE.findall(line))) > 1:
                yield path, number, "lists packages, which ci/packages does: " + line.strip()[:80]


# Where the version of CMakeLists.txt is repeated, since other tools read these files.
VERSION = re.compile(r'project\(tetproof VERSION ([\d.]+)')
VERSIONS = {
    "ci/packaging/conda/recipe.yaml": re.compile(r'^  version: "([\d.]+)"', re.M),
    "ci/packaging/npm/package.json": re.compile(r'"version": "([^"]+)"'),
    "ci/packaging/spack/package.py": re.compile(r'^    version\("([^"]+)"', re.M),
    "ci/packaging/vcpkg/vcpkg.json": re.compile(r'"version-semver": "([^"]+)"'),
    "docs/releases.md": re.compile(r"^### ([\d.]+)", re.M),
}


def check_versions(texts):
    version = VERSION.search(texts.get("CMakeLists.txt", ""))
    for path, pattern in VERSIONS.items() if version else ():
        found = pattern.search(texts.get(path, ""))
        if not found or found.group(1) != version.group(1):
            yield path, 1, "CMakeLists.txt has version %s, here is %s" % (version.group(1), found.group(1) if found else "none")


def check_licences(files, texts, root):
    if "MIT License" not in texts.get("LICENSE", ""):
        yield "LICENSE", 1, "the licence of the project (MIT) must stand here"
    for path in files:
        for licence in sorted(licences_used(path, texts.get(path, ""))):
            folder = os.path.dirname(path)
            notes = [f for f in files if os.path.dirname(f) in (folder, os.path.dirname(folder))
                     and os.path.dirname(f) and re.match(r"LICEN[CS]E|README", os.path.basename(f))]
            if path.startswith("mesher/"):
                yield path, 1, "the mesher must not build on %s code" % licence
            elif not any(re.search(r"\b%s" % licence, texts.get(n, "")) for n in notes):
                yield path, 1, "uses %s code, but no LICENSE or README in its folder says so" % licence


def check_tree(root):
    files = tracked_files(root)
    texts = {}
    for path in files:
        try:
            with open(os.path.join(root, path), encoding="utf-8") as stream:
                texts[path] = stream.read()
        except (UnicodeDecodeError, OSError):
            continue  # binary test data
    for path, text in texts.items():
        lines = text.split("\n")
        for number, line in enumerate(lines, 1):
            if MACHINE_PATH.search(line):
                yield path, number, "path of one machine: " + line.strip()[:80]
        if path.endswith(SOURCE) and path.split("/")[0] in TOP:
            for number, reason in itertools.chain(check_source(path, lines, root), check_namespaces(path, lines, texts)):
                yield path, number, reason
    yield from check_packages(texts)
    yield from check_versions(texts)
    yield from check_licences(files, texts, root)


def main():
    root = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(__file__), "..", ".."))
    violations = list(check_tree(root))
    for path, number, reason in violations:
        print("%s:%d: %s" % (path, number, reason))
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
