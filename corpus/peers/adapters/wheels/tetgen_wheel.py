"""TetGen by the package tetgen. SWITCHES are TetGen's own.

It fills the outermost shells; which tetrahedra are inside is told by the facets crossed on the way in, and the others (of cavities) are left
out. The only markers are those of facets: adjacent triangles that are exactly coplanar share one, as in corpus/peers/tetgen."""
import sys
import time

sys.dont_write_bytecode = True
import contract  # noqa: E402


def coplanar_classes(model):
    """A marker for each triangle, from 1."""
    import numpy
    from fractions import Fraction
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    triangles, vertices = model.triangles, model.vertices
    count = len(triangles)
    edges = numpy.sort(numpy.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    owner = numpy.tile(numpy.arange(count), 3)
    order = numpy.lexsort((edges[:, 1], edges[:, 0]))
    first, second = order[:-1], order[1:]
    same = (edges[first] == edges[second]).all(axis=1)
    left, right = owner[first[same]], owner[second[same]]
    # The corner of the right triangle that is not on the edge.
    apex = triangles[right].sum(axis=1) - edges[first[same]].sum(axis=1)
    a, b, c, d = *(vertices[triangles[left, i]] for i in range(3)), vertices[apex]
    rows = numpy.stack([b - a, c - a, d - a], axis=1)
    size = numpy.abs(rows).max(axis=(1, 2)) ** 3
    flat = numpy.abs(numpy.linalg.det(rows)) <= 1e-12 * size
    for i in numpy.flatnonzero(flat):
        corners = [[Fraction(float(x)) for x in point[i]] for point in (a, b, c, d)]
        u, v, w = ([x - y for x, y in zip(corner, corners[0])] for corner in corners[1:])
        flat[i] = (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0])) == 0
    links = coo_matrix((numpy.ones(flat.sum()), (left[flat], right[flat])), shape=(count, count))
    return connected_components(links, directed=False)[1].astype(numpy.int32) + 1


def inside(tetrahedra, facets):
    """Which tetrahedra are behind an odd number of facets, counted from outside."""
    import numpy
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import breadth_first_order, connected_components

    count = len(tetrahedra)
    faces = numpy.sort(tetrahedra[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]].reshape(-1, 3), axis=1).astype(numpy.int64)
    owner = numpy.repeat(numpy.arange(count), 4)
    base = int(tetrahedra.max()) + 1

    def key(corners):
        return (corners[:, 0] * base + corners[:, 1]) * base + corners[:, 2]

    if base ** 3 >= 2 ** 63:
        raise contract.Refused("more vertices than the adapter counts")
    keys = key(faces)
    is_facet = numpy.isin(keys, key(numpy.sort(facets, axis=1).astype(numpy.int64)))
    order = numpy.argsort(keys, kind="stable")
    first = order[:-1][keys[order[:-1]] == keys[order[1:]]]
    second = order[1:][keys[order[:-1]] == keys[order[1:]]]
    # Groups of tetrahedra with no facet between them; then the groups, and the outside as one more, across facets.
    open_pair = ~is_facet[first]
    links = coo_matrix((numpy.ones(open_pair.sum()), (owner[first[open_pair]], owner[second[open_pair]])), shape=(count, count))
    groups, group = connected_components(links, directed=False)
    lonely = numpy.ones(len(keys), dtype=bool)
    lonely[first] = lonely[second] = False
    borders = numpy.flatnonzero(lonely)
    closed = ~open_pair
    one = numpy.concatenate([group[owner[first[closed]]], group[owner[borders]]])
    other = numpy.concatenate([group[owner[second[closed]]], numpy.full(len(borders), groups)])
    across = coo_matrix((numpy.ones(len(one)), (one, other)), shape=(groups + 1, groups + 1)).tocsr()
    nodes, before = breadth_first_order(across, groups, directed=False)
    depth = numpy.zeros(groups + 1, dtype=int)
    for node in nodes[1:]:
        depth[node] = depth[before[node]] + 1
    return depth[group] % 2 == 1


def mesh(model, words):
    import tetgen

    markers = coplanar_classes(model)
    started = time.monotonic()
    mesher = tetgen.TetGen(model.vertices, model.triangles.astype("int32"), markers)
    vertices, tetrahedra = mesher.tetrahedralize(switches=" ".join(words))[:2]
    seconds = time.monotonic() - started
    return vertices, tetrahedra[inside(tetrahedra, mesher.trifaces)], seconds


contract.run("tetgen", mesh)
