#!/usr/bin/env python3
"""Naming by clang-tidy (.clang-tidy) over the files of a compilation database.

Usage: check_names.py BUILD_DIR [JOBS]. Files that passed before and have not changed since, nor any header, are
not read again. Exits 1 and prints clang-tidy's words if a name breaks the rules.
"""
import concurrent.futures
import hashlib
import json
import os
import subprocess
import sys

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), ".."))


def digest(paths):
    state = hashlib.sha256()
    for path in sorted(paths):
        with open(path, "rb") as stream:
            state.update(path.encode() + b"\0" + stream.read())
    return state.hexdigest()


def project_headers():
    folders = ("mesher", "oracles", "property_tests", "fuzz", "corpus", "reports")
    return [os.path.join(folder, name) for top in folders for folder, _, names in os.walk(os.path.join(ROOT, top))
            for name in names if name.endswith(".h")]


def tidy(build, path):
    run = subprocess.run(["clang-tidy", "--quiet", "-p", build, "--extra-arg=-Wno-unknown-warning-option",
                          "--extra-arg=-Wno-everything", path], capture_output=True, text=True)
    return run.returncode, run.stdout + ("" if run.returncode == 0 else run.stderr)


def main():
    build = os.path.abspath(sys.argv[1])
    jobs = int(sys.argv[2]) if len(sys.argv) > 2 else os.cpu_count()
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as stream:
        entries = json.load(stream)
    files = sorted({os.path.realpath(os.path.join(e["directory"], e["file"])) for e in entries})
    files = [f for f in files if f.startswith(ROOT + os.sep) and not f.startswith(os.path.realpath(build))]
    common = digest(project_headers() + [os.path.join(ROOT, ".clang-tidy")])
    memory = os.path.join(build, "names_checked")
    os.makedirs(memory, exist_ok=True)
    marks = {f: os.path.join(memory, hashlib.sha256((common + digest([f])).encode()).hexdigest()) for f in files}
    unread = [f for f in files if not os.path.exists(marks[f])]
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for path, (code, output) in zip(unread, pool.map(lambda f: tidy(build, f), unread)):
            if code == 0:
                open(marks[path], "w", encoding="utf-8").close()
            else:
                failed += 1
                print(output.strip())
    print("names: %d files, %d unchanged, %d with violations" % (len(files), len(files) - len(unread), failed))
    return 1 if failed or not files else 0


if __name__ == "__main__":
    sys.exit(main())
