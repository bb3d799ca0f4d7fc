#!/usr/bin/env python3
"""What modules for Python ask of a Linux machine, and the tag of a wheel that says so (PEP 600: manylinux_2_X_MACHINE).
Usage: manylinux.py FILE...     modules and the libraries that the wheel takes along; prints the tag; exit 1, and what is in the way, if there is none

The rules are those of auditwheel's policies from manylinux_2_17 on, for what modules of ours may need: the C library, and libgcc and
zlib with symbols that came long before. Everything else has to be in the modules, or beside them (setup.py)."""
import os
import re
import subprocess
import sys

LIBRARIES = {"libc.so.6", "libm.so.6", "libdl.so.2", "librt.so.1", "libpthread.so.0", "libgcc_s.so.1", "libz.so.1", "ld-linux-x86-64.so.2",
             "ld-linux-aarch64.so.1"}
MACHINES = {"Advanced Micro Devices X86-64": "x86_64", "AArch64": "aarch64"}
OLDEST = (2, 17)  # of the C library: where arm64 begins
# Up to this version of a library every distribution has its symbols whose C library is that one or newer.
CAME_WITH = {"GCC": [((4, 7, 0), OLDEST)], "ZLIB": [((1, 2, 5, 2), OLDEST), ((1, 2, 9), (2, 28))]}
# Symbols that the C library has for itself: no version promises them.
PRIVATE = "GLIBC_PRIVATE"


class NotPortable(Exception):
    """The module needs something that other machines may lack."""


def numbers(version):
    return tuple(int(n) for n in version.split("."))


def required_versions(text):
    """The versions that `readelf -V` lists as needed, not those that the module defines: (library, version)."""
    found, library, needs = set(), None, False
    for line in text.splitlines():
        if line.startswith("Version "):
            needs = line.startswith("Version needs section")
        if not needs:
            continue
        at = re.search(r"File: (\S+)", line)
        library = at.group(1) if at else library
        at = re.search(r"Name: (\S+)", line)
        if at:
            found.add((library, at.group(1)))
    return found


def tag(header, dynamic, versions, along=()):
    """The tag, from what `readelf -h`, `-d` and `-V` print; `along`: names of libraries in the wheel."""
    machine = re.search(r"Machine:\s+(.*\S)", header).group(1)
    if machine not in MACHINES:
        raise NotPortable("a machine without wheels: " + machine)
    needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic))
    missing = needed - LIBRARIES - set(along)
    if missing:
        raise NotPortable("it needs " + ", ".join(sorted(missing)))
    if set(re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*)\]", dynamic)) - {"$ORIGIN/along"}:
        raise NotPortable("it names folders of this machine")
    oldest = OLDEST
    for library, version in required_versions(versions):
        kind, _, number = version.partition("_")
        if kind == "GLIBC" and version != PRIVATE:
            oldest = max(oldest, numbers(number)[:2])
        else:
            since = [c_library for newest, c_library in CAME_WITH.get(kind, []) if numbers(number) <= newest]
            if not since:
                raise NotPortable("it needs %s of %s" % (version, library))
            oldest = max(oldest, since[0])
    return "manylinux_%d_%d_%s" % (*oldest, MACHINES[machine])


def tag_of(*files):
    """That of the file which asks for most."""
    along, tags = {os.path.basename(name) for name in files}, []
    for name in files:
        try:
            tags.append(tag(*(subprocess.run(["readelf", "-W", option, name], check=True, capture_output=True, text=True,
                                             env={"PATH": "/usr/bin:/bin", "LC_ALL": "C"}).stdout for option in ("-h", "-d", "-V")), along))
        except NotPortable as error:
            raise NotPortable("%s: %s" % (name, error)) from error
    return max(tags, key=lambda found: numbers(".".join(found.split("_")[1:3])))


if __name__ == "__main__":
    try:
        print(tag_of(*sys.argv[1:]))
    except NotPortable as error:
        sys.exit(str(error))
