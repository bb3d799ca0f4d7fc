#!/usr/bin/env python3
"""A picture: the tetrahedra on one side of a plane, coloured by their size. Usage: picture.py [OUT.png]"""
import os
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import tetproof
from poisson import cube

FACES = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]


def main(out):
    mesh = tetproof.mesh(cube(), max_edge=0.25)
    middles = mesh.points[mesh.tetrahedra].mean(axis=1)
    kept = mesh.tetrahedra[middles.sum(axis=1) < 1.5]
    faces = np.concatenate([kept[:, list(face)] for face in FACES])
    _, first, times = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    seen = first[times == 1]
    sizes = np.tile(np.cbrt(mesh.volumes()[middles.sum(axis=1) < 1.5]), 4)[seen]
    figure = plt.figure(figsize=(6, 6))
    axes = figure.add_subplot(projection="3d")
    colours = plt.cm.viridis((sizes - sizes.min()) / max(np.ptp(sizes), 1e-9))
    axes.add_collection3d(Poly3DCollection(mesh.points[faces[seen]], facecolors=colours, edgecolors="black", linewidths=0.3))
    axes.set_box_aspect((1, 1, 1))
    figure.savefig(out, dpi=100)
    print("%s: %d faces of %d tetrahedra" % (os.path.basename(out), len(seen), len(kept)))
    image = plt.imread(out)
    assert len(np.unique(image.reshape(-1, image.shape[2]), axis=0)) > 100


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(sys.argv[1])
    else:
        with tempfile.TemporaryDirectory() as folder:
            main(os.path.join(folder, "picture.png"))
