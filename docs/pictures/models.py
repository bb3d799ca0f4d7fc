"""The surfaces that the pictures show, as (points, triangles)."""
import itertools
import math


def ring(polar, scale, turn, z):
    return [(scale * r * math.cos(a + turn), scale * r * math.sin(a + turn), z) for a, r in polar]


def wall(low, high, count):
    """Triangles between two rings of as many vertices, whose first ones are given; seen from where they are counter-clockwise."""
    for i, j in ((i, (i + 1) % count) for i in range(count)):
        yield from ((low + i, low + j, high + j), (low + i, high + j, high + i))


def between(outer, inner):
    """Triangles between two rings in a plane, lists of (angle, vertex) by ascending angle from about 0; counter-clockwise."""
    i = j = 0
    while i < len(outer) or j < len(inner):
        o, n = outer[i % len(outer)][1], inner[j % len(inner)][1]
        next_outer, next_inner = (ring[k + 1][0] if k + 1 < len(ring) else 2 * math.pi + (k + 1 > len(ring)) for ring, k in ((outer, i), (inner, j)))
        if next_outer <= next_inner:
            i += 1
            yield o, outer[i % len(outer)][1], n
        else:
            j += 1
            yield o, inner[j % len(inner)][1], n


def gear(teeth=16, layers=5, height=0.6, shrink=0.3):
    """A spiral bevel gear with a keyway in its bore; it turns by one tooth from bottom to top."""
    tooth = ((0.0, 0.78), (0.18, 0.78), (0.30, 0.90), (0.40, 1.0), (0.60, 1.0), (0.70, 0.90), (0.82, 0.78))
    around = [(2 * math.pi * (k + u) / teeth, r) for k in range(teeth) for u, r in tooth]
    bore = [(0.0, 0.27), (0.2, 0.275), (0.28, 0.21)] + [(0.28 + (2 * math.pi - 0.56) * i / 27, 0.21) for i in range(1, 28)] + [(2 * math.pi - 0.2, 0.275)]
    n, m, points, triangles = len(around), len(bore), [], []
    for layer in range(layers + 1):
        u = layer / layers
        points += ring(around, 1 - shrink * u, u * 2 * math.pi / teeth, height * u)
    first = len(points)
    points += ring(bore, 1, 0, 0) + ring(bore, 1, 0, height)
    for layer in range(layers):
        triangles += wall(layer * n, layer * n + n, n)
    triangles += (t[::-1] for t in wall(first, first + m, m))
    top = [layers * n + (i - len(tooth)) % n for i in range(n)]
    for outer, inner, turn in ((list(range(n)), first, -1), (top, first + m, 1)):
        pairs = [(a, v) for (a, _), v in zip(around, outer)], [(a, inner + i) for i, (a, _) in enumerate(bore)]
        triangles += (t[::turn] for t in between(*pairs))
    return points, triangles


def star():
    """The small stellated dodecahedron: a pyramid with an acute tip on each face of a dodecahedron."""
    phi = (1 + math.sqrt(5)) / 2
    tips = [p for a in (-1, 1) for b in (-phi, phi) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    touching = [set(q) for q in itertools.combinations(range(12), 3) if all(math.dist(tips[i], tips[j]) < 2.1 for i, j in itertools.combinations(q, 2))]
    points = tips + [tuple(sum(tips[i][k] for i in q) / (3 * phi) for k in range(3)) for q in touching]
    triangles = []
    for tip, (v, p), (w, q) in ((t, a, b) for t in range(12) for a, b in itertools.combinations(enumerate(touching), 2)):
        if tip in p & q and len(p & q) == 2:
            a, b, c = points[tip], points[12 + v], points[12 + w]
            volume = sum(a[i] * (b[j] * c[k] - b[k] * c[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
            triangles.append((tip, 12 + v, 12 + w) if volume > 0 else (tip, 12 + w, 12 + v))
    return points, triangles


def sphere(centre, radius, hole=()):
    """Twelve rings of twenty vertices; without the squares of the hole."""
    around, rings = 20, 12

    def corner(i, j):
        return int(i > 0) if i in (0, rings) else 2 + (i - 1) * around + j % around

    places = [(0, 0), (math.pi, 0)] + [(math.pi * i / rings, 2 * math.pi * (j + 0.3) / around) for i in range(1, rings) for j in range(around)]
    points = [(centre[0] + radius * math.sin(t) * math.cos(p), centre[1] + radius * math.sin(t) * math.sin(p), centre[2] + radius * math.cos(t))
              for t, p in places]
    squares = [(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)) for i in range(rings) for j in range(around) if (i, j) not in hole]
    return points, [t for a, b, c, d in squares for t in ((a, b, c), (a, c, d)) if len(set(t)) == 3]


def scan(n=30):
    """A ball with waves and noise, of 12 n^2 triangles."""
    number, triangles = {}, []
    for axis, side, i, j in itertools.product(range(3), (0, n), range(n), range(n)):
        square = []
        for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
            corner = [side, i + di, j + dj]
            square.append(number.setdefault(tuple(corner[-axis:] + corner[:-axis]), len(number)))
        a, b, c, d = square if side else square[::-1]
        triangles += [(a, b, c), (a, c, d)]
    points = []
    for k, corner in enumerate(number):
        x, y, z = (2 * c / n - 1 for c in corner)
        r = math.sqrt(x * x + y * y + z * z)
        x, y, z = x / r, y / r, z / r
        r = 0.75 + 0.12 * math.sin(4 * x + 1) * math.cos(5 * y) * math.cos(3 * z) + 0.003 * (k * 7919 % 101 / 50 - 1)
        points.append((r * x, r * y, 0.25 + r * z))
    return points, triangles


def dirty_spheres():
    """Two spheres that overlap; a hole, a triangle that is there twice, and one that is turned round."""
    (points, triangles), (more, others) = sphere((0, 0, 0), 1, {(5, 14), (5, 15), (6, 14)}), sphere((1.1, 0.25, 0.1), 0.8)
    triangles += [tuple(v + len(points) for v in t) for t in others]
    triangles.append(triangles[697])
    triangles[653] = triangles[653][::-1]
    return points + more, triangles


def turned(surface):
    """In another position, coordinates rounded to five decimals."""
    points, triangles = surface
    axes = (0.96, 0, 0.28), (0.0784, 0.96, -0.2688), (-0.2688, 0.28, 0.9216)
    return [tuple(round(sum(a * x for a, x in zip(axis, p)), 5) for axis in axes) for p in points], triangles


def write_off(path, surface):
    points, triangles = surface
    with open(path, "w") as file:
        file.write("OFF\n%d %d 0\n" % (len(points), len(triangles)))
        file.writelines("%r %r %r\n" % tuple(map(float, p)) for p in points)
        file.writelines("3 %d %d %d\n" % t for t in triangles)
