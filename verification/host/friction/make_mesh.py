# SPDX-License-Identifier: MIT
"""Writes incline.msh, a block of 0.2 m by 0.04 m on a base, both turned by 20 degrees, and cylinder.msh, a half space of
1 m and a cylinder of radius 10 m above it, cells of 5 mm where they touch."""
import numpy as np
from tools.gmsh import Mesh
from tools.results import folder

SLOPE, RADIUS, CELL = np.radians(20), 10.0, 0.005


def turned(r, z):
    return np.cos(SLOPE) * r - np.sin(SLOPE) * z, np.sin(SLOPE) * r + np.cos(SLOPE) * z


def graded(even, ratio):
    """From 0 by even cells, then growing ones, to 1."""
    x, size = list(np.arange(0, even + CELL / 2, CELL)), CELL
    while x[-1] + 1.5 * ratio * size < 1:
        size *= ratio
        x.append(x[-1] + size)
    return np.array(x + [1.0])


if __name__ == "__main__":
    here = folder(__file__)
    mesh = Mesh()
    mesh.block("base", np.linspace(-0.6, 0.6, 13), np.linspace(-0.1, 0, 2), turned)
    mesh.block("block", np.linspace(-0.1, 0.1, 5), np.linspace(-1e-9, 0.04, 2), turned)
    mesh.write(here / "incline.msh")
    side, up = graded(0.05, 1.9), graded(0.02, 1.7)
    across = np.concatenate([-side[:0:-1], side])
    mesh = Mesh()
    mesh.block("plane", across, -up[::-1])
    mesh.block("cylinder", across, up, lambda r, z: (r, z + r * r / (2 * RADIUS) * (1 - z) - 1e-9))
    mesh.write(here / "cylinder.msh")
