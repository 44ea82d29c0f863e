# SPDX-License-Identifier: MIT
"""Meshes of this page in Gmsh 4.1: blocks of 6-node triangles. As a program it writes blocks.msh, split.msh, hertz.msh and
plate.msh; page.py makes finer ones with the same functions."""
import pathlib

import numpy as np

OVERLAP = 1e-6    # Bodies that nothing else holds begin so deep in each other: the contact is closed from the first iteration.


class Mesh:
    """Bodies of cells, each of two triangles, and their boundaries NAME_bottom, NAME_top, NAME_side; all left sides are `axis`."""

    def __init__(self):
        self.points, self.cells, self.edges = [], {}, {}

    def block(self, name, r, z, shape=lambda r, z: (r, z)):
        """Adds a body; shape moves its nodes, those in the middle of sides too."""
        first = len(self.points)
        wide, high = 2 * len(r) - 2, 2 * len(z) - 2
        grid_r = np.interp(range(wide + 1), range(0, wide + 1, 2), r)
        grid_z = np.interp(range(high + 1), range(0, high + 1, 2), z)
        self.points += [shape(r, z) for z in grid_z for r in grid_r]

        def nodes(*places):
            return [first + 1 + (wide + 1) * j + i for i, j in places]

        self.cells[name] = []
        for j in range(0, high, 2):
            for i in range(0, wide, 2):
                self.cells[name].append(nodes((i, j), (i + 2, j), (i + 2, j + 2), (i + 1, j), (i + 2, j + 1), (i + 1, j + 1)))
                self.cells[name].append(nodes((i, j), (i + 2, j + 2), (i, j + 2), (i + 1, j + 1), (i + 1, j + 2), (i, j + 1)))
        for side, j in (("bottom", 0), ("top", high)):
            self.edges[f"{name}_{side}"] = [nodes((i, j), (i + 2, j), (i + 1, j)) for i in range(0, wide, 2)]
        for side, i in (("axis", 0), (f"{name}_side", wide)):
            self.edges.setdefault(side, []).extend(nodes((i, j), (i, j + 2), (i, j + 1)) for j in range(0, high, 2))

    def write(self, path):
        n, names, used = len(self.points), list(self.edges), set(sum(sum(self.cells.values(), []), []))
        assert len(used) == n
        lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names) + len(self.cells))]
        lines += [f'1 {i} "{name}"' for i, name in enumerate(names, 1)]
        lines += [f'2 {len(names) + i} "{name}"' for i, name in enumerate(self.cells, 1)]
        lines += ["$EndPhysicalNames", "$Entities", f"0 {len(names)} {len(self.cells)} 0"]
        lines += [f"{i} 0 0 0 1 2 0 1 {i} 0" for i in range(1, len(names) + 1)]
        lines += [f"{i} 0 0 0 1 2 0 1 {len(names) + i} 0" for i in range(1, len(self.cells) + 1)]
        lines += ["$EndEntities", "$Nodes", f"1 {n} 1 {n}", f"2 1 0 {n}"] + [str(i + 1) for i in range(n)]
        lines += [f"{r:.12g} {z:.12g} 0" for r, z in self.points] + ["$EndNodes", "$Elements"]
        total = sum(map(len, self.cells.values())) + sum(map(len, self.edges.values()))
        lines.append(f"{len(names) + len(self.cells)} {total} 1 {total}")
        tag = 0
        for dimension, kind, lists in ((1, 8, self.edges), (2, 9, self.cells)):
            for i, members in enumerate(lists.values(), 1):
                lines.append(f"{dimension} {i} {kind} {len(members)}")
                for member in members:
                    tag += 1
                    lines.append(" ".join(map(str, (tag, *member))))
        lines.append("$EndElements")
        pathlib.Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


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
