# SPDX-License-Identifier: MIT
"""Meshes of this page in Gmsh 4.1: blocks of 6-node triangles. As a program it writes blocks.msh, split.msh, hertz.msh and
plate.msh; page.py makes finer ones with the same functions."""
import numpy as np
from tools.gmsh import Mesh

OVERLAP = 1e-6    # Bodies that nothing else holds begin so deep in each other: the contact is closed from the first iteration.


def graded(fine, cell, end, ratio):
    """From 0 to `end`: equal cells up to `fine`, then growing by about `ratio`."""
    near = np.linspace(0, fine, max(1, round(fine / cell)) + 1)
    count = max(1, round(np.log(1 + (end - fine) / cell * (ratio - 1) / ratio) / np.log(ratio)))
    sizes = ratio ** np.arange(1, count + 1)
    return np.concatenate([near, fine + (end - fine) * np.cumsum(sizes) / sizes.sum()])


def blocks():
    """Two unit squares one upon the other, 3 and 4 unequal cells wide."""
    mesh = Mesh()
    mesh.block("lower", [0, 0.29, 0.61, 1], [0, 0.55, 1])
    mesh.block("upper", [0, 0.21, 0.52, 0.74, 1], [1 - OVERLAP, 1.4, 2])
    return mesh


def split():
    """A unit square under two blocks, which meet over the inside of one of its edges: both surfaces end there."""
    mesh = Mesh()
    mesh.block("lower", [0, 0.29, 0.61, 1], [0, 0.55, 1])
    mesh.block("inner", [0, 0.21, 0.52, 0.73], [1 - OVERLAP, 1.4, 2])
    mesh.block("outer", [0.73, 0.9, 1], [1 - OVERLAP, 1.3, 2])
    return mesh


def hertz(radius, contact, cells, domain):
    """A sphere (or cylinder) above a plane: elements of contact/cells within 1.6 contact radii, bodies of domain contact radii."""
    end, cell = domain * contact, contact / cells
    mesh = Mesh()
    r = graded(1.6 * contact, cell, end, 1.25)
    z = graded(contact, cell, end, 1.25)
    mesh.block("plane", r, -z[::-1])
    # The other body's edges are shorter by a third.
    r, z = graded(1.6 * contact, cell / 1.3, end, 1.25), graded(contact, cell / 1.3, end, 1.25)
    mesh.block("sphere", r, z, lambda r, z: (r, (low := radius - np.sqrt(radius**2 - r**2)) + z * (1 - low / end)))
    return mesh


def plate():
    """A plate of 20 mm and radius 0.15 m on soil of 2 m by 2 m, whose elements are smallest under the rim."""
    mesh = Mesh()
    inwards, outwards = graded(0.02, 0.005, 0.15, 1.35), graded(0.02, 0.005, 1.85, 1.4)
    mesh.block("soil", np.concatenate([0.15 - inwards[::-1], 0.15 + outwards[1:]]), -graded(0.04, 0.01, 2, 1.4)[::-1])
    mesh.block("plate", np.linspace(0, 0.15, 11), [-OVERLAP, 0.01, 0.02])
    return mesh


if __name__ == "__main__":
    from tools.results import folder
    here = folder(__file__)
    blocks().write(here / "blocks.msh")
    split().write(here / "split.msh")
    hertz(10, 0.05, 4, 20).write(here / "hertz.msh")
    plate().write(here / "plate.msh")
