#!/usr/bin/env python3
"""One definition per function: no function of the mesher is defined both in a source file and inline in a header, under one name.
The linker does not mind and takes either, which depends on what was inlined.

Usage: ci/check_definitions.py DEBUG_BUILD   (nothing is inlined there)
Exit 1 and a line for each that is, or if there was nothing to look at.
"""
import pathlib
import subprocess
import sys


def definitions(build):
    """Symbol -> {kind: object files} over the objects of the mesher, without its tests."""
    found = {}
    for path in sorted(pathlib.Path(build).glob("mesher/**/*.o")):
        if "test" in path.name:
            continue
        lines = subprocess.run(["nm", "--demangle", "--defined-only", path], capture_output=True, text=True, check=True).stdout
        for line in lines.splitlines():
            _, kind, symbol = line.split(" ", 2)
            if kind in "TW" and "(" in symbol:
                found.setdefault(symbol, {}).setdefault(kind, []).append(path.name)
    return found


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    found = definitions(sys.argv[1])
    inline = sum("W" in kinds for kinds in found.values())
    twice = {s: k for s, k in found.items() if "T" in k and "W" in k}
    for symbol, kinds in twice.items():
        print(f"defined in {kinds['T'][0]} and inline in {kinds['W'][0]}: {symbol}")
    if inline == 0 or len(found) < 100:
        print(f"nothing to look at in {sys.argv[1]}: is it a debug build?")
        return 1
    print(f"check definitions: {len(found)} functions")
    return 1 if twice else 0


if __name__ == "__main__":
    sys.exit(main())
