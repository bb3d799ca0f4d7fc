#!/usr/bin/env python3
"""Mesh an STL and solve -laplace(u) = 1, u = 0 on the boundary, by linear elements. Usage: poisson.py [PART.stl]

Without a part, a cube of side 1, whose u in the middle is 0.0562 (a series gives 0.05621)."""
import sys

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

import tetproof


def stiffness_and_load(points, tetrahedra):
    a, b, c, d = (points[tetrahedra[:, k]] for k in range(4))
    volume = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
    # The gradient of a corner's hat function: the opposite face's normal over three times the volume.
    normals = np.stack([np.cross(d - b, c - b), np.cross(c - a, d - a), np.cross(d - a, b - a), np.cross(b - a, c - a)], axis=1)
    gradients = normals / (6 * volume)[:, None, None]
    local = np.einsum("tik,tjk->tij", gradients, gradients) * volume[:, None, None]
    rows, columns = np.repeat(tetrahedra, 4, axis=1).ravel(), np.tile(tetrahedra, (1, 4)).ravel()
    n = len(points)
    load = np.bincount(tetrahedra.ravel(), np.repeat(volume / 4, 4), n)
    return scipy.sparse.csr_matrix((local.ravel(), (rows, columns)), (n, n)), load


def cube():
    points = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    triangles = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2],
                 [1, 3, 7], [1, 7, 5]]
    return tetproof.Surface(points, np.array(triangles), np.zeros(12, np.int32))


def main():
    surface = tetproof.read(sys.argv[1]) if len(sys.argv) > 1 else cube()
    size = np.linalg.norm(np.ptp(surface.points, axis=0)) / np.sqrt(3)
    mesh = tetproof.mesh(surface, max_edge=size / 10)
    matrix, load = stiffness_and_load(mesh.points, mesh.tetrahedra)
    free = np.setdiff1d(np.unique(mesh.tetrahedra), mesh.boundary)
    u = np.zeros(len(mesh.points))
    u[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free].tocsc(), load[free])
    print("%d tetrahedra, %d unknowns, largest u %.4f" % (len(mesh.tetrahedra), len(free), u.max()))
    return u.max()


if __name__ == "__main__":
    largest = main()
    if len(sys.argv) == 1:
        assert abs(largest - 0.0562) < 0.003, largest
