#!/usr/bin/env python3
"""Real planar inputs as rings of "x y" lines: coasts and borders (npm: world-atlas), letters (a TrueType font).

Usage: real_inputs.py FOLDER [FONT.ttf]. Downloads world-atlas once with npm; nothing of it is kept in the project.
An edge that two rings share is a border. Rings across the antimeridian are laid out beyond it, the one around the pole
is closed below. Corners where rings cross others or themselves are left out, and counted.
"""
import json
import os
import struct
import subprocess
import sys
import tarfile

ATLAS = "world-atlas@2.0.2"
LAYERS = tuple(("%s-%s.json" % (layer, size), layer) for layer in ("countries", "land")
               for size in ("110m", "50m", "10m"))


def atlas(folder):
    """The unpacked package."""
    package = os.path.join(folder, "package")
    if not os.path.isdir(package):
        name = subprocess.run(["npm", "pack", "--silent", ATLAS], cwd=folder, check=True, capture_output=True,
                              text=True).stdout.split()[-1]
        with tarfile.open(os.path.join(folder, name)) as archive:
            archive.extractall(folder)
    return package


def rings_of_topology(path, layer):
    """Rings of quantised integers, so that shared borders are exactly equal."""
    with open(path, encoding="utf-8") as stream:
        topology = json.load(stream)
    arcs = []
    for arc in topology["arcs"]:
        x = y = 0
        points = []
        for dx, dy in arc:
            x, y = x + dx, y + dy
            points.append((x, y))
        arcs.append(points)

    def stitched(ring):
        points = []
        for index in ring:
            arc = arcs[index] if index >= 0 else arcs[~index][::-1]
            points += arc[1:] if points else arc
        return points

    turn = max(x for arc in arcs for x, _ in arc)  # the whole circle
    bottom = min(y for arc in arcs for _, y in arc) - turn // 50

    def unrolled(ring):
        """Without the jumps from one side of the map to the other."""
        shift, points = 0, []
        for i, (x, y) in enumerate(ring):
            if i > 0 and abs(x - ring[i - 1][0]) > turn // 2:
                shift += turn if x < ring[i - 1][0] else -turn
            points.append((x + shift, y))
        if shift == 0:
            lowest = min(x for x, _ in points)
            return [(x + turn, y) for x, y in points] if lowest < 0 else points
        points = []  # around the pole
        for i, (x, y) in enumerate(ring):
            if i > 0 and abs(x - ring[i - 1][0]) > turn // 2:
                points += [(ring[i - 1][0], bottom), (x, bottom)]
            points.append((x, y))
        return points

    for geometry in topology["objects"][layer]["geometries"]:
        polygons = geometry.get("arcs", [])
        if geometry["type"] == "Polygon":
            polygons = [polygons]
        for polygon in polygons:
            for ring in polygon:
                yield unrolled(stitched(ring))


def glyph_rings(font, text, size=1.0):
    """Outlines of letters side by side, curves as four segments each (glyf tables only, no composites)."""
    with open(font, "rb") as stream:
        data = stream.read()
    tables = {}
    for i in range(struct.unpack(">H", data[4:6])[0]):
        tag, _, offset, length = struct.unpack(">4sIII", data[12 + 16 * i:28 + 16 * i])
        tables[tag.decode()] = data[offset:offset + length]
    units, long_loca = struct.unpack(">H", tables["head"][18:20])[0], struct.unpack(">h", tables["head"][50:52])[0]
    count = struct.unpack(">H", tables["maxp"][4:6])[0]
    loca = struct.unpack(">%d%s" % (count + 1, "I" if long_loca else "H"), tables["loca"][:(count + 1) * (4 if long_loca else 2)])
    loca = [o if long_loca else 2 * o for o in loca]
    metrics = struct.unpack(">H", tables["hhea"][34:36])[0]

    def glyph_index(char):
        cmap = tables["cmap"]
        for i in range(struct.unpack(">H", cmap[2:4])[0]):
            offset = struct.unpack(">I", cmap[8 + 8 * i:12 + 8 * i])[0]
            if struct.unpack(">H", cmap[offset:offset + 2])[0] != 4:
                continue
            segments = struct.unpack(">H", cmap[offset + 6:offset + 8])[0] // 2

            def words(k, kind):
                begin = offset + 14 + 2 * segments * k + (2 if k > 0 else 0)
                return struct.unpack(">%d%s" % (segments, kind), cmap[begin:begin + 2 * segments])
            ends, starts, deltas, ranges = words(0, "H"), words(1, "H"), words(2, "h"), words(3, "H")
            for k in range(segments):
                if starts[k] <= ord(char) <= ends[k]:
                    if ranges[k] == 0:
                        return (ord(char) + deltas[k]) & 0xffff
                    at = offset + 16 + 6 * segments + 2 * k + ranges[k] + 2 * (ord(char) - starts[k])
                    return struct.unpack(">H", cmap[at:at + 2])[0]
        return 0

    def outline(index):
        glyph = tables["glyf"][loca[index]:loca[index + 1]]
        if len(glyph) < 10:
            return []
        contours = struct.unpack(">h", glyph[:2])[0]
        if contours < 0:
            return []
        ends = struct.unpack(">%dH" % contours, glyph[10:10 + 2 * contours])
        at = 10 + 2 * contours
        at += 2 + struct.unpack(">H", glyph[at:at + 2])[0]
        points = ends[-1] + 1
        flags = []
        while len(flags) < points:
            flag = glyph[at]
            at += 1
            flags.append(flag)
            if flag & 8:
                flags += [flag] * glyph[at]
                at += 1

        def coordinates(short, same):
            nonlocal at
            value, result = 0, []
            for flag in flags:
                if flag & short:
                    value += glyph[at] if flag & same else -glyph[at]
                    at += 1
                elif not flag & same:
                    value += struct.unpack(">h", glyph[at:at + 2])[0]
                    at += 2
                result.append(value)
            return result
        xs, ys = coordinates(2, 16), coordinates(4, 32)
        rings, begin = [], 0
        for end in ends:
            corner = [(xs[i], ys[i], flags[i] & 1) for i in range(begin, end + 1)]
            begin = end + 1
            full = []
            for i, (x, y, on) in enumerate(corner):  # on-curve points between two control points
                px, py, before = corner[i - 1]
                if not on and not before:
                    full.append(((x + px) / 2, (y + py) / 2, 1))
                full.append((x, y, on))
            while full and not full[0][2]:
                full.append(full.pop(0))
            ring = []
            for i, (x, y, on) in enumerate(full):
                if on:
                    ring.append((x, y))
                    continue
                (ax, ay, _), (bx, by, _) = full[i - 1], full[(i + 1) % len(full)]
                for k in (1, 2, 3):
                    t = k / 4
                    ring.append(((1 - t) ** 2 * ax + 2 * t * (1 - t) * x + t * t * bx,
                                 (1 - t) ** 2 * ay + 2 * t * (1 - t) * y + t * t * by))
            rings.append(ring)
        return rings

    shift = 0
    for char in text:
        index = glyph_index(char)
        for ring in outline(index):
            yield [((x + shift) * size / units, y * size / units) for x, y in ring]
        at = 4 * min(index, metrics - 1)
        shift += struct.unpack(">H", tables["hmtx"][at:at + 2])[0]


def without_spikes(ring):
    """Without repeated points, and points where the ring turns back onto itself."""
    ring = [p for i, p in enumerate(ring) if p != ring[i - 1]]
    i = 0
    while len(ring) >= 3 and i < len(ring):
        (ax, ay), (bx, by), (cx, cy) = ring[i - 1], ring[i], ring[(i + 1) % len(ring)]
        ux, uy, vx, vy = bx - ax, by - ay, cx - bx, cy - by
        if ux * vy == uy * vx and ux * vx + uy * vy <= 0:
            del ring[i]
            i = max(0, i - 2)
        else:
            i += 1
    return ring if len(ring) >= 3 else []


def conflict(p, q, r, s):
    """Do pq and rs cross, or overlap without being the same? (A vertex on a segment is fine.)"""
    def side(a, b, c):
        value = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        return (value > 0) - (value < 0)
    a, b, c, d = side(p, q, r), side(p, q, s), side(r, s, p), side(r, s, q)
    if a == b == 0:
        (p, q), (r, s) = sorted((p, q)), sorted((r, s))
        return max(p, r) < min(q, s) and (p, q) != (r, s)
    return a * b < 0 and c * d < 0


def clean(rings):
    """Rings that meet at most in vertices and edges: corners that lead to anything else are left out, longest ring first."""
    rings = [r for r in map(without_spikes, rings) if r]
    cell = 1 + max(max(abs(x) for x, _ in r) for r in rings) // 4000
    grid, kept, lost = {}, [], 0

    def cells(p, q):
        """Column by column, with a margin for rounding."""
        (ax, ay), (bx, by) = sorted((p, q))
        result = []
        for x in range(int(ax // cell), int(bx // cell) + 1):
            ends = (ay, by)
            if ax < bx:
                ends = [ay + (by - ay) * (min(max(at, ax), bx) - ax) / (bx - ax) for at in (x * cell, (x + 1) * cell)]
            first, last = (int((y + margin) // cell) for y, margin in ((min(ends), -cell / 1000), (max(ends), cell / 1000)))
            result += [(x, y) for y in range(first, last + 1)]
        return result

    def free(p, q):
        return not any(conflict(p, q, *other) for at in cells(p, q) for other in grid.get(at, ()))

    def enter(p, q):
        for at in cells(p, q):
            grid.setdefault(at, []).append((p, q))

    def leave(p, q):
        for at in cells(p, q):
            grid[at].remove((p, q))

    for ring in sorted(rings, key=len, reverse=True):
        path, missed = ring[:1], 0
        for q in ring[1:]:
            if free(path[-1], q):
                enter(path[-1], q)
                path.append(q)
                missed = 0
                continue
            lost += 1
            missed += 1
            while missed == 16 and len(path) > 1:  # no way on from here: from farther back
                leave(path[-2], path[-1])
                path.pop()
                lost += 1
                missed = 16 if len(path) % 8 else 0
            if len(path) == 1 and missed >= 16:
                path, missed = [q], 0
        while len(path) > 2 and not free(path[-1], path[0]):
            leave(path[-2], path[-1])
            path.pop()
            lost += 1
        if len(path) > 2:
            enter(path[-1], path[0])
            kept.append(path)
        else:
            for p, q in zip(path, path[1:]):
                leave(p, q)
    if lost:
        print("%d corners left out where rings cross others or themselves" % lost)
    return kept


def write(path, rings):
    points = 0
    with open(path, "w", encoding="utf-8") as out:
        for ring in rings:
            for x, y in ring:
                out.write("%r %r\n" % (x, y))
            out.write("\n")
            points += len(ring)
    print("%s: %d points" % (path, points))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    folder = os.path.abspath(sys.argv[1])
    os.makedirs(folder, exist_ok=True)
    package = atlas(folder)
    for name, layer in LAYERS:
        write(os.path.join(folder, name.replace(".json", ".txt")), clean(rings_of_topology(os.path.join(package, name), layer)))
    fonts = sys.argv[2:] or [f for f in ("/usr/share/fonts/truetype/dejavu/DejaVuSerif.ttf",
                                         "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf") if os.path.isfile(f)]
    for font in fonts:
        stem = os.path.splitext(os.path.basename(font))[0]
        write(os.path.join(folder, "letters-%s.txt" % stem),
              glyph_rings(font, "The quick brown fox jumps over the lazy dog & 0123456789 @%"))


if __name__ == "__main__":
    main()
