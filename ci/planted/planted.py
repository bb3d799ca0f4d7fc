"""Errors planted in the sources, one at a time: tables of them, and programs built with one beside an ordinary build.

A table has for each error

  bug NAME TARGET...    the targets of the build that look at what it breaks
  what it does, in a line
  in FILE               may be repeated
  for FILE...           if FILE is a header: the sources to compile anew, which see the change
  - the lines to replace, which occur exactly once
  + what takes their place

Usage: planted.py TABLE BUILD NAME PROGRAM builds the target of an error, which is in BUILD/bin, as PROGRAM."""

import json
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Bug:
    def __init__(self, name, targets):
        self.name, self.targets, self.what = name, targets, ""
        self.edits = []  # file, lines to replace, replacement
        self.compiled = []  # for headers: the files that see the change

    def changed(self):
        """{file: text} with the bug. ValueError if it does not fit."""
        texts = {}
        for file, old, new in self.edits:
            text = texts.get(file) or (ROOT / file).read_text()
            if text.count(old) != 1:
                raise ValueError(f"{self.name}: the lines to replace occur {text.count(old)} times in {file}")
            texts[file] = text.replace(old, new)
        return texts


def read_table(path):
    bugs = []
    for line in path.read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        if line.startswith("bug "):
            _, name, *targets = line.split()
            bugs.append(Bug(name, targets))
        elif line.startswith("in "):
            bugs[-1].edits.append([line[3:], "", ""])
        elif line.startswith("for "):
            bugs[-1].compiled += line.split()[1:]
        elif line[0] == "-":
            bugs[-1].edits[-1][1] += line[1:] + "\n"
        elif line[0] == "+":
            bugs[-1].edits[-1][2] += line[1:] + "\n"
        else:
            bugs[-1].what = line
    return bugs


def run(command, log, folder):
    with open(log, "a") as out:
        if subprocess.run(command, cwd=folder, stdout=out, stderr=out).returncode != 0:
            raise RuntimeError(f"failed, see {log}: {shlex.join(map(str, command))[:200]}")


def compilations(build):
    """The entries of a build's compilation database by file; files that are compiled together have that of all."""
    found = {}
    for entry in json.loads((pathlib.Path(build) / "compile_commands.json").read_text()):
        found[entry["file"]] = entry
        if entry["file"].endswith("_cxx.cxx"):
            found.update((line.split('"')[1], entry) for line in pathlib.Path(entry["file"]).read_text().splitlines() if line.startswith("#include"))
    return found


def compilation(entry, source, target, options=()):
    """The words that compile a source as that of an entry."""
    words = shlex.split(entry["command"])
    words[words.index("-c") + 1], words[words.index("-o") + 1] = str(source), str(target)
    first = next(i for i, word in enumerate(words) if word.startswith("-"))
    return words[:first] + list(options) + words[first:]


def build_with(bug, build, folder, place):
    """Builds the targets of a bug, as folder/TARGET: what it changes is compiled anew and linked in front of the libraries. `place` is the
    path of a target in the build, with {} for its name."""
    log, overlay, known = folder / "build.log", folder / "source", compilations(build)
    for file, text in bug.changed().items():
        (overlay / file).parent.mkdir(parents=True, exist_ok=True)
        (overlay / file).write_text(text)
    objects, replaced = [], set()
    for file in [f for f, _, _ in bug.edits if f.endswith(".cpp")] + bug.compiled:
        entry = known[str(ROOT / file)]
        original = shlex.split(entry["command"])[shlex.split(entry["command"]).index("-o") + 1]
        if original in replaced:
            continue
        replaced.add(original)
        source = overlay / file if (overlay / file).exists() else ROOT / file
        if entry["file"] != str(ROOT / file):
            source = overlay / f"{len(objects)}.cxx"
            text = pathlib.Path(entry["file"]).read_text()
            for changed in (f for f in bug.changed() if f.endswith(".cpp")):
                text = text.replace(f'"{ROOT / changed}"', f'"{overlay / changed}"')
            source.write_text(text)
        objects.append(str(folder / f"{len(objects)}.o"))
        # No warnings: a bug may leave something unused.
        run(compilation(entry, source, objects[-1], ["-w", f"-I{overlay}"]), log, entry["directory"])
    for target in bug.targets:
        listed = subprocess.run(["ninja", "-t", "commands", place.format(target)], cwd=build, capture_output=True, text=True)
        words = shlex.split(listed.stdout.strip().splitlines()[-1].removeprefix(": && ").split(" && ")[0])
        words = [word for word in words if word not in replaced]
        at = words.index("-o")
        words[at : at + 2] = [*objects, "-o", str(folder / target)]
        run(words, log, build)


def main():
    table, build, name, program = sys.argv[1:]
    bug = next(bug for bug in read_table(pathlib.Path(table)) if bug.name == name)
    with tempfile.TemporaryDirectory() as folder:
        build_with(bug, pathlib.Path(build).resolve(), pathlib.Path(folder), "bin/{}")
        shutil.move(pathlib.Path(folder) / bug.targets[0], program)


if __name__ == "__main__":
    main()
