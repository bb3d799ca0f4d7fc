#!/usr/bin/env python3
"""Labels as boundary conditions: heat flows through a bar from one end to the other, insulated around. Temperature is linear, exactly."""
import numpy as np
import scipy.sparse.linalg

import tetproof
from poisson import cube, stiffness_and_load

HOT, COLD, INSULATED = 1, 2, 3


def main():
    bar = cube()
    bar.points[:, 0] *= 4
    middle = bar.points[bar.triangles].mean(axis=1)[:, 0]
    bar.labels = np.where(middle == 0, HOT, np.where(middle == 4, COLD, INSULATED)).astype(np.int32)
    bar.names = {HOT: "hot", COLD: "cold", INSULATED: "insulated"}
    mesh = tetproof.mesh(bar, max_edge=0.5)
    matrix, _ = stiffness_and_load(mesh.points, mesh.tetrahedra)
    u = np.zeros(len(mesh.points))
    ends = {label: np.unique(mesh.boundary[mesh.labels == label]) for label in (HOT, COLD)}
    u[ends[HOT]] = 100
    free = np.setdiff1d(np.unique(mesh.tetrahedra), np.concatenate(list(ends.values())))
    u[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free].tocsc(), -(matrix @ u)[free])
    error = np.abs(u - (100 - 25 * mesh.points[:, 0])).max()
    print("%d tetrahedra, %d nodes at the hot end, largest error %.1e" % (len(mesh.tetrahedra), len(ends[HOT]), error))
    assert error < 1e-9


if __name__ == "__main__":
    main()
