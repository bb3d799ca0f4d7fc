#!/usr/bin/env python3
"""A study of sizes: tetrahedra, angles and time for several largest edges."""
import time

import tetproof
from poisson import cube


def main():
    print("%9s %11s %9s %6s %8s" % ("max_edge", "tetrahedra", "dihedral", "gamma", "seconds"))
    before = 0
    for max_edge in (0.8, 0.4, 0.2, 0.1):
        start = time.process_time()
        mesh = tetproof.mesh(cube(), max_edge=max_edge)
        final = mesh.stats["final"]
        print("%9.2f %11d %9.2f %6.3f %8.2f" % (max_edge, len(mesh.tetrahedra), final["min_dihedral"], final["mean_gamma"],
                                               time.process_time() - start))
        assert len(mesh.tetrahedra) > before
        before = len(mesh.tetrahedra)


if __name__ == "__main__":
    main()
